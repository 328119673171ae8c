//! How much more power a device draws while it builds, from a meter that is far slower than a build.

use crate::engine::StepCost;

/// Reads how much energy a device has used. Core has no clock, so the reader tells the time too.
pub trait EnergyCounter: Send {
    /// Energy used, \[J\], and time passed, \[s\], since some moment.
    fn read(&mut self) -> (f64, f64);
}

/// Seconds of work before the first trial.
const FIRST: f64 = 2.0;
/// Seconds of work between the first two trials, doubled each time: one part in a hundred is spent on them, and less later.
const BETWEEN: f64 = 50.0;
/// No more doublings than this.
const DOUBLINGS: u32 = 4;
/// Seconds of work of a trial, several times what the counter of a GPU takes to be refreshed (20 to 100 ms).
const TRIAL: f64 = 0.5;
/// What is kept of earlier measurements when another is made.
const MEMORY: f64 = 0.5;
/// Least difference in the share of builds, as a part of the time, from which powers can be told.
const LEAST_DIFFERENCE: f64 = 0.02;
/// The ratio is believed within these.
const LIMITS: (f64, f64) = (0.1, 10.0);

/// Compares ordinary times with trials in which the structure is built at each step. Both begin and end when the counter
/// is seen to change. All that is no build is taken to draw the same power.
#[derive(Clone, Debug, Default)]
pub(super) struct BuildPower {
    ordinary: Account,
    trial: Account,
    in_trial: bool,
    trials: u32,
    /// Seconds of work since the last change between the two, and those of them spent on builds.
    work: f64,
    builds: f64,
    /// Energy and time at that change.
    begin: Option<(f64, f64)>,
    /// Energy at the last look, once the time is over.
    seen: Option<f64>,
}

/// Energy, time, and the part of it spent on builds.
#[derive(Clone, Copy, Debug, Default)]
struct Account {
    joules: f64,
    seconds: f64,
    builds: f64,
}

impl Account {
    fn add(&mut self, joules: f64, seconds: f64, builds: f64) {
        self.joules = MEMORY * self.joules + joules;
        self.seconds = MEMORY * self.seconds + seconds;
        self.builds = MEMORY * self.builds + builds;
    }
}

impl BuildPower {
    /// Whether the structure is to be built at each step, to see what that takes.
    pub fn in_trial(&self) -> bool {
        self.in_trial
    }

    /// Mean power of a build over that of all else; 1 as long as nothing else is known.
    pub fn ratio(&self) -> f64 {
        let share = |account: &Account| account.builds / account.seconds;
        let power = |account: &Account| account.joules / account.seconds;
        let difference = share(&self.trial) - share(&self.ordinary);
        // Not a number before both were measured.
        if difference.is_nan() || difference < LEAST_DIFFERENCE {
            return 1.0;
        }
        let excess = (power(&self.trial) - power(&self.ordinary)) / difference;
        let other = power(&self.ordinary) - share(&self.ordinary) * excess;
        if other > 0.0 { (1.0 + excess / other).clamp(LIMITS.0, LIMITS.1) } else { LIMITS.1 }
    }

    /// Takes what a step cost, and reads the counter where a trial is to begin or end.
    pub fn record(&mut self, cost: StepCost, counter: &mut dyn EnergyCounter) {
        let begin = *self.begin.get_or_insert_with(|| counter.read());
        self.work += cost.structure + cost.query;
        self.builds += if cost.built { cost.structure } else { 0.0 };
        let duration = match (self.in_trial, self.trials) {
            (true, _) => TRIAL,
            (false, 0) => FIRST,
            (false, trials) => BETWEEN * f64::from(1u32 << (trials - 1).min(DOUBLINGS)),
        };
        if self.work < duration {
            return;
        }
        let (joules, now) = counter.read();
        if self.seen.replace(joules).is_none_or(|seen| seen == joules) {
            return;
        }
        // A counter that started again, or a clock that stood still, is no reading.
        if joules > begin.0 && now > begin.1 {
            let account = if self.in_trial { &mut self.trial } else { &mut self.ordinary };
            account.add(joules - begin.0, now - begin.1, self.builds);
        }
        self.in_trial = !self.in_trial;
        self.trials += u32::from(self.in_trial);
        (self.work, self.builds, self.begin, self.seen) = (0.0, 0.0, Some((joules, now)), None);
    }
}
