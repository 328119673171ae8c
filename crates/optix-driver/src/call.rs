//! Results of calls: a code becomes an [`Error::Call`] with the driver's own words.

use std::ffi::{CStr, c_char};

use crate::error::{Error, Result};
use crate::sys;
use crate::table::FunctionTable;

impl FunctionTable {
    /// Turns the result code of `function` into a result.
    pub fn check(&self, function: &'static str, code: i32) -> Result<()> {
        self.check_logged(function, code, LogBuffer::EMPTY).map(drop)
    }

    /// As [`check`](Self::check), with what the call logged in the error, or as the value.
    pub fn check_logged(&self, function: &'static str, code: i32, log: LogBuffer) -> Result<String> {
        let log = log.into_text();
        if code == sys::SUCCESS {
            return Ok(log);
        }
        // SAFETY: both take any code and return null or a string that lives as long as the library.
        let (name, message) = unsafe { (text((self.get_error_name)(code)), text((self.get_error_string)(code))) };
        Err(Error::Call { function, code, name, message, log })
    }
}

/// Where a call writes its log; what does not fit is cut off.
pub struct LogBuffer {
    bytes: Vec<u8>,
    /// In: room; out: length of the whole log, which may be more than the room.
    size: usize,
}

impl LogBuffer {
    const EMPTY: Self = Self { bytes: Vec::new(), size: 0 };

    pub fn new() -> Self {
        // A compiler log names each offending line; the first of them tell what is wrong.
        let bytes = vec![0; 16 * 1024];
        Self { size: bytes.len(), bytes }
    }

    /// The two arguments that every logging function takes, valid while the buffer is borrowed.
    pub fn arguments(&mut self) -> (*mut c_char, *mut usize) {
        (self.bytes.as_mut_ptr().cast(), &mut self.size)
    }

    fn into_text(self) -> String {
        let length = self.bytes.iter().position(|&byte| byte == 0).unwrap_or(self.bytes.len());
        String::from_utf8_lossy(&self.bytes[..length]).trim_end().to_owned()
    }
}

/// A string of the driver; empty for null.
///
/// # Safety
/// `pointer` is null or a NUL-terminated string that stays as it is during the call.
pub unsafe fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: not null; the caller promises the rest.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_ends_at_the_first_nul_or_at_the_end_of_the_buffer() {
        assert_eq!(LogBuffer { bytes: b"warning \n\0rest".to_vec(), size: 9 }.into_text(), "warning");
        assert_eq!(LogBuffer { bytes: b"cut of".to_vec(), size: 20 }.into_text(), "cut of");
        assert_eq!(LogBuffer::EMPTY.into_text(), "");
    }
}
