//! What device code and pipelines must agree on beside structures.

#[test]
fn rays_carry_as_many_words_as_pipelines_are_made_for() {
    let header = include_str!("../cuda/include/raytracing.cuh");
    assert!(header.contains(&format!("PAYLOAD_WORDS = {};", nearfield_kernels::kernels::PAYLOAD_WORDS)));
}
