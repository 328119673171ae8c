//! Names of kernels and ray-tracing programs, with the structures they take.

use crate::layout::Layout;
use std::marker::PhantomData;

/// A kernel that takes one structure.
pub struct Kernel<A> {
    /// Its entry point.
    pub name: &'static str,
    /// Which of [`crate::MODULES`] it is in.
    pub module: &'static str,
    /// Threads to a block.
    pub threads: u32,
    arguments: PhantomData<fn(A)>,
}

impl<A> Kernel<A> {
    /// A kernel of a module.
    pub const fn new(module: &'static str, name: &'static str, threads: u32) -> Self {
        Self { name, module, threads, arguments: PhantomData }
    }
}

impl<A> Clone for Kernel<A> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A> Copy for Kernel<A> {}

/// A ray-generation program with the intersection program of its boxes, and the launch parameters both read.
pub struct RayProgram<A: Layout> {
    /// Which of [`crate::RAY_MODULES`] it is in.
    pub module: &'static str,
    /// Entry point that each ray starts at, without the prefix `__raygen__`.
    pub raygen: &'static str,
    /// Entry point called for each box that holds a ray's origin, without the prefix `__intersection__`.
    pub intersection: &'static str,
    parameters: PhantomData<fn(A)>,
}

impl<A: Layout> RayProgram<A> {
    /// A program of a module.
    pub const fn new(module: &'static str, raygen: &'static str, intersection: &'static str) -> Self {
        Self { module, raygen, intersection, parameters: PhantomData }
    }
}

impl<A: Layout> Clone for RayProgram<A> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A: Layout> Copy for RayProgram<A> {}
