// The folder where PoCL keeps compiled kernels, which it cannot do without.
#pragma once
#include <string>

namespace pliant::opencl {

/// PoCL has no device, or one that cannot compile, where this folder cannot be written. Gives it a folder for this process
/// alone then, removed at the end of the process. To be called before PoCL is asked for its devices; does its work once.
void ensure_pocl_cache();

/// What ensure_pocl_cache found wrong, and what follows from it; empty: nothing, or it was not called.
const std::string& pocl_cache_remark();

}  // namespace pliant::opencl
