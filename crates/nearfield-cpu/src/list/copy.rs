//! Short arrays copied from anywhere in memory.

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
