//! Host and device structures from one definition.
//!
//! `layouts!` declares a `#[repr(C)]` structure and knows how to write it in C++. `cuda/include/layouts.cuh` is made
//! of these by [`crate::layouts::header`], with the size of each asserted, so that host and device cannot disagree.

use bytemuck::{Pod, Zeroable};
use std::{fmt::Write as _, marker::PhantomData};

/// A type that host and device lay out alike.
pub trait Layout: Pod {
    /// Its declaration in C++ as a member or parameter called `name`.
    fn declare(name: &str) -> String;
}

macro_rules! scalars {
    ($($rust:ty => $cuda:literal),+ $(,)?) => {
        $(impl Layout for $rust {
            fn declare(name: &str) -> String {
                format!(concat!($cuda, " {}"), name)
            }
        })+
    };
}

scalars! { f32 => "float", f64 => "double", u32 => "u32", i32 => "i32", u64 => "u64", i64 => "i64", u8 => "u8" }

impl<T: Layout, const N: usize> Layout for [T; N]
where
    [T; N]: Pod,
{
    fn declare(name: &str) -> String {
        T::declare(&format!("{name}[{N}]"))
    }
}

/// Address of values of `T` in device memory; null where nothing is stored.
#[repr(transparent)]
pub struct Ptr<T>(u64, PhantomData<*mut T>);

impl<T> Ptr<T> {
    /// Nothing.
    pub const NULL: Self = Self::new(0);

    /// From an address.
    pub const fn new(address: u64) -> Self {
        Self(address, PhantomData)
    }

    /// The address.
    pub const fn address(self) -> u64 {
        self.0
    }
}

impl<T> Clone for Ptr<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Ptr<T> {}

impl<T> Default for Ptr<T> {
    fn default() -> Self {
        Self::NULL
    }
}

impl<T> std::fmt::Debug for Ptr<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:#x}", self.0)
    }
}

// SAFETY: an address is a number; nothing here reads through it.
unsafe impl<T> Send for Ptr<T> {}
// SAFETY: as for Send.
unsafe impl<T> Sync for Ptr<T> {}
// SAFETY: a transparent u64, for which all zeros is null.
unsafe impl<T: 'static> Zeroable for Ptr<T> {}
// SAFETY: a transparent u64: any bits are valid, there is no padding.
unsafe impl<T: 'static> Pod for Ptr<T> {}

impl<T: Layout> Layout for Ptr<T> {
    fn declare(name: &str) -> String {
        T::declare(&format!("*{name}"))
    }
}

/// Four floats, aligned so that a thread loads them at once.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Float4 {
    /// x
    pub x: f32,
    /// y
    pub y: f32,
    /// z
    pub z: f32,
    /// w
    pub w: f32,
}

impl Float4 {
    /// From its components.
    pub const fn new(x: f32, y: f32, z: f32, w: f32) -> Self {
        Self { x, y, z, w }
    }
}

impl Layout for Float4 {
    fn declare(name: &str) -> String {
        format!("float4 {name}")
    }
}

/// A structure of the generated header.
pub struct Definition {
    /// Its C++ text.
    pub text: String,
}

/// C++ text of a structure: its documentation, members and asserted size.
pub fn define(name: &str, doc: &[&str], members: &[(String, &[&str])], size: usize) -> Definition {
    let mut text = String::new();
    for line in doc {
        let _ = writeln!(text, "//{line}");
    }
    let _ = writeln!(text, "struct {name} {{");
    for (declaration, doc) in members {
        for line in *doc {
            let _ = writeln!(text, "    //{line}");
        }
        let _ = writeln!(text, "    {declaration};");
    }
    let _ = writeln!(text, "}};\nstatic_assert(sizeof({name}) == {size}, \"{name} differs between host and device\");");
    Definition { text }
}

/// Declares structures that kernels take, in Rust and in C++. Members must leave no padding: `Pod` checks it.
macro_rules! layouts {
    ($(
        $(#[doc = $doc:literal])+
        pub struct $name:ident {
            $($(#[doc = $mdoc:literal])+ pub $member:ident: $type:ty,)+
        }
    )+) => {
        $(
            $(#[doc = $doc])+
            #[repr(C)]
            #[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
            pub struct $name { $($(#[doc = $mdoc])+ pub $member: $type,)+ }

            impl $crate::layout::Layout for $name {
                fn declare(name: &str) -> String {
                    format!(concat!(stringify!($name), " {}"), name)
                }
            }

            impl Default for $name {
                fn default() -> Self {
                    bytemuck::Zeroable::zeroed()
                }
            }
        )+

        /// The C++ text of this file's structures, in order.
        pub(crate) fn definitions() -> Vec<$crate::layout::Definition> {
            vec![$($crate::layout::define(
                stringify!($name),
                &[$($doc),+],
                &[$((<$type as $crate::layout::Layout>::declare(stringify!($member)), &[$($mdoc),+] as &[&str])),+],
                size_of::<$name>(),
            )),+]
        }
    };
}
pub(crate) use layouts;
