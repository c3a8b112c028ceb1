// Model -> Program: lay the data out in texel buffers and list the passes of a step.
#pragma once
#include "model/model.h"
#include "program/program.h"

namespace pliant {

struct ProgramOptions {
  Integrator integrator = Integrator::increment;
  std::int32_t batch_steps = 64;  ///< steps that one batch may hold: rows of curve_value
};

/// Build the buffer table and the Schedule of a model. Only what the model needs is in it: the surface is a Program of its own
/// (surface_program.h) unless a pressure acts on it.
Program build_program(const Model& model, const ProgramOptions& options = {});

/// Which element a position in the `fault` buffer means, or which node that shape matching moves.
struct FaultLocation {
  std::int32_t body = -1;
  std::int64_t element = -1;  ///< number in its body
  bool node = false;          ///< `element` is the number of a node
};
FaultLocation find_fault(const Model& model, std::int32_t fault_index);

}  // namespace pliant
