// Accesses where there is no memory, as errors of the launch instead of the end of the process.

#pragma once

namespace emulator {

// From now on, in all threads of the operating system.
void report_faults();

} // namespace emulator
