//! Notices that steps of a run take longer or shorter than before.

/// Fewest steps that are compared.
const STEPS: u64 = 200;
/// Fewest seconds that are compared.
const SECONDS: f64 = 0.5;
/// Steps have changed when they take this many times, or this part of, what they took.
const TOLERANCE: f64 = 1.4;
/// Each trial that changes nothing makes the next one less likely.
const PATIENCE: f64 = 1.3;

/// Compares windows of steps with the first one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watch {
    first: Option<f64>,
    steps: u64,
    seconds: f64,
    tolerance: f64,
}

impl Default for Watch {
    fn default() -> Self {
        Self { first: None, steps: 0, seconds: 0.0, tolerance: TOLERANCE }
    }
}

impl Watch {
    /// Takes what some steps took. Whether they have changed.
    pub fn has_changed(&mut self, steps: u64, seconds: f64) -> bool {
        self.steps += steps;
        self.seconds += seconds;
        if self.steps < STEPS || self.seconds < SECONDS {
            return false;
        }
        let now = self.seconds / self.steps as f64;
        (self.steps, self.seconds) = (0, 0.0);
        let first = *self.first.get_or_insert(now);
        now > first * self.tolerance || now < first / self.tolerance
    }

    /// Begins anew.
    pub fn restart(&mut self, was_in_vain: bool) {
        let tolerance = if was_in_vain { self.tolerance * PATIENCE } else { TOLERANCE };
        *self = Self { tolerance, ..Self::default() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seconds of a step at which a change is seen, as it grows.
    fn seen(watch: &mut Watch) -> f64 {
        watch.restart(watch.tolerance != TOLERANCE);
        let mut seconds = 0.01;
        while !watch.has_changed(100, 100.0 * seconds) {
            seconds *= 1.01;
        }
        seconds
    }

    #[test]
    fn steady_steps_have_not_changed() {
        let mut watch = Watch::default();
        assert!((0..100).all(|i| !watch.has_changed(50, if i % 2 == 0 { 0.5 } else { 0.6 })));
    }

    #[test]
    fn steps_that_became_slower_or_quicker_have_changed() {
        for factor in [1.5, 0.6] {
            let mut watch = Watch::default();
            assert!(!watch.has_changed(200, 1.0));
            assert!(!watch.has_changed(100, 0.5 * factor), "too few to tell");
            assert!(watch.has_changed(200, factor));
        }
    }

    #[test]
    fn trials_in_vain_grow_rare() {
        let mut watch = Watch::default();
        let first = seen(&mut watch);
        watch.restart(true);
        assert!(seen(&mut watch) > 1.2 * first);
    }
}
