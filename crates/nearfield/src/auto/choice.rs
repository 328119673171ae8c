//! Which method was chosen, and why.

use super::Survey;
use nearfield_core::Method;
use serde::Serialize;
use std::fmt::Write;

/// A method that could be used.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Candidate {
    /// The method.
    pub method: Method,
    /// Seconds of a step by the cost model.
    pub predicted_seconds: f64,
    /// Seconds of a step as last measured; absent where it was not tried.
    pub measured_seconds: Option<f64>,
}

impl Candidate {
    /// The best that is known of how long a step takes.
    pub fn seconds(&self) -> f64 {
        self.measured_seconds.unwrap_or(self.predicted_seconds)
    }
}

/// A change of method in a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Switch {
    /// The last step by the method before.
    pub step: u64,
    /// The method before.
    pub from: Method,
    /// The method after.
    pub to: Method,
}

/// How the method was chosen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// The method.
    pub method: Method,
    /// Why, in a sentence.
    pub reason: String,
    /// What the system looked like; absent where the user chose.
    pub survey: Option<Survey>,
    /// What could have been chosen, the best first.
    pub candidates: Vec<Candidate>,
    /// Changes of method so far.
    pub switches: Vec<Switch>,
}

impl Choice {
    /// The method the user chose.
    pub fn of_user(method: Method) -> Self {
        Self { method, reason: "chosen by the user".into(), survey: None, candidates: Vec::new(), switches: Vec::new() }
    }

    /// The method, why, and a table of the candidates: several lines.
    pub fn explain(&self) -> String {
        let mut text = format!("method {}: {}", self.method, self.reason);
        if let Some(survey) = self.survey {
            let radii = if survey.variable_radii { "a radius for each" } else { "one radius" };
            let Survey { n, neighbors, .. } = survey;
            write!(text, "\n  {n} particles, {radii}, about {neighbors:.3} neighbours of each").expect("text");
        }
        if !self.candidates.is_empty() {
            write!(text, "\n  {:<12} {:>14} {:>14}", "", "predicted ms", "measured ms").expect("text");
        }
        for candidate in &self.candidates {
            let measured = candidate.measured_seconds.map_or("-".into(), |seconds| format!("{:.4}", seconds * 1e3));
            let predicted = candidate.predicted_seconds * 1e3;
            write!(text, "\n  {:<12} {predicted:>14.4} {measured:>14}", candidate.method).expect("text");
        }
        for Switch { step, from, to } in &self.switches {
            write!(text, "\n  {from} until step {step}, then {to}").expect("text");
        }
        text
    }
}
