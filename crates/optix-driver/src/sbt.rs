//! Shader binding tables: which programs, with which data, a launch and its rays run.
//!
//! A record is a 32-byte header that the driver packs and data that its programs read. Records of a section have one
//! stride, so the largest decides; all are 16-byte aligned. Sections follow each other: ray generation, miss, hit.

use std::sync::Arc;

use crate::error::{Error, Result, to_u32};
use crate::program_group::{ProgramGroup, ProgramGroupKind};
use crate::sys::{self, SBT_ALIGNMENT, SBT_HEADER_SIZE};

/// One record: a group's programs and the data they read.
#[derive(Clone, Copy, Debug)]
pub struct SbtRecord<'a> {
    group: &'a Arc<ProgramGroup>,
    data: &'a [u8],
}

impl<'a> SbtRecord<'a> {
    /// A record without data.
    pub fn new(group: &'a Arc<ProgramGroup>) -> Self {
        Self { group, data: &[] }
    }

    /// A record whose programs read `data`; its start is 16-byte aligned on the device.
    pub fn with_data(group: &'a Arc<ProgramGroup>, data: &'a [u8]) -> Self {
        Self { group, data }
    }
}

/// A table on the host: the bytes to upload, and where its sections are in them.
#[derive(Clone, Debug)]
pub struct SbtImage {
    bytes: Vec<u8>,
    miss: Section,
    hit: Section,
}

/// A table on the device, for [`Pipeline::launch`](crate::Pipeline::launch).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShaderBindingTable(pub(crate) sys::ShaderBindingTable);

impl SbtImage {
    /// Lays out a table and packs its headers. Needs no device memory.
    ///
    /// # Errors
    /// [`Error::WrongSection`] for a group of another kind; [`Error::Call`]; [`Error::TooLarge`] for data or counts
    /// beyond 32 bits.
    pub fn new(raygen: SbtRecord<'_>, miss: &[SbtRecord<'_>], hit: &[SbtRecord<'_>]) -> Result<Self> {
        let mut bytes = Vec::new();
        append_section(&mut bytes, ProgramGroupKind::Raygen, &[raygen])?;
        let miss = append_section(&mut bytes, ProgramGroupKind::Miss, miss)?;
        let hit = append_section(&mut bytes, ProgramGroupKind::Hitgroup, hit)?;
        Ok(Self { bytes, miss, hit })
    }

    /// What to upload.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The table as it is once [`bytes`](Self::bytes) are uploaded to the device address `address`.
    ///
    /// # Errors
    /// [`Error::MisalignedTable`] unless `address` is a multiple of 16.
    pub fn at(&self, address: u64) -> Result<ShaderBindingTable> {
        if !address.is_multiple_of(SBT_ALIGNMENT as u64) {
            return Err(Error::MisalignedTable(address));
        }
        let base = |section: Section| if section.count == 0 { 0 } else { address + section.offset };
        Ok(ShaderBindingTable(sys::ShaderBindingTable {
            raygen: address,
            exception: 0,
            miss: base(self.miss),
            miss_stride: self.miss.stride,
            miss_count: self.miss.count,
            hit: base(self.hit),
            hit_stride: self.hit.stride,
            hit_count: self.hit.count,
            callables: 0,
            callables_stride: 0,
            callables_count: 0,
        }))
    }
}

/// Records of one kind within the bytes of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Section {
    offset: u64,
    stride: u32,
    count: u32,
}

