//! Rays find the boxes that brute force finds, as they were at the last build or refit.

mod common;
use common::*;
use nearfield_core::Result;
use nearfield_cuda::gpu::{Aabb, AccelerationStructure, Bodies, Gpu, Preference, Trace};
use nearfield_emulator::Emulator;
use nearfield_kernels::{Float4, Primitive, Ptr};

/// What a ray finds: number of boxes, sum of their numbers, sum of their instances.
type Found = (u32, u32, u32);

/// Numbers in [0, 1) that look random.
fn random(seed: u32, n: usize) -> Vec<f32> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    (0..n).map(|_| next()).collect()
}

fn boxes(seed: u32, n: usize) -> Vec<Aabb> {
    let half = 0.08;
    random(seed, 3 * n)
        .chunks(3)
        .map(|x| [x[0], x[1], x[2]])
        .map(|[x, y, z]| [x - half, y - half, z - half, x + half, y + half, z + half])
        .collect()
}

fn points(seed: u32, n: usize) -> Vec<Float4> {
    random(seed, 3 * n).chunks(3).map(|x| Float4::new(x[0], x[1], x[2], 0.0)).collect()
}

fn brute_force(boxes: &[Aabb], translations: &[[f32; 3]], points: &[Float4]) -> Vec<Found> {
    let ray = |x: &Float4| {
        let mut found = (0, 0, 0);
        for (instance, t) in (0..).zip(translations) {
            let local = [x.x - t[0], x.y - t[1], x.z - t[2]];
            for (number, b) in (0..).zip(boxes) {
                if (0..3).all(|axis| b[axis] <= local[axis] && local[axis] <= b[axis + 3]) {
                    found = (found.0 + 1, found.1 + number, found.2 + instance);
                }
            }
        }
        found
    };
    points.iter().map(ray).collect()
}

fn trace(gpu: &Emulator, handle: u64, points: &[Float4]) -> Result<Vec<Found>> {
    let n = points.len();
    let rays = Rays {
        points: buffer(gpu, points),
        counts: buffer(gpu, &vec![9u32; n]),
        sums: buffer(gpu, &vec![9u64; n]),
        handle,
    };
    run(gpu, "points", &rays, n)?;
    let counts = content::<u32>(gpu, rays.counts, n);
    let sums = content::<u64>(gpu, rays.sums, n);
    Ok(counts.iter().zip(sums).map(|(&count, sum)| (count, sum as u32, (sum >> 32) as u32)).collect())
}

fn run(gpu: &Emulator, raygen: &'static str, rays: &Rays, n: usize) -> Result<()> {
    let parameters = bytemuck::bytes_of(rays);
    let trace = Trace { module: "rays", primitive: Primitive::Box, raygen, hit: "boxes", rays: n as u32, parameters };
    // SAFETY: the arrays have an entry for each ray; the emulator checks the handle.
    unsafe { tracing(gpu).trace(trace) }
}

