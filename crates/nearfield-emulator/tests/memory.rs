//! The memory checker.

mod common;
use common::*;
use nearfield_core::Error;
use nearfield_cuda::{
    Sequence,
    gpu::{Gpu, Memory, Queue},
};
use nearfield_emulator::Emulator;

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn a_write_beyond_a_buffer_is_reported_with_its_name() {
    let gpu = emulator();
    let output = gpu.allocate("too small", 40).unwrap();
    launch(&gpu, ("blocks", "overrun"), (1, 32), &Blocks { input: 0, output, ticket: 0, n: 9, unused: 0 }).unwrap();
    gpu.synchronize().unwrap();
    launch(&gpu, ("blocks", "overrun"), (1, 32), &Blocks { input: 0, output, ticket: 0, n: 10, unused: 0 }).unwrap();
    let text = failure(gpu.synchronize());
    assert!(text.contains("`too small` of 40 bytes, 0 bytes after its end"), "{text}");
    // SAFETY: from `allocate`, and not used again.
    unsafe { gpu.release(output) };
    assert!(failure(gpu.synchronize()).contains("`too small`"));
    gpu.synchronize().expect("it is reported once");
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn new_memory_holds_a_pattern_at_an_aligned_address() {
    let gpu = emulator();
    let address = gpu.allocate("new", 100).unwrap();
    assert_eq!(address % 256, 0);
    assert_eq!(content::<u8>(&gpu, address, 100), [0xA5; 100]);
    // SAFETY: ranges of the buffer that do not overlap.
    unsafe { gpu.fill(address, 7, 50).and_then(|()| gpu.copy(address, address + 50, 25)) }.unwrap();
    assert_eq!(content::<u8>(&gpu, address + 25, 75), [[7; 25], [7; 25], [0xA5; 25]].concat());
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn transfers_outside_a_buffer_are_refused() {
    let gpu = emulator();
    let address = buffer(&gpu, &[1u8; 64]);
    let mut data = [0; 65];
    // SAFETY: the emulator checks ranges.
    unsafe {
        assert!(failure(gpu.download(address, &mut data)).contains("`test`, has 64 bytes"));
        assert!(failure(gpu.upload(&data[..2], address + 63)).contains("`test`, has 64 bytes"));
        assert!(failure(gpu.fill(address - 1, 0, 1)).contains("fill of 1 bytes"));
        assert!(failure(gpu.copy(address, address + 8, 16)).contains("overlap"));
        gpu.release(address);
        assert!(failure(gpu.download(address, &mut data[..1])).contains("download of 1 bytes"));
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn memory_is_limited_and_counted() {
    let gpu = Emulator::with_memory(1000).unwrap();
    let address = gpu.allocate("first", 600).unwrap();
    assert_eq!(gpu.memory().unwrap(), Memory { free: 400, total: 1000 });
    let refused = gpu.allocate("second", 401);
    assert_eq!(refused, Err(Error::OutOfMemory { what: "second", needed: 401, available: 400 }));
    // SAFETY: from `allocate`, and not used again.
    unsafe { gpu.release(address) };
    gpu.allocate("second", 1000).unwrap();
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn who_reads_a_released_buffer_sees_a_pattern() {
    let gpu = emulator();
    let (input, output) = (buffer(&gpu, &[5u32; 32]), buffer(&gpu, &[0u32; 32]));
    // SAFETY: from `allocate`; the emulator keeps it for those who use it again.
    unsafe { gpu.release(input) };
    launch(&gpu, ("blocks", "wild"), (1, 32), &Blocks { input, output, ticket: 0, n: 0, unused: 0 }).unwrap();
    assert_eq!(content::<u32>(&gpu, output, 32), [0xA5A5_A5A5; 32]);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn a_sequence_does_nothing_until_it_is_run_and_then_all_its_parts_each_time() {
    let gpu = emulator();
    let address = buffer(&gpu, &[1u8; 4]);
    let sequence = Sequence::default();
    // SAFETY: all is within the buffer.
    unsafe {
        sequence.fill(address, 2, 3).unwrap();
        sequence.fill(address, 3, 1).unwrap();
        assert_eq!(content::<u8>(&gpu, address, 4), [1; 4]);
        for _ in 0..2 {
            gpu.run(&sequence).unwrap();
            assert_eq!(content::<u8>(&gpu, address, 4), [3, 2, 2, 1]);
            gpu.fill(address, 1, 4).unwrap();
        }
    }
}
