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

/// What rays meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Primitive {
    /// Boxes, by an intersection program: infinitesimal rays meet those that hold their origin.
    Box,
    /// The device's own spheres, shells of one radius, by an any-hit program.
    Sphere,
    /// The device's own triangles, by an any-hit program.
    Triangle,
}

/// A ray-generation program with the program of what its rays meet, and the launch parameters both read.
pub struct RayProgram<A: Layout> {
    /// Which of [`crate::RAY_MODULES`] it is in.
    pub module: &'static str,
    /// What its rays are traced against.
    pub primitive: Primitive,
    /// Entry point that each ray starts at, without the prefix `__raygen__`.
    pub raygen: &'static str,
    /// Entry point called for each primitive that a ray meets, without the prefix `__intersection__` or `__anyhit__`.
    pub hit: &'static str,
    parameters: PhantomData<fn(A)>,
}

impl<A: Layout> RayProgram<A> {
    /// A program of a module, in which both entry points are called `name`.
    pub const fn new(module: &'static str, primitive: Primitive, name: &'static str) -> Self {
        Self { module, primitive, raygen: name, hit: name, parameters: PhantomData }
    }
}

impl<A: Layout> Clone for RayProgram<A> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A: Layout> Copy for RayProgram<A> {}
