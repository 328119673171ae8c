use super::*;

/// Everything a kernel can compute, on values with ties, NaN and padding.
struct Everything<'a> {
    a: &'a [f32; 16],
    b: &'a [f32; 16],
    u: &'a [u32; 16],
    v: &'a [u32; 16],
}

impl Kernel for Everything<'_> {
    type Output = (Vec<u32>, Vec<u16>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let (a, b, c) = (l.load(self.a), l.load(self.b), l.splat(0.3));
        let (u, v) = (l.load_u(self.u), l.load_u(self.v));
        let masks = vec![l.lt(a, b), l.ne_u(u, v), l.gt_u(u, v), l.ne_u(u, l.splat_u(3))];
        let mut bits = Vec::new();
        let mut out = [0.0; 16];
        for value in [l.add(a, b), l.sub(a, b), l.mul(a, b), l.mul_add(a, b, c), l.mul_sub(a, b, c)] {
            l.compress(u16::MAX, value, &mut out);
            bits.extend(out.iter().map(|x| if x.is_nan() { 1 } else { x.to_bits() }));
        }
        l.compress(u16::MAX, l.max(b, c), &mut out);
        bits.extend(out.map(f32::to_bits));
        for value in l.quarters(&[self.b[0], self.b[1], self.b[2], self.b[3]]) {
            l.compress(u16::MAX, value, &mut out);
            bits.extend(out.map(f32::to_bits));
        }
        let sums = l.sum_halves([b, c, l.mul(b, b)], [l.sub(b, c), b, l.load(&out)]);
        bits.extend(sums.as_flattened().iter().map(|x| x.to_bits()));
        let halves: &[[f32; 8]] = self.b.as_chunks().0;
        let index = [7, 0, 3, 3, 1, 6, 5, 2];
        let (odd, less) = (l.mask(0xaaaa), l.less(a, b));
        for value in [
            l.min(a, b),
            l.min(b, a),
            l.sqrt(l.mul(b, b)),
            l.keep(odd, b),
            l.keep(l.and(odd, less), b),
            l.keep(l.mask(0x8421), l.load(&[f32::INFINITY; 16])),
            l.twice(&halves[0]),
            l.halves(self.b[3], self.b[4]),
            l.look_up(&halves[0], &halves[1], &index),
        ] {
            l.compress(u16::MAX, value, &mut out);
            bits.extend(out.iter().map(|x| if x.is_nan() { 1 } else { x.to_bits() }));
        }
        let mut out_u = [0; 16];
        l.compress_u(u16::MAX, v, &mut out_u);
        bits.extend(out_u);
        let numbers =
            std::array::from_fn(|k| [0.0, 0.99, 1.0, 5e8, 2147483520.0, 16777215.0][k % 6] / (1 + k / 6) as f32);
        l.compress_u(u16::MAX, l.truncate(l.load(&numbers)), &mut out_u);
        bits.extend(out_u);
        for mask in [masks[0], masks[1], 0, 1, 0x8000, 0xffff, 0x5aa5, 0x00ff, 0xff00] {
            let n = mask.count_ones() as usize;
            l.compress(mask, b, &mut out);
            l.compress_u(mask, u, &mut out_u);
            bits.extend(out[..n].iter().map(|x| x.to_bits()));
            bits.extend(&out_u[..n]);
        }
        (bits, masks)
    }
}

#[test]
fn every_instruction_set_computes_the_same_bits() {
    let mut a: [f32; 16] = std::array::from_fn(|k| 0.1 * k as f32 - 0.7);
    let b: [f32; 16] = std::array::from_fn(|k| if k % 3 == 0 { a[k] } else { 0.37 * k as f32 - 2.0 });
    a[5] = f32::NAN;
    let u: [u32; 16] = std::array::from_fn(|k| (k as u32 * 7) % 16);
    let v: [u32; 16] = std::array::from_fn(|k| if k % 4 == 0 { u[k] } else { k as u32 });
    let run = |isa: Isa| isa.run(Everything { a: &a, b: &b, u: &u, v: &v });
    let expected = run(Isa::Portable);
    assert_eq!(expected.1[0] >> 5 & 1, 0, "NaN is not less than anything");
    for isa in Isa::available() {
        assert_eq!(run(isa), expected, "{isa:?}");
    }
}

