//! Pixels of small scenes must be what geometry says.

use nearfield::{
    Boundary, Interaction, Particles, Radii, SimBox, System, Vec3s,
    generate::{Generate, Positions},
    render::{Background, ColorBy, ColorMap, Error, Focus, Image, Options, Projection, Renderer, Shape, View},
};
use nearfield_core::oracle;

/// From +x, so that y grows to the right and z upwards.
const FRONT: View =
    View { projection: Projection::Orthographic, azimuth: 0.0, elevation: 0.0, zoom: 1.0, size: [200, 200] };

fn options(view: View) -> Options {
    Options { view, samples: 4, ..Options::default() }
}

/// Particles in a cube `[0, 10)`.
fn system(boundary: Boundary, positions: &[[f32; 3]]) -> System {
    System {
        sim_box: SimBox::cubic(10.0, boundary).unwrap(),
        particles: Particles::at(positions.iter().copied()),
        radii: Radii::Uniform(2.0),
        interaction: Interaction::lennard_jones(),
    }
}

fn draw(system: &System, options: Options) -> Image {
    Renderer::new(system, options).unwrap().draw(system, &|| {}).unwrap()
}

const WHITE: [u8; 4] = [255; 4];

/// Pixels that are not background, in each row.
fn covered(image: &Image) -> Vec<Vec<u32>> {
    let [width, height] = image.size();
    (0..height).map(|y| (0..width).filter(|&x| image.pixel(x, y) != WHITE).collect()).collect()
}

/// The pixel that shows a point of the cube's middle plane, where the cube fills 94 % of the picture.
fn seen_at(y: f32, z: f32) -> [u32; 2] {
    let scale = 0.94 * 200.0 / 10.0;
    [100.0 + scale * (y - 5.0), 100.0 - scale * (z - 5.0)].map(|c| c as u32)
}

/// Blue, green and orange are told apart by their strongest and weakest channels.
fn is_bluish([red, _, blue, _]: [u8; 4]) -> bool {
    i32::from(blue) > i32::from(red) + 60
}

fn is_orange([red, green, blue, _]: [u8; 4]) -> bool {
    i32::from(red) > i32::from(blue) + 60 && i32::from(red) > i32::from(green) + 40
}

#[test]
fn a_sphere_covers_the_middle_and_94_percent_of_the_width_but_no_corner() {
    let image = draw(&system(Boundary::Open, &[[1.0, 2.0, 3.0]]), Options { radius: Some(0.7), ..options(FRONT) });
    assert!(is_bluish(image.pixel(100, 100)), "{:?}", image.pixel(100, 100));
    for (x, y) in [(0, 0), (199, 0), (0, 199), (199, 199)] {
        assert_eq!(image.pixel(x, y), WHITE);
    }
    let middle = &covered(&image)[100];
    assert!((5..=7).contains(&middle[0]) && (192..=194).contains(middle.last().unwrap()), "{middle:?}");
}

#[test]
fn the_part_covered_by_a_sphere_is_a_disc() {
    let image = draw(&system(Boundary::Open, &[[1.0, 2.0, 3.0]]), Options { radius: Some(0.7), ..options(FRONT) });
    let radius = 0.94 * 100.0_f64;
    for (y, row) in covered(&image).iter().enumerate() {
        let height = y as f64 + 0.5 - 100.0;
        let expected = 2.0 * (radius * radius - height * height).max(0.0).sqrt();
        // Any pixel that the edge touches counts as covered.
        assert!((row.len() as f64 - expected).abs() < 16.0, "row {y}: {} pixels, expected {expected}", row.len());
    }
    let area: usize = covered(&image).iter().map(Vec::len).sum();
    let expected = std::f64::consts::PI * radius * radius;
    assert!((area as f64 / expected - 1.0).abs() < 0.03, "{area}, expected {expected}");
}

#[test]
fn perspective_shrinks_the_farther_sphere_and_orthography_does_not() {
    let positions = [[9.0, 2.5, 5.0], [1.0, 7.5, 5.0]];
    let widths = |projection| {
        let options = options(View { projection, ..FRONT });
        let options = Options { radius: Some(0.8), draw_box: false, ..options };
        let row = covered(&draw(&system(Boundary::Periodic, &positions), options))[100].clone();
        row.into_iter().fold([0_i32, 0], |[near, far], x| if x < 100 { [near + 1, far] } else { [near, far + 1] })
    };
    let [near, far] = widths(Projection::Perspective);
    assert!(f64::from(near) > 1.15 * f64::from(far) && far > 15, "near {near} pixels, far {far} pixels");
    let [near, far] = widths(Projection::Orthographic);
    assert!(near.abs_diff(far) <= 1 && near > 25, "near {near} pixels, far {far} pixels");
}

