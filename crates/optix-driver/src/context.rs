//! The device context: OptiX on one GPU, within a CUDA context of the caller.

use std::ffi::{CString, c_char, c_void};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::ptr;
use std::sync::Arc;

use crate::call::text;
use crate::error::{Error, Result};
use crate::loader::OptiX;
use crate::sys;
use crate::table::FunctionTable;

/// Receives the driver's messages: level, topic, text. May be called from any thread that calls OptiX.
pub type LogCallback = Box<dyn Fn(LogLevel, &str, &str) + Send + Sync>;

/// How serious a message of the driver is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LogLevel {
    /// The context is no longer usable.
    Fatal,
    /// A call failed.
    Error,
    /// Something works, but not as asked for; an unwritable cache, for example.
    Warning,
    /// Progress and statistics.
    Print,
}

impl LogLevel {
    fn from_driver(level: u32) -> Self {
        match level {
            0 | 1 => Self::Fatal,
            2 => Self::Error,
            3 => Self::Warning,
            _ => Self::Print,
        }
    }
}

/// Where compiled modules are kept between runs. Compiling takes hundreds of milliseconds, a cached module below one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Cache {
    /// The driver's choice: the variables `OPTIX_CACHE_PATH` and `OPTIX_CACHE_MAXSIZE`, else a folder per user.
    #[default]
    Default,
    /// Nothing is kept.
    Off,
    /// This folder.
    Location(PathBuf),
}

/// Options of a [`DeviceContext`].
#[derive(Default)]
pub struct ContextOptions {
    /// Checks every call and launch; compiling takes two to three times as long, launches a fifth longer.
    pub validation: bool,
    /// Receives messages of every level.
    pub log: Option<LogCallback>,
    /// Where compiled modules are kept.
    pub cache: Cache,
}

/// OptiX on one GPU. Every other object is made from it and keeps it alive.
pub struct DeviceContext {
    pub(crate) optix: OptiX,
    pub(crate) handle: sys::ContextHandle,
    /// Boxed twice: the driver holds a thin pointer to it for as long as the context lives.
    _log: Option<Box<LogCallback>>,
}

// SAFETY: the driver's functions may be called for one context from several threads at once, all but the destruction,
// which needs the only owner; the callback is `Send + Sync`, and nothing else is shared.
unsafe impl Send for DeviceContext {}
// SAFETY: as above.
unsafe impl Sync for DeviceContext {}

impl DeviceContext {
    /// OptiX within `cu_context`, a `CUcontext`; null stands for the one that is current on this thread.
    ///
    /// Takes about 0.1 s, on a machine's first use a second.
    ///
    /// # Errors
    /// [`Error::Call`] with the driver's reason, also if a [`Cache::Location`] cannot be written to;
    /// [`Error::CacheLocation`] if it is no path.
    ///
    /// # Safety
    /// - `cu_context` is null or a `CUcontext`; the one used stays alive until the last object made from this context
    ///   is dropped.
    pub unsafe fn new(optix: &OptiX, cu_context: *mut c_void, options: ContextOptions) -> Result<Arc<Self>> {
        let log = options.log.map(Box::new);
        let options_for_driver = sys::ContextOptions {
            log_function: log.as_ref().map(|_| forward as sys::LogFunction),
            log_data: log.as_deref().map_or(ptr::null_mut(), |callback| ptr::from_ref(callback).cast_mut().cast()),
            log_level: if log.is_some() { 4 } else { 0 },
            validation: if options.validation { sys::VALIDATION_ALL } else { 0 },
        };
        let mut handle = sys::ContextHandle::NULL;
        let table = &optix.table;
        // SAFETY: the structs live during the call, the callback as long as the context; the caller promises the rest.
        let code = unsafe { (table.context_create)(cu_context, &options_for_driver, &mut handle) };
        table.check("optixDeviceContextCreate", code)?;
        let context = Arc::new(Self { optix: optix.clone(), handle, _log: log });
        context.set_cache(&options.cache)?;
        Ok(context)
    }

    /// Version of the RT cores times ten: 10 for the first generation. **0 means that there are none:** traversal runs
    /// in software, and everything works the same.
    ///
    /// # Errors
    /// [`Error::Call`].
    pub fn rtcore_version(&self) -> Result<u32> {
        self.property(sys::PROPERTY_RTCORE_VERSION)
    }

    /// Most primitives in one geometry acceleration structure.
    ///
    /// # Errors
    /// [`Error::Call`].
    pub fn max_primitives(&self) -> Result<u32> {
        self.property(sys::PROPERTY_MAX_PRIMITIVES_PER_GAS)
    }

