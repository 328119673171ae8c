//! Every kernel of plain CUDA, on few particles.

use crate::loaded;
use nearfield_conformance::cases;
use nearfield_core::{
    Boundary::{Open, Periodic, Wall},
    Dynamics, Engine, Ensemble, ListKind, ListRequest, Particles, PerParticle, Plan, Quantities, Radii, oracle,
};

/// Lists against brute force; forces and a few steps of each ensemble to finite positions.
pub fn lists_and_motion(plan: &Plan) {
    let n = 300;
    for (boundary, seed) in [([Periodic; 3], 1), ([Wall; 3], 2), ([Periodic, Open, Wall], 3)] {
        let sim_box = cases::cube(10.0, boundary);
        let positions = cases::uniform(n, &sim_box, seed);
        let radii = (0..n).map(|i| 0.5 + (i % 7) as f32 * 0.5).collect();
        for radii in [Radii::Uniform(2.5), Radii::PerParticle(radii)] {
            let system = cases::soft(sim_box, positions.clone(), radii);
            for deterministic in [false, true] {
                let plan = Plan { deterministic, ..*plan };
                let mut engine = loaded(&system, &plan).expect("plain CUDA methods treat any radii");
                let request = ListRequest { shifts: true, distances: true, sorted: true, kind: ListKind::Full };
                let list = engine.neighbor_list(request).expect("a list");
                let expected = oracle::pairs(&system.sim_box, &system.particles, &system.radii);
                assert!(oracle::canonical(&list) == expected, "{plan:?} finds other pairs");
                let totals = engine.evaluate(Quantities::ALL).expect("an evaluation");
                assert_eq!(totals.pairs as usize, expected.len(), "{plan:?}");
                let mut forces = PerParticle::default();
                engine.per_particle(&mut forces).expect("a copy");
                assert_eq!(forces.neighbors.iter().map(|&n| n as usize).sum::<usize>(), 2 * expected.len());
                let mut from = 0;
                for ensemble in [
                    Ensemble::Nve,
                    Ensemble::Langevin { temperature: 1.0, friction: 1.0 },
                    Ensemble::Rescale { temperature: 1.0, relaxation: 0.1 },
                ] {
                    let dynamics = Dynamics { ensemble, max_displacement: 0.1, ..Dynamics::nve(0.005) };
                    engine.advance(&dynamics, from, 3, Quantities::ALL).expect("a run");
                    from += 3;
                }
                let mut end = Particles::default();
                engine.snapshot(&mut end).expect("a copy");
                assert!(end.position.iter().all(|x| x.iter().all(|x| x.is_finite())), "{plan:?}");
                assert!(end != system.particles, "{plan:?}: nothing moved");
            }
        }
    }
}
