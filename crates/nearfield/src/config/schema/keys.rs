//! The table of keys, in the order they are printed.

use super::{Accepts, Key, Section};
use nearfield_core::{Images, Method, Order, potentials::Potential};

const NUMBER: Accepts = Accepts::Words("a number");
const WHOLE: Accepts = Accepts::Words("a whole number, 0 or more");
const SWITCH: Accepts = Accepts::Words("true or false");
const TEXT: Accepts = Accepts::Words("text in quotes");
const RANGE: Accepts = Accepts::Words("two numbers [low, high]");
const VECTOR: Accepts = Accepts::Words("three numbers [x, y, z]");
const SKIN: Accepts = Accepts::Words("a number, or \"auto\"");
const MEMORY: Accepts = Accepts::Words("bytes, or text such as \"4 GiB\"");
const BOUNDARY: Accepts = Accepts::Names(|| vec!["periodic", "wall", "open"]);

const fn key(name: &'static str, accepts: Accepts, about: &'static str) -> Key {
    Key { name, accepts, about, example: None }
}

const fn optional(name: &'static str, accepts: Accepts, about: &'static str, example: &'static str) -> Key {
    Key { name, accepts, about, example: Some(example) }
}

const fn section(name: &'static str, about: &'static str, keys: &'static [Key]) -> Section {
    Section { name, about, repeated: false, keys, sections: &[] }
}

/// The names of a choice that can also be left to Nearfield.
fn or_auto(names: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    std::iter::once("auto").chain(names).collect()
}

/// The whole file.
pub(in crate::config) static ROOT: Section = Section {
    name: "",
    about: "",
    repeated: false,
    keys: &[],
    sections: &[
        Section {
            sections: &[Section { sections: &[RADII], ..GENERATE }],
            ..section("system", "what is simulated: an input file or generated particles", SYSTEM)
        },
        section("boundary", "what happens at the faces of the box", BOUNDARIES),
        Section {
            sections: &[Section { repeated: true, ..section("type", "one entry for each type of particle", TYPE) }],
            ..section("interaction", "forces", INTERACTION)
        },
        section("method", "how it is computed", METHOD),
        section("dynamics", "how particles move", DYNAMICS),
        section("output", "what is written; an interval of 0 turns an output off", OUTPUT),
    ],
};

const SYSTEM: &[Key] =
    &[optional("input", TEXT, "input file, relative to this file; excludes [system.generate]", "\"start.xyz\"")];

const GENERATE: Section = section(
    "generate",
    "initial conditions",
    &[
        key(
            "positions",
            Accepts::Names(|| vec!["fcc", "lattice", "disordered", "cluster", "uniform", "sphere-surface"]),
            "arrangement",
        ),
        key("n", WHOLE, "number of particles"),
        optional("density", NUMBER, "particles per volume, for a cubic box; excludes box", "0.8442"),
        optional("box", VECTOR, "box lengths; excludes density", "[1000.0, 1000.0, 1000.0]"),
        key("temperature", NUMBER, "of the initial velocities"),
        key("seed", WHOLE, "of positions, radii and velocities"),
        optional("center", VECTOR, "of a cluster; random when absent", "[500.0, 500.0, 500.0]"),
        key("spread", NUMBER, "standard deviation of a cluster on each axis"),
    ],
);

const RADII: Section = section(
    "radii",
    "optional: a search radius for each particle",
    &[
        key("distribution", Accepts::Names(|| vec!["constant", "uniform", "lognormal"]), "of the radii"),
        key("value", NUMBER, "constant: the radius"),
        key("mu", NUMBER, "lognormal: mean of the logarithm"),
        key("sigma", NUMBER, "lognormal: standard deviation of the logarithm"),
        key("range", RANGE, "uniform, lognormal: smallest and largest radius"),
        key("outside", Accepts::Names(|| vec!["redraw", "clamp"]), "lognormal: what happens to draws outside range"),
    ],
);

