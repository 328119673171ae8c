//! The report of `nearfield plot`: files, page, and the page in a browser where there is one.
//!
//! The browser is Chromium: `NEARFIELD_CHROMIUM` names it, `chromium` on the PATH by default. Without one that test is
//! shown as ignored.

mod browser;
mod fixture;
mod page;

use libtest_mimic::{Arguments, Failed, Trial};

fn main() {
    let trial = |name: &str, body: fn()| {
        Trial::test(name, move || {
            body();
            Ok::<(), Failed>(())
        })
    };
    let trials = vec![
        trial("each_suite_has_its_figures_as_svg_and_png", page::each_suite_has_its_figures_as_svg_and_png),
        trial("the_page_is_well_formed_and_holds_every_figure", page::the_page_is_well_formed_and_holds_every_figure),
        trial("the_page_needs_no_network", page::the_page_needs_no_network),
        trial("results_of_two_devices_are_drawn_together", page::results_of_two_devices_are_drawn_together),
        trial("full_results_take_the_place_of_quick_ones", page::full_results_take_the_place_of_quick_ones),
        trial("wrong_results_are_named_on_the_page", page::wrong_results_are_named_on_the_page),
        trial("a_folder_without_results_is_an_error", page::a_folder_without_results_is_an_error),
        trial("a_browser_shows_every_figure", browser::a_browser_shows_every_figure)
            .with_ignored_flag(browser::chromium().is_none()),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
