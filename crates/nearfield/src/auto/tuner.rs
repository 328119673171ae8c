//! Which method to use: predicted before a run, tried in it where that pays.

use super::{Candidate, Choice, Profile, Survey, Switch, trial, watch::Watch};
use crate::Result;
use nearfield_core::{Dynamics, Engine, Method, Plan, System};

/// Part of the predicted time of a run that trials may take.
const SHARE: f64 = 0.05;

/// The choice so far, and what may change it.
pub(crate) struct Tuner {
    profile: Profile,
    /// Measured over predicted seconds of methods that were tried: predictions are wrong by about as much again.
    errors: Vec<(Method, f64)>,
    /// Whether the next opportunity to try the candidates is to be taken.
    due: bool,
    watch: Watch,
}

impl Tuner {
    /// The first choice, by the cost model. `plan` gives all settings but the method.
    ///
    /// # Errors
    /// [`crate::Error::Profile`]; that of the simplest method where none supports the system.
    pub fn new(engine: &mut dyn Engine, system: &System, plan: &Plan) -> Result<(Self, Choice)> {
        let tuner = Self { profile: Profile::load()?, errors: Vec::new(), due: true, watch: Watch::default() };
        let survey = Survey::of(system);
        let candidates = tuner.candidates(engine, system, plan, &survey);
        let method = match candidates.first() {
            Some(candidate) => candidate.method,
            None => {
                engine.supports(system, &Plan { method: Method::Cell, ..*plan })?;
                Method::Cell
            }
        };
        let reason = "predicted to be the fastest".into();
        Ok((tuner, Choice { method, reason, survey: Some(survey), candidates, switches: Vec::new() }))
    }

    /// Those that support the system, the best first by prediction.
    fn candidates(&self, engine: &dyn Engine, system: &System, plan: &Plan, survey: &Survey) -> Vec<Candidate> {
        let predicted = self.profile.of(&engine.device()).map(|device| device.predict(survey)).unwrap_or_default();
        let supported = |&(method, _): &(Method, f64)| engine.supports(system, &Plan { method, ..*plan }).is_ok();
        let candidate = |(method, seconds)| Candidate {
            method,
            predicted_seconds: seconds * self.error(method),
            measured_seconds: None,
        };
        let mut candidates: Vec<_> = predicted.into_iter().filter(supported).map(candidate).collect();
        candidates.sort_by(|a, b| a.predicted_seconds.total_cmp(&b.predicted_seconds));
        candidates
    }

    fn error(&self, method: Method) -> f64 {
        self.errors.iter().find(|(other, _)| *other == method).map_or(1.0, |(_, error)| *error)
    }

    /// Takes what some steps took, to notice when they have changed.
    pub fn record(&mut self, steps: u64, seconds: f64) {
        self.due |= self.watch.has_changed(steps, seconds);
    }

    /// Whether candidates may be worth trying: a run that has gone for some steps is taken to go on for as many.
    pub fn is_due(&self, choice: &Choice, (done, remaining): (u64, u64)) -> bool {
        self.due && affordable(&choice.candidates, done.max(remaining)) > 1
    }

    /// Tries as many candidates as a part of the steps to come pays for, the most promising first, from the state after
    /// `done` steps. Gives whether the engine was used: it then has to be loaded again, by the method of `choice`.
    pub fn tune(
        &mut self,
        engine: &mut dyn Engine,
        system: &System,
        dynamics: &Dynamics,
        plan: &Plan,
        (done, remaining): (u64, u64),
        choice: &mut Choice,
    ) -> bool {
        self.due = false;
        // The first choice was made from what the system looks like at the start.
        let survey = choice.survey.filter(|_| done == 0).unwrap_or_else(|| Survey::of(system));
        let mut candidates = self.candidates(engine, system, plan, &survey);
        let affordable = affordable(&candidates, done.max(remaining));
        if affordable < 2 {
            return false;
        }
        for candidate in &mut candidates[..affordable] {
            let plan = Plan { method: candidate.method, ..*plan };
            // What fails here may do so for one method only, as for want of memory; if not, the run will meet it.
            candidate.measured_seconds = trial::seconds_of_step(engine, system, dynamics, done, &plan).ok();
            self.learn(candidate);
        }
        candidates.sort_by(|a, b| key(a).total_cmp(&key(b)));
        let before = choice.method;
        if candidates[0].measured_seconds.is_some() {
            choice.method = candidates[0].method;
            choice.reason = reason(&candidates, done);
        }
        choice.survey = Some(survey);
        choice.candidates = candidates;
        if done > 0 && before != choice.method {
            choice.switches.push(Switch { step: done, from: before, to: choice.method });
        }
        self.watch.restart(before == choice.method);
        true
    }

    fn learn(&mut self, candidate: &Candidate) {
        let Some(measured) = candidate.measured_seconds else { return };
        let error = self.error(candidate.method) * measured / candidate.predicted_seconds;
        self.errors.retain(|(method, _)| *method != candidate.method);
        self.errors.push((candidate.method, error));
    }
}

