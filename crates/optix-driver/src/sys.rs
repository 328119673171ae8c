//! What crosses the border to the driver in ABI 87 (OptiX 8.0): handles, structs, enum values.
//!
//! Only what this crate calls is declared. The driver reads structs by offset, so each one is asserted below: a layout
//! that drifts is a compile error, not a wrong picture. ABI 93 has the same layouts; from 105 on some differ (pipeline
//! options, triangle input) and would need their own module.

use std::ffi::{c_char, c_void};
use std::mem::{offset_of, size_of};

macro_rules! handles {
    ($($name:ident),*) => {
        $(
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            #[repr(transparent)]
            pub struct $name(pub *mut c_void);

            impl $name {
                pub const NULL: Self = Self(std::ptr::null_mut());
            }
        )*
    };
}

handles!(ContextHandle, ModuleHandle, ProgramGroupHandle, PipelineHandle);

pub const SUCCESS: i32 = 0;

pub const VALIDATION_ALL: u32 = 0xFFFF_FFFF;

pub const PROPERTY_MAX_PRIMITIVES_PER_GAS: u32 = 0x2003;
pub const PROPERTY_MAX_INSTANCES_PER_IAS: u32 = 0x2004;
pub const PROPERTY_RTCORE_VERSION: u32 = 0x2005;
pub const PROPERTY_MAX_INSTANCE_ID: u32 = 0x2006;

pub const GRAPH_SINGLE_GAS: u32 = 1;
pub const GRAPH_SINGLE_LEVEL_INSTANCING: u32 = 2;

pub const PRIMITIVE_CUSTOM: u32 = 1;
pub const PRIMITIVE_SPHERE: u32 = 0x40;
pub const PRIMITIVE_TRIANGLE: u32 = 0x8000_0000;

pub const GROUP_RAYGEN: u32 = 0x2421;
pub const GROUP_MISS: u32 = 0x2422;
pub const GROUP_HITGROUP: u32 = 0x2424;

pub const BUILTIN_SPHERE: u32 = 0x2506;

pub const INPUT_TRIANGLES: u32 = 0x2141;
pub const INPUT_CUSTOM: u32 = 0x2142;
pub const INPUT_INSTANCES: u32 = 0x2143;
pub const INPUT_SPHERES: u32 = 0x2146;

pub const VERTEX_FLOAT3: u32 = 0x2121;
pub const INDEX_NONE: u32 = 0;
pub const INDEX_U32X3: u32 = 0x2103;

pub const BUILD_ALLOW_UPDATE: u32 = 1;
pub const BUILD_ALLOW_COMPACTION: u32 = 2;
pub const BUILD_FAST_TRACE: u32 = 4;
pub const BUILD_FAST_BUILD: u32 = 8;

pub const OPERATION_BUILD: u32 = 0x2161;
pub const OPERATION_UPDATE: u32 = 0x2162;

pub const EMIT_COMPACTED_SIZE: u32 = 0x2181;

/// Bytes of the header that the driver packs at the start of every SBT record.
pub const SBT_HEADER_SIZE: usize = 32;
/// Alignment of SBT records on the device.
pub const SBT_ALIGNMENT: usize = 16;

pub type LogFunction = unsafe extern "C" fn(u32, *const c_char, *const c_char, *mut c_void);

#[repr(C)]
pub struct ContextOptions {
    pub log_function: Option<LogFunction>,
    pub log_data: *mut c_void,
    pub log_level: u32,
    pub validation: u32,
}

#[repr(C)]
pub struct ModuleOptions {
    pub max_registers: u32,
    pub optimization_level: u32,
    pub debug_level: u32,
    pub bound_values: *const c_void,
    pub num_bound_values: u32,
    pub num_payload_types: u32,
    pub payload_types: *const c_void,
}

#[repr(C)]
pub struct PipelineOptions {
    pub uses_motion: u32,
    pub graph_flags: u32,
    pub num_payload: u32,
    pub num_attributes: u32,
    pub exception_flags: u32,
    pub params_name: *const c_char,
    pub primitive_flags: u32,
    pub uses_micromaps: u32,
}

#[repr(C)]
pub struct LinkOptions {
    pub max_trace_depth: u32,
}

/// One program: absent when both are null, built in when only the name is.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Program {
    pub module: ModuleHandle,
    pub entry: *const c_char,
}

/// Ray generation and miss use the first program; a hitgroup has closest hit, any hit, intersection.
#[repr(C)]
pub struct ProgramGroupDesc {
    pub kind: u32,
    pub flags: u32,
    pub programs: [Program; 3],
}

#[repr(C)]
pub struct ProgramGroupOptions {
    pub payload_type: *const c_void,
}

#[repr(C)]
pub struct BuiltinIsOptions {
    pub primitive: u32,
    pub uses_motion: u32,
    pub build_flags: u32,
    pub end_cap_flags: u32,
}

#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct StackSizes {
    pub raygen: u32,
    pub miss: u32,
    pub closest_hit: u32,
    pub any_hit: u32,
    pub intersection: u32,
    pub continuation_callable: u32,
    pub direct_callable: u32,
}

