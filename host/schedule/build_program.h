// Model to Program: arranges the data in texel buffers and lists the passes of a step.
#pragma once
#include "model/model.h"
#include "program/program.h"

namespace pliant {

struct ProgramOptions {
  Integrator integrator = Integrator::increment;
  std::int32_t batch_steps = 64;   ///< maximum number of steps of a batch: rows of curve_value
  std::int32_t blades = 0;         ///< blades that cut by force
  std::int32_t blade_samples = 0;  ///< samples of their edges, of all together
};

/// Builds the buffer table and the Schedule of a model, with only the buffers and passes that the model needs. The surface has
/// its own Program (surface_program.h) unless a pressure acts on it.
Program build_program(const Model& model, const ProgramOptions& options = {});

/// The element, or the node moved by shape matching, at a position in the `fault` buffer.
struct FaultLocation {
  std::int32_t body = -1;
  std::int64_t element = -1;  ///< index in its body
  bool node = false;          ///< true if `element` is the index of a node
};
FaultLocation find_fault(const Model& model, std::int32_t fault_index);

}  // namespace pliant