fn append_section(bytes: &mut Vec<u8>, kind: ProgramGroupKind, records: &[SbtRecord<'_>]) -> Result<Section> {
    let offset = bytes.len();
    let stride = records.iter().map(|record| record_size(record.data.len())).max().unwrap_or(0);
    let section = Section {
        offset: offset as u64,
        stride: to_u32("stride of SBT records", stride)?,
        count: to_u32("SBT records", records.len())?,
    };
    bytes.resize(offset + stride * records.len(), 0);
    for (record, target) in records.iter().zip(bytes[offset..].chunks_exact_mut(stride.max(1))) {
        if record.group.kind() != kind {
            return Err(Error::WrongSection { expected: kind, found: record.group.kind() });
        }
        target[..SBT_HEADER_SIZE].copy_from_slice(&pack_header(record.group)?.0);
        target[SBT_HEADER_SIZE..][..record.data.len()].copy_from_slice(record.data);
    }
    Ok(section)
}

/// Bytes of a record with `data` bytes of data, up to where the next may start.
fn record_size(data: usize) -> usize {
    (SBT_HEADER_SIZE + data).next_multiple_of(SBT_ALIGNMENT)
}

/// A header, aligned as the driver wants records to be.
#[repr(C, align(16))]
struct Header([u8; SBT_HEADER_SIZE]);

const _: () = assert!(align_of::<Header>() == SBT_ALIGNMENT);

fn pack_header(group: &ProgramGroup) -> Result<Header> {
    let mut header = Header([0; SBT_HEADER_SIZE]);
    let table = group.context.table();
    // SAFETY: the group is alive, and the driver writes the 32 bytes of a header.
    let code = unsafe { (table.sbt_record_pack_header)(group.handle, header.0.as_mut_ptr().cast()) };
    table.check("optixSbtRecordPackHeader", code)?;
    Ok(header)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock;
    use crate::program_group::{Hitgroup, Program};

    /// Ray generation 3, miss 4, hitgroup 5; the mock packs headers of 32 times the handle.
    fn groups() -> [Arc<ProgramGroup>; 3] {
        let context = mock::context();
        let module = mock::module(&context);
        [
            ProgramGroup::raygen(Program::new(&module, c"__raygen__a")).unwrap(),
            ProgramGroup::empty_miss(&context).unwrap(),
            ProgramGroup::hitgroup(&context, Hitgroup::default()).unwrap(),
        ]
    }

    #[test]
    fn records_are_padded_to_sixteen_bytes() {
        assert_eq!([0, 1, 16, 17, 48].map(record_size), [32, 48, 48, 64, 80]);
    }

    #[test]
    fn sections_follow_each_other_and_the_largest_record_decides_the_stride() {
        let [raygen, miss, hit] = groups();
        let hits = [SbtRecord::with_data(&hit, &[1, 2, 3]), SbtRecord::new(&hit), SbtRecord::with_data(&hit, &[9; 20])];
        let image = SbtImage::new(SbtRecord::with_data(&raygen, &[7; 8]), &[SbtRecord::new(&miss)], &hits).unwrap();
        let bytes = image.bytes();
        assert_eq!(bytes.len(), 48 + 32 + 3 * 64);
        assert_eq!((&bytes[..32], &bytes[32..40], &bytes[40..48]), (&[3; 32][..], &[7; 8][..], &[0; 8][..]));
        assert_eq!(&bytes[48..80], [4; 32]);
        assert_eq!((&bytes[80..112], &bytes[112..115], &bytes[115..144]), (&[5; 32][..], &[1, 2, 3][..], &[0; 29][..]));
        assert_eq!((&bytes[208..240], &bytes[240..260]), (&[5; 32][..], &[9; 20][..]));

        let table = image.at(0x7000).unwrap().0;
        assert_eq!((table.raygen, table.exception, table.callables, table.callables_count), (0x7000, 0, 0, 0));
        assert_eq!((table.miss, table.miss_stride, table.miss_count), (0x7000 + 48, 32, 1));
        assert_eq!((table.hit, table.hit_stride, table.hit_count), (0x7000 + 80, 64, 3));
    }

    #[test]
    fn an_empty_section_has_no_address() {
        let [raygen, ..] = groups();
        let table = SbtImage::new(SbtRecord::new(&raygen), &[], &[]).unwrap().at(0x7000).unwrap().0;
        assert_eq!((table.miss, table.miss_stride, table.miss_count), (0, 0, 0));
        assert_eq!((table.hit, table.hit_stride, table.hit_count), (0, 0, 0));
    }

    #[test]
    fn headers_are_packed_into_aligned_memory() {
        let [raygen, ..] = groups();
        mock::take_calls();
        SbtImage::new(SbtRecord::new(&raygen), &[], &[]).unwrap();
        assert_eq!(mock::calls(), ["optixSbtRecordPackHeader 3 address%16=0"]);
    }

    #[test]
    fn a_group_in_the_wrong_section_is_an_error() {
        use ProgramGroupKind::{Hitgroup, Miss, Raygen};
        let [raygen, miss, hit] = groups();
        let [raygen, miss, hit] = [&raygen, &miss, &hit].map(SbtRecord::new);
        let wrong = |expected, found| Err(Error::WrongSection { expected, found });
        assert_eq!(SbtImage::new(miss, &[miss], &[hit]).map(drop), wrong(Raygen, Miss));
        assert_eq!(SbtImage::new(raygen, &[hit], &[hit]).map(drop), wrong(Miss, Hitgroup));
        assert_eq!(SbtImage::new(raygen, &[miss], &[raygen]).map(drop), wrong(Hitgroup, Raygen));
    }

    #[test]
    fn a_misaligned_address_is_an_error() {
        let [raygen, ..] = groups();
        let image = SbtImage::new(SbtRecord::new(&raygen), &[], &[]).unwrap();
        assert_eq!(image.at(0x7008), Err(Error::MisalignedTable(0x7008)));
    }
}