/// A structure over boxes, and their address.
fn built(gpu: &Emulator, boxes: &[Aabb]) -> (Box<dyn AccelerationStructure>, Ptr<Aabb>) {
    let address = Ptr::new(buffer(gpu, boxes));
    let mut structure = tracing(gpu).structure().unwrap();
    // SAFETY: as many as there are.
    unsafe { structure.build(Bodies::Boxes(address), boxes.len() as u32, Preference::Traces) }.unwrap();
    (structure, address)
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn rays_find_the_boxes_of_brute_force() {
    for n in [0, 1, 3, 4, 5, 17, 1000] {
        let gpu = emulator();
        let (boxes, points) = (boxes(1, n), points(2, 300));
        let (structure, _) = built(&gpu, &boxes);
        let found = trace(&gpu, structure.handle(), &points).unwrap();
        assert_eq!(found, brute_force(&boxes, &[[0.0; 3]], &points), "{n} boxes");
        assert!(n < 1000 || found.iter().any(|&(count, ..)| count > 1), "the test sees neighbours");
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn rays_find_the_boxes_of_all_instances() {
    let gpu = emulator();
    let (boxes, points) = (boxes(3, 200), points(4, 300));
    let (structure, _) = built(&gpu, &boxes);
    let translations: Vec<[f32; 3]> =
        (0..27).map(|c| [c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1].map(|k| k as f32)).collect();
    let mut instances = tracing(&gpu).structure().unwrap();
    instances.build_instances(&*structure, &translations).unwrap();
    let found = trace(&gpu, instances.handle(), &points).unwrap();
    assert_eq!(found, brute_force(&boxes, &translations, &points));
    assert!(found.iter().any(|&(.., images)| images % 13 != 0), "the test sees images");
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn bounds_belong_to_boxes_and_boxes_of_nan_hold_nothing() {
    let gpu = emulator();
    let mut boxes = vec![[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]; 12];
    boxes[5][1] = f32::NAN;
    boxes[6] = [f32::NAN; 6];
    let points =
        [Float4::new(0.0, 1.0, 0.5, 0.0), Float4::new(0.5, 0.5, 1.0000001, 0.0), Float4::new(f32::NAN, 0.5, 0.5, 0.0)];
    let (structure, _) = built(&gpu, &boxes);
    assert_eq!(trace(&gpu, structure.handle(), &points).unwrap(), [(10, 66 - 11, 0), (0, 0, 0), (0, 0, 0)]);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn boxes_that_move_are_seen_after_a_refit_and_not_before() {
    let gpu = emulator();
    let (before, after, points) = (boxes(5, 500), boxes(6, 500), points(7, 300));
    let (mut structure, address) = built(&gpu, &before);
    let handle = structure.handle();
    // SAFETY: as large as before.
    unsafe { gpu.upload(bytemuck::cast_slice(&after), address.address()) }.unwrap();
    assert_eq!(trace(&gpu, handle, &points).unwrap(), brute_force(&before, &[[0.0; 3]], &points));
    // SAFETY: as many as there are.
    unsafe { structure.refit(Bodies::Boxes(address), 500) }.unwrap();
    assert_eq!(structure.handle(), handle);
    assert_eq!(trace(&gpu, handle, &points).unwrap(), brute_force(&after, &[[0.0; 3]], &points));
    // SAFETY: fewer than there are.
    let text = failure(unsafe { structure.refit(Bodies::Boxes(address), 499) });
    assert!(text.contains("499 boxes to a structure of 500 boxes"), "{text}");
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn outdated_handles_and_instances_are_reported() {
    let gpu = emulator();
    let (boxes, points) = (boxes(8, 50), points(9, 10));
    let (mut structure, address) = built(&gpu, &boxes);
    let mut instances = tracing(&gpu).structure().unwrap();
    let text = failure(instances.build_instances(&*tracing(&gpu).structure().unwrap(), &[[0.0; 3]]));
    assert!(text.contains("not built"), "{text}");
    instances.build_instances(&*structure, &[[0.0; 3]]).unwrap();
    // SAFETY: as many as there are.
    unsafe { structure.refit(Bodies::Boxes(address), 50) }.unwrap();
    assert!(failure(trace(&gpu, instances.handle(), &points)).contains("refitted since"));
    instances.build_instances(&*structure, &[[0.0; 3]]).unwrap();
    let old = structure.handle();
    // SAFETY: as many as there are.
    unsafe { structure.build(Bodies::Boxes(address), 50, Preference::Traces) }.unwrap();
    assert!(failure(trace(&gpu, instances.handle(), &points)).contains("rebuilt or dropped"));
    assert!(failure(trace(&gpu, old, &points)).contains("no acceleration structure"));
    trace(&gpu, structure.handle(), &points).unwrap();
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn structures_take_memory_and_give_it_back() {
    let gpu = emulator();
    let boxes = boxes(10, 100);
    let address = Ptr::new(buffer(&gpu, &boxes));
    let free = gpu.memory().unwrap().free;
    let mut structure = tracing(&gpu).structure().unwrap();
    assert_eq!((structure.handle(), structure.bytes()), (0, 0));
    // SAFETY: as many as there are.
    unsafe { structure.build(Bodies::Boxes(address), 100, Preference::Traces) }.unwrap();
    assert!(structure.bytes() > 0);
    assert_eq!(gpu.memory().unwrap().free, free - structure.bytes());
    drop(structure);
    assert_eq!(gpu.memory().unwrap().free, free);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn programs_that_work_together_are_refused_as_optix_refuses_them() {
    let gpu = emulator();
    let rays = Rays { points: 0, counts: buffer(&gpu, &[0u32; 64]), sums: 0, handle: 0 };
    assert!(failure(run(&gpu, "cooperating", &rays, 64)).contains("no warp operations"));
    assert!(failure(run(&gpu, "missing", &rays, 64)).contains("lacks"));
}
