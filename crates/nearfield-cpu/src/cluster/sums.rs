//! Sums of particles: a set for each task, for it alone adds to them, and their addition.
//!
//! A task touches its own blocks and those within reach, so only the pages of blocks that it touches are added. Tasks are
//! added in their order: results do not depend on which thread did what. All sums are zero but while they are computed:
//! who adds them up takes them.

use super::{
    BLOCK, Mover,
    blocks::{Blocks, PAGE},
    lennard_jones::{Kernel, Law},
    list::{PairList, Pairs, Reach},
    motion::Page,
};
use crate::{Grid, lanes, parallel::Scattered};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Sums of eight particles that do not depend on the order of terms: force, energy, virial, neighbours.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Exact([[f64; BLOCK]; 6]);

impl Exact {
    #[inline(always)]
    pub fn add(&mut self, lane: usize, terms: [f64; 6]) {
        for (sums, term) in self.0.iter_mut().zip(terms) {
            sums[lane] += term;
        }
    }
}

/// Sums of eight particles, each in two parts, for it takes longer to add these up than to keep them apart: lanes k and
/// k + 8 are particle k's.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Parts(pub [[f32; 2 * BLOCK]; 3]);

impl Default for Parts {
    fn default() -> Self {
        Self([[0.0; 2 * BLOCK]; 3])
    }
}

/// Where results go: arrays `[N]` in the order of particles; the last three are empty where only forces are wanted.
pub(crate) struct Output<'a> {
    pub force: [&'a mut [f32]; 3],
    pub energy: &'a mut [f64],
    pub virial: &'a mut [f64],
    pub neighbors: &'a mut [u32],
}

/// Sums of one task, `[n_blocks]` or longer, of which only the touched pages mean anything.
#[derive(Default)]
struct TaskSums {
    force: Vec<Parts>,
    energy: Vec<Parts>,
    exact: Vec<Exact>,
    /// See [`Kernel`].
    crossed: Vec<u32>,
    /// Whether a page is touched.
    seen: Vec<bool>,
}

/// Sums of all tasks.
#[derive(Default)]
pub(super) struct PageSums {
    tasks: Vec<TaskSums>,
    touching: Touching,
    n_blocks: usize,
}

/// Tasks that touch each page, and where those of a page begin.
#[derive(Default)]
struct Touching {
    tasks: Vec<u32>,
    starts: Vec<u32>,
}

impl Touching {
    /// The tasks that touch page `p`.
    fn page(&self, p: usize) -> &[u32] {
        &self.tasks[self.starts[p] as usize..self.starts[p + 1] as usize]
    }
}

impl TaskSums {
    /// Forces and energies, for several threads to take.
    fn scattered(&mut self) -> (Scattered<'_, Parts>, Scattered<'_, Parts>) {
        (Scattered::new(&mut self.force), Scattered::new(&mut self.energy))
    }
}

/// Makes `values`, all zero, no shorter than `n`.
fn grow<T: Copy + Default>(values: &mut Vec<T>, n: usize) {
    if values.len() < n {
        // Zeros that nobody has written take no memory: most pages are other tasks'. With some to spare, for the number
        // of blocks varies from list to list.
        *values = vec![T::default(); n + n / 8];
    }
}

/// Takes the sums of a block from `of`, those of the `tasks` that touch it.
///
/// # Safety
/// No other thread takes sums of this block.
#[inline(always)]
unsafe fn take(of: &[Scattered<Parts>], tasks: &[u32], b: usize) -> [[f32; BLOCK]; 3] {
    let mut sums = [[0.0; BLOCK]; 3];
    for &t in tasks {
        // SAFETY: the caller's promise.
        let parts = unsafe { &mut of[t as usize].range(b..b + 1)[0] };
        for k in 0..3 {
            for lane in 0..BLOCK {
                sums[k][lane] += parts.0[k][lane] + parts.0[k][lane + BLOCK];
            }
        }
        *parts = Parts::default();
    }
    sums
}

/// The force from what a law's scale was left out of.
#[inline(always)]
fn scaled(mut force: [[f32; BLOCK]; 3], scale: f32) -> [[f32; BLOCK]; 3] {
    for of_axis in &mut force {
        for f in of_axis {
            *f *= scale;
        }
    }
    force
}

