//! The driver's function table: which slot holds which function, and the functions with their types.

use std::ffi::{c_char, c_void};

use crate::error::{Error, Result};
use crate::sys;

/// One version of the driver's table. Versions differ in length and in where a function stands, so both are data.
pub struct Abi {
    /// The number that `optixQueryFunctionTable` takes.
    pub version: i32,
    /// Pointers in the table; the driver refuses any other number.
    pub len: usize,
    pub slots: Slots,
}

/// Declares each function once; makes the slots and the typed table from it.
macro_rules! functions {
    ($($name:ident($($argument:ty),* $(,)?) -> $output:ty;)*) => {
        /// Where in the table each function stands.
        pub struct Slots {
            $(pub $name: usize,)*
        }

        impl Slots {
            #[cfg(test)]
            pub fn named(&self) -> Vec<(&'static str, usize)> {
                vec![$((stringify!($name), self.$name)),*]
            }
        }

        /// The driver's functions. They stay valid as the library is never unloaded.
        #[derive(Debug)]
        pub struct FunctionTable {
            $(pub $name: unsafe extern "C" fn($($argument),*) -> $output,)*
        }

        impl FunctionTable {
            /// Picks the functions of `abi` out of the driver's table.
            ///
            /// # Safety
            /// Every non-null pointer of `raw` that `abi` names is the function of that name, of the type declared
            /// here, and stays valid for the life of the process.
            ///
            /// # Errors
            /// [`Error::FunctionMissing`] for a null pointer in a slot that is used.
            pub unsafe fn from_raw(abi: &Abi, raw: &[*const c_void]) -> Result<Self> {
                let pointer = |function: &'static str, slot: usize| match raw.get(slot) {
                    Some(pointer) if !pointer.is_null() => Ok(*pointer),
                    _ => Err(Error::FunctionMissing { abi: abi.version, function }),
                };
                Ok(Self {
                    $($name: {
                        let pointer = pointer(stringify!($name), abi.slots.$name)?;
                        // SAFETY: not null, and the caller promises the function's type and life.
                        unsafe {
                            std::mem::transmute::<*const c_void, unsafe extern "C" fn($($argument),*) -> $output>(
                                pointer,
                            )
                        }
                    },)*
                })
            }
        }
    };
}

functions! {
    get_error_name(i32) -> *const c_char;
    get_error_string(i32) -> *const c_char;
    context_create(*mut c_void, *const sys::ContextOptions, *mut sys::ContextHandle) -> i32;
    context_destroy(sys::ContextHandle) -> i32;
    context_get_property(sys::ContextHandle, u32, *mut c_void, usize) -> i32;
    context_set_cache_enabled(sys::ContextHandle, i32) -> i32;
    context_set_cache_location(sys::ContextHandle, *const c_char) -> i32;
    context_get_cache_enabled(sys::ContextHandle, *mut i32) -> i32;
    context_get_cache_location(sys::ContextHandle, *mut c_char, usize) -> i32;
    module_create(
        sys::ContextHandle,
        *const sys::ModuleOptions,
        *const sys::PipelineOptions,
        *const c_char,
        usize,
        *mut c_char,
        *mut usize,
        *mut sys::ModuleHandle,
    ) -> i32;
    module_destroy(sys::ModuleHandle) -> i32;
    builtin_is_module_get(
        sys::ContextHandle,
        *const sys::ModuleOptions,
        *const sys::PipelineOptions,
        *const sys::BuiltinIsOptions,
        *mut sys::ModuleHandle,
    ) -> i32;
    program_group_create(
        sys::ContextHandle,
        *const sys::ProgramGroupDesc,
        u32,
        *const sys::ProgramGroupOptions,
        *mut c_char,
        *mut usize,
        *mut sys::ProgramGroupHandle,
    ) -> i32;
    program_group_destroy(sys::ProgramGroupHandle) -> i32;
    program_group_get_stack_size(sys::ProgramGroupHandle, *mut sys::StackSizes, sys::PipelineHandle) -> i32;
    pipeline_create(
        sys::ContextHandle,
        *const sys::PipelineOptions,
        *const sys::LinkOptions,
        *const sys::ProgramGroupHandle,
        u32,
        *mut c_char,
        *mut usize,
        *mut sys::PipelineHandle,
    ) -> i32;
    pipeline_destroy(sys::PipelineHandle) -> i32;
    pipeline_set_stack_size(sys::PipelineHandle, u32, u32, u32, u32) -> i32;
    accel_compute_memory_usage(
        sys::ContextHandle,
        *const sys::AccelOptions,
        *const sys::BuildInput,
        u32,
        *mut sys::AccelSizes,
    ) -> i32;
    accel_build(
        sys::ContextHandle,
        *mut c_void,
        *const sys::AccelOptions,
        *const sys::BuildInput,
        u32,
        u64,
        usize,
        u64,
        usize,
        *mut u64,
        *const sys::Emit,
        u32,
    ) -> i32;
    accel_compact(sys::ContextHandle, *mut c_void, u64, u64, usize, *mut u64) -> i32;
    sbt_record_pack_header(sys::ProgramGroupHandle, *mut c_void) -> i32;
    launch(
        sys::PipelineHandle,
        *mut c_void,
        u64,
        usize,
        *const sys::ShaderBindingTable,
        u32,
        u32,
        u32,
    ) -> i32;
}

/// OptiX 8.0, the first version of driver 535; later drivers go on offering it.
pub const ABI_87: Abi = Abi {
    version: 87,
    len: 48,
    slots: Slots {
        get_error_name: 0,
        get_error_string: 1,
        context_create: 2,
        context_destroy: 3,
        context_get_property: 4,
        context_set_cache_enabled: 6,
        context_set_cache_location: 7,
        context_get_cache_enabled: 9,
        context_get_cache_location: 10,
        module_create: 12,
        module_destroy: 15,
        builtin_is_module_get: 16,
        program_group_create: 18,
        program_group_destroy: 19,
        program_group_get_stack_size: 20,
        pipeline_create: 21,
        pipeline_destroy: 22,
        pipeline_set_stack_size: 23,
        accel_compute_memory_usage: 24,
        accel_build: 25,
        accel_compact: 29,
        sbt_record_pack_header: 38,
        launch: 39,
    },
};

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn slots_are_distinct_and_inside_the_table() {
        let slots = ABI_87.slots.named();
        let distinct: BTreeSet<_> = slots.iter().map(|&(_, slot)| slot).collect();
        assert_eq!(distinct.len(), slots.len());
        assert!(slots.iter().all(|&(_, slot)| slot < ABI_87.len));
        assert_eq!(ABI_87.len * size_of::<*const c_void>(), 384);
    }

    #[test]
    fn a_hole_in_the_table_is_an_error_that_names_the_function() {
        let mut raw = [std::ptr::dangling::<c_void>(); ABI_87.len];
        raw[ABI_87.slots.launch] = std::ptr::null();
        // SAFETY: none of the functions is called.
        let error = unsafe { FunctionTable::from_raw(&ABI_87, &raw) }.unwrap_err();
        assert_eq!(error, Error::FunctionMissing { abi: 87, function: "launch" });
    }

    #[test]
    fn a_table_that_is_too_short_is_an_error() {
        let raw = [std::ptr::dangling::<c_void>(); 10];
        // SAFETY: none of the functions is called.
        assert!(unsafe { FunctionTable::from_raw(&ABI_87, &raw) }.is_err());
    }
}
