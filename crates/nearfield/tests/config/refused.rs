//! What is refused, and what the messages name.

use super::*;

#[test]
fn an_unknown_key_names_its_line_and_the_nearest_known_key() {
    assert_eq!(
        message("[interaction]\npotential = \"wca\"\n\ncutof = 3.0\n"),
        "line 4: unknown key \"cutof\" in [interaction]; did you mean \"cutoff\"?"
    );
    assert_eq!(
        message("[system.generate.radii]\nsimga = 3.0\n"),
        "line 2: unknown key \"simga\" in [system.generate.radii]; did you mean \"sigma\"?"
    );
    assert_eq!(
        message("[[interaction.type]]\n[[interaction.type]]\nmas = 1\n"),
        "line 3: unknown key \"mas\" in [interaction.type]; did you mean \"mass\"?"
    );
    assert_eq!(message("\n[sytem]\n"), "line 2: unknown key \"sytem\"; did you mean \"system\"?");
    assert_eq!(
        message("[method]\ncutoff = 3.0\n"),
        "line 2: unknown key \"cutoff\" in [method]; it belongs to [interaction]"
    );
    assert_eq!(message("[boundary]\nabc = 3.0\n"), "line 2: unknown key \"abc\" in [boundary]; known keys are x, y, z");
}

#[test]
fn a_wrong_type_names_key_line_and_what_is_expected() {
    for (text, expected) in [
        ("[interaction]\ncutoff = \"far\"", "line 2: interaction.cutoff = \"far\": expected a number"),
        ("[dynamics]\nsteps = -5", "line 2: dynamics.steps = -5: expected a whole number, 0 or more"),
        ("[dynamics]\nsteps = 1.5", "line 2: dynamics.steps = 1.5: expected a whole number, 0 or more"),
        ("[method]\n\ndeterministic = 1", "line 3: method.deterministic = 1: expected true or false"),
        ("[output]\ndirectory = 7", "line 2: output.directory = 7: expected text in quotes"),
        (
            "[system.generate]\nbox = [1.0, 2.0]",
            "line 2: system.generate.box = [1.0, 2.0]: expected three numbers [x, y, z]",
        ),
        (
            "[system.generate]\nbox = [1.0, \"a\", 2.0]",
            "line 2: system.generate.box = [1.0, \"a\", 2.0]: expected three numbers [x, y, z]",
        ),
        (
            "[[interaction.type]]\n[[interaction.type]]\nepsilon = true",
            "line 3: interaction.type.1.epsilon = true: expected a number",
        ),
        ("interaction = 5", "line 1: interaction = 5: expected a section [interaction]"),
        (
            "[interaction.type]\nepsilon = 1.0",
            "line 1: interaction.type = { epsilon = 1.0 }: expected a section [[interaction.type]]",
        ),
    ] {
        assert_eq!(message(text), expected);
    }
}

#[test]
fn a_wrong_choice_names_the_choices_and_the_nearest() {
    for (text, expected) in [
        (
            "[boundary]\ny = \"periodc\"",
            "line 2: boundary.y = \"periodc\": expected periodic | wall | open; did you mean \"periodic\"?",
        ),
        (
            "[interaction]\npotential = \"lj\"",
            "line 2: interaction.potential = \"lj\": \
             expected lennard-jones | wca | yukawa | morse | gaussian | table",
        ),
        ("[method]\ndevice = \"gpu\"", "line 2: method.device = \"gpu\": expected auto | cpu | cuda | cuda:N"),
        (
            "[method]\nmaintenance = \"fixed:0\"",
            "line 2: method.maintenance = \"fixed:0\": expected every | fixed:K | average | gradient | gradient:joules | displacement; \
             did you mean \"fixed:K\"?",
        ),
        (
            "[method]\nimages = \"ghost\"",
            "line 2: method.images = \"ghost\": expected auto | gamma | instances | ghosts; did you mean \"ghosts\"?",
        ),
        ("[method]\norder = 3", "line 2: method.order = 3: expected none | morton | cell"),
        (
            "[system.generate]\npositions = \"bcc\"",
            "line 2: system.generate.positions = \"bcc\": \
             expected fcc | lattice | disordered | cluster | uniform | sphere-surface",
        ),
    ] {
        assert_eq!(message(text), expected);
    }
    let names: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
    assert_eq!(
        message("[method]\nname = \"octree\""),
        format!("line 2: method.name = \"octree\": expected auto | {}", names.join(" | "))
    );
}

