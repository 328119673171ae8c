//! Sequences, which a real device keeps as graphs.

use nearfield_cuda::{
    Buffer, CudaDevice, Gpu, Sequence,
    gpu::{Queue, launch},
};
use nearfield_kernels::{Float4, kernels, layouts::SampleArgs};
use std::sync::Arc;

/// The second time as a graph, which does the same.
pub fn a_sequence_that_comes_again_is_kept_as_a_graph() {
    let device = Arc::new(CudaDevice::new(0).unwrap_or_else(|error| panic!("{error}")));
    let gpu: Arc<dyn Gpu> = device.clone();
    let (mut from, mut to) = (Buffer::new(&gpu, "positions"), Buffer::new(&gpu, "a sample"));
    let untouched = vec![Float4::new(1.0, 2.0, 3.0, 4.0); 1000];
    for graphs in [0, 1, 1] {
        from.upload(&untouched).expect("memory");
        to.upload(&untouched).expect("memory");
        let sequence = Sequence::default();
        let arguments = SampleArgs { position: from.ptr(), sample: to.ptr(), n: 1000, n_sampled: 1000 };
        // SAFETY: both buffers hold a thousand positions, of which the last are not filled.
        unsafe {
            sequence.fill(from.ptr().address(), 0x40, 16 * 998 + 3).expect("a fill");
            sequence.fill(from.ptr().address(), 0x41, 16).expect("a fill");
            launch(&sequence, kernels::SAMPLE, 1000, &arguments).expect("a launch");
            gpu.run(&sequence).expect("a run");
        }
        let filled = |byte: u8| f32::from_ne_bytes([byte; 4]);
        let copy = to.download().expect("a copy");
        assert_eq!(copy[0].x, filled(0x41));
        assert!(copy[1..998].iter().all(|p| [p.x, p.y, p.z, p.w] == [filled(0x40); 4]));
        assert_eq!(copy[999].w, 4.0);
        assert_eq!(device.n_graphs(), graphs);
    }
}
