//! The mocked functions: each notes its name and arguments and answers as the driver would.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;

use super::DRIVER;
use super::describe::describe_build;
use crate::sys;
use crate::table::FunctionTable;

/// Notes a call; returns its result code.
fn note(function: &'static str, arguments: &str) -> i32 {
    DRIVER.with_borrow_mut(|driver| {
        driver.calls.push(format!("{function} {arguments}"));
        driver.failure.as_ref().filter(|(failing, ..)| *failing == function).map_or(0, |(_, code, _)| *code)
    })
}

/// Notes a call that fills in a handle.
unsafe fn create(function: &'static str, arguments: &str, handle: *mut *mut c_void) -> i32 {
    let code = note(function, arguments);
    if code == 0 {
        let number = DRIVER.with_borrow_mut(|driver| {
            driver.handles += 1;
            driver.handles
        });
        // SAFETY: callers pass a pointer to a handle, which is a transparent pointer.
        unsafe { *handle = ptr::without_provenance_mut(number) };
    }
    code
}

/// Writes a failure's log as the driver does: what fits, NUL-terminated; the size is that of the whole.
unsafe fn write_log(function: &str, log: *mut c_char, size: *mut usize) {
    let text = DRIVER.with_borrow(|driver| match &driver.failure {
        Some((failing, _, text)) if *failing == function => text.clone(),
        _ => String::new(),
    });
    // SAFETY: callers pass a buffer and its size.
    unsafe {
        let fitting = text.len().min(*size - 1);
        ptr::copy_nonoverlapping(text.as_ptr().cast(), log, fitting);
        *log.add(fitting) = 0;
        *size = text.len() + 1;
    }
}

unsafe fn c_str(pointer: *const c_char) -> String {
    // SAFETY: callers pass a string.
    unsafe { CStr::from_ptr(pointer) }.to_str().expect("tests use UTF-8").to_owned()
}

pub unsafe extern "C" fn query_function_table(
    abi: i32,
    num_options: u32,
    _keys: *const c_void,
    _values: *const c_void,
    table: *mut *const c_void,
    bytes: usize,
) -> i32 {
    let code = note("optixQueryFunctionTable", &format!("abi={abi} options={num_options} bytes={bytes}"));
    if code != 0 {
        return code;
    }
    // SAFETY: the loader passes room for `bytes`.
    let table = unsafe { std::slice::from_raw_parts_mut(table, bytes / size_of::<*const c_void>()) };
    // The slots are written down a second time, so that a slip in one of the two lists fails every test.
    macro_rules! fill {
        ($($name:ident: $slot:literal),* $(,)?) => {
            // Through the typed table, so that a function of another type than the slot's does not compile.
            let typed = FunctionTable { $($name),* };
            $(table[$slot] = typed.$name as *const c_void;)*
        };
    }
    fill! {
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
    }
    0
}

unsafe extern "C" fn get_error_name(_code: i32) -> *const c_char {
    c"MOCK_ERROR".as_ptr()
}

unsafe extern "C" fn get_error_string(_code: i32) -> *const c_char {
    c"a mocked error".as_ptr()
}

unsafe extern "C" fn context_create(
    _cu_context: *mut c_void,
    options: *const sys::ContextOptions,
    context: *mut sys::ContextHandle,
) -> i32 {
    // SAFETY: as the driver's contract says.
    let options = unsafe { &*options };
    let log = options.log_function;
    let arguments = format!("log={} level={} validation={:#x}", log.is_some(), options.log_level, options.validation);
    if let Some(log) = log {
        DRIVER.with_borrow_mut(|driver| driver.log = Some((log, options.log_data)));
        // SAFETY: as the driver's contract says.
        unsafe { log(3, c"CACHE".as_ptr(), c"created\n".as_ptr(), options.log_data) };
    }
    // SAFETY: as the driver's contract says.
    unsafe { create("optixDeviceContextCreate", &arguments, context.cast()) }
}

