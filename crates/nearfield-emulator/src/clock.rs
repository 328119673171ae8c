//! Points in time: launches run when they are enqueued, so the host's clock is the device's.

use nearfield_core::{Error, Result};
use nearfield_cuda::gpu::Mark;
use std::{any::Any, time::Instant};

/// A point in time.
pub struct Moment(Instant);

impl Moment {
    /// The present.
    pub fn now() -> Self {
        Self(Instant::now())
    }
}

impl Mark for Moment {
    fn seconds_since(&self, earlier: &dyn Mark) -> Result<f64> {
        let earlier = earlier.as_any().downcast_ref::<Self>();
        let earlier = earlier.ok_or_else(|| Error::Device("the earlier mark is of another device".into()))?;
        Ok(self.0.saturating_duration_since(earlier.0).as_secs_f64())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
