//! The kernels of nearfield-kernels run: one that is simple enough to be checked by hand.

mod common;
use common::*;
use nearfield_cuda::gpu;
use nearfield_kernels::{Float4, Kernel, Ptr, layouts::*};

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn a_free_particle_moves_by_its_velocity_times_the_time_step() {
    let gpu = emulator();
    let position = buffer(&gpu, &[Float4::new(1.0, 2.0, 9.5, 0.0)]);
    let velocity = buffer(&gpu, &[Float4::new(0.5, -1.0, 4.0, f32::from_bits(0))]);
    let image = buffer(&gpu, &[0i32; 3]);
    let status = buffer(&gpu, &[u64::MAX; 2]);
    let space = Box3 { lo: [0.0; 3], hi: [10.0; 3], length: [10.0; 3], boundary: [0; 3] };
    let arguments = IntegrateArgs {
        integrator: Integrator {
            space,
            dt: 0.25,
            speed_limit: f32::INFINITY,
            half_kick: Ptr::new(buffer(&gpu, &[0.125f32])),
            ..Default::default()
        },
        particles: Particles {
            position: Ptr::new(position),
            velocity: Ptr::new(velocity),
            image: Ptr::new(image),
            id: Ptr::new(buffer(&gpu, &[0u32])),
            n: 1,
            unused: 0,
        },
        force: Ptr::new(buffer(&gpu, &[Float4::default()])),
        status: Ptr::new(status),
        start: 1,
        ..Default::default()
    };
    // SAFETY: all arrays hold one particle.
    unsafe { gpu::launch(&gpu, Kernel::new("integrate", "integrate", 256), 1, &arguments) }.unwrap();
    assert_eq!(content::<Float4>(&gpu, position, 1), [Float4::new(1.125, 1.75, 0.5, 0.0)]);
    assert_eq!(content::<Float4>(&gpu, velocity, 1), [Float4::new(0.5, -1.0, 4.0, 0.0)]);
    assert_eq!(content::<i32>(&gpu, image, 3), [0, 0, 1]);
    assert_eq!(content::<u64>(&gpu, status, 2), [u64::MAX; 2]);
}
