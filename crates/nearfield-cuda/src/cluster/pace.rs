//! How far the host goes ahead of the device where steps are made by lists.

/// Steps that a list is first thought to serve for.
const FIRST_LIFE: u64 = 8;

/// Most steps enqueued for a list: those that would serve longer are made anew, which then costs little.
const MOST_STEPS: u64 = 200;

/// Most lists between waits: where the device runs out of room for one, nothing is done in those after it.
const MOST_LISTS: u64 = 64;

/// Steps beyond the last are not done, but cost less than a sequence that was not enqueued before.
const FEW: u64 = 8;

/// What lists have served for lately.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pace {
    steps: u64,
    typical: f64,
    lists: u64,
}

/// How many lists and steps are enqueued before the host waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stretch {
    /// Lists to be made, each after the steps of the one before.
    pub lists: u64,
    /// Steps to each list, the one at hand included.
    pub steps: u64,
    /// Steps by the last list; none where another stretch is to follow.
    pub rest: u64,
}

/// How lists have served in a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Served {
    /// Lists that served and were followed by another.
    pub lists: u64,
    /// Steps by these.
    pub steps: u64,
    /// Most steps by one of these, or of the last as far as it got.
    pub longest: u64,
}

impl Pace {
    pub fn new() -> Self {
        Self { steps: FIRST_LIFE, typical: FIRST_LIFE as f64, lists: 1 }
    }

    /// For `wanted` steps.
    pub fn stretch(&self, wanted: u64) -> Stretch {
        let lists = (wanted as f64 / self.typical) as u64;
        if lists > self.lists {
            return Stretch { lists: self.lists, steps: self.steps, rest: 0 };
        }
        Stretch { lists, steps: self.steps, rest: self.steps.min(wanted.max(1).next_multiple_of(FEW)) }
    }

    /// A step beyond those that the longest has served for costs less than a list that comes a step early.
    pub fn learn(&mut self, served: Served) {
        let grown = if served.longest >= self.steps { self.steps + self.steps / 2 } else { served.longest };
        self.steps = (grown + 1).max(self.steps - 1).min(MOST_STEPS);
        if served.lists > 0 {
            let lists = served.lists as f64;
            self.typical += (served.steps as f64 / lists - self.typical) * lists / (lists + 1.0);
        }
        self.lists = (2 * self.lists).min(MOST_LISTS);
    }

    /// There was no room for a list: others may need more, too.
    pub fn hold_back(&mut self) {
        self.lists = 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stretches of lists that serve for `life` steps each.
    fn after(life: u64, stretches: u64) -> Pace {
        let mut pace = Pace::new();
        for _ in 0..stretches {
            let Stretch { lists, steps, .. } = pace.stretch(u64::MAX);
            let longest = life.min(steps);
            pace.learn(Served { lists, steps: lists * longest, longest });
        }
        pace
    }

    #[test]
    fn a_list_gets_one_step_more_than_it_serves_for() {
        assert_eq!(after(7, 10).steps, 8);
        assert_eq!(after(30, 10).steps, 31);
        assert_eq!(after(1, 10).steps, 2);
        assert_eq!(after(100_000, 20).steps, MOST_STEPS);
        assert!((after(30, 20).typical - 30.0).abs() < 1.0);
    }

    #[test]
    fn stretches_grow_and_end_where_they_are_wanted_to() {
        let pace = after(7, 10);
        assert_eq!(pace.stretch(1_000_000), Stretch { lists: MOST_LISTS, steps: 8, rest: 0 });
        assert_eq!(pace.stretch(100), Stretch { lists: 14, steps: 8, rest: 8 });
        assert_eq!(pace.stretch(3), Stretch { lists: 0, steps: 8, rest: 8 });
        assert_eq!(pace.stretch(0), Stretch { lists: 0, steps: 8, rest: 8 });
        assert_eq!(Pace::new().stretch(1000), Stretch { lists: 1, steps: 8, rest: 0 });
    }

    #[test]
    fn a_list_that_never_ends_is_not_made_anew_for_few_steps() {
        let pace = after(100_000, 20);
        assert_eq!(pace.stretch(100), Stretch { lists: 0, steps: MOST_STEPS, rest: 104 });
    }
}
