// A scene on the double backend with what the parts of a Simulation share, and no Simulation around it.
#pragma once
#include <memory>
#include <utility>

#include "backends/choice/backends.h"
#include "schedule/build_program.h"
#include "schedule/surface_program.h"
#include "simulation/state/run_context.h"

namespace pliant {

struct Loaded {
  explicit Loaded(Scene of) : scene(std::move(of)), loaded(open_backend("cpu:double")) {
    const auto model = std::make_shared<const Model>(build_model(scene));
    Program program = build_program(*model, {scene.integrator, settings.batch_steps});
    Program surface = surface_program(model->surface, program);
    loaded.load(model, std::move(program), std::move(surface));
    state.clock.dt = 1e-3;
  }
  Scene scene;
  RunSettings settings;
  LoadedModel loaded;
  RunState state;
  RunContext run{scene, settings, loaded, state};
};

}  // namespace pliant
