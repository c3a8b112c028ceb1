// The backend "cpu:check": the float twins on one thread, with the same bits as "cpu", several times slower. It verifies the
// effect of each pass on the buffers and names a pass that
//   - reads a scratch value that no pass of the step has written (Buffer::carried and Buffer::fixed declare exceptions) or a
//   value
//     outside a buffer: the pass runs in two worlds that differ only in such values, so that everything that depends on one
//     differs between them. Likewise, everything that the host reads must have been written;
//   - writes outside a buffer: guard zones on both sides of each buffer must stay unchanged;
//   - changes a constant or control buffer, or the fixed end of scratch.
// It does not detect reads without effect, nor an integer beyond a buffer's end that only ends an empty loop.
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

/// Opens the backend. Its run() and read functions throw Error (internal) with pass, step, buffer and value; the program must
/// then be loaded again. Throws Error on a processor without hardware fma.
std::unique_ptr<Backend> make_check_backend(const CheckOptions& options = {});

}  // namespace pliant
