// The folder in which PoCL stores compiled kernels, which it requires.
#pragma once
#include <string>

namespace pliant::opencl {

/// If this folder is not writable, PoCL has no device or one that cannot compile. This then sets a private folder, removed at
/// the end of the process. Call before PoCL's devices are listed; runs once.
void ensure_pocl_cache();

/// Returns what ensure_pocl_cache found and its consequence; empty: no problem, or not called.
const std::string& pocl_cache_remark();

}  // namespace pliant::opencl