#[derive(Clone, Copy)]
#[repr(C)]
pub struct AabbInput {
    pub buffers: *const u64,
    pub count: u32,
    pub stride: u32,
    pub flags: *const u32,
    pub num_sbt_records: u32,
    pub sbt_offset_buffer: u64,
    pub sbt_offset_size: u32,
    pub sbt_offset_stride: u32,
    pub primitive_offset: u32,
}

#[derive(Clone, Copy)]
#[repr(C)]
pub struct SphereInput {
    pub centers: *const u64,
    pub stride: u32,
    pub count: u32,
    pub radii: *const u64,
    pub radius_stride: u32,
    pub single_radius: u32,
    pub flags: *const u32,
    pub num_sbt_records: u32,
    pub sbt_offset_buffer: u64,
    pub sbt_offset_size: u32,
    pub sbt_offset_stride: u32,
    pub primitive_offset: u32,
}

#[derive(Clone, Copy)]
#[repr(C)]
pub struct TriangleInput {
    pub vertices: *const u64,
    pub num_vertices: u32,
    pub vertex_format: u32,
    pub vertex_stride: u32,
    pub indices: u64,
    pub num_triplets: u32,
    pub index_format: u32,
    pub index_stride: u32,
    pub transform: u64,
    pub flags: *const u32,
    pub num_sbt_records: u32,
    pub unused: [u32; 43],
}

#[derive(Clone, Copy)]
#[repr(C)]
pub struct InstanceInput {
    pub instances: u64,
    pub count: u32,
    pub stride: u32,
}

#[derive(Clone, Copy)]
#[repr(C)]
pub union BuildInputData {
    pub zero: [u64; 128],
    pub aabbs: AabbInput,
    pub spheres: SphereInput,
    pub triangles: TriangleInput,
    pub instances: InstanceInput,
}

#[derive(Clone, Copy)]
#[repr(C)]
pub struct BuildInput {
    pub kind: u32,
    pub data: BuildInputData,
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct AccelOptions {
    pub flags: u32,
    pub operation: u32,
    pub motion: [u32; 3],
}

#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct AccelSizes {
    pub output: usize,
    pub temp: usize,
    pub temp_update: usize,
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Emit {
    pub result: u64,
    pub kind: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct ShaderBindingTable {
    pub raygen: u64,
    pub exception: u64,
    pub miss: u64,
    pub miss_stride: u32,
    pub miss_count: u32,
    pub hit: u64,
    pub hit_stride: u32,
    pub hit_count: u32,
    pub callables: u64,
    pub callables_stride: u32,
    pub callables_count: u32,
}

macro_rules! layout {
    ($type:ident: $size:literal { $($field:ident: $offset:literal),* $(,)? }) => {
        const _: () = assert!(size_of::<$type>() == $size);
        $(const _: () = assert!(offset_of!($type, $field) == $offset);)*
    };
}

layout!(ContextOptions: 24 { log_function: 0, log_data: 8, log_level: 16, validation: 20 });
layout!(ModuleOptions: 40 {
    max_registers: 0, optimization_level: 4, debug_level: 8, bound_values: 16, num_bound_values: 24,
    num_payload_types: 28, payload_types: 32,
});
layout!(PipelineOptions: 40 {
    uses_motion: 0, graph_flags: 4, num_payload: 8, num_attributes: 12, exception_flags: 16, params_name: 24,
    primitive_flags: 32, uses_micromaps: 36,
});
layout!(LinkOptions: 4 { max_trace_depth: 0 });
layout!(Program: 16 { module: 0, entry: 8 });
layout!(ProgramGroupDesc: 56 { kind: 0, flags: 4, programs: 8 });
layout!(ProgramGroupOptions: 8 { payload_type: 0 });
layout!(BuiltinIsOptions: 16 { primitive: 0, uses_motion: 4, build_flags: 8, end_cap_flags: 12 });
layout!(StackSizes: 28 {
    raygen: 0, miss: 4, closest_hit: 8, any_hit: 12, intersection: 16, continuation_callable: 20, direct_callable: 24,
});
layout!(AabbInput: 56 { buffers: 0, count: 8, stride: 12, flags: 16, num_sbt_records: 24 });
layout!(SphereInput: 72 {
    centers: 0, stride: 8, count: 12, radii: 16, radius_stride: 24, single_radius: 28, flags: 32, num_sbt_records: 40,
});
layout!(TriangleInput: 240 {
    vertices: 0, num_vertices: 8, vertex_format: 12, vertex_stride: 16, indices: 24, num_triplets: 32, index_format: 36,
    index_stride: 40, transform: 48, flags: 56, num_sbt_records: 64,
});
layout!(InstanceInput: 16 { instances: 0, count: 8, stride: 12 });
layout!(BuildInput: 1032 { kind: 0, data: 8 });
layout!(AccelOptions: 20 { flags: 0, operation: 4, motion: 8 });
layout!(AccelSizes: 24 { output: 0, temp: 8, temp_update: 16 });
layout!(Emit: 16 { result: 0, kind: 8 });
layout!(ShaderBindingTable: 64 {
    raygen: 0, exception: 8, miss: 16, miss_stride: 24, miss_count: 28, hit: 32, hit_stride: 40, hit_count: 44,
    callables: 48, callables_stride: 56, callables_count: 60,
});
