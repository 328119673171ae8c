//! The configuration file: defaults, overrides, printing, conversions.

mod refused;

use nearfield::config::{Bytes, Choice, Config, Device, Error, PotentialName, Source};
use nearfield::generate::{Outside, Positions};
use nearfield_core::{
    Boundary, Ensemble, Images, Maintenance, Method, Mixing, Order, Radii, Skin, Truncation, potentials::Potential,
};
use std::{io::Write, path::Path};

fn parse(text: &str) -> Result<Config, Error> {
    Config::parse(text, &[], "")
}

fn parse_with(text: &str, overrides: &[&str]) -> Result<Config, Error> {
    Config::parse(text, &overrides.iter().map(|&option| option.to_owned()).collect::<Vec<_>>(), "")
}

fn message(text: &str) -> String {
    parse(text).unwrap_err().to_string()
}

fn set_message(option: &str) -> String {
    parse_with("", &[option]).unwrap_err().to_string()
}

/// The listing of the manual, with every default written out.
const LISTING: &str = r#"
[system.generate]
positions = "fcc"                 # fcc | lattice | disordered | cluster | uniform | sphere-surface
n = 32000
density = 0.8442                  # or box = [1000.0, 1000.0, 1000.0]
temperature = 1.44
seed = 1
[system.generate.radii]           # optional: per-particle search radii
distribution = "lognormal"        # constant | uniform | lognormal
mu = 1.0
sigma = 2.0
range = [1.0, 330.0]
outside = "redraw"                # redraw | clamp
[boundary]
x = "periodic"                    # periodic | wall | open
y = "periodic"
z = "periodic"
[interaction]
potential = "lennard-jones"       # lennard-jones | wca | yukawa | morse | gaussian | table
cutoff = 2.5                      # ignored where particles have radii
truncation = "cut"                # cut | energy | force
mixing = "lorentz-berthelot"      # lorentz-berthelot | geometric
[[interaction.type]]              # one entry a type; a single anonymous one is the default
name = "1"
epsilon = 1.0
sigma = 1.0
mass = 1.0
[method]
name = "auto"
device = "auto"                   # auto | cpu | cuda | cuda:N
maintenance = "gradient"          # every | fixed:K | average | gradient | gradient:joules | displacement
images = "auto"                   # auto | gamma | instances | ghosts
order = "morton"                  # none | morton | cell
skin = 0.3                        # list methods
deterministic = false
[dynamics]
steps = 1000
dt = 0.005
ensemble = "nve"                  # nve | langevin | rescale
max_displacement = 0.0            # per step; 0 = off
[output]
directory = "out"
thermo_every = 100
trajectory_every = 1000
trajectory = "trajectory.xyz"
checkpoint_every = 10000
"#;

#[test]
fn defaults_are_those_of_the_manual() {
    let listed = parse(LISTING).unwrap();
    let mut sparse = parse("[system.generate]\ndensity = 0.8442\n[system.generate.radii]").unwrap();
    // Two defaults that the listing cannot show: the single type has no name, and the skin is chosen.
    assert_eq!((&sparse.interaction.types[0].name, sparse.method.skin), (&None, Skin::Auto));
    sparse.interaction.types[0].name = Some("1".into());
    sparse.method.skin = Skin::Fixed(0.3);
    assert_eq!(listed, sparse);

    let defaults = parse("").unwrap();
    assert_eq!(defaults, Config::default());
    assert_eq!(defaults.interaction.potential, PotentialName::LennardJones);
    assert_eq!((defaults.interaction.kappa, defaults.interaction.alpha), (1.0, 5.0));
    assert_eq!(defaults.interaction.radius_per_sigma, 2.5);
    assert!(!defaults.interaction.tail_correction);
    assert_eq!((defaults.dynamics.friction, defaults.dynamics.relaxation), (1.0, 0.1));
    assert_eq!((defaults.output.rdf_every, defaults.output.msd_every), (0, 0));
    assert_eq!(sparse.system.generate.unwrap().spread, 25.0);
}

#[test]
fn a_skin_is_a_number_or_chosen() {
    for (written, skin) in [("0.3", Skin::Fixed(0.3)), ("1", Skin::Fixed(1.0)), ("\"auto\"", Skin::Auto)] {
        let config = parse(&format!("[method]\nskin = {written}")).unwrap();
        assert_eq!(config.method.skin, skin);
        assert_eq!(parse(&config.to_toml().unwrap()).unwrap().method.skin, skin);
    }
    assert_eq!(parse_with("", &["method.skin=auto"]).unwrap().method.skin, Skin::Auto);
    assert!(parse("[method]\nskin = 0.3").unwrap().to_toml().unwrap().contains("skin = 0.3 "));
    assert_eq!(message("[method]\nskin = \"thin\""), "line 2: method.skin = \"thin\": expected a number, or \"auto\"");
}

