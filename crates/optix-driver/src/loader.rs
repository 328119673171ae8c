//! Finding the driver's OptiX library and asking it for its functions.

use std::error::Error as _;
use std::ffi::c_void;
use std::sync::Arc;

use libloading::Library;

use crate::error::{Error, Result};
use crate::sys;
use crate::table::{ABI_87, Abi, FunctionTable};

/// Part of the driver; the version belongs to the name, so no development link is needed.
const LIBRARY: &str = "libnvoptix.so.1";
const ENTRY: &str = "optixQueryFunctionTable";

type QueryFunctionTable =
    unsafe extern "C" fn(i32, u32, *const c_void, *const c_void, *mut *const c_void, usize) -> i32;

/// OptiX of the installed driver. Cheap to clone; everything made from it keeps it alive.
#[derive(Clone, Debug)]
pub struct OptiX {
    pub(crate) table: Arc<FunctionTable>,
}

impl OptiX {
    /// Loads OptiX 8.0 (ABI 87) from the driver.
    ///
    /// Looks for `libnvoptix.so.1` where the system looks for libraries. Needs no GPU yet. In a container the library
    /// is there only if the runtime was asked for the driver's graphics parts (`NVIDIA_DRIVER_CAPABILITIES`).
    ///
    /// # Errors
    /// [`Error::LibraryNotFound`] without the library, and always on Windows, where looking it up is not supported;
    /// [`Error::SymbolMissing`], [`Error::AbiRefused`] or [`Error::FunctionMissing`] if the driver is too old.
    pub fn load() -> Result<Self> {
        if cfg!(windows) {
            let reason = "looking it up on Windows is not supported".to_owned();
            return Err(Error::LibraryNotFound { name: "nvoptix.dll".to_owned(), reason });
        }
        Self::load_library(LIBRARY)
    }

    fn load_library(name: &str) -> Result<Self> {
        // SAFETY: the driver's library may be loaded at any time; its initialisers set up only its own state.
        let library = unsafe { Library::new(name) }.map_err(|error| Error::LibraryNotFound {
            name: name.to_owned(),
            reason: error.source().map_or_else(|| error.to_string(), ToString::to_string),
        })?;
        // SAFETY: the symbol has this type in every version of the library.
        let query = unsafe { library.get::<QueryFunctionTable>(ENTRY) }
            .map(|symbol| *symbol)
            .map_err(|_| Error::SymbolMissing { library: name.to_owned(), symbol: ENTRY })?;
        // Never unloaded: the driver starts threads and registers exit handlers that run its code, and they may outlive
        // every object made here.
        std::mem::forget(library);
        // SAFETY: the function is the driver's, and so is what it fills in.
        unsafe { Self::query(query, &ABI_87) }
    }

    /// Asks `query` for the table of `abi`.
    ///
    /// # Safety
    /// On success `query` fills the table with the functions that `abi` names, which stay valid for the life of the
    /// process.
    pub(crate) unsafe fn query(query: QueryFunctionTable, abi: &Abi) -> Result<Self> {
        let mut raw = vec![std::ptr::null::<c_void>(); abi.len];
        let (none, bytes) = (std::ptr::null(), size_of_val(raw.as_slice()));
        // SAFETY: `raw` has room for `bytes`; there are no options, hence no keys and no values.
        let code = unsafe { query(abi.version, 0, none, none, raw.as_mut_ptr(), bytes) };
        if code != sys::SUCCESS {
            return Err(Error::AbiRefused { abi: abi.version, code });
        }
        // SAFETY: the caller promises it.
        let table = unsafe { FunctionTable::from_raw(abi, &raw) }?;
        Ok(Self { table: Arc::new(table) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mock;

    #[test]
    fn an_absent_library_is_an_error_that_says_what_was_looked_for() {
        let name = "libno-such-optix.so.1";
        let Error::LibraryNotFound { name: found, reason } = OptiX::load_library(name).unwrap_err() else {
            panic!("another error")
        };
        assert_eq!(found, name);
        assert!(!reason.is_empty());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_library_that_is_not_optix_is_an_error_that_names_the_symbol() {
        let error = OptiX::load_library("libc.so.6").unwrap_err();
        assert_eq!(error, Error::SymbolMissing { library: "libc.so.6".into(), symbol: ENTRY });
    }

    #[test]
    fn the_table_is_asked_for_with_its_version_and_exact_size() {
        mock::load();
        assert_eq!(mock::calls(), ["optixQueryFunctionTable abi=87 options=0 bytes=384"]);
    }

    #[test]
    fn a_driver_without_the_abi_is_an_error_with_its_code() {
        mock::reset();
        mock::fail("optixQueryFunctionTable", 7801, "");
        // SAFETY: the mock's function fails and fills nothing.
        let error = unsafe { OptiX::query(mock::query_function_table, &ABI_87) }.unwrap_err();
        assert_eq!(error, Error::AbiRefused { abi: 87, code: 7801 });
    }
}