    /// Most instances in one instance acceleration structure.
    ///
    /// # Errors
    /// [`Error::Call`].
    pub fn max_instances(&self) -> Result<u32> {
        self.property(sys::PROPERTY_MAX_INSTANCES_PER_IAS)
    }

    /// Largest [`Instance::id`](crate::Instance::id).
    ///
    /// # Errors
    /// [`Error::Call`].
    pub fn max_instance_id(&self) -> Result<u32> {
        self.property(sys::PROPERTY_MAX_INSTANCE_ID)
    }

    /// Whether compiled modules are kept between runs.
    ///
    /// # Errors
    /// [`Error::Call`].
    pub fn cache_enabled(&self) -> Result<bool> {
        let mut enabled = 0;
        // SAFETY: the context is alive, and `enabled` is what the function fills.
        let code = unsafe { (self.table().context_get_cache_enabled)(self.handle, &mut enabled) };
        self.table().check("optixDeviceContextGetCacheEnabled", code)?;
        Ok(enabled != 0)
    }

    /// The folder in which compiled modules are kept.
    ///
    /// # Errors
    /// [`Error::Call`], also if the path is longer than 4095 bytes.
    pub fn cache_location(&self) -> Result<PathBuf> {
        let mut buffer: [c_char; 4096] = [0; 4096];
        let function = self.table().context_get_cache_location;
        // SAFETY: the context is alive, and the buffer has the length named.
        let code = unsafe { function(self.handle, buffer.as_mut_ptr(), buffer.len()) };
        self.table().check("optixDeviceContextGetCacheLocation", code)?;
        // SAFETY: on success the buffer holds a NUL-terminated string.
        Ok(PathBuf::from(unsafe { text(buffer.as_ptr()) }))
    }

    pub(crate) fn table(&self) -> &FunctionTable {
        &self.optix.table
    }

    fn property(&self, property: u32) -> Result<u32> {
        let mut value = 0_u32;
        let function = self.table().context_get_property;
        // SAFETY: the context is alive, and every property asked for here is a `u32`.
        let code = unsafe { function(self.handle, property, (&raw mut value).cast(), size_of::<u32>()) };
        self.table().check("optixDeviceContextGetProperty", code)?;
        Ok(value)
    }

    fn set_cache(&self, cache: &Cache) -> Result<()> {
        match cache {
            Cache::Default => Ok(()),
            Cache::Off => {
                // SAFETY: the context is alive.
                let code = unsafe { (self.table().context_set_cache_enabled)(self.handle, 0) };
                self.table().check("optixDeviceContextSetCacheEnabled", code)
            }
            Cache::Location(path) => {
                let location = c_path(path)?;
                // SAFETY: the context is alive, the string lives during the call.
                let code = unsafe { (self.table().context_set_cache_location)(self.handle, location.as_ptr()) };
                self.table().check("optixDeviceContextSetCacheLocation", code)
            }
        }
    }
}

impl Drop for DeviceContext {
    fn drop(&mut self) {
        // An error is dropped: there is nobody to hand it to, and the handle is gone either way.
        // SAFETY: the only owner of a live handle; what was made from it held an `Arc` and is destroyed.
        unsafe { (self.table().context_destroy)(self.handle) };
    }
}

impl fmt::Debug for DeviceContext {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DeviceContext").field("handle", &self.handle).finish_non_exhaustive()
    }
}

fn c_path(path: &Path) -> Result<CString> {
    CString::new(path.as_os_str().as_encoded_bytes()).map_err(|_| Error::CacheLocation(path.to_owned()))
}