struct Compressed<'a>(&'a [f32; 16], u16);

impl Kernel for Compressed<'_> {
    type Output = [f32; 16];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f32; 16] {
        let mut out = [0.0; 16];
        l.compress(self.1, l.load(self.0), &mut out);
        out
    }
}

#[test]
fn what_follows_compressed_lanes_is_made_of_whole_lanes_or_zero() {
    // Each byte but the highest would give NaN where it is repeated.
    let values: [f32; 16] = std::array::from_fn(|k| f32::from_bits(0x3fff_ffff + ((k as u32) << 24)));
    for isa in Isa::available() {
        for mask in [0, 1, 0x8000, 0x5aa5, 0x00ff, 0xff00, 0x1248] {
            for x in isa.run(Compressed(&values, mask)) {
                assert!(x == 0.0 || values.contains(&x), "{isa:?}: {x:e} with mask {mask:04x}");
            }
        }
    }
}

/// Reciprocals of sixteen values where a mask says so.
struct Reciprocals<'a>(&'a [f32; 16], u16);

impl Kernel for Reciprocals<'_> {
    type Output = [f32; 16];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f32; 16] {
        let mut out = [0.0; 16];
        l.compress(u16::MAX, l.reciprocal(l.mask(self.1), l.load(self.0)), &mut out);
        out
    }
}

#[test]
fn reciprocals_are_good_to_two_units_in_the_last_place() {
    // Mantissas of all sizes: a prime apart.
    let values = (0x3f80_0000..0x4000_0000).step_by(251).flat_map(|bits| {
        let mantissa = f32::from_bits(bits);
        [mantissa, mantissa * 1e-12, mantissa * 1e12]
    });
    let values: Vec<f32> = values.collect();
    for isa in Isa::available() {
        for sixteen in values.as_chunks().0 {
            for (y, a) in isa.run(Reciprocals(sixteen, u16::MAX)).into_iter().zip(sixteen) {
                let apart = y.to_bits().abs_diff(a.recip().to_bits());
                assert!(apart <= 2, "{isa:?}: {a:e} gives {y:e}, {apart} units from the reciprocal");
            }
        }
    }
}

#[test]
fn reciprocals_outside_the_mask_are_zero_even_of_what_has_none() {
    let mut values = [f32::NAN; 16];
    values[..4].copy_from_slice(&[4.0, 0.0, f32::INFINITY, f32::NEG_INFINITY]);
    for isa in Isa::available() {
        let [inside, outside @ ..] = isa.run(Reciprocals(&values, 1));
        assert!((inside - 0.25).abs() < 1e-6, "{isa:?}: {inside}");
        assert_eq!(outside.map(f32::to_bits), [0; 15], "{isa:?}");
    }
}

/// Sixteen values added to eight sums that are kept in two parts.
struct Added<'a>(&'a [f32; 16], [f32; 16]);

impl Kernel for Added<'_> {
    type Output = [f32; 16];

    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) -> [f32; 16] {
        l.add_to_parts(l.load(self.0), &mut self.1);
        self.1
    }
}

#[test]
fn what_is_added_to_a_sum_of_two_parts_is_in_one_or_the_other() {
    // All sums are exact.
    let values: [f32; 16] = std::array::from_fn(|k| (3 * k) as f32);
    let before: [f32; 16] = std::array::from_fn(|k| 100.0 + k as f32);
    for isa in Isa::available() {
        let after = isa.run(Added(&values, before));
        for k in 0..8 {
            let expected = before[k] + before[k + 8] + values[k] + values[k + 8];
            assert_eq!(after[k] + after[k + 8], expected, "{isa:?}: sum {k}");
        }
    }
}
