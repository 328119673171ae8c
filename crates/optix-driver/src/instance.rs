//! Instances: a structure placed somewhere in the scene.

use std::mem::{align_of, offset_of, size_of};

use crate::accel::TraversableHandle;

/// One placement of a structure, in the layout that the device reads (80 bytes, 16-byte aligned).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct Instance {
    /// From the structure's coordinates to the scene's: 3 rows of 4, the last column being the translation.
    pub transform: [f32; 12],
    /// What programs see as the instance's id, at most [`max_instance_id`](crate::DeviceContext::max_instance_id).
    pub id: u32,
    /// Added to the index of the hit record.
    pub sbt_offset: u32,
    /// Met only by rays whose mask has a bit in common; of 8 bits.
    pub mask: u32,
    flags: u32,
    /// The structure.
    pub handle: TraversableHandle,
    unused: [u32; 2],
}

const _: () = assert!(size_of::<Instance>() == 80 && align_of::<Instance>() == 16);
const _: () = assert!(offset_of!(Instance, transform) == 0 && offset_of!(Instance, id) == 48);
const _: () = assert!(offset_of!(Instance, sbt_offset) == 52 && offset_of!(Instance, mask) == 56);
const _: () = assert!(offset_of!(Instance, flags) == 60 && offset_of!(Instance, handle) == 64);

impl Instance {
    /// `handle` where it is, visible to every ray, with the hit records from the first.
    pub fn new(handle: TraversableHandle, id: u32) -> Self {
        Self::translated(handle, id, [0.0; 3])
    }

    /// As [`new`](Self::new), moved by `shift`.
    pub fn translated(handle: TraversableHandle, id: u32, shift: [f32; 3]) -> Self {
        let [x, y, z] = shift;
        #[rustfmt::skip]
        let transform = [
            1.0, 0.0, 0.0, x,
            0.0, 1.0, 0.0, y,
            0.0, 0.0, 1.0, z,
        ];
        Self { transform, id, sbt_offset: 0, mask: 255, flags: 0, handle, unused: [0; 2] }
    }

    /// The bytes to upload for [`Instances`](crate::Instances).
    pub fn bytes(instances: &[Self]) -> &[u8] {
        // SAFETY: the fields fill the 80 bytes without padding, so every byte is initialised; any byte is a `u8`.
        unsafe { std::slice::from_raw_parts(instances.as_ptr().cast(), size_of_val(instances)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_translation_is_the_last_column_of_the_transform() {
        let instance = Instance::translated(TraversableHandle(9), 4, [1.5, -2.0, 3.0]);
        let apply = |p: [f32; 3]| {
            [0, 1, 2].map(|row| {
                let t = &instance.transform[4 * row..4 * row + 4];
                t[0] * p[0] + t[1] * p[1] + t[2] * p[2] + t[3]
            })
        };
        assert_eq!(apply([10.0, 20.0, 30.0]), [11.5, 18.0, 33.0]);
        assert_eq!(Instance::new(TraversableHandle(9), 4), Instance::translated(TraversableHandle(9), 4, [0.0; 3]));
    }

    #[test]
    fn the_bytes_hold_each_field_where_the_device_reads_it() {
        let instances =
            [Instance::new(TraversableHandle(1), 0), Instance::translated(TraversableHandle(7), 3, [2.0; 3])];
        let bytes = Instance::bytes(&instances);
        assert_eq!(bytes.len(), 160);
        let word = |offset: usize| u32::from_ne_bytes(bytes[offset..offset + 4].try_into().unwrap());
        assert_eq!(word(80 + 12), 2.0_f32.to_bits());
        assert_eq!([48, 52, 56, 60, 64, 68].map(|offset| word(80 + offset)), [3, 0, 255, 0, 7, 0]);
    }
}
