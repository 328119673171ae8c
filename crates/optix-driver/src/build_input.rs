//! What acceleration structures are built over: boxes, spheres, triangles, instances.

use crate::sys;

/// When the any-hit program runs for an input's primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum AnyHit {
    /// For every hit; splitting a primitive in the hierarchy may report a hit twice.
    #[default]
    Always = 0,
    /// Never; traversal is faster.
    Never = 1,
    /// Exactly once a primitive and ray.
    OncePerPrimitive = 2,
}

/// One set of primitives in device memory, with one record in the shader binding table.
///
/// Addresses are device addresses (`CUdeviceptr`), strides and sizes are in bytes. The primitives of a structure are
/// all of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BuildInput {
    /// Boxes with an intersection program of the user.
    Aabbs(Aabbs),
    /// Built-in spheres.
    Spheres(Spheres),
    /// Built-in triangles.
    Triangles(Triangles),
    /// Instances of other structures.
    Instances(Instances),
}

/// Axis-aligned boxes: 6 `f32` each, least x, y, z, then greatest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabbs {
    /// Address of the first box, 8-byte aligned.
    pub buffer: u64,
    /// Number of boxes.
    pub count: u32,
    /// From one box to the next, 24 if packed; a multiple of 8.
    pub stride: u32,
    /// When the any-hit program runs.
    pub any_hit: AnyHit,
}

/// Spheres: shells, not balls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spheres {
    /// Address of the first centre: 3 `f32`.
    pub centers: u64,
    /// Number of spheres.
    pub count: u32,
    /// From one centre to the next: 12 if packed, 16 for `float4`.
    pub stride: u32,
    /// Their radii.
    pub radii: SphereRadii,
    /// When the any-hit program runs.
    pub any_hit: AnyHit,
}

/// Radii of [`Spheres`], `f32` in device memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SphereRadii {
    /// One for all.
    Single {
        /// Address of the radius.
        buffer: u64,
    },
    /// One for each.
    PerSphere {
        /// Address of the first radius.
        buffer: u64,
        /// From one radius to the next, 4 if packed.
        stride: u32,
    },
}

/// Triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangles {
    /// Address of the first vertex: 3 `f32`.
    pub vertices: u64,
    /// Number of vertices.
    pub num_vertices: u32,
    /// From one vertex to the next, 12 if packed.
    pub vertex_stride: u32,
    /// Which vertices make a triangle; without, each three in turn.
    pub indices: Option<Triplets>,
    /// When the any-hit program runs.
    pub any_hit: AnyHit,
}

/// Vertex indices of [`Triangles`], 3 packed `u32` each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triplets {
    /// Address of the first index.
    pub buffer: u64,
    /// Number of triangles.
    pub count: u32,
}

/// Packed [`Instance`](crate::Instance) records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instances {
    /// Address of the first record, 16-byte aligned.
    pub buffer: u64,
    /// Number of instances.
    pub count: u32,
}

impl BuildInput {
    /// For the driver; points into `self`: without motion its host arrays of addresses and flags have one element.
    pub(crate) fn lower(&self) -> sys::BuildInput {
        // The driver wants the unused rest of the union zero.
        let mut data = sys::BuildInputData { zero: [0; 128] };
        let kind = match self {
            Self::Aabbs(aabbs) => {
                data.aabbs = aabbs.lower();
                sys::INPUT_CUSTOM
            }
            Self::Spheres(spheres) => {
                data.spheres = spheres.lower();
                sys::INPUT_SPHERES
            }
            Self::Triangles(triangles) => {
                data.triangles = triangles.lower();
                sys::INPUT_TRIANGLES
            }
            Self::Instances(instances) => {
                data.instances = sys::InstanceInput { instances: instances.buffer, count: instances.count, stride: 0 };
                sys::INPUT_INSTANCES
            }
        };
        sys::BuildInput { kind, data }
    }
}

impl Aabbs {
    fn lower(&self) -> sys::AabbInput {
        sys::AabbInput {
            buffers: &self.buffer,
            count: self.count,
            stride: self.stride,
            flags: self.any_hit.flags(),
            num_sbt_records: 1,
            sbt_offset_buffer: 0,
            sbt_offset_size: 0,
            sbt_offset_stride: 0,
            primitive_offset: 0,
        }
    }
}

