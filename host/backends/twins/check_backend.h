// The backend "cpu:check": the float twins on one thread, with the bits of "cpu", several times slower. It looks at what each
// pass does to the buffers and names the pass that
//   - reads a value of scratch that no pass of the step has written (Buffer::carried and Buffer::fixed say what else may be
//     read), or a value outside a buffer: the pass runs in two worlds that differ in nothing but such values, so that whatever
//     depends on one differs between them. Likewise, what the host reads must have been written;
//   - writes outside a buffer: there are zones on both sides of each that nothing may write;
//   - changes a constant or control buffer, or the fixed end of scratch.
// What a pass reads without effect is not noticed, nor is an integer beyond a buffer's end that only ends an empty loop.
#pragma once
#include <memory>

#include "backends/interface/backend.h"

namespace pliant {

namespace ref {
class Registry;
}

struct CheckOptions {
  bool probe = true;                        ///< run the known-answer probe
  const ref::Registry* registry = nullptr;  ///< nullptr: the twins of kernels/. Must outlive the backend.
};

/// Its run() and read functions throw Error (internal) that names pass, step, buffer and value; the program must then be loaded
/// again. Throws Error on a processor without hardware fma.
std::unique_ptr<Backend> make_check_backend(const CheckOptions& options = {});

}  // namespace pliant