#[test]
fn every_choice_that_is_offered_is_accepted() {
    for (key, choices) in [
        ("system.generate.positions", "fcc|lattice|disordered|cluster|uniform|sphere-surface"),
        ("system.generate.radii.distribution", "constant|uniform|lognormal"),
        ("system.generate.radii.outside", "redraw|clamp"),
        ("boundary.x", "periodic|wall|open"),
        ("interaction.truncation", "cut|energy|force"),
        ("interaction.mixing", "lorentz-berthelot|geometric"),
        ("method.device", "auto|cpu|cuda|cuda:0|cuda:13"),
        ("method.maintenance", "every|fixed:200|average|gradient|displacement"),
        ("method.images", "auto|gamma|instances|ghosts"),
        ("method.order", "none|morton|cell"),
        ("dynamics.ensemble", "nve|langevin|rescale"),
    ] {
        for choice in choices.split('|') {
            let option = format!("{key}={choice}");
            let result = parse_with("[system.generate]\ndensity = 1", &[&option]);
            assert!(result.is_ok(), "{option}: {}", result.unwrap_err());
        }
    }
    for name in Potential::NAMES {
        let table = "interaction.table=rUF.txt";
        parse_with("", &[&format!("interaction.potential={name}"), table]).unwrap();
    }
    for method in Method::ALL {
        let config = parse_with("", &[&format!("method.name={method}")]).unwrap();
        assert_eq!(config.method.name, Choice::Of(*method));
    }
}

#[test]
fn overrides_win_and_take_bare_words() {
    let config = parse_with(
        "[dynamics]\ndt = 0.001\n[[interaction.type]]\nname = \"A\"",
        &[
            "dynamics.dt=0.002",
            "method.maintenance=fixed:20",
            "method.device = cuda:1",
            "boundary.z=wall",
            "interaction.type.0.epsilon=2",
            "interaction.type.1.name=7",
            "system.generate.box=[10, 20, 30]",
            "system.generate.positions=lattice",
            "output.directory=2024-05-01",
            "method.memory_budget=512 MiB",
            "output.velocities=false",
            "dynamics.steps=1",
            "dynamics.steps=2",
        ],
    )
    .unwrap();
    assert_eq!((config.dynamics.dt, config.dynamics.steps), (0.002, 2));
    assert_eq!(config.method.maintenance, Maintenance::Fixed(20));
    assert_eq!(config.method.device, Device::Cuda(Some(1)));
    assert_eq!(config.boundary.axes(), [Boundary::Periodic, Boundary::Periodic, Boundary::Wall]);
    let [a, b] = config.interaction.types.as_slice() else { panic!("two types") };
    assert_eq!((a.name.as_deref(), a.epsilon, b.name.as_deref()), (Some("A"), 2.0, Some("7")));
    let generate = config.system.generate.unwrap();
    assert_eq!((generate.lengths, generate.positions), (Some([10.0, 20.0, 30.0]), Positions::Lattice));
    assert_eq!(config.output.directory, Path::new("2024-05-01"));
    assert_eq!(config.method.memory_budget, Bytes(512 << 20));
    assert!(!config.output.velocities);
}

#[test]
fn an_override_of_the_default_type_needs_no_entry() {
    let config = parse_with("", &["interaction.type.0.sigma=64"]).unwrap();
    assert_eq!(config.interaction.types.len(), 1);
    assert_eq!(config.interaction.types[0].sigma, 64.0);
}

#[test]
fn a_printed_configuration_reads_back_equal() {
    let full = r#"
        [system.generate]
        positions = "cluster"
        n = 77
        box = [1.5, 2.0, 3.25]
        center = [0.1, 0.2, 0.3]
        [system.generate.radii]
        distribution = "uniform"
        range = [0.1, 0.7]
        [boundary]
        x = "wall"
        [interaction]
        potential = "table"
        table = "dir with \"quotes\"/t.txt"
        [[interaction.type]]
        name = "A"
        epsilon = 0.1
        [[interaction.type]]
        mass = 1e-7
        [method]
        name = "rt-list"
        device = "cuda:2"
        maintenance = "fixed:200"
        images = "ghosts"
        memory_budget = 12345
        [dynamics]
        ensemble = "rescale"
        dt = 1e-3
    "#;
    let input = "[system]\ninput = \"start.xyz\"";
    for text in ["", LISTING, full, input] {
        let config = parse(text).unwrap();
        let printed = config.to_toml().unwrap();
        assert_eq!(parse(&printed).unwrap_or_else(|error| panic!("{error}\n{printed}")), config, "{printed}");
    }
}

#[test]
fn what_toml_cannot_hold_is_not_printed() {
    let mut config = Config::default();
    config.dynamics.seed = u64::MAX;
    let error = config.to_toml().unwrap_err().to_string();
    assert!(error.starts_with("the configuration cannot be written as TOML: "), "{error}");
}

