//! `nearfield neighbors`: every pair within a cutoff.

use super::{forces::plan, note_radii, print_json, print_line};
use crate::{arguments::NeighborsArguments, failure::Failure};
use nearfield::{ListKind, ListRequest, Method, NeighborList, engine, file_points, io};
use serde::Serialize;
use std::time::Instant;

/// What `--json` prints.
#[derive(Serialize)]
struct Summary {
    n: usize,
    pairs: usize,
    /// Neighbours of the particle that has fewest.
    min: usize,
    /// Neighbours of the particle that has most.
    max: usize,
    mean: f64,
    device: String,
    method: Method,
    seconds: f64,
}

pub fn run(arguments: &NeighborsArguments) -> Result<(), Failure> {
    let writer = arguments.output.as_ref().map(|path| writer(path)).transpose()?;
    let system = file_points(&arguments.input, arguments.cutoff, arguments.how.boundary)?;
    note_radii(&system.radii);
    let mut engine = engine(arguments.how.device)?;
    let plan = plan(&mut *engine, &system, &arguments.how)?;
    let kind = if arguments.half { ListKind::Half } else { ListKind::Full };
    let wanted = arguments.output.is_some();
    let shifts = wanted && system.sim_box.any_periodic();
    let start = Instant::now();
    engine.load(&system, &plan)?;
    let list = engine.neighbor_list(ListRequest { kind, shifts, distances: wanted, sorted: wanted })?;
    let seconds = start.elapsed().as_secs_f64();
    if let (Some(write), Some(path)) = (writer, &arguments.output) {
        write(path, &list)?;
    }
    let neighbors = counts(&list);
    let n = neighbors.len();
    let summary = Summary {
        n,
        pairs: list.n_pairs(),
        min: neighbors.iter().copied().min().unwrap_or(0),
        max: neighbors.iter().copied().max().unwrap_or(0),
        mean: 2.0 * list.n_pairs() as f64 / n.max(1) as f64,
        device: engine.device(),
        method: plan.method,
        seconds,
    };
    if arguments.how.json {
        return print_json(&summary);
    }
    let Summary { pairs, min, max, mean, device, method, .. } = summary;
    print_line(&format!("{}: {n} particles, {pairs} pairs within range", io::input_name(&arguments.input)));
    print_line(&format!("neighbours of a particle: {min} to {max}, {mean:.3} on average"));
    print_line(&format!("method {method} on {device}, {:.3} ms", seconds * 1e3));
    Ok(())
}

/// Neighbours of each particle; a half list counts for both.
fn counts(list: &NeighborList) -> Vec<usize> {
    let mut counts: Vec<usize> = (0..list.n_particles()).map(|i| list.row(i).len()).collect();
    if list.kind == ListKind::Half {
        for &j in &list.indices {
            counts[j as usize] += 1;
        }
    }
    counts
}

type Writer = fn(&std::path::Path, &NeighborList) -> io::Result<()>;

/// How to write the file, told before the search so that a wrong name costs nothing.
fn writer(path: &std::path::Path) -> Result<Writer, Failure> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => Ok(|path, list| io::write_pairs_csv(path, list)),
        Some("npz") => Ok(|path, list| io::write_pairs_npz(path, list)),
        _ => Err(Failure::request(format!("{}: pairs are written as .csv or .npz", path.display()))),
    }
}
