//! Progress bars, on stderr when that is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use nearfield::Progress;
use std::fmt::Write;

/// A bar with rate, time left and the present temperature and energy.
pub struct RunBar {
    bar: ProgressBar,
    n_particles: usize,
}

impl RunBar {
    /// A bar from `step` to `last_step`.
    pub fn new(step: u64, last_step: u64, n_particles: usize) -> Self {
        // Hidden by itself where stderr is no terminal.
        let bar = ProgressBar::with_draw_target(Some(last_step), ProgressDrawTarget::stderr());
        let rate = |state: &ProgressState, out: &mut dyn Write| {
            // Nothing can be done about a failing terminal.
            let _ = write!(out, "{:.0} steps/s", state.per_sec());
        };
        let template = "{bar:32.cyan/black} {pos}/{len} steps  {rate}  {eta} left  {msg}";
        let style = ProgressStyle::with_template(template).expect("the template is valid").with_key("rate", rate);
        bar.set_style(style);
        bar.set_position(step);
        bar.reset_eta();
        Self { bar, n_particles }
    }

    /// Shows where the run is.
    pub fn update(&self, progress: &Progress) {
        self.bar.set_position(progress.step);
        if let Some(thermo) = progress.thermo {
            let per_particle = thermo.total_energy / self.n_particles as f64;
            self.bar.set_message(format!("T {:.4}  E/N {per_particle:.5}", thermo.temperature));
        }
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

/// A bar of the rows of a picture.
pub struct PictureBar(ProgressBar);

impl PictureBar {
    /// A bar of picture `number`, counted from 1.
    pub fn new(number: usize, n_rows: u32) -> Self {
        let bar = ProgressBar::with_draw_target(Some(n_rows.into()), ProgressDrawTarget::stderr());
        let template = "{bar:32.cyan/black} {percent}% of {msg}  {eta} left";
        bar.set_style(ProgressStyle::with_template(template).expect("the template is valid"));
        bar.set_message(format!("picture {number}"));
        Self(bar)
    }

    /// Another row is drawn; from any thread.
    pub fn row_done(&self) {
        self.0.inc(1);
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// A bar of the measurements of a suite.
pub struct SuiteBar(ProgressBar);

impl SuiteBar {
    /// A bar of the suite of that name.
    pub fn new(suite: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
        let template = "{prefix:11} {bar:32.cyan/black} {pos}/{len}  {eta} left  {wide_msg}";
        bar.set_style(ProgressStyle::with_template(template).expect("the template is valid"));
        bar.set_prefix(suite);
        Self(bar)
    }

    /// Shows what comes next.
    pub fn update(&self, done: usize, total: usize, what: &str) {
        self.0.set_length(total as u64);
        self.0.set_position(done as u64);
        self.0.set_message(what.to_owned());
    }

    /// Removes the bar.
    pub fn clear(&self) {
        self.0.finish_and_clear();
    }
}