unsafe extern "C" fn context_destroy(context: sys::ContextHandle) -> i32 {
    if let Some((log, data)) = DRIVER.with_borrow_mut(|driver| driver.log.take()) {
        // SAFETY: as the driver's contract says.
        unsafe { log(4, c"CONTEXT".as_ptr(), c"destroyed".as_ptr(), data) };
    }
    note("optixDeviceContextDestroy", &context.0.addr().to_string())
}

unsafe extern "C" fn context_get_property(
    _context: sys::ContextHandle,
    property: u32,
    value: *mut c_void,
    bytes: usize,
) -> i32 {
    let answer = match property {
        sys::PROPERTY_RTCORE_VERSION => 0,
        sys::PROPERTY_MAX_PRIMITIVES_PER_GAS => 1 << 29,
        sys::PROPERTY_MAX_INSTANCES_PER_IAS => 1 << 28,
        _ => (1 << 28) - 1,
    };
    // SAFETY: as the driver's contract says.
    unsafe { *value.cast::<u32>() = answer };
    note("optixDeviceContextGetProperty", &format!("{property:#x} bytes={bytes}"))
}

unsafe extern "C" fn context_set_cache_enabled(_context: sys::ContextHandle, enabled: i32) -> i32 {
    DRIVER.with_borrow_mut(|driver| driver.cache_off = enabled == 0);
    note("optixDeviceContextSetCacheEnabled", &enabled.to_string())
}

unsafe extern "C" fn context_set_cache_location(_context: sys::ContextHandle, location: *const c_char) -> i32 {
    // SAFETY: as the driver's contract says.
    let location = unsafe { c_str(location) };
    DRIVER.with_borrow_mut(|driver| driver.cache_location = location.clone().into_bytes());
    note("optixDeviceContextSetCacheLocation", &location)
}

unsafe extern "C" fn context_get_cache_enabled(_context: sys::ContextHandle, enabled: *mut i32) -> i32 {
    // SAFETY: as the driver's contract says.
    unsafe { *enabled = i32::from(DRIVER.with_borrow(|driver| !driver.cache_off)) };
    note("optixDeviceContextGetCacheEnabled", "")
}

unsafe extern "C" fn context_get_cache_location(
    _context: sys::ContextHandle,
    location: *mut c_char,
    size: usize,
) -> i32 {
    let text = DRIVER.with_borrow(|driver| driver.cache_location.clone());
    assert!(text.len() < size);
    // SAFETY: as the driver's contract says, and the text fits.
    unsafe {
        ptr::copy_nonoverlapping(text.as_ptr().cast(), location, text.len());
        *location.add(text.len()) = 0;
    }
    note("optixDeviceContextGetCacheLocation", "")
}

unsafe extern "C" fn module_create(
    context: sys::ContextHandle,
    options: *const sys::ModuleOptions,
    pipeline: *const sys::PipelineOptions,
    ptx: *const c_char,
    len: usize,
    log: *mut c_char,
    log_size: *mut usize,
    module: *mut sys::ModuleHandle,
) -> i32 {
    // SAFETY: as the driver's contract says.
    let (options, pipeline, ptx) =
        unsafe { (&*options, &*pipeline, std::slice::from_raw_parts(ptx.cast::<u8>(), len)) };
    let arguments = format!(
        "{} registers={} graph={} payload={} attributes={} params={} primitives={:#x} ptx={}",
        context.0.addr(),
        options.max_registers,
        pipeline.graph_flags,
        pipeline.num_payload,
        pipeline.num_attributes,
        // SAFETY: as the driver's contract says.
        unsafe { c_str(pipeline.params_name) },
        pipeline.primitive_flags,
        String::from_utf8_lossy(ptx)
    );
    // SAFETY: as the driver's contract says.
    unsafe {
        write_log("optixModuleCreate", log, log_size);
        create("optixModuleCreate", &arguments, module.cast())
    }
}

unsafe extern "C" fn module_destroy(module: sys::ModuleHandle) -> i32 {
    note("optixModuleDestroy", &module.0.addr().to_string())
}

