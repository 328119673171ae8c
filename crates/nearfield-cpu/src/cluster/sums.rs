//! Sums of particles: a set for each task, for it alone adds to them, and their addition.
//!
//! A task touches its own blocks and those within reach, so only the pages of blocks that it touches are cleared and
//! added. Tasks are added in their order: results do not depend on which thread did what.

use super::{
    BLOCK,
    blocks::{Blocks, Octet, PAGE},
    lennard_jones::{Kernel, Law},
    list::{PairList, Pairs},
};
use crate::parallel::Scattered;
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
    pub fn lay_out(&mut self, list: &PairList, n_blocks: usize) {
        self.n_blocks = n_blocks;
        let n_pages = n_blocks.div_ceil(PAGE);
        self.tasks.resize_with(list.tasks.len(), TaskSums::default);
        self.tasks.par_iter_mut().zip(&list.tasks).with_max_len(1).for_each(|(sums, task)| {
            sums.seen.clear();
            sums.seen.resize(n_pages, false);
            let own = task.clusters_of.clone().map(|b| b as u32);
            for b in own.chain(task.outer.blocks.iter().copied()) {
                sums.seen[b as usize / PAGE] = true;
            }
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

    /// Sums by a law for vectors. False when a force is not finite.
    pub fn evaluate<P: Law>(&mut self, blocks: &Blocks, list: &PairList, law: P, out: Output) -> bool {
        let (n, energies) = (self.n_blocks, !out.energy.is_empty());
        self.tasks.par_iter_mut().zip(&list.tasks).with_max_len(1).for_each(|(sums, task)| {
            let TaskSums { force, energy, touched, crossed, .. } = sums;
            clear(force, touched, n);
            let list = &task.inner;
            if energies {
                clear(energy, touched, n);
                super::isa().run(Kernel::<P, true> { law, blocks, list, force, energy, crossed });
            } else {
                super::isa().run(Kernel::<P, false> { law, blocks, list, force, energy: &mut [], crossed });
            }
        });
        let scale = law.scale();
        self.hand_out(blocks, out, |tasks, b| {
            let mut sums = Exact::default();
            let mut force = Octet::default();
            for &t in tasks {
                let task = &self.tasks[t as usize];
                for axis in 0..3 {
                    for lane in 0..BLOCK {
                        force.0[axis][lane] += task.force[b].0[axis][lane];
                    }
                }
                if energies {
                    for k in 0..3 {
                        for lane in 0..BLOCK {
                            sums.0[3 + k][lane] += f64::from(task.energy[b].0[k][lane]);
                        }
                    }
                }
            }
            for axis in 0..3 {
                for lane in 0..BLOCK {
                    force.0[axis][lane] *= scale;
                }
            }
            if energies {
                for lane in 0..BLOCK {
                    sums.0[3][lane] *= f64::from(scale);
                    sums.0[4][lane] *= f64::from(scale);
                }
            }
            (force, sums)
        })
    }

    /// Sums by a function that adds a list's pairs to exact sums. False when a force is not finite.
    pub fn evaluate_exactly(
        &mut self,
        blocks: &Blocks,
        list: &PairList,
        out: Output,
        add: &(dyn Fn(&Pairs, &mut [Exact]) + Sync),
    ) -> bool {
        let n = self.n_blocks;
        self.tasks.par_iter_mut().zip(&list.tasks).with_max_len(1).for_each(|(sums, task)| {
            clear(&mut sums.exact, &sums.touched, n);
            add(&task.inner, &mut sums.exact);
        });
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
            let tasks = &self.touching[self.starts[p] as usize..self.starts[p + 1] as usize];
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