#[test]
fn the_edges_of_the_box_are_where_its_faces_are() {
    let options = Options { radius: Some(0.3), samples: 16, ..options(FRONT) };
    let particle = [[5.0, 5.0, 5.0]];
    let image = draw(&system(Boundary::Periodic, &particle), options.clone());
    // Between edge and particle there is nothing; the edges are 6 pixels from the picture's.
    let row = &covered(&image)[50];
    assert!(row.len() <= 6 && row.iter().all(|x| (4..=8).contains(x) || (192..=196).contains(x)), "{row:?}");
    assert!(row.iter().any(|x| *x < 100) && row.iter().any(|x| *x > 100), "{row:?}");
    let top = covered(&image).iter().position(|row| row.len() > 150).unwrap();
    assert!((4..=8).contains(&top), "{top}");
    for (boundary, draw_box) in [(Boundary::Open, true), (Boundary::Periodic, false)] {
        let image = draw(&system(boundary, &particle), Options { draw_box, radius: None, ..options.clone() });
        assert_eq!(image.pixel(6, 6), WHITE, "{boundary:?}");
    }
}

#[test]
fn what_is_in_front_hides_what_is_behind() {
    let mut system = system(Boundary::Periodic, &[[2.0, 5.0, 5.0], [8.0, 5.0, 5.0]]);
    system.interaction.types.push(nearfield::ParticleType { name: "B".into(), ..system.interaction.types[0].clone() });
    system.particles.kind = vec![0, 1];
    let middle = |azimuth| {
        let view = View { azimuth, ..FRONT };
        let options = Options { radius: Some(1.0), draw_legend: false, ..options(view) };
        draw(&system, options).pixel(100, 100)
    };
    let (front, back) = (middle(0.0), middle(180.0));
    assert!(front[0] > front[2] && is_bluish(back), "type B {front:?}, type A {back:?}");
}

#[test]
fn the_slowest_and_the_fastest_have_the_colours_of_the_ends() {
    let mut system = system(Boundary::Periodic, &[[5.0, 2.0, 5.0], [5.0, 8.0, 5.0]]);
    system.particles.velocity = [[0.0; 3], [0.0, 3.0, 4.0]].into_iter().collect::<Vec3s>();
    for map in [ColorMap::Viridis, ColorMap::Plasma] {
        let options = Options { radius: Some(1.0), draw_legend: false, color_map: map, ..options(FRONT) };
        let image = draw(&system, Options { color_by: ColorBy::Speed, ..options });
        for (y, end) in [(2.0, 0.0), (8.0, 1.0)] {
            let [x, row] = seen_at(y, 5.0);
            let seen = image.pixel(x, row);
            // Light changes brightness, not hue.
            let linear = |c: [u8; 3]| c.map(|c| (f64::from(c) / 255.0).powf(2.2));
            let (a, b) = (linear([seen[0], seen[1], seen[2]]), linear(map.at(end)));
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
            assert!(cosine > 0.99, "{map:?} at {end}: {seen:?} instead of {:?}", map.at(end));
        }
    }
}

#[test]
fn the_focus_has_exactly_the_neighbours_that_brute_force_finds() {
    for boundary in [Boundary::Periodic, Boundary::Open] {
        let spec =
            Generate { positions: Positions::Disordered, n: 400, lengths: Some([10.0; 3]), ..Generate::default() };
        let particles = spec.build([boundary; 3], 1.0).unwrap().particles;
        let own: Vec<f32> = (0..400).map(|i| 0.5 + 0.004 * i as f32).collect();
        for radii in [Radii::Uniform(2.0), Radii::PerParticle(own)] {
            let system = System { particles: particles.clone(), radii, ..system(boundary, &[]) };
            let pairs = oracle::pairs(&system.sim_box, &system.particles, &system.radii);
            let mut n_neighbors = 0;
            for particle in [0, 7, 399] {
                let mut expected: Vec<(u32, [i8; 3])> = Vec::new();
                for pair in &pairs {
                    if pair.i as usize == particle {
                        expected.push((pair.j, pair.image));
                    } else if pair.j as usize == particle {
                        expected.push((pair.i, pair.image.map(|c| -c)));
                    }
                }
                expected.sort_unstable();
                n_neighbors += expected.len();
                assert_eq!(Focus::find(&system, particle).unwrap(), Focus { particle, neighbors: expected });
            }
            assert!(n_neighbors > 10, "{boundary:?}: {n_neighbors} neighbours test little");
        }
    }
}

#[test]
fn a_focus_is_orange_its_neighbours_are_blue_where_they_are_in_range_and_others_are_grey() {
    // Particle 1 is in range through the face y = 0 only, particle 2 is not.
    let system = system(Boundary::Periodic, &[[5.0, 0.5, 5.0], [5.0, 9.3, 5.0], [4.0, 2.4, 6.5]]);
    let options = Options { radius: Some(0.3), focus: Some(0), draw_box: false, samples: 4, ..options(FRONT) };
    let image = draw(&system, options);
    // The neighbourhood, 1.05 cutoffs either way, fills 94 % of the picture.
    let scale = 0.94 * 100.0 / 2.1;
    let at = |y: f32, z: f32| image.pixel((100.0 + scale * (y - 0.5)) as u32, (100.0 - scale * (z - 5.0)) as u32);
    assert!(is_orange(at(0.5, 5.0)), "{:?}", at(0.5, 5.0));
    assert!(is_bluish(at(-0.7, 5.0)), "{:?}", at(-0.7, 5.0));
    let [red, green, blue, _] = at(2.4, 6.5);
    assert!(red.abs_diff(green) < 12 && green.abs_diff(blue) < 12 && red < 240, "{:?}", at(2.4, 6.5));
}

