//! Checkpoints in a program.

use crate::{build, methods_of_the_cpu, smooth};
use nearfield::{Method, Simulation, run::Checkpoint};
use std::fs;

#[test]
fn a_restored_simulation_continues_bit_for_bit() {
    for method in methods_of_the_cpu() {
        let start = || build(Simulation::builder(smooth(108, 0.8442, 1.44)).method(method));
        let mut whole = start();
        whole.advance(137).unwrap();
        let checkpoint = whole.checkpoint().unwrap();
        whole.advance(150).unwrap();
        let mut restored = start();
        restored.restore(&checkpoint).unwrap();
        assert_eq!(restored.step(), 137);
        assert!(restored.system().unwrap().particles == checkpoint.particles);
        restored.advance(150).unwrap();
        assert!(restored.system().unwrap().particles == whole.system().unwrap().particles, "{method}");
        assert_eq!(restored.thermo().unwrap(), whole.thermo().unwrap(), "{method}");
    }
}

#[test]
fn a_checkpoint_survives_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    let mut simulation = build(Simulation::builder(smooth(108, 0.5, 1.0)).method(Method::RtForces));
    simulation.advance(20).unwrap();
    let mut checkpoint = simulation.checkpoint().unwrap();
    checkpoint.observers.insert("thermo".into(), vec![1, 2, 255]);
    checkpoint.write(&path).unwrap();
    assert_eq!(Checkpoint::read(&path).unwrap(), checkpoint);
}

#[test]
fn a_damaged_checkpoint_is_an_error_and_never_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    let mut simulation = build(Simulation::builder(smooth(32, 0.1, 1.0)).method(Method::Cell));
    simulation.checkpoint().unwrap().write(&path).unwrap();
    let good = fs::read(&path).unwrap();
    for length in [0, 1, 10, good.len() / 2, good.len() - 1] {
        fs::write(&path, &good[..length]).unwrap();
        let error = Checkpoint::read(&path).unwrap_err();
        assert!(error.to_string().contains("not a checkpoint"), "{length} bytes: {error}");
        assert!(error.is_request());
    }
    for at in 0..good.len() {
        let mut bad = good.clone();
        bad[at] ^= 0x55;
        fs::write(&path, &bad).unwrap();
        // A changed digit of a coordinate cannot be told; anything else must be refused, and nothing may panic.
        if let Ok(checkpoint) = Checkpoint::read(&path) {
            let _ = simulation.restore(&checkpoint);
        }
    }
}

#[test]
fn a_checkpoint_of_impossible_particles_is_refused() {
    let mut simulation = build(Simulation::builder(smooth(32, 0.1, 1.0)).method(Method::Cell));
    simulation.advance(3).unwrap();
    let good = simulation.checkpoint().unwrap();
    let mut bad = good.clone();
    bad.particles.position.set(5, [f32::NAN; 3]);
    assert!(simulation.restore(&bad).unwrap_err().to_string().contains("particle 5"));
    let mut bad = good.clone();
    bad.order.ids[3] = bad.order.ids[4];
    assert!(simulation.restore(&bad).unwrap_err().to_string().contains("memory order"));
    simulation.restore(&good).unwrap();
    simulation.advance(1).unwrap();
}
