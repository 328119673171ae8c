//! Writing frames.

use super::elements::is_symbol;
use crate::io::{Bounds, Configuration, number};
use std::io::Write;

/// Appends one frame. `configuration` has no [`Configuration::flaw`].
pub(in crate::io) fn encode(configuration: &Configuration, out: &mut Vec<u8>) {
    writeln!(out, "{}", configuration.len()).expect("writing to memory");
    encode_comment(configuration, out);
    for i in 0..configuration.len() {
        encode_particle(configuration, i, out);
    }
}

fn encode_comment(configuration: &Configuration, out: &mut Vec<u8>) {
    match configuration.bounds {
        Some(bounds) => encode_bounds(bounds, out),
        None => out.extend_from_slice(b"pbc=\"F F F\" "),
    }
    out.extend_from_slice(b"Properties=");
    out.extend_from_slice(properties(configuration).as_bytes());
    if let Some(step) = configuration.step {
        write!(out, " step={step}").expect("writing to memory");
    }
    if let Some(time) = configuration.time {
        out.extend_from_slice(b" time=");
        out.extend_from_slice(zmij::Buffer::new().format(time).as_bytes());
    }
    if let Some(comment) = &configuration.comment {
        let quoted = comment.replace('\\', "\\\\").replace('"', "\\\"").replace(['\n', '\r'], " ");
        write!(out, " comment=\"{quoted}\"").expect("writing to memory");
    }
    out.push(b'\n');
}

/// In double precision, where the difference of two singles is exact unless they are very unlike: then
/// `lo + length` rounds back to `hi`.
fn encode_bounds(bounds: Bounds, out: &mut Vec<u8>) {
    let (lo, hi) = (bounds.lo.map(f64::from), bounds.hi.map(f64::from));
    let length: [f64; 3] = std::array::from_fn(|axis| hi[axis] - lo[axis]);
    let text = |value: f64| zmij::Buffer::new().format(value).to_owned();
    let [x, y, z] = length.map(text);
    write!(out, "Lattice=\"{x} 0.0 0.0 0.0 {y} 0.0 0.0 0.0 {z}\" ").expect("writing to memory");
    if lo != [0.0; 3] {
        let [x, y, z] = lo.map(text);
        write!(out, "Origin=\"{x} {y} {z}\" ").expect("writing to memory");
    }
    if let Some(periodic) = bounds.periodic {
        let [x, y, z] = periodic.map(|p| if p { 'T' } else { 'F' });
        write!(out, "pbc=\"{x} {y} {z}\" ").expect("writing to memory");
    }
}

fn properties(configuration: &Configuration) -> String {
    // ASE refuses a `species` that is no chemical symbol; `type` it keeps as it is, and OVITO takes either for the
    // type.
    let symbols = configuration.species.names.iter().all(|name| is_symbol(name));
    let optional = [
        (configuration.velocity.is_some(), ":velo:R:3"),
        (configuration.force.is_some(), ":forces:R:3"),
        (configuration.mass.is_some(), ":masses:R:1"),
        (configuration.radius.is_some(), ":radius:R:1"),
        (configuration.image.is_some(), ":map_shift:I:3"),
        (configuration.id.is_some(), ":id:I:1"),
    ];
    let species = if symbols { "species:S:1:pos:R:3" } else { "type:S:1:pos:R:3" };
    std::iter::once(species).chain(optional.iter().filter(|(is_there, _)| *is_there).map(|(_, text)| *text)).collect()
}

fn encode_particle(configuration: &Configuration, i: usize, out: &mut Vec<u8>) {
    let species = &configuration.species;
    let kind = species.of[i] as usize;
    out.extend_from_slice(species.names[kind].as_bytes());
    number::push_vector(out, configuration.position.get(i));
    if let Some(velocity) = &configuration.velocity {
        number::push_vector(out, velocity.get(i));
    }
    if let Some(force) = &configuration.force {
        number::push_vector(out, force.get(i));
    }
    if let Some(mass) = &configuration.mass {
        number::push(out, mass[kind]);
    }
    if let Some(radius) = &configuration.radius {
        number::push(out, radius[i]);
    }
    if let Some(image) = &configuration.image {
        let [x, y, z] = image[i];
        write!(out, " {x} {y} {z}").expect("writing to memory");
    }
    if let Some(id) = &configuration.id {
        write!(out, " {}", id[i]).expect("writing to memory");
    }
    out.push(b'\n');
}