impl Spheres {
    fn lower(&self) -> sys::SphereInput {
        let (radii, radius_stride, single_radius) = match &self.radii {
            SphereRadii::Single { buffer } => (buffer, 0, 1),
            SphereRadii::PerSphere { buffer, stride } => (buffer, *stride, 0),
        };
        sys::SphereInput {
            centers: &self.centers,
            stride: self.stride,
            count: self.count,
            radii,
            radius_stride,
            single_radius,
            flags: self.any_hit.flags(),
            num_sbt_records: 1,
            sbt_offset_buffer: 0,
            sbt_offset_size: 0,
            sbt_offset_stride: 0,
            primitive_offset: 0,
        }
    }
}

impl Triangles {
    fn lower(&self) -> sys::TriangleInput {
        let (indices, num_triplets, index_format, index_stride) = match self.indices {
            Some(Triplets { buffer, count }) => (buffer, count, sys::INDEX_U32X3, 12),
            None => (0, 0, sys::INDEX_NONE, 0),
        };
        sys::TriangleInput {
            vertices: &self.vertices,
            num_vertices: self.num_vertices,
            vertex_format: sys::VERTEX_FLOAT3,
            vertex_stride: self.vertex_stride,
            indices,
            num_triplets,
            index_format,
            index_stride,
            transform: 0,
            flags: self.any_hit.flags(),
            num_sbt_records: 1,
            unused: [0; 43],
        }
    }
}

impl AnyHit {
    /// The host array of geometry flags, one for the one record.
    fn flags(&self) -> *const u32 {
        std::ptr::from_ref(self).cast()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock::describe;

    fn described(input: BuildInput) -> String {
        // SAFETY: the lowered input points into `input`, which is alive.
        unsafe { describe(&input.lower()) }
    }

    #[test]
    fn boxes_are_described_to_the_driver() {
        let aabbs = Aabbs { buffer: 0x1000, count: 5, stride: 24, any_hit: AnyHit::Never };
        assert_eq!(described(BuildInput::Aabbs(aabbs)), "custom 0x1000 n=5 stride=24 flags=1 records=1");
    }

    #[test]
    fn spheres_have_one_radius_or_one_each() {
        let one = Spheres {
            centers: 0x1000,
            count: 7,
            stride: 16,
            radii: SphereRadii::Single { buffer: 0x2000 },
            any_hit: AnyHit::OncePerPrimitive,
        };
        let each = Spheres { radii: SphereRadii::PerSphere { buffer: 0x3000, stride: 4 }, ..one };
        assert_eq!(
            [one, each].map(|spheres| described(BuildInput::Spheres(spheres))),
            [
                "spheres 0x1000 n=7 stride=16 radii=0x2000 stride=0 single=1 flags=2 records=1",
                "spheres 0x1000 n=7 stride=16 radii=0x3000 stride=4 single=0 flags=2 records=1",
            ]
        );
    }

    #[test]
    fn triangles_have_indices_or_take_vertices_in_turn() {
        let plain =
            Triangles { vertices: 0x1000, num_vertices: 9, vertex_stride: 12, indices: None, any_hit: AnyHit::Always };
        let indexed = Triangles { indices: Some(Triplets { buffer: 0x2000, count: 4 }), ..plain };
        assert_eq!(
            [plain, indexed].map(|triangles| described(BuildInput::Triangles(triangles))),
            [
                "triangles 0x1000 n=9 format=0x2121 stride=12 indices=0x0 n=0 format=0x0 stride=0 flags=0 records=1",
                "triangles 0x1000 n=9 format=0x2121 stride=12 indices=0x2000 n=4 format=0x2103 stride=12 flags=0 \
                 records=1",
            ]
        );
    }

    #[test]
    fn instances_are_packed() {
        let instances = Instances { buffer: 0x1000, count: 27 };
        assert_eq!(described(BuildInput::Instances(instances)), "instances 0x1000 n=27 stride=0");
    }
}