#[test]
fn a_printed_configuration_shows_every_key_explained() {
    let printed = parse("").unwrap().to_toml().unwrap();
    for line in printed.lines().filter(|line| !line.is_empty()) {
        assert!(line.trim_start_matches("# ").contains("# "), "no comment: {line}");
        assert!(line.chars().count() <= 160, "long line: {line}");
    }
    // Commented-out sections and keys are valid too: with the marks removed, all but the alternatives parse.
    let uncommented: String = printed
        .lines()
        .map(|line| line.strip_prefix("# ").unwrap_or(line))
        .filter(|line| !line.starts_with("input") && !line.starts_with("box"))
        .map(|line| format!("{line}\n"))
        .collect();
    let all = parse(&uncommented).unwrap_or_else(|error| panic!("{error}\n{uncommented}"));
    assert!(all.system.generate.as_ref().is_some_and(|generate| generate.radii.is_some()));

    // Every key of the types is printed, and none else.
    let json = serde_json::to_value(&all).unwrap();
    let mut keys = Vec::new();
    collect_keys(&json, &mut keys);
    for key in keys {
        assert!(
            uncommented.lines().any(|line| line.starts_with(&format!("{key} = ")))
                || uncommented.contains(&format!("{key}]"))
                || key == "input"
                || key == "box",
            "{key} is missing"
        );
    }
}

fn collect_keys(value: &serde_json::Value, keys: &mut Vec<String>) {
    match value {
        serde_json::Value::Object(map) => {
            for (key, value) in map {
                keys.push(key.clone());
                collect_keys(value, keys);
            }
        }
        serde_json::Value::Array(entries) => entries.iter().for_each(|entry| collect_keys(entry, keys)),
        _ => {}
    }
}

#[test]
fn a_configuration_becomes_interaction_dynamics_and_plan() {
    let config = parse_with(
        "[interaction]\npotential = \"yukawa\"\nkappa = 0.5\ntruncation = \"energy\"\nmixing = \"geometric\"\n\
         [[interaction.type]]\n[[interaction.type]]\nname = \"B\"\nmass = 3.0\n\
         [dynamics]\nensemble = \"langevin\"\ntemperature = 0.7\nfriction = 2.0\nseed = 9\nmax_displacement = 0.1\n\
         [method]\norder = \"cell\"\nskin = 0.4\nmemory_budget = \"2 GiB\"\ndeterministic = true",
        &[],
    )
    .unwrap();
    let interaction = config.interaction().unwrap();
    assert!(matches!(interaction.potential, Potential::Yukawa(y) if y.kappa == 0.5));
    assert_eq!((interaction.truncation, interaction.mixing), (Truncation::Energy, Mixing::Geometric));
    let names: Vec<_> = interaction.types.iter().map(|kind| (kind.name.as_str(), kind.mass)).collect();
    assert_eq!(names, [("1", 1.0), ("B", 3.0)]);

    let dynamics = config.dynamics();
    assert_eq!(dynamics.ensemble, Ensemble::Langevin { temperature: 0.7, friction: 2.0 });
    assert_eq!((dynamics.dt, dynamics.seed, dynamics.max_displacement), (0.005, 9, 0.1));

    let plan = config.plan(Method::RtList);
    assert_eq!((plan.method, plan.images, plan.order), (Method::RtList, Images::Gamma, Order::Cell));
    assert_eq!((plan.skin, plan.deterministic, plan.memory_budget), (Skin::Fixed(0.4), true, 2 << 30));
}

#[test]
fn a_table_is_read_relative_to_the_configuration() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        std::fs::File::create(folder.path().join(name)).unwrap().write_all(text.as_bytes()).unwrap();
        folder.path().join(name)
    };
    let path = write("run.toml", "[interaction]\npotential = \"table\"\ntable = \"soft.txt\"");
    let config = Config::load(&path, &[]).unwrap();
    assert!(matches!(config.interaction(), Err(Error::Read { .. })));

    write("soft.txt", "# r U F\n0.5 1.0 2.0\n\n1.0 0.25 1.0 # the middle\n2.0 0.0 0.0\n");
    let Potential::Table(table) = config.interaction().unwrap().potential else { panic!("a table") };
    assert_eq!(table.end(), 2.0);

    let soft = write("soft.txt", "0.5 1.0 2.0\n1.0 oops 1.0\n");
    let error = config.interaction().unwrap_err().to_string();
    assert_eq!(error, format!("{}, line 2: expected three numbers r U F", soft.display()));
    write("soft.txt", "1.0 1.0 2.0\n0.5 1.0 1.0\n");
    let error = config.interaction().unwrap_err().to_string();
    assert!(error.ends_with("row 2: r = 0.5 must be greater than in the row before and not negative"), "{error}");

    let missing = Config::load(&folder.path().join("none.toml"), &[]).unwrap_err().to_string();
    assert!(missing.starts_with("cannot read ") && missing.contains("none.toml"), "{missing}");
}

