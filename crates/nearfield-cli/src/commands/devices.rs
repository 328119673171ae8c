//! `nearfield devices`.

use super::{print_json, print_line};
use crate::failure::Failure;

pub fn run(json: bool) -> Result<(), Failure> {
    let devices = nearfield::devices();
    if json {
        return print_json(&devices);
    }
    for device in devices {
        let usable = if device.usable { "usable" } else { "not usable" };
        print_line(&format!("{:<6} {usable:<11} {}", device.name, device.detail));
    }
    Ok(())
}
