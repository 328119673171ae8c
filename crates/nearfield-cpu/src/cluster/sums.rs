//! Sums of particles: a set for each task, for it alone adds to them, and their addition.
//!
//! A task touches its own blocks and those within reach, so only the pages of blocks that it touches are cleared and
//! added. Tasks are added in their order: results do not depend on which thread did what.

use super::{
    BLOCK, Mover,
    blocks::{Blocks, Octet, PAGE},
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
    force: Vec<Octet>,
    energy: Vec<Octet>,
    exact: Vec<Exact>,
    touched: Vec<u32>,
    /// See [`Kernel`].
    crossed: Vec<u32>,
    /// Whether a page is in `touched`.
    seen: Vec<bool>,
}

/// Sums of all tasks.
#[derive(Default)]
pub(super) struct PageSums {
    tasks: Vec<TaskSums>,
    /// Tasks that touch each page, and where those of a page begin.
    touching: Vec<u32>,
    starts: Vec<u32>,
    n_blocks: usize,
}

fn page(p: u32, n_blocks: usize) -> std::ops::Range<usize> {
    p as usize * PAGE..((p as usize + 1) * PAGE).min(n_blocks)
}

/// Makes `values` no shorter than `n` and clears the touched pages.
fn clear<T: Copy + Default>(values: &mut Vec<T>, touched: &[u32], n: usize) {
    if values.len() < n {
        // Zeros that nobody has written take no memory: most pages are other tasks'. With some to spare, for the number
        // of blocks varies from list to list.
        *values = vec![T::default(); n + n / 8];
    } else {
        touched.iter().for_each(|&p| values[page(p, n)].fill(T::default()));
    }
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
            sums.touched.clear();
            sums.touched.extend((0..n_pages as u32).filter(|&p| sums.seen[p as usize]));
        });
        self.touching.clear();
        self.starts.clear();
        for p in 0..n_pages {
            self.starts.push(self.touching.len() as u32);
            self.touching.extend((0..self.tasks.len() as u32).filter(|&t| self.tasks[t as usize].seen[p]));
        }
        self.starts.push(self.touching.len() as u32);
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
        let clear = |sums: &mut TaskSums| {
            clear(&mut sums.force, &sums.touched, n);
            if energies {
                clear(&mut sums.energy, &sums.touched, n);
            }
        };
        self.for_each_list(blocks, list, grid, &clear, &|TaskSums { force, energy, crossed, .. }, list| {
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
    pub fn give(&self, blocks: &Blocks, scale: f32, out: Output) -> bool {
        let energies = !out.energy.is_empty();
        self.hand_out(blocks, out, |tasks, b| {
            let mut sums = Exact::default();
            if energies {
                for &t in tasks {
                    let energy = &self.tasks[t as usize].energy[b].0;
                    for (sums, terms) in sums.0[3..].iter_mut().zip(energy) {
                        for lane in 0..BLOCK {
                            sums[lane] += f64::from(terms[lane]);
                        }
                    }
                }
                for sums in &mut sums.0[3..5] {
                    sums.iter_mut().for_each(|sum| *sum *= f64::from(scale));
                }
            }
            (self.force(tasks, b, scale), sums)
        })
    }

    /// Moves particles by the computed forces. Whether all keep to their budgets.
    pub fn advance<M: Mover>(&self, blocks: &mut Blocks, scale: f32, mover: &M) -> bool {
        let kept = blocks.pages().enumerate().map(|(p, page)| {
            let tasks = self.touching_page(p);
            super::isa().run(Advance { sums: self, tasks, scale, page, mover })
        });
        kept.reduce(|| true, |a, b| a & b)
    }

    /// The force on block `b` from the `tasks` that touch it.
    #[inline(always)]
    fn force(&self, tasks: &[u32], b: usize, scale: f32) -> Octet {
        let [mut x, mut y, mut z] = [[0.0; BLOCK]; 3];
        for &t in tasks {
            let terms = &self.tasks[t as usize].force[b].0;
            for lane in 0..BLOCK {
                x[lane] += terms[0][lane];
                y[lane] += terms[1][lane];
                z[lane] += terms[2][lane];
            }
        }
        for lane in 0..BLOCK {
            x[lane] *= scale;
            y[lane] *= scale;
            z[lane] *= scale;
        }
        Octet([x, y, z])
    }

    /// The tasks that touch page `p`.
    fn touching_page(&self, p: usize) -> &[u32] {
        &self.touching[self.starts[p] as usize..self.starts[p + 1] as usize]
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
        let clear = |sums: &mut TaskSums| clear(&mut sums.exact, &sums.touched, n);
        self.for_each_list(blocks, list, grid, &clear, &|sums, pairs| add(pairs, &mut sums.exact));
        self.hand_out(blocks, out, |tasks, b| {
            let mut sums = Exact::default();
            for &t in tasks {
                let of_task = &self.tasks[t as usize].exact[b];
                for (sums, terms) in sums.0.iter_mut().zip(&of_task.0) {
                    for lane in 0..BLOCK {
                        sums[lane] += terms[lane];
                    }
                }
            }
            let [x, y, z, ..] = sums.0.map(|sums| sums.map(|sum| sum as f32));
            (Octet([x, y, z]), sums)
        })
    }

    /// Writes the sums that `total` gives for each block, from the tasks that touch it, to where they go.
    fn hand_out(&self, blocks: &Blocks, out: Output, total: impl Fn(&[u32], usize) -> (Octet, Exact) + Sync) -> bool {
        let energies = !out.energy.is_empty();
        let force = out.force.map(Scattered::new);
        let (energy, virial) = (Scattered::new(out.energy), Scattered::new(out.virial));
        let neighbors = Scattered::new(out.neighbors);
        let finite = AtomicBool::new(true);
        (0..blocks.n_pages()).into_par_iter().for_each(|p| {
            let tasks = self.touching_page(p);
            let mut check = [0.0f32; BLOCK];
            for b in blocks.page(p) {
                let (of_block, sums) = total(tasks, b);
                let particles = blocks.particles(b);
                for axis in 0..3 {
                    // SAFETY: no two blocks have a particle in common, and each is visited once.
                    let to = unsafe { force[axis].range(particles.clone()) };
                    to.copy_from_slice(&of_block.0[axis][..to.len()]);
                    for lane in 0..to.len() {
                        // Zero times anything finite is zero; NaN and infinity stay NaN.
                        check[lane] += of_block.0[axis][lane] * 0.0;
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

    /// Bytes held, as far as they have been touched.
    pub fn bytes(&self) -> usize {
        let of_task = |task: &TaskSums| {
            let block = usize::from(!task.force.is_empty()) * size_of::<Octet>()
                + usize::from(!task.energy.is_empty()) * size_of::<Octet>()
                + usize::from(!task.exact.is_empty()) * size_of::<Exact>();
            task.touched.len() * PAGE * block + task.seen.capacity()
        };
        self.tasks.iter().map(of_task).sum::<usize>() + 4 * self.touching.capacity()
    }
}

/// Moves the particles of a page by the forces on them. Gives whether all keep to their budgets.
struct Advance<'a, M> {
    sums: &'a PageSums,
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
            let force = sums.force(tasks, page.start + k, scale);
            mover.advance(page.particles(k), &force.0, &mut page.position[k].0);
            kept &= page.keeps_to_budget(k);
        }
        kept
    }
}
