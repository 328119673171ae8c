//! Rays of finite length cross spheres and triangles.

mod common;
use common::*;
use nearfield_core::Result;
use nearfield_cuda::gpu::{AccelerationStructure, Bodies, Preference, Trace, Triangle};
use nearfield_emulator::Emulator;
use nearfield_kernels::{Float4, Primitive, Ptr};

/// For rays along x of length w: number of crossings and distance of the last.
fn crossings(gpu: &Emulator, handle: u64, primitive: Primitive, origins: &[[f32; 4]]) -> Result<Vec<(u32, f32)>> {
    let origins: Vec<Float4> = origins.iter().map(|o| Float4::new(o[0], o[1], o[2], o[3])).collect();
    let n = origins.len();
    let rays = Rays {
        points: buffer(gpu, &origins),
        counts: buffer(gpu, &vec![9u32; n]),
        sums: buffer(gpu, &vec![9u64; n]),
        handle,
    };
    let parameters = bytemuck::bytes_of(&rays);
    let trace = Trace { module: "rays", primitive, raygen: "segments", hit: "crossings", rays: n as u32, parameters };
    // SAFETY: the arrays have an entry for each ray; the emulator checks the handle.
    unsafe { tracing(gpu).trace(trace)? };
    let (counts, distances) = (content::<u32>(gpu, rays.counts, n), content::<u64>(gpu, rays.sums, n));
    Ok(counts.into_iter().zip(distances.into_iter().map(|bits| f32::from_bits(bits as u32))).collect())
}

fn built(gpu: &Emulator, bodies: Bodies, n: u32) -> Box<dyn AccelerationStructure> {
    let mut structure = tracing(gpu).structure().expect("a structure");
    // SAFETY: the caller has as many.
    unsafe { structure.build(bodies, n, Preference::Traces) }.expect("a build");
    structure
}

fn spheres(gpu: &Emulator) -> Box<dyn AccelerationStructure> {
    let center = Ptr::new(buffer(gpu, &[Float4::new(5.0, 0.0, 0.0, 7.0), Float4::new(50.0, 0.0, 0.0, 7.0)]));
    built(gpu, Bodies::Spheres { center, radius: Ptr::new(buffer(gpu, &[1.0f32])) }, 2)
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn spheres_are_shells_met_where_rays_enter_and_where_they_leave() {
    let gpu = emulator();
    let structure = spheres(&gpu);
    let rays =
        [[0.0, 0.0, 0.0, 3.9], [0.0, 0.0, 0.0, 4.1], [0.0, 0.0, 0.0, 6.1], [4.5, 0.0, 0.0, 1.0], [4.5, 0.0, 0.0, 2.0]];
    let found = crossings(&gpu, structure.handle(), Primitive::Sphere, &rays).unwrap();
    assert_eq!(found, [(0, 0.0), (1, 4.0), (2, 6.0), (0, 0.0), (1, 1.5)]);
    let beside = [[0.0, 0.8, 0.0, 10.0], [0.0, 0.8, 0.7, 10.0]];
    let found = crossings(&gpu, structure.handle(), Primitive::Sphere, &beside).unwrap();
    assert_eq!((found[0].0, found[1].0), (2, 0));
    assert!((found[0].1 - 5.6).abs() < 1e-5);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn triangles_are_met_from_both_sides_with_their_edges() {
    let gpu = emulator();
    let square: [Triangle; 2] =
        [[[2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 1.0, 1.0]], [[2.0, 0.0, 0.0], [2.0, 1.0, 1.0], [2.0, 0.0, 1.0]]];
    let structure = built(&gpu, Bodies::Triangles(Ptr::new(buffer(&gpu, &square))), 2);
    let rays = [
        [0.0, 0.75, 0.25, 3.0],
        [0.0, 0.5, 0.5, 3.0],
        [0.0, 1.5, 0.5, 3.0],
        [0.0, 0.75, 0.25, 1.9],
        [2.1, 0.7, 0.2, 9.0],
    ];
    let found = crossings(&gpu, structure.handle(), Primitive::Triangle, &rays).unwrap();
    assert_eq!(found, [(1, 2.0), (2, 2.0), (0, 0.0), (0, 0.0), (0, 0.0)]);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn instances_of_spheres_are_met_where_they_are_translated_to() {
    let gpu = emulator();
    let structure = spheres(&gpu);
    let mut instances = tracing(&gpu).structure().unwrap();
    instances.build_instances(&*structure, &[[0.0; 3], [-3.0, 0.0, 0.0]]).unwrap();
    let found = crossings(&gpu, instances.handle(), Primitive::Sphere, &[[0.0, 0.0, 0.0, 3.5]]).unwrap();
    assert_eq!(found, [(2, 3.0)]);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn programs_for_other_primitives_are_refused() {
    let gpu = emulator();
    let structure = spheres(&gpu);
    let text = failure(crossings(&gpu, structure.handle(), Primitive::Triangle, &[[0.0; 4]]));
    assert!(text.contains("primitives of another kind"), "{text}");
}
