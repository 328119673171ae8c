//! `nearfield methods`.

use super::{print_json, print_line};
use crate::failure::Failure;

pub fn run(json: bool) -> Result<(), Failure> {
    let methods = nearfield::methods();
    if json {
        return print_json(&methods);
    }
    print_line(&format!(
        "{:<10} {:<6} {:<32} {:<18} {:<15} settings",
        "method", "device", "structure, probe, consumer", "in the papers", "variable radii"
    ));
    for m in methods {
        let yes_no = if m.variable_radii { "yes" } else { "no" };
        let mut settings = vec!["order"];
        if m.bvh {
            settings.extend(["images", "maintenance"]);
        }
        if m.list {
            settings.extend(["skin", "memory_budget"]);
        }
        if m.list_tolerance {
            settings.push("list_tolerance");
        }
        let settings = settings.join(", ");
        print_line(&format!(
            "{:<10} {:<6} {:<32} {:<18} {yes_no:<15} {settings}",
            m.method, m.device, m.sentence, m.paper_name
        ));
    }
    print_line(
        "auto takes the one predicted to be the fastest, and in a run that is long enough tries the best few of them.",
    );
    Ok(())
}
