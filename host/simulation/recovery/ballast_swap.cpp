#include "simulation/recovery/ballast_swap.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "model/nodes/ballast.h"
#include "schedule/build_program.h"
#include "schedule/surface_program.h"
#include "simulation/state/snapshot.h"
#include "simulation/step/coupling.h"
#include "simulation/step/host_loads.h"

namespace pliant {

void load_with_state(RunContext& run, std::shared_ptr<const Model> model, const Snapshot& snapshot) {
  Program program = build_program(*model, run.program_options());
  Program surface = surface_program(model->surface, program);
  run.loaded.load(std::move(model), std::move(program), std::move(surface));
  write_buffers(snapshot, run.loaded);
  run.place_surface();
}

void load_ballast(RunContext& run, std::vector<NodeInertia> ballast) {
  const std::shared_ptr<const Model> old = run.loaded.shared_model();
  const auto model = std::make_shared<Model>(*old);
  set_ballast(run.scene, *model, ballast);
  const Snapshot before = take_snapshot(run);
  try {
    load_with_state(run, model, before);
  } catch (...) {
    load_with_state(run, old, before);
    throw;
  }
  std::vector<double> u = run.loaded.u(), w = run.loaded.w();
  const std::vector<double>& start = run.loaded.program().at(run.loaded.program().find("node_u")).reals;
  for (std::size_t s = 0; s < model->mass.size(); ++s) {
    if (!(model->mass[s] > 0)) continue;
    u[4 * s + 3] = start[4 * s + 3];  // the inverse mass; 0 for fixed nodes
    const double kept = std::min(1.0, old->mass[s] / model->mass[s]);
    for (std::size_t c = 0; c < 3; ++c) {
      if (run.loaded.free()[3 * s + c]) w[4 * s + c] *= kept;
    }
  }
  run.loaded.write_u(u);
  run.loaded.write_w(w);
  run.state.ballast = std::move(ballast);
  run.state.kept.reset();  // its buffers contain the old masses
  upload_coupling(run);
  if (!run.state.forces.empty()) HostLoads(run).upload();
}

}  // namespace pliant
