//! `render`: pictures of files and trajectories, and mistakes in asking for them.

use crate::command::Folder;

/// Three particles in a periodic cube of length 10, with velocities.
const FRAME: &str = "3\nLattice=\"10 0 0 0 10 0 0 0 10\" Properties=species:S:1:pos:R:3:velo:R:3 pbc=\"T T T\"\n\
                     A 1 1 1 0 0 1\nB 2 1 1 0 2 0\nA 5 5 5 3 0 0\n";

/// Width and height that a PNG file says it has.
fn size(folder: &Folder, name: &str) -> [u32; 2] {
    let bytes = std::fs::read(folder.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n", "{name}");
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
}

#[test]
fn every_input_gives_a_picture_of_the_size_asked_for() {
    let folder = Folder::new();
    folder.write("start.xyz", FRAME).write("open.xyz", "2\n\nAr 0 0 0\nXe 3 0 0\n");
    folder.write(
        "run.toml",
        "[system.generate]\npositions = \"fcc\"\nn = 108\ndensity = 0.8\n[interaction]\ncutoff = 2.0",
    );
    folder.succeed("generate fcc -n 108 --density 0.8 -o melt.data");
    for options in [
        "start.xyz",
        "open.xyz",
        "melt.data --color energy --cutoff 2",
        "melt.data --color neighbors --cutoff 1.5 --colormap magma --label contacts",
        "start.xyz --color speed --color-range -1,3 --label v",
        "start.xyz --focus 0 --cutoff 2 --show squares",
        "start.xyz --as boxes --cutoff 1 --background #102030 --projection orthographic",
        "run.toml --focus 5",
        "run.toml --as spheres --cutoff 1 --no-box --no-legend --radius 0.2 --zoom 2 --orbit 30,-10",
    ] {
        let said = folder.succeed(&format!("render {options} -o picture.png --size 72x48 --samples 2")).stderr;
        assert!(said.starts_with("wrote ") && said.contains("picture.png"), "{said}");
        assert_eq!(size(&folder, "picture.png"), [72, 48], "{options}");
        std::fs::remove_file(folder.path("picture.png")).unwrap();
    }
}

#[test]
fn standard_input_is_drawn_too() {
    let folder = Folder::new();
    let outcome = folder.run_with_input("render - -o picture.png --size 60x40 --samples 1", FRAME);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(size(&folder, "picture.png"), [60, 40]);
}

#[test]
fn a_trajectory_gives_a_numbered_picture_for_each_frame_in_the_range() {
    let folder = Folder::new();
    folder.write("trajectory.xyz", FRAME.repeat(5));
    let written = |frames: &str| {
        folder.succeed(&format!("render trajectory.xyz -o film.png --size 40x30 --samples 1 --frames {frames}"));
        let mut names = Vec::new();
        for number in 1..10 {
            let path = folder.path(format!("film_{number:04}.png"));
            if path.exists() {
                names.push(number);
                std::fs::remove_file(path).unwrap();
            }
        }
        assert!(!folder.path("film.png").exists());
        names
    };
    assert_eq!(written(""), [1, 2, 3, 4, 5]);
    assert_eq!(written("all"), [1, 2, 3, 4, 5]);
    assert_eq!(written("1:3"), [1, 2, 3]);
    assert_eq!(written("0:4:2"), [1, 2, 3]);
    assert_eq!(written("4:"), [1]);
}

#[test]
fn pictures_of_equal_frames_are_equal() {
    let folder = Folder::new();
    folder.write("trajectory.xyz", FRAME.repeat(3));
    let line = "render trajectory.xyz --color speed --size 60x40 --samples 4";
    folder.succeed(&format!("{line} --frames -o film.png"));
    folder.succeed(&format!("{line} --frame last -o last.png"));
    let bytes = |name: &str| std::fs::read(folder.path(name)).unwrap();
    assert!(bytes("film_0001.png") == bytes("film_0003.png") && bytes("film_0001.png") == bytes("last.png"));
}

#[test]
fn wrong_requests_are_explained_and_write_nothing() {
    let folder = Folder::new();
    folder.write("start.xyz", FRAME).write("still.xyz", "1\n\nA 0 0 0\n").write("empty.xyz", "0\n\n");
    folder.write("run.toml", "[system.generate]\nn = 108\ndensity = 0.8").write("other.toml", "");
    for (options, words) in [
        ("start.xyz --focus 3 --cutoff 2", ["no particle 3", "counted from 0"]),
        ("start.xyz --focus 0", ["start.xyz gives no radii", "--cutoff"]),
        ("start.xyz --as squares", ["start.xyz gives no radii", "--cutoff"]),
        ("start.xyz --color neighbors", ["start.xyz gives no radii", "--cutoff"]),
        ("start.xyz --color neighbors --cutoff 6", ["start.xyz", "exceeds half the periodic length"]),
        ("start.xyz --color neighbors --cutoff -1", ["cutoff", "must be positive"]),
        ("still.xyz --color speed", ["still.xyz gives no velocities", "--color speed"]),
        ("start.xyz --color mass", ["invalid value 'mass'", "speed"]),
        ("start.xyz --size 0x10", ["size 0x10", "must be 1 to 16384"]),
        ("start.xyz --size 10", ["--size", "1920x1080"]),
        ("start.xyz --orbit 3", ["--orbit", "-60,20"]),
        ("start.xyz --orbit 0,95", ["elevation 95", "-90 to 90"]),
        ("start.xyz --zoom -1", ["zoom -1", "must be positive"]),
        ("start.xyz --radius 0", ["radius 0", "must be positive"]),
        ("start.xyz --samples 0", ["samples 0", "1 to 1024"]),
        ("start.xyz --background blue", ["--background", "transparent"]),
        ("start.xyz --color speed --color-range 2,1", ["color range 2,1", "smaller and a larger"]),
        ("start.xyz --frame 1", ["start.xyz has 1 frame", "frame 1"]),
        ("start.xyz --frame first", ["--frame", "last"]),
        ("start.xyz --frames 3:", ["start.xyz has 1 frame", "frame 3"]),
        ("start.xyz --frames 3", ["--frames", "FIRST:LAST"]),
        ("start.xyz --frames --frame 0", ["--frame", "cannot be used with"]),
        ("run.toml --frames", ["run.toml", "only extended XYZ"]),
        ("run.toml --config other.toml", ["--config", "configuration files"]),
        ("gone.xyz", ["cannot open gone.xyz", "No such file"]),
        ("empty.xyz", ["no particles", "to draw"]),
    ] {
        folder.refuse(&format!("render {options} -o picture.png"), &words);
        assert!(!folder.path("picture.png").exists(), "{options}");
    }
    folder.refuse("render start.xyz -o picture.jpg", &["picture.jpg", "written as .png"]);
    folder.refuse("render start.xyz", &["--output", "required"]);
}
