//! NVRTC: CUDA C++ to PTX. The functions are declared here after its documentation, those that are called only.

use libloading::Library;
use std::{
    ffi::{CString, c_char, c_int, c_void},
    path::Path,
    ptr,
};

type Program = *mut c_void;
/// `nvrtcResult`; 0 is success.
type Status = c_int;
type CreateProgram = unsafe extern "C" fn(
    *mut Program,
    *const c_char,
    *const c_char,
    c_int,
    *const *const c_char,
    *const *const c_char,
) -> Status;
type CompileProgram = unsafe extern "C" fn(Program, c_int, *const *const c_char) -> Status;
type Size = unsafe extern "C" fn(Program, *mut usize) -> Status;
type Text = unsafe extern "C" fn(Program, *mut c_char) -> Status;
type DestroyProgram = unsafe extern "C" fn(*mut Program) -> Status;

/// The loaded library.
pub struct Nvrtc {
    create: CreateProgram,
    compile: CompileProgram,
    log_size: Size,
    log: Text,
    ptx_size: Size,
    ptx: Text,
    destroy: DestroyProgram,
    /// Keeps the functions where they are.
    _library: Library,
}

impl Nvrtc {
    /// Loads the library.
    pub fn open(path: &Path) -> Result<Self, String> {
        let describe = |error: libloading::Error| format!("{}: {error}", path.display());
        // SAFETY: NVRTC's initialisers have no preconditions; the wheel was checked against its hash.
        let library = unsafe { Library::new(path) }.map_err(describe)?;
        // SAFETY: the types are those of NVRTC's documentation, stable since its first version.
        unsafe {
            Ok(Self {
                create: *library.get::<CreateProgram>(b"nvrtcCreateProgram").map_err(describe)?,
                compile: *library.get::<CompileProgram>(b"nvrtcCompileProgram").map_err(describe)?,
                log_size: *library.get::<Size>(b"nvrtcGetProgramLogSize").map_err(describe)?,
                log: *library.get::<Text>(b"nvrtcGetProgramLog").map_err(describe)?,
                ptx_size: *library.get::<Size>(b"nvrtcGetPTXSize").map_err(describe)?,
                ptx: *library.get::<Text>(b"nvrtcGetPTX").map_err(describe)?,
                destroy: *library.get::<DestroyProgram>(b"nvrtcDestroyProgram").map_err(describe)?,
                _library: library,
            })
        }
    }

    /// The PTX of a source, without the NUL at its end; the compiler's messages where it has any to give.
    pub fn compile(&self, name: &str, source: &str, options: &[&str]) -> Result<String, String> {
        let c_string = |text: &str| CString::new(text).map_err(|_| format!("{name} contains a NUL"));
        let (c_name, c_source) = (c_string(name)?, c_string(source)?);
        let options = options.iter().map(|option| c_string(option)).collect::<Result<Vec<_>, _>>()?;
        let options: Vec<*const c_char> = options.iter().map(|option| option.as_ptr()).collect();
        let mut program = ptr::null_mut();
        // SAFETY: both texts end in NUL and live through the call, which copies them; there are no headers to pass.
        let status =
            unsafe { (self.create)(&mut program, c_source.as_ptr(), c_name.as_ptr(), 0, ptr::null(), ptr::null()) };
        if status != 0 {
            return Err(format!("{name}: nvrtcCreateProgram gives {status}"));
        }
        // SAFETY: the program is a live one, and `options` holds as many texts that end in NUL as is said.
        let status = unsafe { (self.compile)(program, options.len() as c_int, options.as_ptr()) };
        let log = self.text(program, self.log_size, self.log);
        let ptx = self.text(program, self.ptx_size, self.ptx);
        // SAFETY: the program is not used after this.
        unsafe { (self.destroy)(&mut program) };
        let log = log?;
        if status != 0 {
            return Err(format!("{name} does not compile:\n{log}"));
        }
        if !log.trim().is_empty() {
            println!("{log}");
        }
        ptx.map(|ptx| without_call_numbers(&ptx))
    }

    /// A text of a program.
    fn text(&self, program: Program, size: Size, text: Text) -> Result<String, String> {
        let mut length = 0;
        // SAFETY: the program is a live one.
        let status = unsafe { size(program, &mut length) };
        let mut bytes = vec![0u8; length];
        // SAFETY: as many bytes as the library asked for.
        let status = if status == 0 { unsafe { text(program, bytes.as_mut_ptr().cast()) } } else { status };
        if status != 0 {
            return Err(format!("NVRTC gives {status} instead of a text"));
        }
        while bytes.last() == Some(&0) {
            bytes.pop();
        }
        String::from_utf8(bytes).map_err(|error| error.to_string())
    }
}

/// Comments number the calls of all sources compiled before by the same process; without the numbers the PTX depends on
/// its source alone.
fn without_call_numbers(ptx: &str) -> String {
    let mut text = String::with_capacity(ptx.len());
    for line in ptx.lines() {
        text.push_str(line.split_once("// callseq").map_or(line, |(code, _)| code.trim_end()));
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::without_call_numbers;

    #[test]
    fn numbers_of_calls_are_taken_out() {
        let ptx = "\tadd;\n\t{ // callseq 7, 0\n\t} // callseq 7\n";
        assert_eq!(without_call_numbers(ptx), "\tadd;\n\t{\n\t}\n");
    }
}
