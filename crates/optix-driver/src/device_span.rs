//! A range of device memory.

/// Device memory that the caller owns: address and length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceSpan {
    /// Device address (`CUdeviceptr`).
    pub address: u64,
    /// Length in bytes.
    pub bytes: usize,
}