impl PageSums {
    /// Finds which pages tasks touch.
    pub fn lay_out(&mut self, list: &mut PairList, blocks: &Blocks, reach: Reach) {
        self.n_blocks = blocks.len();
        let n_pages = blocks.n_pages();
        self.tasks.resize_with(list.tasks.len(), TaskSums::default);
        self.tasks.par_iter_mut().zip(&mut list.tasks).with_max_len(1).for_each(|(sums, task)| {
            sums.seen.clear();
            sums.seen.resize(n_pages, false);
            task.mark_pages(reach, blocks, &mut sums.seen);
        });
        let Touching { tasks, starts } = &mut self.touching;
        tasks.clear();
        starts.clear();
        for p in 0..n_pages {
            starts.push(tasks.len() as u32);
            tasks.extend((0..self.tasks.len() as u32).filter(|&t| self.tasks[t as usize].seen[p]));
        }
        starts.push(tasks.len() as u32);
    }

    /// Sums by a law for vectors, of energies too or of forces alone. Gives what they are to be multiplied with. With a
    /// `grid` there is no list.
    pub fn compute<P: Law>(
        &mut self,
        blocks: &Blocks,
        list: &mut PairList,
        grid: Option<&Grid>,
        law: P,
        energies: bool,
    ) -> f32 {
        let n = self.n_blocks;
        let begin = |sums: &mut TaskSums| {
            grow(&mut sums.force, n);
            if energies {
                grow(&mut sums.energy, n);
            }
        };
        self.for_each_list(blocks, list, grid, &begin, &|TaskSums { force, energy, crossed, .. }, list| {
            if energies {
                super::isa().run(Kernel::<P, true> { law, blocks, list, force, energy, crossed });
            } else {
                super::isa().run(Kernel::<P, false> { law, blocks, list, force, energy: &mut [], crossed });
            }
        });
        law.scale()
    }

    /// Calls `begin` for the sums of each task, then `add` with them and its inner list, or all batches of pairs within
    /// the cutoff where there is a `grid`.
    fn for_each_list(
        &mut self,
        blocks: &Blocks,
        list: &mut PairList,
        grid: Option<&Grid>,
        begin: &(dyn Fn(&mut TaskSums) + Sync),
        add: &(dyn Fn(&mut TaskSums, &Pairs) + Sync),
    ) {
        self.tasks.par_iter_mut().zip(&mut list.tasks).with_max_len(1).for_each(|(sums, task)| {
            begin(sums);
            match grid {
                None => add(sums, &task.inner),
                Some(grid) => task.for_each_batch(grid, blocks, |pairs| add(sums, pairs)),
            }
        });
    }

    /// Hands out what was computed. False when a force is not finite.
    pub fn give(&mut self, blocks: &Blocks, scale: f32, out: Output) -> bool {
        let energies = !out.energy.is_empty();
        let Self { tasks, touching, .. } = self;
        let (force, energy): (Vec<_>, Vec<_>) = tasks.iter_mut().map(TaskSums::scattered).unzip();
        hand_out(touching, blocks, out, |tasks, b| {
            let mut sums = Exact::default();
            if energies {
                // SAFETY: each block is handed out once.
                let energy = unsafe { take(&energy, tasks, b) };
                for (k, scale) in [scale, scale, 1.0].into_iter().enumerate() {
                    sums.0[3 + k] = energy[k].map(|sum| f64::from(sum) * f64::from(scale));
                }
            }
            // SAFETY: as above.
            (scaled(unsafe { take(&force, tasks, b) }, scale), sums)
        })
    }

    /// Moves particles by the computed forces. Whether all keep to their budgets.
    pub fn advance<M: Mover>(&mut self, blocks: &mut Blocks, scale: f32, mover: &M) -> bool {
        let Self { tasks, touching, .. } = self;
        let sums: Vec<_> = tasks.iter_mut().map(|task| Scattered::new(&mut task.force)).collect();
        let kept = blocks.pages().enumerate().map(|(p, page)| {
            let tasks = touching.page(p);
            super::isa().run(Advance { sums: &sums, tasks, scale, page, mover })
        });
        kept.reduce(|| true, |a, b| a & b)
    }

