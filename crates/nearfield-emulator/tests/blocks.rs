//! Barriers, atomics and the order of blocks.

mod common;
use common::*;

fn inputs(n: u32) -> Vec<u32> {
    (0..n).map(|i| i * 7919 % 1000 + 1).collect()
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn block_sums_through_shared_memory_are_the_sums() {
    let gpu = emulator();
    let input = inputs(1000);
    let a = Blocks { input: buffer(&gpu, &input), output: buffer(&gpu, &[0u32; 4]), ticket: 0, n: 1000, unused: 0 };
    launch(&gpu, ("blocks", "block_sums"), (4, 256), &a).unwrap();
    let sums: Vec<u32> = input.chunks(256).map(|block| block.iter().sum()).collect();
    assert_eq!(content::<u32>(&gpu, a.output, 4), sums);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn atomics_of_integers_return_the_old_and_store_the_new() {
    let gpu = emulator();
    let input = inputs(1000);
    let output = buffer(&gpu, &[0, u32::MAX, 0, 0, u32::MAX, 0]);
    let a = Blocks { input: buffer(&gpu, &input), output, ticket: buffer(&gpu, &[1u32]), n: 1000, unused: 0 };
    launch(&gpu, ("blocks", "atomics"), (4, 256), &a).unwrap();
    let expected = [
        input.iter().sum(),
        *input.iter().min().unwrap(),
        *input.iter().max().unwrap(),
        input.iter().fold(0, |bits, v| bits | v),
        input.iter().fold(u32::MAX, |bits, v| bits & v),
        1,
    ];
    assert_eq!(content::<u32>(&gpu, output, 6), expected);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn atomics_add_floats_and_wrapping_integers() {
    let gpu = emulator();
    let a = Floats {
        single: buffer(&gpu, &[1.0f32]),
        twice: buffer(&gpu, &[1.0f64]),
        whole: buffer(&gpu, &[10u64]),
        n: 100,
        unused: 0,
    };
    launch(&gpu, ("blocks", "atomic_floats"), (1, 128), &a).unwrap();
    assert_eq!(content::<f32>(&gpu, a.single, 1), [51.0]);
    assert_eq!(content::<f64>(&gpu, a.twice, 1), [26.0]);
    assert_eq!(content::<u64>(&gpu, a.whole, 1), [10u64.wrapping_sub(100)]);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn blocks_that_look_back_find_the_sum_of_those_before() {
    let gpu = emulator();
    let input = inputs(1000);
    let output = buffer(&gpu, &[0u32; 32]);
    let a = Blocks { input: buffer(&gpu, &input), output, ticket: buffer(&gpu, &[0u32]), n: 1000, unused: 0 };
    launch(&gpu, ("blocks", "look_back"), (32, 32), &a).unwrap();
    let sums: Vec<u32> = (1..=32).map(|tiles| input.iter().take(32 * tiles).sum::<u32>() + 1).collect();
    assert_eq!(content::<u32>(&gpu, output, 32), sums);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn barriers_do_not_wait_for_threads_that_ended() {
    let gpu = emulator();
    let output = buffer(&gpu, &[0u32; 128]);
    for n in [1, 50, 128] {
        launch(&gpu, ("blocks", "leavers"), (1, 128), &Blocks { input: 0, output, ticket: 0, n, unused: 0 }).unwrap();
        assert_eq!(content::<u32>(&gpu, output, n as usize), vec![n; n as usize]);
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn launches_side_by_side_do_not_disturb_each_other() {
    std::thread::scope(|scope| {
        for shift in 0..4 {
            scope.spawn(move || {
                let gpu = emulator();
                let input: Vec<u32> = (0..1024).map(|i| i << shift).collect();
                let output = buffer(&gpu, &[0u32; 4]);
                let a = Blocks { input: buffer(&gpu, &input), output, ticket: 0, n: 1024, unused: 0 };
                for _ in 0..50 {
                    launch(&gpu, ("blocks", "block_sums"), (4, 256), &a).unwrap();
                    let sums: Vec<u32> = input.chunks(256).map(|block| block.iter().sum()).collect();
                    assert_eq!(content::<u32>(&gpu, output, 4), sums);
                }
            });
        }
    });
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn launches_that_a_device_refuses_are_refused() {
    let gpu = emulator();
    let a = Blocks { input: 0, output: 0, ticket: 0, n: 0, unused: 0 };
    let refused = |kernel, grid| failure(launch(&gpu, kernel, grid, &a));
    assert!(refused(("blocks", "missing"), (1, 32)).contains("no kernel missing"));
    assert!(refused(("warps", "block_sums"), (1, 32)).contains("no kernel block_sums in module warps"));
    assert!(refused(("blocks", "block_sums"), (1, 512)).contains("at most 256 threads"));
    assert!(refused(("blocks", "block_sums"), (0, 256)).contains("cannot be launched"));
    assert!(failure(launch(&gpu, ("blocks", "block_sums"), (1, 32), &0u64)).contains("takes 32 bytes"));
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn a_kernel_that_needs_too_much_stack_is_reported() {
    let gpu = emulator();
    let a = Blocks { input: 0, output: buffer(&gpu, &[0u32; 32]), ticket: 0, n: 3, unused: 0 };
    assert!(failure(launch(&gpu, ("blocks", "deep"), (1, 32), &a)).contains("more stack"));
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn threads_of_odd_blocks_run_backwards() {
    let gpu = emulator();
    let a = Blocks { input: 0, output: buffer(&gpu, &[0u32; 128]), ticket: buffer(&gpu, &[0u32; 2]), n: 0, unused: 0 };
    launch(&gpu, ("blocks", "turns"), (2, 64), &a).unwrap();
    let turns: Vec<u32> = (0..64).chain((0..64).rev()).collect();
    assert_eq!(content::<u32>(&gpu, a.output, 128), turns);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn an_access_where_there_is_no_memory_is_reported_and_the_device_goes_on() {
    let gpu = emulator();
    let output = buffer(&gpu, &[0u32; 32]);
    for input in [0, 64, 0xA5A5_A5A5_A5A5_A5A4] {
        let text =
            failure(launch(&gpu, ("blocks", "wild"), (3, 32), &Blocks { input, output, ticket: 0, n: 0, unused: 0 }));
        assert!(text.contains("wild, block 0: thread 0 accesses"), "{text}");
    }
    let input = buffer(&gpu, &[5u32; 32]);
    launch(&gpu, ("blocks", "wild"), (1, 32), &Blocks { input, output, ticket: 0, n: 0, unused: 0 }).unwrap();
    assert_eq!(content::<u32>(&gpu, output, 32), [5; 32]);
}
