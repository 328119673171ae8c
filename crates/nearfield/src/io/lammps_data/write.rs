//! Writing, in atom style atomic.

use crate::io::{Configuration, number};
use std::io::Write;

/// Writes the file, or says why the format cannot hold the configuration. `configuration` has no
/// [`Configuration::flaw`]. Radii and forces are left out: atom style atomic has no place for them.
pub(in crate::io) fn encode(configuration: &Configuration, out: &mut Vec<u8>) -> Result<(), &'static str> {
    let Some(bounds) = configuration.bounds else { return Err("a LAMMPS data file needs a box") };
    let names = &configuration.species.names;
    let title = match (&configuration.comment, configuration.step) {
        (Some(comment), _) => comment.replace(['\n', '\r'], " "),
        (None, Some(step)) => format!("LAMMPS data file via Nearfield, timestep = {step}"),
        (None, None) => "LAMMPS data file via Nearfield".to_owned(),
    };
    let mut header = format!("{title}\n\n{} atoms\n{} atom types\n\n", configuration.len(), names.len()).into_bytes();
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        number::push(&mut header, bounds.lo[axis]);
        number::push(&mut header, bounds.hi[axis]);
        writeln!(header, " {name}lo {name}hi").expect("writing to memory");
    }
    out.append(&mut header);
    encode_labels(names, out);
    if let Some(masses) = &configuration.mass {
        out.extend_from_slice(b"\nMasses\n\n");
        for (kind, &mass) in (1..).zip(masses) {
            encode_entry(out, kind, |out| number::push(out, mass));
        }
    }
    let id = |i: usize| configuration.id.as_ref().map_or(i as u64 + 1, |id| id[i]);
    out.extend_from_slice(b"\nAtoms # atomic\n\n");
    for i in 0..configuration.len() {
        encode_entry(out, id(i), |out| {
            write!(out, " {}", configuration.species.of[i] + 1).expect("writing to memory");
            number::push_vector(out, configuration.position.get(i));
            if let Some(image) = &configuration.image {
                let [x, y, z] = image[i];
                write!(out, " {x} {y} {z}").expect("writing to memory");
            }
        });
    }
    if let Some(velocity) = &configuration.velocity {
        out.extend_from_slice(b"\nVelocities\n\n");
        for i in 0..configuration.len() {
            encode_entry(out, id(i), |out| number::push_vector(out, velocity.get(i)));
        }
    }
    Ok(())
}

/// Names that differ from the type numbers are kept as labels, which LAMMPS knows since 2022.
fn encode_labels(names: &[String], out: &mut Vec<u8>) {
    if names.iter().zip(1u64..).all(|(name, kind)| *name == kind.to_string()) {
        return;
    }
    out.extend_from_slice(b"\nAtom Type Labels\n\n");
    for (kind, name) in (1..).zip(names) {
        encode_entry(out, kind, |out| write!(out, " {name}").expect("writing to memory"));
    }
}

fn encode_entry(out: &mut Vec<u8>, id: u64, rest: impl FnOnce(&mut Vec<u8>)) {
    write!(out, "{id}").expect("writing to memory");
    rest(out);
    out.push(b'\n');
}