/// Hands a message of the driver to the callback behind `data`.
unsafe extern "C" fn forward(level: u32, tag: *const c_char, message: *const c_char, data: *mut c_void) {
    // SAFETY: `data` is the callback box of a context, which outlives the context; it is only shared.
    let callback = unsafe { &*data.cast_const().cast::<LogCallback>() };
    // SAFETY: the driver's strings live during the call.
    let (tag, message) = unsafe { (text(tag), text(message)) };
    // A panic must not unwind into the driver. Its hook has reported it, and a lost message is no reason to abort.
    let _ = catch_unwind(AssertUnwindSafe(|| callback(LogLevel::from_driver(level), &tag, message.trim_end())));
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use crate::mock;

    fn context(options: ContextOptions) -> Result<Arc<DeviceContext>> {
        let optix = mock::load();
        mock::take_calls();
        // SAFETY: the mock follows no pointers to a CUDA context.
        unsafe { DeviceContext::new(&optix, ptr::null_mut(), options) }
    }

    #[test]
    fn a_context_is_made_with_its_options_and_destroyed_when_dropped() {
        drop(context(ContextOptions { validation: true, ..Default::default() }).unwrap());
        assert_eq!(
            mock::calls(),
            ["optixDeviceContextCreate log=false level=0 validation=0xffffffff", "optixDeviceContextDestroy 1"]
        );
    }

    #[test]
    fn properties_are_asked_for_by_number_with_their_size() {
        let context = context(ContextOptions::default()).unwrap();
        mock::take_calls();
        assert_eq!(context.rtcore_version(), Ok(0));
        assert_eq!(context.max_primitives(), Ok(1 << 29));
        assert_eq!(context.max_instances(), Ok(1 << 28));
        assert_eq!(context.max_instance_id(), Ok((1 << 28) - 1));
        assert_eq!(
            mock::calls(),
            ["0x2005", "0x2003", "0x2004", "0x2006"]
                .map(|property| { format!("optixDeviceContextGetProperty {property} bytes=4") })
        );
    }

    #[test]
    fn the_cache_is_left_alone_switched_off_or_moved() {
        let on = context(ContextOptions::default()).unwrap();
        assert_eq!(on.cache_enabled(), Ok(true));
        let off = context(ContextOptions { cache: Cache::Off, ..Default::default() }).unwrap();
        assert_eq!(off.cache_enabled(), Ok(false));
        let cache = Cache::Location("some/folder".into());
        let moved = context(ContextOptions { cache, ..Default::default() }).unwrap();
        assert_eq!(moved.cache_location(), Ok("some/folder".into()));
    }

    #[test]
    fn a_cache_location_that_is_refused_is_an_error_and_destroys_the_context() {
        let optix = mock::load();
        mock::take_calls();
        mock::fail("optixDeviceContextSetCacheLocation", 7010, "");
        let options = ContextOptions { cache: Cache::Location("nowhere".into()), ..Default::default() };
        // SAFETY: the mock follows no pointers to a CUDA context.
        let error = unsafe { DeviceContext::new(&optix, ptr::null_mut(), options) }.unwrap_err();
        assert!(matches!(error, Error::Call { code: 7010, .. }), "{error}");
        assert_eq!(mock::calls().last().unwrap(), "optixDeviceContextDestroy 1");
    }

    #[test]
    fn a_cache_location_with_a_nul_is_an_error() {
        let options = ContextOptions { cache: Cache::Location("no\0where".into()), ..Default::default() };
        assert_eq!(context(options).unwrap_err(), Error::CacheLocation("no\0where".into()));
    }

    #[test]
    fn a_failed_creation_is_an_error_with_the_drivers_words() {
        let optix = mock::load();
        mock::take_calls();
        mock::fail("optixDeviceContextCreate", 7050, "");
        // SAFETY: the mock follows no pointers to a CUDA context.
        let error = unsafe { DeviceContext::new(&optix, ptr::null_mut(), ContextOptions::default()) }.unwrap_err();
        let Error::Call { function, code, name, message, log } = error else { panic!("another error") };
        assert_eq!((function, code), ("optixDeviceContextCreate", 7050));
        assert_eq!((&*name, &*message, &*log), ("MOCK_ERROR", "a mocked error", ""));
        assert_eq!(mock::calls().len(), 1, "nothing was made, so nothing is destroyed");
    }

    #[test]
    fn messages_reach_the_callback_with_their_level() {
        let messages = Arc::new(Mutex::new(Vec::new()));
        let log: LogCallback = Box::new({
            let messages = Arc::clone(&messages);
            move |level, tag, text| messages.lock().unwrap().push((level, tag.to_owned(), text.to_owned()))
        });
        drop(context(ContextOptions { log: Some(log), ..Default::default() }).unwrap());
        let expected = [(LogLevel::Warning, "CACHE", "created"), (LogLevel::Print, "CONTEXT", "destroyed")];
        let messages = messages.lock().unwrap();
        assert!(messages.iter().map(|(level, tag, text)| (*level, &**tag, &**text)).eq(expected), "{messages:?}");
    }

    #[test]
    fn a_panic_in_the_callback_does_not_reach_the_driver() {
        let log: LogCallback = Box::new(|_, _, _| panic!("on purpose"));
        assert!(context(ContextOptions { log: Some(log), ..Default::default() }).is_ok());
    }
}
