//! Dividing a sequence so that all parts are the same work.

/// Consecutive blocks and how much work they were.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub blocks: usize,
    pub work: f64,
}

/// Where each of `n_parts` parts of `n` blocks ends, if work is distributed as it was in `pieces`, evenly in each; all of one
/// length where there are none.
pub(super) fn ends(pieces: &[Piece], n: usize, n_parts: usize) -> Vec<usize> {
    let (blocks, work) = pieces.iter().fold((0, 0.0), |(blocks, work), p| (blocks + p.blocks, work + p.work));
    let even = [Piece { blocks: n, work: n as f64 }];
    let (pieces, blocks, work) = if work > 0.0 { (pieces, blocks, work) } else { (&even[..], n, n as f64) };
    let mut ends = Vec::with_capacity(n_parts);
    // Blocks and work before the piece at hand.
    let (mut start, mut before) = (0, 0.0);
    let mut pieces = pieces.iter().peekable();
    for part in 1..n_parts {
        let wanted = work * part as f64 / n_parts as f64;
        while let Some(piece) = pieces.next_if(|piece| before + piece.work < wanted) {
            start += piece.blocks;
            before += piece.work;
        }
        let into = pieces.peek().map_or(0.0, |p| p.blocks as f64 * (wanted - before) / p.work);
        let end = (start as f64 + into) / blocks.max(1) as f64 * n as f64;
        ends.push((end.round() as usize).min(n));
    }
    ends.push(n);
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_pieces_all_parts_are_of_one_length() {
        assert_eq!(ends(&[], 12, 4), [3, 6, 9, 12]);
        assert_eq!(ends(&[], 0, 1), [0]);
        assert_eq!(ends(&[Piece { blocks: 5, work: 0.0 }], 6, 2), [3, 6]);
    }

    #[test]
    fn parts_are_of_equal_work() {
        let pieces = [(10, 30.0), (10, 10.0), (0, 0.0), (20, 20.0)].map(|(blocks, work)| Piece { blocks, work });
        assert_eq!(ends(&pieces, 40, 2), [10, 40]);
        assert_eq!(ends(&pieces, 40, 4), [5, 10, 25, 40]);
        // As many again, and fewer.
        assert_eq!(ends(&pieces, 80, 4), [10, 20, 50, 80]);
        assert_eq!(ends(&pieces, 4, 4), [1, 1, 3, 4]);
    }

    #[test]
    fn parts_follow_each_other_and_end_where_blocks_do() {
        let pieces: Vec<_> = (0..7).map(|k| Piece { blocks: k * k % 5, work: (k * 3 % 4) as f64 }).collect();
        for n in 0..40 {
            for n_parts in 1..9 {
                let ends = ends(&pieces, n, n_parts);
                assert_eq!((ends.len(), ends.last()), (n_parts, Some(&n)));
                assert!(ends.is_sorted(), "{ends:?}");
            }
        }
    }
}
