//! A parallel sort of particles by code: one radix pass into buckets, then each bucket on its own.
//!
//! Chunks are scattered into buckets locally, then each bucket collects its part of every chunk. Two copies instead of
//! the one of a shared scatter, but every thread writes memory of its own.

use rayon::prelude::*;

/// A particle and its place on the curve. The order is total, so the result depends on the input alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Key {
    pub code: u64,
    pub particle: u32,
}

const BUCKET_BITS: u32 = 11;
const BUCKETS: usize = 1 << BUCKET_BITS;
/// Keys scattered together: their 1 MiB stays in a core's cache.
const CHUNK: usize = 1 << 16;
/// Fewer keys than this are sorted directly, and buckets larger than this by all threads.
const SMALL: usize = 1 << 14;

/// The buffers of the sort, kept for the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct KeySort {
    scattered: Vec<Key>,
    /// For each chunk, where each of its buckets ends.
    ends: Vec<u32>,
    /// Where each bucket starts in the result, and its end.
    starts: Vec<usize>,
}

impl KeySort {
    /// Sorts `keys` by code, then particle.
    pub fn sort(&mut self, keys: &mut [Key]) {
        if keys.len() <= SMALL {
            keys.sort_unstable();
            return;
        }
        let (least, most) = keys
            .par_chunks(CHUNK)
            .map(|chunk| chunk.iter().fold((u64::MAX, 0), |(lo, hi), key| (key.code.min(lo), key.code.max(hi))))
            .reduce(|| (u64::MAX, 0), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        // Higher bits than this are the same in all codes, and would leave buckets empty.
        let differing = u64::BITS - (least ^ most).leading_zeros();
        let shift = differing.saturating_sub(BUCKET_BITS);

        self.scattered.resize(keys.len(), Key::default());
        self.ends.clear();
        self.ends.resize(keys.len().div_ceil(CHUNK) * BUCKETS, 0);
        keys.par_chunks(CHUNK)
            .zip(self.scattered.par_chunks_mut(CHUNK))
            .zip(self.ends.par_chunks_mut(BUCKETS))
            .for_each(|((keys, scattered), ends)| scatter(keys, scattered, ends, shift));

        self.starts.clear();
        self.starts.resize(BUCKETS + 1, 0);
        for ends in self.ends.chunks(BUCKETS) {
            for (bucket, size) in sizes(ends).enumerate() {
                self.starts[bucket + 1] += size;
            }
        }
        for bucket in 0..BUCKETS {
            self.starts[bucket + 1] += self.starts[bucket];
        }
        self.collect(keys, 0, BUCKETS);
    }

    pub fn bytes(&self) -> usize {
        size_of::<Key>() * self.scattered.capacity()
            + size_of::<u32>() * self.ends.capacity()
            + size_of::<usize>() * self.starts.capacity()
    }

    /// Fills `out` with buckets `from..to`, sorted.
    fn collect(&self, out: &mut [Key], from: usize, to: usize) {
        if out.len() <= SMALL || to - from == 1 {
            let mut rest = out;
            for bucket in from..to {
                let (out, tail) = rest.split_at_mut(self.starts[bucket + 1] - self.starts[bucket]);
                self.collect_bucket(out, bucket);
                rest = tail;
            }
            return;
        }
        let middle = from.midpoint(to);
        let (left, right) = out.split_at_mut(self.starts[middle] - self.starts[from]);
        rayon::join(|| self.collect(left, from, middle), || self.collect(right, middle, to));
    }

    fn collect_bucket(&self, out: &mut [Key], bucket: usize) {
        let mut filled = 0;
        for (chunk, ends) in self.scattered.chunks(CHUNK).zip(self.ends.chunks(BUCKETS)) {
            let start = if bucket == 0 { 0 } else { ends[bucket - 1] as usize };
            let part = &chunk[start..ends[bucket] as usize];
            out[filled..filled + part.len()].copy_from_slice(part);
            filled += part.len();
        }
        if out.len() > SMALL {
            out.par_sort_unstable();
        } else {
            out.sort_unstable();
        }
    }
}

/// Sizes of the buckets that end at `ends`.
fn sizes(ends: &[u32]) -> impl Iterator<Item = usize> + '_ {
    ends.iter().scan(0, |start, &end| Some((end - std::mem::replace(start, end)) as usize))
}

/// One stable counting sort of a chunk by the bucket bits.
fn scatter(keys: &[Key], scattered: &mut [Key], ends: &mut [u32], shift: u32) {
    let bucket = |key: &Key| (key.code >> shift) as usize & (BUCKETS - 1);
    for key in keys {
        ends[bucket(key)] += 1;
    }
    let mut start = 0;
    for end in ends.iter_mut() {
        start += std::mem::replace(end, start);
    }
    for key in keys {
        let next = &mut ends[bucket(key)];
        scattered[*next as usize] = *key;
        *next += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearfield_core::philox::philox4x32;

    #[test]
    fn keys_are_sorted_whatever_bits_they_differ_in() {
        for n in [0, 1, SMALL, SMALL + 1, 3 * CHUNK + 7] {
            for mask in [u64::MAX, 0, 1, 0xFFF, 0xF << 60, 0x8000_0000_0000_0001] {
                let mut keys: Vec<Key> = (0..n as u32)
                    .map(|particle| {
                        let [a, b, ..] = philox4x32([particle, 0, 0, 0], [1, 2]);
                        Key { code: (u64::from(a) << 32 | u64::from(b)) & mask, particle }
                    })
                    .collect();
                let mut expected = keys.clone();
                expected.sort();
                KeySort::default().sort(&mut keys);
                assert!(keys == expected, "{n} keys of mask {mask:#x}");
            }
        }
    }
}
