//! Short arrays copied from anywhere in memory.

use crate::LANES;

/// Copies the first `n` entries, and may copy what comes after them, as long as there is room: most rows are one chunk
/// then, whatever their length, and no jump depends on it. For rows that are written one after the other.
#[inline(always)]
pub(super) fn copy_over(from: &[u32], n: usize, to: &mut [u32]) {
    let n_chunks = n.div_ceil(LANES);
    match (from.as_chunks::<LANES>().0.get(..n_chunks), to.as_chunks_mut::<LANES>().0.get_mut(..n_chunks)) {
        (Some(from), Some(to)) => from.iter().zip(to).for_each(|(from, to)| *to = *from),
        _ => copy(&from[..n], &mut to[..n]),
    }
}

/// Copies a row. Rows are short, so that a call of the C library would take longer than the copy.
#[inline(always)]
pub(crate) fn copy(from: &[u32], to: &mut [u32]) {
    match from.len() {
        0..4 => to.iter_mut().zip(from).for_each(|(to, from)| *to = *from),
        4..8 => copy_by::<4>(from, to),
        _ => copy_by::<8>(from, to),
    }
}

/// As [`copy`], of no fewer than `N`.
#[inline(always)]
fn copy_by<const N: usize>(from: &[u32], to: &mut [u32]) {
    for (from, to) in from.as_chunks::<N>().0.iter().zip(to.as_chunks_mut::<N>().0) {
        *to = *from;
    }
    // The rest, and some of the others once more.
    if let (Some(from), Some(to)) = (from.last_chunk::<N>(), to.last_chunk_mut::<N>()) {
        *to = *from;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_copied_over_the_rest_of_the_one_before_are_whole() {
        for last in [0, 1, 15, 16, 17] {
            let lengths = [3, 0, 16, 17, 1, 40, 8, last];
            let from: Vec<u32> = (0..100).collect();
            let mut to = vec![u32::MAX; lengths.iter().sum()];
            let (mut rest, mut expected) = (&mut to[..], Vec::new());
            for (k, n) in lengths.into_iter().enumerate() {
                copy_over(&from[k..], n, rest);
                rest = &mut rest[n..];
                expected.extend_from_slice(&from[k..k + n]);
            }
            assert_eq!(to, expected);
        }
    }

    #[test]
    fn rows_of_any_length_are_copied_and_nothing_else_is_written() {
        let from: Vec<u32> = (1..=100).collect();
        for n in 0..=from.len() {
            let mut to = vec![0; n + 2];
            copy(&from[..n], &mut to[1..=n]);
            assert_eq!(to[1..=n], from[..n]);
            assert_eq!([to[0], to[n + 1]], [0, 0]);
        }
    }
}
