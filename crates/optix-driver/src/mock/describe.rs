//! Build inputs in words, to compare in tests.

use std::fmt::Write;

use crate::sys;

/// A build input in words, following its pointers to host memory.
///
/// # Safety
/// The pointers are valid.
pub unsafe fn describe(input: &sys::BuildInput) -> String {
    // SAFETY: the kind says which part of the union is meant, and the caller promises the pointers.
    unsafe {
        match input.kind {
            sys::INPUT_CUSTOM => {
                let i = input.data.aabbs;
                let (buffer, flags) = (*i.buffers, *i.flags);
                let records = i.num_sbt_records;
                format!("custom {buffer:#x} n={} stride={} flags={flags} records={records}", i.count, i.stride)
            }
            sys::INPUT_SPHERES => {
                let i = input.data.spheres;
                let radii = format!("{:#x} stride={} single={}", *i.radii, i.radius_stride, i.single_radius);
                let centers = format!("{:#x} n={} stride={}", *i.centers, i.count, i.stride);
                format!("spheres {centers} radii={radii} flags={} records={}", *i.flags, i.num_sbt_records)
            }
            sys::INPUT_TRIANGLES => {
                let i = input.data.triangles;
                let mut text = format!("triangles {:#x} n={}", *i.vertices, i.num_vertices);
                let _ = write!(text, " format={:#x} stride={}", i.vertex_format, i.vertex_stride);
                let _ = write!(text, " indices={:#x} n={}", i.indices, i.num_triplets);
                let _ = write!(text, " format={:#x} stride={}", i.index_format, i.index_stride);
                let _ = write!(text, " flags={} records={}", *i.flags, i.num_sbt_records);
                text
            }
            sys::INPUT_INSTANCES => {
                let i = input.data.instances;
                format!("instances {:#x} n={} stride={}", i.instances, i.count, i.stride)
            }
            kind => format!("unknown {kind:#x}"),
        }
    }
}

/// Options and inputs of a build in words.
pub unsafe fn describe_build(options: *const sys::AccelOptions, inputs: *const sys::BuildInput, count: u32) -> String {
    // SAFETY: as the driver's contract says.
    unsafe {
        let options = &*options;
        let inputs = std::slice::from_raw_parts(inputs, count as usize);
        let inputs: Vec<_> = inputs.iter().map(|input| describe(input)).collect();
        assert_eq!(options.motion, [0; 3]);
        format!("flags={} operation={:#x} [{}]", options.flags, options.operation, inputs.join(", "))
    }
}
