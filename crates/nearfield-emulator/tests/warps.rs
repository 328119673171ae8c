//! Warp operations have CUDA's semantics, and their misuse is reported.

mod common;
use common::*;

const ALL: u32 = !0;
const UNWRITTEN: u32 = 0xA5A5_A5A5;

/// The `[rows][32]` results of a kernel of one warp.
fn lanes(kernel: &'static str, mask: u32, argument: u32, width: u32) -> Vec<Vec<u32>> {
    let gpu = emulator();
    let out = buffer(&gpu, &[UNWRITTEN; 128]);
    launch(&gpu, ("warps", kernel), (1, 32), &Lanes { out, mask, argument, width, unused: 0 }).unwrap();
    content::<u32>(&gpu, out, 128).chunks(32).map(<[u32]>::to_vec).collect()
}

/// What `value` gives for each lane of the mask; other lanes write nothing.
fn expected(mask: u32, value: impl Fn(u32) -> u32) -> Vec<u32> {
    (0..32).map(|lane| if mask >> lane & 1 == 1 { value(lane) } else { UNWRITTEN }).collect()
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn shuffles_of_a_full_warp_take_the_lane_cuda_names() {
    let rows = lanes("shuffles", ALL, 5, 32);
    assert_eq!(rows[0], expected(ALL, |_| 5));
    assert_eq!(rows[1], expected(ALL, |lane| if lane < 5 { lane } else { lane - 5 }));
    assert_eq!(rows[2], expected(ALL, |lane| if lane + 5 > 31 { lane } else { lane + 5 }));
    assert_eq!(rows[3], expected(ALL, |lane| lane ^ 5));
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn shuffles_of_narrow_width_stay_in_their_group() {
    let rows = lanes("shuffles", ALL, 3, 8);
    assert_eq!(rows[0], expected(ALL, |lane| lane / 8 * 8 + 3));
    assert_eq!(rows[1], expected(ALL, |lane| if lane % 8 < 3 { lane } else { lane - 3 }));
    assert_eq!(rows[2], expected(ALL, |lane| if lane % 8 + 3 > 7 { lane } else { lane + 3 }));
    assert_eq!(rows[3], expected(ALL, |lane| lane ^ 3));
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn shuffles_of_a_partial_mask_need_only_its_lanes() {
    let mask = 0x00F0_00FF;
    let rows = lanes("shuffles", mask, 1, 32);
    assert_eq!(rows[0], expected(mask, |_| 1));
    // Lanes outside the mask hold an undefined value, which the emulator shows as a pattern.
    let held = |source: u32| if mask >> source & 1 == 1 { source } else { UNWRITTEN };
    assert_eq!(rows[1], expected(mask, |lane| held(lane.max(1) - 1)));
    assert_eq!(rows[3], expected(mask, |lane| lane ^ 1));
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn shuffles_move_every_scalar_type() {
    assert_eq!(lanes("types", ALL, 0, 32)[0], vec![1; 32]);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn votes_count_the_lanes_of_the_mask_only() {
    for mask in [ALL, 0x0000_FFF0, 0x8000_0001] {
        let rows = lanes("votes", mask, 3, 32);
        let threes = (0..32).filter(|lane| lane % 3 == 0).fold(0, |bits, lane| bits | 1 << lane) & mask;
        assert_eq!(rows[0], expected(mask, |_| threes));
        assert_eq!(rows[1], expected(mask, |_| 1));
        assert_eq!(rows[2], expected(mask, |_| u32::from(threes == mask)));
        let alike = |lane: u32| (0..32).filter(|k| k % 3 == lane % 3).fold(0, |bits, k| bits | 1 << k) & mask;
        assert_eq!(rows[3], expected(mask, alike));
    }
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn lanes_meet_after_loops_of_different_length() {
    let gpu = emulator();
    let out = buffer(&gpu, &[0u32; 192]);
    launch(&gpu, ("warps", "divergent"), (3, 64), &Lanes { out, mask: ALL, argument: 0, width: 32, unused: 0 })
        .unwrap();
    assert_eq!(content::<u32>(&gpu, out, 192), vec![31 * 32 / 2; 192]);
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn a_lane_that_ends_before_a_warp_operation_is_reported_wherever_it_is() {
    let gpu = emulator();
    let out = buffer(&gpu, &[0u32; 32]);
    for argument in [0, 13, 31] {
        let a = Lanes { out, mask: ALL, argument, width: 32, unused: 0 };
        let text = failure(launch(&gpu, ("warps", "early_exit"), (1, 32), &a));
        assert!(text.contains("early_exit, block 0: lane exited before warp operation"), "{text}");
    }
    let a = Lanes { out, mask: ALL, argument: 99, width: 32, unused: 0 };
    launch(&gpu, ("warps", "early_exit"), (1, 32), &a).expect("the emulator is as before");
}

#[test]
#[cfg_attr(not(host_compiler), ignore = "no C++ compiler")]
fn deadlock_is_reported_with_the_block_and_who_waits() {
    let gpu = emulator();
    let out = buffer(&gpu, &[0u32; 32]);
    let a = Lanes { out, mask: ALL, argument: 0, width: 32, unused: 0 };
    let text = failure(launch(&gpu, ("warps", "deadlock"), (2, 32), &a));
    assert!(text.contains("deadlock, block 0: deadlock: 16 threads wait at a barrier, thread 0"), "{text}");
}
