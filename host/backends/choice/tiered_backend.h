// A backend for a World on a machine without a GPU: the twins compute until the kernels of an OpenCL processor are compiled,
// then OpenCL does. Both compute the same bits, so nobody sees when they change, except by the clock.
#pragma once
#include <memory>

#include "backends/interface/backend.h"

namespace pliant {

/// `twins` and `opencl` are bit-exact and compute in float; `device` is the N of opencl:N. The result has the properties of
/// `opencl`.
///
/// It goes back to the twins where a changed program (a cut, a tool that comes) has kernels that were not launched yet, unless
/// all first ones came from the cache on disk: then the others most likely do, and a launch takes less time than two changes.
/// If the device fails to build a kernel or has no memory, the twins go on, and remark() has the reason.
std::unique_ptr<Backend> make_tiered_backend(std::unique_ptr<Backend> twins, std::unique_ptr<Backend> opencl, int device);

}  // namespace pliant