unsafe extern "C" fn builtin_is_module_get(
    context: sys::ContextHandle,
    _options: *const sys::ModuleOptions,
    pipeline: *const sys::PipelineOptions,
    builtin: *const sys::BuiltinIsOptions,
    module: *mut sys::ModuleHandle,
) -> i32 {
    // SAFETY: as the driver's contract says.
    unsafe {
        let (pipeline, builtin) = (&*pipeline, &*builtin);
        let arguments = format!(
            "{} primitive={:#x} flags={} primitives={:#x}",
            context.0.addr(),
            builtin.primitive,
            builtin.build_flags,
            pipeline.primitive_flags
        );
        create("optixBuiltinISModuleGet", &arguments, module.cast())
    }
}

unsafe extern "C" fn program_group_create(
    context: sys::ContextHandle,
    description: *const sys::ProgramGroupDesc,
    count: u32,
    options: *const sys::ProgramGroupOptions,
    log: *mut c_char,
    log_size: *mut usize,
    group: *mut sys::ProgramGroupHandle,
) -> i32 {
    assert_eq!((count, options.is_null()), (1, false));
    // SAFETY: as the driver's contract says.
    let description = unsafe { &*description };
    let programs = description.programs.map(|program| {
        let module = program.module.0.addr();
        match (module, program.entry.is_null()) {
            (0, true) => "-".to_owned(),
            (_, true) => format!("{module}:"),
            // SAFETY: as the driver's contract says.
            (_, false) => format!("{module}:{}", unsafe { c_str(program.entry) }),
        }
    });
    let arguments = format!("{} kind={:#x} [{}]", context.0.addr(), description.kind, programs.join(", "));
    // SAFETY: as the driver's contract says.
    unsafe {
        write_log("optixProgramGroupCreate", log, log_size);
        create("optixProgramGroupCreate", &arguments, group.cast())
    }
}

unsafe extern "C" fn program_group_destroy(group: sys::ProgramGroupHandle) -> i32 {
    note("optixProgramGroupDestroy", &group.0.addr().to_string())
}

unsafe extern "C" fn program_group_get_stack_size(
    group: sys::ProgramGroupHandle,
    sizes: *mut sys::StackSizes,
    pipeline: sys::PipelineHandle,
) -> i32 {
    let number = u32::try_from(group.0.addr()).expect("handles are small");
    let answer = sys::StackSizes {
        raygen: 10 * number,
        miss: number,
        closest_hit: number,
        any_hit: 2 * number,
        intersection: 3 * number,
        continuation_callable: 0,
        direct_callable: 0,
    };
    // SAFETY: as the driver's contract says.
    unsafe { *sizes = answer };
    note("optixProgramGroupGetStackSize", &format!("{number} pipeline={}", pipeline.0.addr()))
}

unsafe extern "C" fn pipeline_create(
    context: sys::ContextHandle,
    options: *const sys::PipelineOptions,
    link: *const sys::LinkOptions,
    groups: *const sys::ProgramGroupHandle,
    count: u32,
    log: *mut c_char,
    log_size: *mut usize,
    pipeline: *mut sys::PipelineHandle,
) -> i32 {
    // SAFETY: as the driver's contract says.
    unsafe {
        let groups = std::slice::from_raw_parts(groups, count as usize);
        let groups: Vec<_> = groups.iter().map(|group| group.0.addr()).collect();
        let (depth, graph) = ((*link).max_trace_depth, (*options).graph_flags);
        let arguments = format!("{} depth={depth} graph={graph} groups={groups:?}", context.0.addr());
        write_log("optixPipelineCreate", log, log_size);
        create("optixPipelineCreate", &arguments, pipeline.cast())
    }
}

unsafe extern "C" fn pipeline_destroy(pipeline: sys::PipelineHandle) -> i32 {
    note("optixPipelineDestroy", &pipeline.0.addr().to_string())
}

unsafe extern "C" fn pipeline_set_stack_size(
    pipeline: sys::PipelineHandle,
    from_traversal: u32,
    from_state: u32,
    continuation: u32,
    graph_depth: u32,
) -> i32 {
    let pipeline = pipeline.0.addr();
    let direct = format!("{from_traversal},{from_state}");
    let arguments = format!("{pipeline} direct={direct} continuation={continuation} depth={graph_depth}");
    note("optixPipelineSetStackSize", &arguments)
}