#[test]
fn values_out_of_range_name_key_line_and_reason() {
    for (text, expected) in [
        ("[dynamics]\nsteps = 10\ndt = -0.1", "line 3: dynamics.dt = -0.1: must be positive and finite"),
        ("[dynamics]\ndt = nan", "line 2: dynamics.dt = NaN: must be positive and finite"),
        (
            "[dynamics]\nmax_displacement = -0.1",
            "line 2: dynamics.max_displacement = -0.1: must be zero (off) or positive",
        ),
        ("[dynamics]\nensemble = \"langevin\"\nfriction = 0.0", "line 3: dynamics.friction = 0: must be positive"),
        ("[dynamics]\nensemble = \"rescale\"\ntemperature = 0", "line 3: dynamics.temperature = 0: must be positive"),
        ("[interaction]\ncutoff = 0", "line 2: interaction.cutoff = 0: must be positive and finite"),
        (
            "[interaction]\ncutoff = 1e-60",
            &format!("line 2: interaction.cutoff = {}: must be positive and finite", 1e-60),
        ),
        (
            "[[interaction.type]]\nmass = 1.0\n[[interaction.type]]\n\nmass = -1.0",
            "line 5: interaction.type.1.mass = -1: must be positive and finite",
        ),
        ("[interaction]\ntype = []", "line 2: interaction.type = []: at least one type is needed"),
        (
            "[method]\nlist_tolerance = -1.0",
            "line 2: method.list_tolerance = -1: must be zero (lists miss no pair) or positive",
        ),
        ("[method]\nskin = -1.0", "line 2: method.skin = -1: must be zero (a list each step) or positive"),
        ("[output]\nrdf_bins = 0", "line 2: output.rdf_bins = 0: at least one bin is needed"),
        ("[system.generate]\ndensity = 1.0\nn = 0", "line 3: system.generate.n = 0: at least one particle is needed"),
        (
            "[system.generate]\ndensity = 1.0\n[system.generate.radii]\nrange = [3.0, 2.0]",
            "line 4: system.generate.radii.range = [3.0, 2.0]: must be two positive numbers, the smaller one first",
        ),
    ] {
        assert_eq!(message(text), expected);
    }
}

#[test]
fn contradictions_and_gaps_are_explained() {
    assert_eq!(
        message("[system]\ninput = \"a.xyz\"\n[system.generate]\ndensity = 1.0"),
        "system.input and [system.generate] are both given; keep one of them"
    );
    let empty = parse("").unwrap();
    let nothing = "there is nothing to simulate: set system.input = \"FILE\" or add a [system.generate] section";
    assert_eq!(empty.source().unwrap_err().to_string(), nothing);
    assert_eq!(empty.generate().unwrap_err().to_string(), nothing);
    assert_eq!(
        message("[system.generate]\nn = 4"),
        "system.generate: the size of the box is missing: give either density or box = [x, y, z]"
    );
    assert_eq!(
        message("[system.generate]\ndensity = 1\nbox = [1, 1, 1]"),
        "system.generate: density and box are both given: give either density or box = [x, y, z]"
    );
    assert_eq!(
        message("[interaction]\npotential = \"table\""),
        "interaction.potential = \"table\" needs a file of columns r U F: set interaction.table"
    );
    assert_eq!(
        message("[[interaction.type]]\nname = \"Ar\"\n[[interaction.type]]\nname = \"Ar\""),
        "two [[interaction.type]] entries are named \"Ar\"; names must differ"
    );
}

#[test]
fn broken_toml_names_its_line() {
    let error = message("[dynamics]\nsteps = 10\ndt = = 1\n");
    assert!(error.starts_with("line 3: "), "{error}");
    assert!(!error.contains('\n'), "one line: {error}");
    let twice = message("[dynamics]\nsteps = 10\nsteps = 20\n");
    assert!(twice.starts_with("line 3: duplicate key"), "{twice}");
}

#[test]
fn errors_in_overrides_name_the_option() {
    for (option, expected) in [
        (
            "interaction.cutof=3",
            "--set interaction.cutof=3: unknown key \"cutof\" in [interaction]; did you mean \"cutoff\"?",
        ),
        ("dynamics.dt=fast", "--set dynamics.dt=fast: dynamics.dt = \"fast\": expected a number"),
        ("dynamics.dt=-1", "--set dynamics.dt=-1: dynamics.dt = -1: must be positive and finite"),
        ("dynamics.dt", "--set dynamics.dt: write KEY=VALUE, as in --set dynamics.dt=0.002"),
        ("=3", "--set =3: write KEY=VALUE, as in --set dynamics.dt=0.002"),
        (
            "boundary.x=wal",
            "--set boundary.x=wal: boundary.x = \"wal\": expected periodic | wall | open; did you mean \"wall\"?",
        ),
        ("system.generate.box=[1, 2", "--set system.generate.box=[1, 2: [1, 2 is not a TOML value"),
        (
            "interaction.type.3.mass=1",
            "--set interaction.type.3.mass=1: there is no entry 3 of \"type\"; they are numbered from 0",
        ),
        ("dynamics=5", "--set dynamics=5: dynamics = 5: expected a section [dynamics]"),
    ] {
        assert_eq!(set_message(option), expected);
    }
    assert_eq!(
        set_message("sytem.generate.n=5"),
        "--set sytem.generate.n=5: unknown key \"sytem\"; did you mean \"system\"?"
    );
    let through_a_value = parse_with("[dynamics]\ndt = 1", &["dynamics.dt.x=1"]).unwrap_err().to_string();
    assert_eq!(through_a_value, "--set dynamics.dt.x=1: \"dt\" is not a section");
    // The last option that set a key is to blame, not one that set another.
    let last = parse_with("", &["dynamics.dt=-1", "dynamics.steps=5", "dynamics.dt=-2"]).unwrap_err().to_string();
    assert_eq!(last, "--set dynamics.dt=-2: dynamics.dt = -2: must be positive and finite");
}
