//! One error type for everything that can fail between the library and a launch.

use std::path::PathBuf;

use crate::ProgramGroupKind;

/// Shorthand for results of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why OptiX is not available, or what it refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The library that comes with the driver could not be loaded.
    #[error(
        "OptiX is not available: {name} could not be loaded ({reason}); it comes with NVIDIA driver 535 or newer, \
         and LD_LIBRARY_PATH names further folders to look in"
    )]
    LibraryNotFound {
        /// What was looked for.
        name: String,
        /// What the system's loader said.
        reason: String,
    },
    /// The library was loaded but is not OptiX 7 or newer.
    #[error("{library} has no symbol {symbol}: it is not the OptiX library of NVIDIA driver 535 or newer")]
    SymbolMissing {
        /// The library that was loaded.
        library: String,
        /// The symbol it lacks.
        symbol: &'static str,
    },
    /// The driver does not offer the function table asked for.
    #[error("the driver refused OptiX ABI {abi} with code {code}; it needs NVIDIA driver 535 or newer")]
    AbiRefused {
        /// The ABI asked for.
        abi: i32,
        /// OptiX result code: 7801 for an unknown ABI, 7802 for a table of another size.
        code: i32,
    },
    /// The driver's function table has a hole where this crate needs a function.
    #[error("the driver's table of OptiX ABI {abi} has no {function}")]
    FunctionMissing {
        /// The ABI asked for.
        abi: i32,
        /// Name of the function in this crate's table.
        function: &'static str,
    },
    /// An OptiX function returned something else than success.
    #[error(
        "{function} failed with {code} {name} ({message}){}{log}",
        if log.is_empty() { "" } else { ":\n" }
    )]
    Call {
        /// The OptiX function.
        function: &'static str,
        /// OptiX result code: 7200 bad PTX, 7001 unknown entry, 7202 payload, 7900 CUDA.
        code: i32,
        /// The driver's name of the code.
        name: String,
        /// The driver's explanation of the code.
        message: String,
        /// What the driver logged during the call; empty for functions without a log.
        log: String,
    },
    /// The cache location holds a NUL character, which no path can.
    #[error("the cache location {0:?} holds a NUL character")]
    CacheLocation(PathBuf),
    /// A length does not fit the 32 bits that OptiX has for it.
    #[error("{what}: {value} does not fit into 32 bits")]
    TooLarge {
        /// What was counted or measured.
        what: &'static str,
        /// The offending value.
        value: usize,
    },
    /// Parts of different device contexts cannot be combined.
    #[error("{0} belongs to another device context")]
    ContextMismatch(&'static str),
    /// A program group stands in the wrong section of a shader binding table.
    #[error("the {expected:?} section of a shader binding table cannot hold a record of a {found:?} group")]
    WrongSection {
        /// The kind of group that the section holds.
        expected: ProgramGroupKind,
        /// The kind of group it was given.
        found: ProgramGroupKind,
    },
    /// A shader binding table was placed at an address that its records' alignment forbids.
    #[error("a shader binding table cannot start at {0:#x}: records are 16-byte aligned")]
    MisalignedTable(u64),
    /// An update was asked for with options that do not allow updates.
    #[error("this acceleration structure cannot be updated: build it with `allow_update`")]
    UpdateNotAllowed,
    /// A compacted size was asked for with options that do not allow compaction.
    #[error("this acceleration structure has no compacted size: build it with `allow_compaction`")]
    CompactionNotAllowed,
}

/// `value` as OptiX counts it.
pub(crate) fn to_u32(what: &'static str, value: usize) -> Result<u32> {
    u32::try_from(value).map_err(|_| Error::TooLarge { what, value })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn call(log: &str) -> Error {
        Error::Call {
            function: "optixModuleCreate",
            code: 7200,
            name: "OPTIX_ERROR_INVALID_INPUT".into(),
            message: "Invalid input".into(),
            log: log.into(),
        }
    }

    #[test]
    fn a_failed_call_names_function_code_and_log() {
        let first = "optixModuleCreate failed with 7200 OPTIX_ERROR_INVALID_INPUT (Invalid input)";
        assert_eq!(call("").to_string(), first);
        assert_eq!(call("line 3: no such thing").to_string(), format!("{first}:\nline 3: no such thing"));
    }

    #[test]
    fn an_absent_library_says_what_was_looked_for_and_where_it_comes_from() {
        let text = Error::LibraryNotFound { name: "libx.so".into(), reason: "no such file".into() }.to_string();
        assert!(text.contains("libx.so") && text.contains("no such file") && text.contains("driver 535"), "{text}");
    }

    #[test]
    fn counts_beyond_32_bits_are_errors() {
        assert_eq!(to_u32("records", 7), Ok(7));
        assert_eq!(to_u32("records", 1 << 32), Err(Error::TooLarge { what: "records", value: 1 << 32 }));
    }
}