unsafe extern "C" fn accel_compute_memory_usage(
    context: sys::ContextHandle,
    options: *const sys::AccelOptions,
    inputs: *const sys::BuildInput,
    count: u32,
    sizes: *mut sys::AccelSizes,
) -> i32 {
    // SAFETY: as the driver's contract says; tests ask for the sizes of boxes only.
    unsafe {
        let primitives = (*inputs).data.aabbs.count as usize;
        *sizes = sys::AccelSizes { output: 80 * primitives, temp: 48 * primitives, temp_update: 24 * primitives };
        let build = describe_build(options, inputs, count);
        note("optixAccelComputeMemoryUsage", &format!("{} {build}", context.0.addr()))
    }
}

unsafe extern "C" fn accel_build(
    context: sys::ContextHandle,
    stream: *mut c_void,
    options: *const sys::AccelOptions,
    inputs: *const sys::BuildInput,
    count: u32,
    temp: u64,
    temp_size: usize,
    output: u64,
    output_size: usize,
    handle: *mut u64,
    emit: *const sys::Emit,
    num_emit: u32,
) -> i32 {
    // SAFETY: as the driver's contract says.
    unsafe {
        let emit: &[sys::Emit] = if num_emit == 0 { &[] } else { std::slice::from_raw_parts(emit, num_emit as usize) };
        let emit: Vec<_> = emit.iter().map(|emit| format!("{:#x}:{:#x}", emit.result, emit.kind)).collect();
        *handle = output + 1;
        let build = describe_build(options, inputs, count);
        let (context, stream) = (context.0.addr(), stream.addr());
        let memory = format!("temp={temp:#x}+{temp_size} output={output:#x}+{output_size}");
        let emit = emit.join(", ");
        note("optixAccelBuild", &format!("{context} stream={stream:#x} {build} {memory} emit=[{emit}]"))
    }
}

unsafe extern "C" fn accel_compact(
    context: sys::ContextHandle,
    stream: *mut c_void,
    input: u64,
    output: u64,
    output_size: usize,
    handle: *mut u64,
) -> i32 {
    // SAFETY: as the driver's contract says.
    unsafe { *handle = output + 1 };
    let (context, stream) = (context.0.addr(), stream.addr());
    let arguments = format!("{context} stream={stream:#x} handle={input:#x} output={output:#x}+{output_size}");
    note("optixAccelCompact", &arguments)
}

unsafe extern "C" fn sbt_record_pack_header(group: sys::ProgramGroupHandle, header: *mut c_void) -> i32 {
    let number = u8::try_from(group.0.addr()).expect("handles are small");
    // SAFETY: as the driver's contract says.
    unsafe { header.cast::<[u8; sys::SBT_HEADER_SIZE]>().write_unaligned([number; sys::SBT_HEADER_SIZE]) };
    note("optixSbtRecordPackHeader", &format!("{number} address%16={}", header.addr() % 16))
}

unsafe extern "C" fn launch(
    pipeline: sys::PipelineHandle,
    stream: *mut c_void,
    params: u64,
    params_size: usize,
    sbt: *const sys::ShaderBindingTable,
    width: u32,
    height: u32,
    depth: u32,
) -> i32 {
    // SAFETY: as the driver's contract says.
    let sbt = unsafe { &*sbt };
    let miss = format!("{:#x}/{}x{}", sbt.miss, sbt.miss_stride, sbt.miss_count);
    let hit = format!("{:#x}/{}x{}", sbt.hit, sbt.hit_stride, sbt.hit_count);
    let (pipeline, stream, raygen) = (pipeline.0.addr(), stream.addr(), sbt.raygen);
    let table = format!("raygen={raygen:#x} miss={miss} hit={hit}");
    let params = format!("{params:#x}+{params_size}");
    note("optixLaunch", &format!("{pipeline} stream={stream:#x} params={params} {table} {width}x{height}x{depth}"))
}
