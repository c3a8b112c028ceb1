#include "simulation/contact_lists.h"

#include <algorithm>
#include <cmath>

#include "layout.h"
#include "schedule/contact_data.h"

namespace pliant {
namespace {

/// Increments may grow until the next look, by so much; a look also counts on it (contact_near).
constexpr double kFaster = 2.5;
/// What is not near may come nearer by the margin less this share of it before a look is due.
constexpr double kReserve = 0.5;
/// Pairs of tissue are looked for again when they have moved by this share of the margin, or after so many steps.
constexpr double kPairTravel = 0.08;
constexpr std::int64_t kPairSteps = 64;

/// Share of a cell.
constexpr double kMargin = 0.25;

}  // namespace

double contact_margin(const Model& model) { return kMargin * model.contact->spacing; }

void ContactLists::update(std::int32_t step_in_batch, const Motion& motion) {
  const std::int64_t step = run_.state.clock.step + step_in_batch;
  if (run_.loaded.take_updated()) forget();
  if (run_.state.look.step < 0 || (step % contact_look_every == 0 && due(step, motion))) {
    look(step_in_batch, step);
  } else if (loaded_ != run_.loaded.changes()) {
    list();
  }
}

double ContactLists::largest_increment() {
  for (const Pass& pass : run_.loaded.program().status) {
    if (pass.kernel == "increment_reduce") run_.backend().run(pass, 0);
  }
  return run_.loaded.largest_increment();
}

bool ContactLists::due(std::int64_t step, const Motion& motion) {
  ContactLook& look = run_.state.look;
  const std::int64_t since = step - look.step;
  if (since <= 0) return false;
  const double now = run_.state.clock.time_at(step), h = run_.state.clock.dt;
  const double nodes = kFaster * contact_look_every * largest_increment();
  bool any = run_.scene.contact && since >= kPairSteps;
  for (std::size_t k = 0; k < look.room.size(); ++k) {
    const bool tool = k + 1 < look.room.size() || !run_.scene.contact;
    // What has moved since the last question, and what may move until the next.
    const double before = tool ? motion(k, now - contact_look_every * h, now) : nodes;
    const double after = tool ? motion(k, now, now + contact_look_every * h) : nodes;
    look.travel[k] += nodes + before;
    any = any || !(look.travel[k] + nodes + after < look.room[k]);
  }
  return any;
}

void ContactLists::look(std::int32_t step_in_batch, std::int64_t step) {
  for (const Pass& pass : run_.loaded.program().look) run_.backend().run(pass, step_in_batch);
  run_.state.look.step = step;
  list();
  const BufferId near = run_.loaded.program().find("contact_near");
  measure_room(run_.backend().read_ints(near));
}

void ContactLists::measure_room(const std::vector<std::int32_t>& near) {
  const Program& program = run_.loaded.program();
  const std::size_t tools = run_.model().tools->size();
  const double margin = contact_margin(run_.model());
  std::vector<double> room(tools, 1e30);
  if (tools > 0) {
    const std::vector<double> gap = run_.backend().read_reals(program.find("contact_gap"));
    for (std::size_t tile = 0; tile < near.size(); ++tile) {
      for (std::size_t t = 0; t < tools; ++t) {
        if ((near[tile] >> t & 1) == 0) room[t] = std::min(room[t], gap[tile * tools + t]);
      }
    }
  }
  // Where all is near, it is asked again after a few cells, so that the lists become shorter again.
  for (double& r : room) r = std::min(r, 1e29) - kReserve * margin;
  for (double& r : room) r = r > 1e28 ? 4 * margin : r;
  if (run_.scene.contact) room.push_back(kPairTravel * margin);
  run_.state.look.room = std::move(room);
  run_.state.look.travel.assign(run_.state.look.room.size(), 0);
}

void ContactLists::list() {
  const Program& program = run_.loaded.program();
  Backend& backend = run_.backend();
  const std::vector<std::int32_t> near = backend.read_ints(program.find("contact_near"));
  std::vector<std::int32_t> points, nodes;
  for (std::size_t tile = 0; tile < near.size(); ++tile) {
    if (near[tile] != 0) points.push_back(static_cast<std::int32_t>(tile));
  }
  const std::vector<std::int32_t>& offset = program.at(program.find("contact_tiles_offset")).ints;
  const std::vector<std::int32_t>& tiles = program.at(program.find("contact_tiles")).ints;
  for (std::size_t n = 0; n + 1 < offset.size() && !points.empty(); ++n) {
    const auto is_near = [&](std::int32_t tile) { return near[static_cast<std::size_t>(tile)] != 0; };
    if (std::any_of(tiles.begin() + offset[n], tiles.begin() + offset[n + 1], is_near))
      nodes.push_back(static_cast<std::int32_t>(n));
  }
  *program.near_points = static_cast<std::int64_t>(points.size()) * PLIANT_TILE;
  *program.near_nodes = static_cast<std::int64_t>(nodes.size()) * PLIANT_TILE;
  const auto write = [&](const char* name, std::vector<std::int32_t> list) {
    const BufferId id = program.find(name);
    list.resize(program.at(id).count, -1);
    backend.write_ints(id, list);
  };
  write("contact_list", std::move(points));
  write("contact_node_list", std::move(nodes));
  loaded_ = run_.loaded.changes();
}

}  // namespace pliant
