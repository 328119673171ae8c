//! The command as its users meet it: exit codes, messages, files.

mod bad_input;
mod bench;
mod command;
mod evaluate;
mod listings;
mod render;
mod resume;
mod run;