const BOUNDARIES: &[Key] =
    &[key("x", BOUNDARY, "faces across x"), key("y", BOUNDARY, "faces across y"), key("z", BOUNDARY, "faces across z")];

const INTERACTION: &[Key] = &[
    key("potential", Accepts::Names(|| Potential::NAMES.to_vec()), "pair potential"),
    key("cutoff", NUMBER, "range; ignored where particles have radii"),
    key("truncation", Accepts::Names(|| vec!["cut", "energy", "force"]), "what is shifted to zero at the cutoff"),
    key("mixing", Accepts::Names(|| vec!["lorentz-berthelot", "geometric"]), "rule for unlike types"),
    key("tail_correction", SWITCH, "add what a homogeneous fluid beyond the cutoff contributes"),
    key("kappa", NUMBER, "yukawa: inverse screening length"),
    key("alpha", NUMBER, "morse: inverse width"),
    optional("table", TEXT, "table: file of columns r U F, relative to this file", "\"potential.txt\""),
    key("radius_per_sigma", NUMBER, "where particles have radii, sigma is the pair's range over this"),
];

const TYPE: &[Key] = &[
    optional("name", TEXT, "species or LAMMPS type id; absent: the entry's number, or any if single", "\"1\""),
    key("epsilon", NUMBER, "energy scale"),
    key("sigma", NUMBER, "length scale"),
    key("mass", NUMBER, "mass"),
];

const METHOD: &[Key] = &[
    key("name", Accepts::Names(|| or_auto(Method::ALL.iter().map(|m| m.name()))), "method"),
    key(
        "device",
        Accepts::Names(|| vec!["auto", "cpu", "cuda", "cuda:N"]),
        "where; auto: the first usable GPU, else the CPU",
    ),
    key(
        "maintenance",
        Accepts::Names(|| vec!["every", "fixed:K", "average", "gradient", "gradient:joules", "displacement"]),
        "when a BVH is rebuilt instead of refitted",
    ),
    key("images", Accepts::Names(|| or_auto(Images::ALL.iter().map(|i| i.name()))), "periodic images of BVH methods"),
    key("order", Accepts::Names(|| Order::ALL.iter().map(|o| o.name()).collect()), "of particles in memory"),
    key("skin", SKIN, "list methods: margin around the cutoff, or \"auto\"; 0 builds the list each step"),
    key(
        "list_tolerance",
        NUMBER,
        "cluster on a CPU: drift of energy per particle and time that lists may cause; 0 = none",
    ),
    key("deterministic", SWITCH, "bitwise equal results for any method and number of threads"),
    key("memory_budget", MEMORY, "most memory a stored neighbour list may take"),
];

const DYNAMICS: &[Key] = &[
    key("steps", WHOLE, "number of steps"),
    key("dt", NUMBER, "time step"),
    key("ensemble", Accepts::Names(|| vec!["nve", "langevin", "rescale"]), "thermostat, or none"),
    key("temperature", NUMBER, "langevin, rescale: target"),
    key("friction", NUMBER, "langevin: rate"),
    key("relaxation", NUMBER, "rescale: time"),
    key("max_displacement", NUMBER, "longest move in a step, for starts that overlap; 0 = no limit"),
    key("seed", WHOLE, "of the thermostat"),
];

const OUTPUT: &[Key] = &[
    key("directory", TEXT, "folder for everything"),
    key("thermo_every", WHOLE, "steps between rows of thermo.csv"),
    key("trajectory_every", WHOLE, "steps between frames of the trajectory"),
    key("trajectory", TEXT, "its file name; the extension tells the format"),
    key("velocities", SWITCH, "whether it holds velocities"),
    key("checkpoint_every", WHOLE, "steps between checkpoints"),
    key("rdf_every", WHOLE, "steps between samples of the radial distribution function"),
    key("rdf_bins", WHOLE, "its bins up to the cutoff"),
    key("msd_every", WHOLE, "steps between samples of the mean squared displacement"),
];
