//! Maintenance policies on paper A's figure 8, scaled: the structure and query time of `rt-list` under each policy.
//!
//! `cargo bench -p nearfield --bench policies [-- N [STEPS [FILTER]]]`. Positions lattice, disordered, cluster; radii 1,
//! 160, U[1,160], LN(1,2) in [1,330]; periodic box. The paper has n = 140,000 in a 1000^3 box and 2000 steps. Here the
//! box keeps the paper's number density at the n asked for, and radii above 1 shrink with the box, so that neighbour
//! counts shrink with n. The paper states neither time step nor velocities: dt 0.05, T = 10 and at most one length a
//! step, which carries a particle through several lattice spacings in a run. One line of JSON for each case and policy: total structure and query seconds, rebuilds, refits,
//! interactions. The policies of a case run in turn in small slices of steps, each on its own simulation of equal start
//! (exact sums make all of them the same trajectory), so that a drift of the machine's speed strikes all alike.

use nearfield::{
    Boundary, Dynamics, Interaction, Maintenance, Method, Plan, Report, Simulation, Skin, System,
    generate::{Distribution, Generate, Positions, RadiiSpec},
};
use serde_json::json;

/// Steps of a slice.
const SLICE: u64 = 25;
/// The paper's number of particles and box.
const PAPER: (f64, f64) = (140_000.0, 1000.0);

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let number = |k: usize, default: u64| words.get(k).map_or(default, |word| word.parse().expect("a number"));
    let (n, steps) = (number(0, 20_000) as usize, number(1, 1000));
    let filter = words.get(2).map_or("", String::as_str);
    let scale = (n as f64 / PAPER.0).cbrt();
    for positions in [Positions::Lattice, Positions::Disordered, Positions::Cluster] {
        let constant = |value| RadiiSpec { distribution: Distribution::Constant, value, ..RadiiSpec::default() };
        let varied = |distribution, largest| RadiiSpec { distribution, range: [1.0, largest], ..RadiiSpec::default() };
        let cases = [
            ("r=1", constant(1.0)),
            ("r=160", constant(160.0 * scale)),
            ("r=U[1,160]", varied(Distribution::Uniform, 160.0 * scale)),
            ("r=LN[1,330]", varied(Distribution::Lognormal, 330.0 * scale)),
        ];
        for (radii, spec) in cases {
            let name = format!("{} {radii}", format!("{positions:?}").to_lowercase());
            if filter.split_whitespace().all(|word| name.split(' ').any(|part| part == word)) {
                run(&name, n, steps, scale, positions, &spec);
            }
        }
    }
}

fn run(name: &str, n: usize, steps: u64, scale: f64, positions: Positions, radii: &RadiiSpec) {
    let policies = ["gradient", "fixed:200", "average", "every"];
    let mut simulations: Vec<Simulation> = policies
        .iter()
        .map(|policy| simulation(n, scale, positions, radii, policy.parse().expect("a policy")))
        .collect();
    for from in (0..steps).step_by(SLICE as usize) {
        for simulation in &mut simulations {
            simulation.advance(SLICE.min(steps - from)).expect("a capped run cannot blow up");
        }
    }
    for (policy, simulation) in policies.iter().zip(&mut simulations) {
        let pairs = simulation.thermo().expect("a capped run cannot blow up").pairs;
        let Report { builds, refits, build_seconds, refit_seconds, query_seconds, .. } = simulation.report();
        let line = json!({
            "benchmark": "policies",
            "case": name,
            "policy": policy,
            "device": simulation.device(),
            "version": env!("CARGO_PKG_VERSION"),
            "n": n,
            "steps": steps,
            "structure_seconds": build_seconds + refit_seconds,
            "query_seconds": query_seconds,
            "total_seconds": build_seconds + refit_seconds + query_seconds,
            "builds": builds,
            "refits": refits,
            "final_pairs_per_particle": pairs as f64 / n as f64,
        });
        println!("{line}");
    }
}

/// A start of paper A with the given policy.
fn simulation(n: usize, scale: f64, positions: Positions, radii: &RadiiSpec, maintenance: Maintenance) -> Simulation {
    let spec = Generate {
        positions,
        n,
        lengths: Some([PAPER.1 * scale; 3]),
        spread: 25.0 * scale,
        temperature: 10.0,
        radii: Some(radii.clone()),
        ..Generate::default()
    };
    let start = spec.build([Boundary::Periodic; 3], 1.0).expect("a valid start");
    let mut interaction = Interaction::lennard_jones();
    let radii = start.radii.expect("radii were asked for");
    interaction.types[0].sigma = radii.largest() / interaction.radius_per_sigma;
    let system = System { sim_box: start.sim_box, particles: start.particles, radii, interaction };
    let plan = Plan { maintenance, skin: Skin::NONE, ..Plan::new(Method::RtList) };
    let dynamics = Dynamics { max_displacement: 1.0, ..Dynamics::nve(0.05) };
    Simulation::builder(system).dynamics(dynamics).method(Method::RtList).plan(plan).build().expect("a valid system")
}
