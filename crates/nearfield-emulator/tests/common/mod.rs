//! Typed buffers on an emulator, and launches by name.

#![allow(dead_code, reason = "each test file uses some of it")]

use bytemuck::{Pod, Zeroable};
use nearfield_core::{Error, Result};
use nearfield_cuda::gpu::{Gpu, Launch, Queue, RayTracing};
use nearfield_emulator::Emulator;

/// An emulator, where tests of it are not ignored.
pub fn emulator() -> Emulator {
    Emulator::new().expect("kernels were compiled")
}

/// Parameters of the ray programs of tests: addresses, and what is traced.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Rays {
    pub points: u64,
    pub counts: u64,
    pub sums: u64,
    pub handle: u64,
}

/// Rays on an emulator.
pub fn tracing(gpu: &Emulator) -> &dyn RayTracing {
    gpu.ray_tracing().expect("it is emulated")
}

/// Address of a new buffer with content.
pub fn buffer<T: Pod>(gpu: &Emulator, content: &[T]) -> u64 {
    let address = gpu.allocate("test", size_of_val(content)).expect("there is room");
    // SAFETY: as large as the content.
    unsafe { gpu.upload(bytemuck::cast_slice(content), address) }.expect("it is a buffer");
    address
}

/// Content of a buffer.
pub fn content<T: Pod>(gpu: &Emulator, address: u64, n: usize) -> Vec<T> {
    let mut content = vec![T::zeroed(); n];
    // SAFETY: the emulator checks the range.
    unsafe { gpu.download(address, bytemuck::cast_slice_mut(&mut content)) }.expect("it is a buffer");
    content
}

/// Runs a kernel.
pub fn launch<A: Pod>(gpu: &Emulator, kernel: (&'static str, &'static str), grid: (u32, u32), a: &A) -> Result<()> {
    let arguments = bytemuck::bytes_of(a);
    let launch = Launch { module: kernel.0, name: kernel.1, blocks: grid.0, threads: grid.1, arguments };
    // SAFETY: tests hand over buffers large enough, or are about those that are not.
    unsafe { gpu.launch(launch) }
}

/// Text of the error that must have come.
pub fn failure<T>(result: Result<T>) -> String {
    match result {
        Err(Error::Device(text)) => text,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("no error was reported"),
    }
}

/// Arguments of the kernels in `warps.cu`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Lanes {
    pub out: u64,
    pub mask: u32,
    pub argument: u32,
    pub width: u32,
    pub unused: u32,
}

/// Arguments of the kernels in `blocks.cu`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Blocks {
    pub input: u64,
    pub output: u64,
    pub ticket: u64,
    pub n: u32,
    pub unused: u32,
}

/// Arguments of `atomic_floats`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Floats {
    pub single: u64,
    pub twice: u64,
    pub whole: u64,
    pub n: u32,
    pub unused: u32,
}
