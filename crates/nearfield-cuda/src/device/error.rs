//! Why there is no GPU.

/// Why a GPU cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unavailable {
    /// The driver's library was not found.
    #[error("no NVIDIA driver: the library libcuda.so.1 was not found")]
    NoDriver,
    /// The driver has no device.
    #[error("the NVIDIA driver found no GPU ({0})")]
    NoDevice(String),
    /// The driver is older than the kernels' PTX.
    #[error("the NVIDIA driver supports CUDA {found}, but {needed} (driver 535) or newer is needed")]
    OldDriver {
        /// CUDA version of the driver.
        found: String,
        /// Least version.
        needed: String,
    },
    /// There are fewer devices.
    #[error("there is no GPU {ordinal}: the NVIDIA driver found {count}, numbered from 0")]
    NoSuchDevice {
        /// The number asked for.
        ordinal: usize,
        /// How many there are.
        count: usize,
    },
    /// The device is older than the kernels' PTX.
    #[error("{name} has compute capability {major}.{minor}, but 7.5 or newer is needed")]
    OldDevice {
        /// Name of the device.
        name: String,
        /// Major version.
        major: i32,
        /// Minor version.
        minor: i32,
    },
    /// Anything else the driver said.
    #[error("the NVIDIA driver failed: {0}")]
    Driver(String),
}
