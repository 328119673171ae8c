//! Errors on their way to the user: one sentence on stderr, and the exit code.

use crate::commands::print_note;
use std::{fmt, process::ExitCode};

/// Why a command failed.
#[derive(Debug)]
pub struct Failure {
    message: String,
    /// Whether the request was wrong (exit code 2) rather than its execution (1).
    is_request: bool,
}

impl Failure {
    /// The request cannot be meant.
    pub fn request(message: impl fmt::Display) -> Self {
        Self { message: message.to_string(), is_request: true }
    }

    /// The request was carried out, and something in it went wrong.
    pub fn execution(message: impl fmt::Display) -> Self {
        Self { message: message.to_string(), is_request: false }
    }

    /// Puts what was being read before the message.
    pub fn within(mut self, place: impl fmt::Display) -> Self {
        self.message = format!("{place}: {}", self.message);
        self
    }

    /// Prints the message and gives the exit code.
    pub fn report(&self) -> ExitCode {
        print_note(&format!("error: {}", self.message));
        ExitCode::from(if self.is_request { 2 } else { 1 })
    }
}

impl<E: Into<nearfield::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        let error = error.into();
        Self { message: error.to_string(), is_request: error.is_request() }
    }
}
