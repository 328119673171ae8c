//! The committed header against the structures it is made of.

#[test]
fn the_committed_header_is_the_generated_one() {
    let committed = include_str!("../cuda/include/layouts.cuh");
    assert!(committed == nearfield_kernels::layouts::header(), "layouts.cuh is stale: run `cargo xtask ptx`");
}