#[test]
fn species_of_an_input_are_matched_by_name() {
    let types = |text: &str| parse(text).unwrap().interaction;
    let anonymous = types("");
    assert_eq!(anonymous.match_species(&["Ar"]).unwrap(), [0]);
    assert!(anonymous.match_species::<&str>(&[]).unwrap().is_empty());
    assert_eq!(
        anonymous.match_species(&["Ar", "Kr"]).unwrap_err().to_string(),
        "the input has particles of species \"Ar\", but no [[interaction.type]] has that name; known types are \"1\""
    );
    let named = types("[[interaction.type]]\nname = \"Ar\"\n[[interaction.type]]\nname = \"Kr\"");
    assert_eq!(named.match_species(&["Kr", "Ar"]).unwrap(), [1, 0]);
    assert_eq!(
        named.match_species(&["Xe"]).unwrap_err().to_string(),
        "the input has particles of species \"Xe\", but no [[interaction.type]] has that name; \
         known types are \"Ar\", \"Kr\""
    );
    let single = types("[[interaction.type]]\nname = \"Ar\"");
    assert!(single.match_species(&["Kr"]).is_err(), "a named type accepts only its species");
    let numbered = types("[[interaction.type]]\nname = 2\n[[interaction.type]]\nname = \"1\"");
    assert_eq!(numbered.match_species(&["1", "2"]).unwrap(), [1, 0]);
    let unnamed = types("[[interaction.type]]\n[[interaction.type]]");
    assert_eq!(unnamed.match_species(&["2", "1"]).unwrap(), [1, 0]);
}

#[test]
fn memory_is_written_with_or_without_a_unit() {
    for (text, bytes) in [("4 GiB", 4 << 30), ("1.5KiB", 1536), ("77", 77), ("3 MiB", 3 << 20), ("10 B", 10)] {
        assert_eq!(text.parse(), Ok(Bytes(bytes)));
    }
    for text in ["", "GiB", "4 GB", "-1 KiB", "four"] {
        assert!(text.parse::<Bytes>().is_err(), "{text}");
    }
    assert_eq!(Bytes(4 << 30).to_string(), "4 GiB");
    assert_eq!(Bytes(1537).to_string(), "1537 B");
    assert_eq!(Bytes(0).to_string(), "0 B");
    assert_eq!(
        message("[method]\nmemory_budget = \"lots\""),
        "line 2: method.memory_budget = \"lots\": expected bytes, or text such as \"4 GiB\""
    );
}

#[test]
fn devices_are_spelled_as_documented() {
    for text in ["auto", "cpu", "cuda", "cuda:3"] {
        assert_eq!(text.parse::<Device>().unwrap().to_string(), text);
    }
    assert_eq!("cuda:x".parse::<Device>(), Err("unknown device \"cuda:x\"; there are auto, cpu, cuda, cuda:N".into()));
}

fn example(name: &str) -> Config {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    Config::load(&path, &[]).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn the_examples_are_valid_and_generate_valid_systems() {
    for name in ["melt.toml", "droplet.toml", "polydisperse.toml", "slab.toml"] {
        let config = example(name);
        assert!(matches!(config.source(), Ok(Source::Generate(_))), "{name}");
        let (sim_box, particles, radii) = config.generate().unwrap();
        let interaction = config.interaction().unwrap();
        let system = nearfield_core::System { sim_box, particles, radii, interaction };
        system.validate().unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn the_melt_example_is_the_classic_one() {
    let melt = example("melt.toml");
    let generate = melt.system.generate.as_ref().unwrap();
    assert_eq!((generate.n, generate.density, generate.temperature), (32_000, Some(0.8442), 1.44));
    assert_eq!((melt.interaction.cutoff, melt.dynamics.dt, melt.dynamics.steps), (2.5, 0.005, 1000));
    assert_eq!(melt.output.directory, Path::new("out/melt"));
    assert_eq!(melt.generate().unwrap().2, Radii::Uniform(2.5));
}

#[test]
fn the_polydisperse_example_has_the_radii_of_paper_a() {
    let config = example("polydisperse.toml");
    let spec = config.system.generate.as_ref().and_then(|generate| generate.radii.clone()).unwrap();
    assert_eq!((spec.mu, spec.sigma, spec.range, spec.outside), (1.0, 2.0, [1.0, 330.0], Outside::Redraw));
    assert!(matches!(config.generate().unwrap().2, Radii::PerParticle(radii) if radii.len() == 5000));
    assert!(config.dynamics.max_displacement > 0.0);
}