/// How many of the candidates, the best first, can be tried in a part of the time of so many steps.
fn affordable(candidates: &[Candidate], steps: u64) -> usize {
    let mut left = candidates.first().map_or(0.0, |best| SHARE * steps as f64 * best.seconds());
    let fits = |candidate: &&Candidate| {
        left -= trial::duration(candidate.seconds());
        left >= 0.0
    };
    candidates.iter().take_while(fits).count()
}

/// Those measured first.
fn key(candidate: &Candidate) -> f64 {
    candidate.measured_seconds.unwrap_or(f64::INFINITY)
}

fn reason(candidates: &[Candidate], step: u64) -> String {
    let measured = |candidate: &Candidate| {
        candidate.measured_seconds.map(|seconds| format!("{} {:.4} ms", candidate.method, seconds * 1e3))
    };
    let others: Vec<String> = candidates[1..].iter().filter_map(measured).collect();
    let seconds = candidates[0].seconds() * 1e3;
    let others = if others.is_empty() { "no other could be".into() } else { others.join(", ") };
    format!("fastest of those tried at step {step}: {seconds:.4} ms a step ({others})")
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearfield_core::{
        Boundary, Error, Interaction, ListRequest, NeighborList, Particles, PerParticle, Quantities, Radii, Report,
        Result, SimBox, Totals,
    };
    use std::{thread, time::Duration};

    /// `cell` takes two milliseconds a step; `cluster` one before step 1000, then four; `brute` fails.
    struct Fake(Method);

    impl Engine for Fake {
        fn device(&self) -> String {
            "fake".into()
        }

        fn supports(&self, _: &System, _: &Plan) -> Result<()> {
            Ok(())
        }

        fn load(&mut self, _: &System, plan: &Plan) -> Result<()> {
            self.0 = plan.method;
            Ok(())
        }

        fn evaluate(&mut self, _: Quantities) -> Result<Totals> {
            Ok(Totals::default())
        }

        fn advance(&mut self, _: &Dynamics, from: u64, steps: u64, _: Quantities) -> Result<Totals> {
            let milliseconds = match self.0 {
                Method::Cell => 2,
                Method::Cluster if from < 1000 => 1,
                Method::Cluster => 4,
                _ => return Err(Error::Device("broken".into())),
            };
            thread::sleep(Duration::from_millis(milliseconds * steps));
            Ok(Totals::default())
        }

        fn snapshot(&mut self, _: &mut Particles) -> Result<()> {
            Ok(())
        }

        fn per_particle(&mut self, _: &mut PerParticle) -> Result<()> {
            Ok(())
        }

        fn neighbor_list(&mut self, _: ListRequest) -> Result<NeighborList> {
            Err(Error::NotLoaded)
        }

        fn report(&self) -> Report {
            Report::default()
        }

        fn record_history(&mut self, _: bool) {}
    }

    #[test]
    fn the_fastest_goes_on_until_another_is_faster_and_what_fails_is_not_chosen() {
        let system = System {
            sim_box: SimBox::cubic(10.0, Boundary::Open).expect("a box"),
            particles: Particles::at([[1.0; 3], [5.0; 3]]),
            radii: Radii::Uniform(1.0),
            interaction: Interaction::lennard_jones(),
        };
        let (mut engine, plan, dynamics) = (Fake(Method::Brute), Plan::new(Method::Cell), Dynamics::nve(0.001));
        let (mut tuner, mut choice) = Tuner::new(&mut engine, &system, &plan).expect("a choice");
        assert!(!tuner.is_due(&choice, (0, 10)), "too short to try anything");
        let remaining = 1_000_000_000;
        assert!(tuner.is_due(&choice, (0, remaining)));
        assert!(tuner.tune(&mut engine, &system, &dynamics, &plan, (0, remaining), &mut choice));
        assert_eq!((choice.method, choice.switches.len()), (Method::Cluster, 0), "{choice:?}");
        let brute = choice.candidates.iter().find(|candidate| candidate.method == Method::Brute);
        assert!(brute.is_some_and(|candidate| candidate.measured_seconds.is_none()), "{choice:?}");
        assert!(!tuner.is_due(&choice, (1, remaining)), "nothing has changed");
        tuner.record(1000, 1.0);
        assert!(!tuner.is_due(&choice, (1000, remaining)));
        tuner.record(1000, 4.0);
        assert!(tuner.is_due(&choice, (2000, remaining)));
        assert!(tuner.tune(&mut engine, &system, &dynamics, &plan, (2000, remaining), &mut choice));
        let switch = Switch { step: 2000, from: Method::Cluster, to: Method::Cell };
        assert_eq!((choice.method, &choice.switches[..]), (Method::Cell, &[switch][..]), "{choice:?}");
    }
}
