// Model -> Program: lay the data out in texel buffers and list the passes of a step.
#pragma once
#include "model/model.h"
#include "program/program.h"

namespace pliant {

struct ProgramOptions {
  Integrator integrator = Integrator::increment;
  std::int32_t batch_steps = 64;  ///< steps that one batch may hold: rows of curve_value
  bool surface_follows = false;   ///< the model has no surface yet, and set_surface supplies it; not with pressures
};

/// Build the buffer table and the Schedule of a model. Only what the model needs is in it.
Program build_program(const Model& model, const ProgramOptions& options = {});

/// What ProgramOptions::surface_follows left open. With `changes`, the buffers hold what they held before an edit already, only
/// what is listed differs, and Buffer::changed says so.
void set_surface(const ModelSurface& surface, Program& program, const SurfaceChanges* changes = nullptr);

/// Which element a position in the `fault` buffer means, or which node that shape matching moves.
struct FaultPlace {
  std::int32_t body = -1;
  std::int64_t element = -1;  ///< number in its body
  bool node = false;          ///< `element` is the number of a node
};
FaultPlace find_fault(const Model& model, std::int32_t fault_index);

}  // namespace pliant
