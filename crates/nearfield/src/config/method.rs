//! `[method]`: how to compute.

use super::{Bytes, Device, Error, Result, text};
use nearfield_core::{Images, Maintenance, Method, Order, Plan, Skin};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// A named choice, or `auto`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Choice<T> {
    /// Nearfield chooses.
    #[default]
    Auto,
    /// The user chose.
    Of(T),
}

impl<T: fmt::Display> fmt::Display for Choice<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.pad("auto"),
            Self::Of(choice) => choice.fmt(f),
        }
    }
}

impl<T: FromStr<Err = String>> FromStr for Choice<T> {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        if text == "auto" { Ok(Self::Auto) } else { text.parse().map(Self::Of) }
    }
}

/// `[method]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MethodConfig {
    /// The method.
    #[serde(with = "text")]
    pub name: Choice<Method>,
    /// The device.
    #[serde(with = "text")]
    pub device: Device,
    /// When a BVH is rebuilt rather than refitted.
    #[serde(with = "text")]
    pub maintenance: Maintenance,
    /// Periodic images of BVH methods.
    #[serde(with = "text")]
    pub images: Choice<Images>,
    /// Memory order.
    #[serde(with = "text")]
    pub order: Order,
    /// Verlet skin of list methods.
    pub skin: Skin,
    /// Greatest expected drift of the energy, for each particle and unit of time, from pairs that lists miss; 0 for lists
    /// that miss none.
    pub list_tolerance: f64,
    /// Sum forces independently of order.
    pub deterministic: bool,
    /// Most bytes a stored neighbour list may take.
    pub memory_budget: Bytes,
}

impl Default for MethodConfig {
    fn default() -> Self {
        Self {
            name: Choice::Auto,
            device: Device::Auto,
            maintenance: Maintenance::Gradient,
            images: Choice::Auto,
            order: Order::Morton,
            skin: Skin::Auto,
            list_tolerance: 0.0,
            deterministic: false,
            memory_budget: Bytes(4 << 30),
        }
    }
}

impl MethodConfig {
    pub(super) fn validate(&self) -> Result<()> {
        if let Skin::Fixed(skin) = self.skin
            && !(skin.is_finite() && skin >= 0.0)
        {
            return Err(Error::invalid("method.skin", self.skin, "must be zero (a list each step) or positive"));
        }
        if !(self.list_tolerance.is_finite() && self.list_tolerance >= 0.0) {
            let reason = "must be zero (lists miss no pair) or positive";
            return Err(Error::invalid("method.list_tolerance", self.list_tolerance, reason));
        }
        if self.memory_budget.0 == 0 {
            return Err(Error::invalid("method.memory_budget", self.memory_budget, "must be positive"));
        }
        Ok(())
    }

    /// The plan for a method. `images = "auto"` is `gamma`.
    pub fn plan(&self, method: Method) -> Plan {
        let images = match self.images {
            Choice::Auto => Images::Gamma,
            Choice::Of(images) => images,
        };
        Plan {
            method,
            images,
            order: self.order,
            maintenance: self.maintenance,
            skin: self.skin,
            list_tolerance: self.list_tolerance,
            deterministic: self.deterministic,
            memory_budget: self.memory_budget.0,
        }
    }
}