    /// Sums by a function that adds a list's pairs to exact sums. False when a force is not finite.
    pub fn evaluate_exactly(
        &mut self,
        blocks: &Blocks,
        list: &mut PairList,
        grid: Option<&Grid>,
        out: Output,
        add: &(dyn Fn(&Pairs, &mut [Exact]) + Sync),
    ) -> bool {
        let n = self.n_blocks;
        let begin = |sums: &mut TaskSums| grow(&mut sums.exact, n);
        self.for_each_list(blocks, list, grid, &begin, &|sums, pairs| add(pairs, &mut sums.exact));
        let Self { tasks, touching, .. } = self;
        let exact: Vec<_> = tasks.iter_mut().map(|task| Scattered::new(&mut task.exact)).collect();
        hand_out(touching, blocks, out, |tasks, b| {
            let mut sums = Exact::default();
            for &t in tasks {
                // SAFETY: each block is handed out once.
                let of_task = std::mem::take(unsafe { &mut exact[t as usize].range(b..b + 1)[0] });
                for (sums, terms) in sums.0.iter_mut().zip(&of_task.0) {
                    for lane in 0..BLOCK {
                        sums[lane] += terms[lane];
                    }
                }
            }
            let [x, y, z, ..] = sums.0.map(|sums| sums.map(|sum| sum as f32));
            ([x, y, z], sums)
        })
    }

    /// Bytes held, as far as they have been touched.
    pub fn bytes(&self) -> usize {
        let of_task = |task: &TaskSums| {
            let block = usize::from(!task.force.is_empty()) * size_of::<Parts>()
                + usize::from(!task.energy.is_empty()) * size_of::<Parts>()
                + usize::from(!task.exact.is_empty()) * size_of::<Exact>();
            let touched = task.seen.iter().filter(|&&seen| seen).count();
            touched * PAGE * block + task.seen.capacity() + 4 * task.crossed.capacity()
        };
        self.tasks.iter().map(of_task).sum::<usize>() + 4 * self.touching.tasks.capacity()
    }
}

/// Writes the sums that `total` gives for each block, from the tasks that touch it, to where they go. False when a force is
/// not finite.
fn hand_out(
    touching: &Touching,
    blocks: &Blocks,
    out: Output,
    total: impl Fn(&[u32], usize) -> ([[f32; BLOCK]; 3], Exact) + Sync,
) -> bool {
    let energies = !out.energy.is_empty();
    let force = out.force.map(Scattered::new);
    let (energy, virial) = (Scattered::new(out.energy), Scattered::new(out.virial));
    let neighbors = Scattered::new(out.neighbors);
    let finite = AtomicBool::new(true);
    (0..blocks.n_pages()).into_par_iter().for_each(|p| {
        let tasks = touching.page(p);
        let mut check = [0.0f32; BLOCK];
        for b in blocks.page(p) {
            let (of_block, sums) = total(tasks, b);
            let particles = blocks.particles(b);
            for axis in 0..3 {
                // SAFETY: no two blocks have a particle in common, and each is visited once.
                let to = unsafe { force[axis].range(particles.clone()) };
                to.copy_from_slice(&of_block[axis][..to.len()]);
                for lane in 0..to.len() {
                    // Zero times anything finite is zero; NaN and infinity stay NaN.
                    check[lane] += of_block[axis][lane] * 0.0;
                }
            }
            if energies {
                for (lane, i) in particles.enumerate() {
                    // SAFETY: as above.
                    unsafe {
                        energy.write(i, 0.5 * sums.0[3][lane]);
                        virial.write(i, 0.5 * sums.0[4][lane]);
                        neighbors.write(i, sums.0[5][lane] as u32);
                    }
                }
            }
        }
        if check != [0.0; BLOCK] {
            finite.store(false, Relaxed);
        }
    });
    finite.into_inner()
}

/// Moves the particles of a page by the forces on them. Gives whether all keep to their budgets.
struct Advance<'a, M> {
    sums: &'a [Scattered<'a, Parts>],
    tasks: &'a [u32],
    scale: f32,
    page: Page<'a>,
    mover: &'a M,
}

impl<M: Mover> lanes::Kernel for Advance<'_, M> {
    type Output = bool;

    #[inline(always)]
    fn run<L: lanes::Lanes>(self, _: L) -> bool {
        let Self { sums, tasks, scale, mut page, mover } = self;
        let mut kept = true;
        for k in 0..page.position.len() {
            // SAFETY: each block is in one page.
            let force = scaled(unsafe { take(sums, tasks, page.start + k) }, scale);
            mover.advance(page.particles(k), &force, &mut page.position[k].0);
            kept &= page.keeps_to_budget(k);
        }
        kept
    }
}