#[test]
fn shapes_are_seen_through_and_have_the_size_of_the_cutoff() {
    let alone = system(Boundary::Periodic, &[[5.0; 3]]);
    for (shape, half) in [(Shape::Sphere, 2.0 * (2.0_f32 / 3.0).sqrt()), (Shape::Box, 2.0)] {
        let options = Options { shape, radius: Some(0.2), draw_box: false, ..options(FRONT) };
        let row = covered(&draw(&alone, options))[100].clone();
        let [from, to] = [seen_at(5.0 - half, 5.0)[0], seen_at(5.0 + half, 5.0)[0]];
        let last = *row.last().unwrap();
        assert!(row[0].abs_diff(from) <= 1 && last.abs_diff(to) <= 1, "{shape:?}: {} to {last}", row[0]);
    }
    // Squares are across x: nothing of them is seen from the side but an edge.
    let squares = |azimuth| {
        let options = Options { shape: Shape::Squares, radius: Some(0.2), draw_box: false, ..options(FRONT) };
        let view = View { azimuth, ..FRONT };
        covered(&draw(&alone, Options { view, ..options }))[90].len()
    };
    let width = seen_at(6.0, 5.0)[0] - seen_at(4.0, 5.0)[0];
    assert!(squares(0.0).abs_diff(width as usize) <= 2, "{}", squares(0.0));
    assert!(squares(90.0) <= 6, "{}", squares(90.0));
}

#[test]
fn a_transparent_background_is_transparent_and_particles_are_not() {
    let options = Options { background: Background::Transparent, radius: Some(0.7), ..options(FRONT) };
    let image = draw(&system(Boundary::Open, &[[1.0; 3]]), options);
    assert_eq!(image.pixel(0, 0)[3], 0);
    assert_eq!(image.pixel(100, 100)[3], 255);
    let opacities: Vec<u8> = (0..200).map(|x| image.pixel(x, 60)[3]).collect();
    assert!(opacities.iter().any(|&a| a > 0 && a < 255), "edges are smooth: {opacities:?}");
}

#[test]
fn the_same_input_gives_the_same_picture_whatever_the_threads() {
    let start =
        Generate { n: 500, density: Some(0.8), ..Generate::default() }.build([Boundary::Periodic; 3], 1.0).unwrap();
    let system = System { sim_box: start.sim_box, particles: start.particles, ..system(Boundary::Periodic, &[]) };
    let options =
        Options { color_by: ColorBy::Neighbors, shape: Shape::Sphere, ..options(View { size: [90, 60], ..FRONT }) };
    let with_threads = |n| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
        pool.install(|| draw(&system, options.clone()))
    };
    let one = with_threads(1);
    assert!(one == with_threads(3));
    assert!(one == with_threads(2));
}

#[test]
fn a_picture_of_a_written_file_has_the_size_asked_for() {
    let path = std::env::temp_dir().join(format!("nearfield-render-{}.png", std::process::id()));
    let image = draw(&system(Boundary::Periodic, &[[5.0; 3]]), options(View { size: [123, 45], ..FRONT }));
    image.write_png(&path).unwrap();
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(std::fs::File::open(&path).unwrap())).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert_eq!([info.width, info.height], [123, 45]);
    assert_eq!(data[..3], image.pixel(0, 0)[..3]);
}

#[test]
fn wrong_requests_are_refused() {
    let particle = system(Boundary::Periodic, &[[5.0; 3]]);
    let refused = |system: &System, options: Options| match Renderer::new(system, options) {
        Err(nearfield::Error::Render(error)) => error,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("this must be refused"),
    };
    let good = || options(FRONT);
    assert!(matches!(refused(&system(Boundary::Open, &[]), good()), Error::Empty));
    let error = refused(&particle, Options { focus: Some(1), ..good() });
    assert!(matches!(error, Error::Focus { focus: 1, n: 1 }), "{error}");
    for (options, word) in [
        (options(View { size: [0, 10], ..FRONT }), "size"),
        (options(View { size: [10, 99999], ..FRONT }), "size"),
        (options(View { zoom: 0.0, ..FRONT }), "zoom"),
        (options(View { zoom: f32::NAN, ..FRONT }), "zoom"),
        (options(View { elevation: 91.0, ..FRONT }), "elevation"),
        (options(View { azimuth: f32::INFINITY, ..FRONT }), "azimuth"),
        (Options { radius: Some(-1.0), ..good() }, "radius"),
        (Options { samples: 0, ..good() }, "samples"),
        (Options { color_range: Some([1.0, 1.0]), ..good() }, "color range"),
    ] {
        let error = refused(&particle, options);
        assert!(error.to_string().starts_with(word), "{error}");
    }
}
