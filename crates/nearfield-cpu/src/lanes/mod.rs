//! Sixteen lanes of f32 and u32 on whatever vector unit there is, chosen once per kernel at run time.
//!
//! A kernel is written once over [`Lanes`] and given to [`Isa::run`], which compiles it for each instruction set. All
//! operations are exact and equal on every one of them. Everything a kernel calls must be `#[inline(always)]`: code
//! outside the kernel's own function is compiled without its instruction set.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
mod portable;

pub(crate) use portable::Portable;
use std::sync::OnceLock;

/// Sixteen lanes; masks are one bit a lane, the lowest bit for lane 0.
pub(crate) trait Lanes: Copy {
    /// Sixteen f32.
    type F: Copy;
    /// Sixteen u32 below 2³¹, or the padding `u32::MAX`.
    type U: Copy;
    /// Sixteen truth values.
    type M: Copy;

    fn splat(self, value: f32) -> Self::F;
    fn load(self, from: &[f32; 16]) -> Self::F;
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    fn mul_sub(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// The larger; unspecified where one is NaN.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    /// a < b; false where one is NaN.
    fn lt(self, a: Self::F, b: Self::F) -> u16;

    fn splat_u(self, value: u32) -> Self::U;
    fn load_u(self, from: &[u32; 16]) -> Self::U;
    fn ne_u(self, a: Self::U, b: Self::U) -> u16;
    /// a > b, for values below 2³¹.
    fn gt_u(self, a: Self::U, b: Self::U) -> u16;

    /// Rounded towards zero, for values from 0 to 2³¹ - 128.
    fn truncate(self, a: Self::F) -> Self::U;

    /// Stores the lanes of the mask next to each other. After them comes what was there, any lane, or zero: the kernels
    /// read it, and it must be finite where all of these are.
    fn compress(self, mask: u16, value: Self::F, to: &mut [f32; 16]);
    /// As [`Lanes::compress`], for u32.
    fn compress_u(self, mask: u16, value: Self::U, to: &mut [u32; 16]);

    /// a < b as truth values; false where one is NaN.
    fn less(self, a: Self::F, b: Self::F) -> Self::M;
    fn mask(self, bits: u16) -> Self::M;
    fn and(self, a: Self::M, b: Self::M) -> Self::M;
    /// Zero where the mask is false, whatever was there.
    fn keep(self, mask: Self::M, value: Self::F) -> Self::F;
    /// The smaller; b where one is NaN.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    fn sqrt(self, a: Self::F) -> Self::F;
    /// 1 / a where the mask is true, within two units in the last place (the one operation that differs between
    /// instruction sets); zero elsewhere.
    fn reciprocal(self, mask: Self::M, a: Self::F) -> Self::F;

    /// The same eight values in lanes 0 to 7 and 8 to 15.
    fn twice(self, half: &[f32; 8]) -> Self::F;
    /// One value in lanes 0 to 7, another in lanes 8 to 15.
    fn halves(self, low: f32, high: f32) -> Self::F;
    /// Each of four values in eight lanes.
    fn quarters(self, four: &[f32; 4]) -> [Self::F; 2];
    /// Adds to eight sums, each kept in two parts: what is in lanes k and k + 8 to elements k and k + 8, or all of it to
    /// element k where that is quicker.
    fn add_to_parts(self, a: Self::F, to: &mut [f32; 16]);
    /// Sums of lanes 0 to 7 and of lanes 8 to 15, of `a` and then of `b`, for each axis.
    fn sum_halves(self, a: [Self::F; 3], b: [Self::F; 3]) -> [[f32; 4]; 3];
    /// `low[index]` in lanes 0 to 7, `high[index]` in lanes 8 to 15. Indices are below 8.
    fn look_up(self, low: &[f32; 8], high: &[f32; 8], index: &[u32; 8]) -> Self::F;
}

/// Work to be done in one instruction set.
pub(crate) trait Kernel {
    /// What it gives.
    type Output;

    /// The work. Implementations are `#[inline(always)]`.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// An instruction set that this machine has.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Isa {
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    #[cfg(target_arch = "aarch64")]
    Neon(pulp::aarch64::Neon),
    Portable,
}

/// A kernel and the lanes to run it on, for pulp to compile with their instruction set.
struct OnLanes<L, K> {
    lanes: L,
    kernel: K,
}

impl<L: Lanes, K: Kernel> pulp::NullaryFnOnce for OnLanes<L, K> {
    type Output = K::Output;

    #[inline(always)]
    fn call(self) -> K::Output {
        self.kernel.run(self.lanes)
    }
}

impl Isa {
    /// The best one, or the one that the environment variable NEARFIELD_SIMD names ("AVX-512", "AVX2", "NEON",
    /// "portable") where the machine has it: for comparing them.
    pub fn detect() -> Self {
        static CHOSEN: OnceLock<Isa> = OnceLock::new();
        *CHOSEN.get_or_init(|| {
            let wanted = std::env::var("NEARFIELD_SIMD").unwrap_or_default();
            let named = Self::available().find(|isa| isa.name().eq_ignore_ascii_case(&wanted));
            named.or_else(|| Self::available().next()).expect("the portable one is always there")
        })
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => "AVX-512",
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => "AVX2",
            #[cfg(target_arch = "aarch64")]
            Self::Neon(_) => "NEON",
            Self::Portable => "portable",
        }
    }

    /// All of this machine, the best first.
    pub fn available() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let vector = [pulp::x86::V4::try_new().map(Self::Avx512), pulp::x86::V3::try_new().map(Self::Avx2)];
        #[cfg(target_arch = "aarch64")]
        let vector = [pulp::aarch64::Neon::try_new().map(Self::Neon)];
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        let vector: [Option<Self>; 0] = [];
        vector.into_iter().flatten().chain([Self::Portable])
    }

    /// Runs a kernel compiled for this instruction set.
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(v4) => v4.vectorize(OnLanes { lanes: v4, kernel }),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(v3) => v3.vectorize(OnLanes { lanes: v3, kernel }),
            #[cfg(target_arch = "aarch64")]
            Self::Neon(neon) => neon.vectorize(OnLanes { lanes: neon, kernel }),
            Self::Portable => kernel.run(Portable),
        }
    }
}

#[cfg(test)]
mod tests;
