//! The progress bar of a run, on stderr when that is a terminal.

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
