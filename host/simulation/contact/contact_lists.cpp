#include "simulation/contact/contact_lists.h"

#include <algorithm>
#include <cmath>

#include "layout.h"
#include "schedule/contact/contact_data.h"

namespace pliant {
namespace {

/// Factor by which increments may grow until the next search; searches include it (contact_near).
constexpr double kFaster = 2.5;
/// ContactLook::room of a tool is the least gap of the tiles that are not near it, less this fraction of the margin.
constexpr double kReserve = 0.5;
/// Pairs of tissue are searched again after motion by this fraction of the margin, or after this many steps.
constexpr double kPairTravel = 0.08;
constexpr std::int64_t kPairSteps = 64;

/// Broad-phase margin as a fraction of a cell.
constexpr double kMargin = 0.25;

}  // namespace

double contact_margin(const Model& model) { return kMargin * model.contact->spacing; }

void ContactLists::update(std::int32_t step_in_batch, const Motion& motion) {
  const std::int64_t step = run_.state.clock.step + step_in_batch;
  const bool tools = !run_.model().tools->empty(), tissue = run_.scene.contact.has_value();
  ContactLook& last = run_.state.look;
  Due due{tools && last.tools < 0, tissue && last.tissue < 0};
  if (step % contact_look_every == 0 && ((tools && !due.tools) || (tissue && !due.tissue))) {
    const Due moved = due_after_motion(step, motion);
    due = {tools && (due.tools || moved.tools), tissue && (due.tissue || moved.tissue)};
  }
  if (due.tools || due.tissue) {
    look(due, step_in_batch, step);
  } else if (loaded_ != run_.loaded.changes()) {
    list(run_.backend().read_ints(run_.loaded.program().find("contact_near")));
  }
}

double ContactLists::largest_increment() {
  for (const Pass& pass : run_.loaded.program().status) {
    if (pass.kernel == "increment_reduce") run_.backend().run(pass, 0);
  }
  const double most = run_.loaded.largest_increment();
  return std::isfinite(most) ? most : 0;  // a lost batch is taken back
}

ContactLists::Due ContactLists::due_after_motion(std::int64_t step, const Motion& motion) {
  ContactLook& look = run_.state.look;
  const double now = run_.state.clock.time_at(step), ahead = contact_look_every * run_.state.clock.dt;
  // Motion since the last check, and possible motion until the next.
  const double nodes = kFaster * contact_look_every * largest_increment();
  Due due;
  for (std::size_t t = 0; t < look.room.size() && look.tools >= 0 && look.tools < step; ++t) {
    look.travel[t] += nodes + motion(t, now - ahead, now);
    due.tools = due.tools || !(look.travel[t] + nodes + motion(t, now, now + ahead) < look.room[t]);
  }
  if (run_.scene.contact && look.tissue >= 0 && look.tissue < step) {
    look.tissue_travel += nodes;
    due.tissue = step - look.tissue >= kPairSteps || !(look.tissue_travel + nodes < kPairTravel * contact_margin(run_.model()));
  }
  return due;
}

void ContactLists::look(const Due& due, std::int32_t step_in_batch, std::int64_t step) {
  if (due.tissue && at_search_) at_search_(true);
  for (const Pass& pass : run_.loaded.program().look) {
    if (pass.kernel == "contact_near" ? due.tools : due.tissue) run_.backend().run(pass, step_in_batch);
  }
  const std::vector<std::int32_t> near = run_.backend().read_ints(run_.loaded.program().find("contact_near"));
  list(near);
  if (due.tissue && at_search_) at_search_(false);
  if (due.tools) {
    run_.state.look.tools = step;
    measure_room(near);
  }
  if (due.tissue) {
    run_.state.look.tissue = step;
    run_.state.look.tissue_travel = 0;
  }
}

void ContactLists::measure_room(const std::vector<std::int32_t>& near) {
  const std::size_t tools = run_.model().tools->size();
  const double margin = contact_margin(run_.model());
  std::vector<double> room(tools, 1e30);
  const std::vector<double> gap = run_.backend().read_reals(run_.loaded.program().find("contact_gap"));
  for (std::size_t tile = 0; tile < near.size(); ++tile) {
    for (std::size_t t = 0; t < tools; ++t) {
      if ((near[tile] >> t & 1) == 0) room[t] = std::min(room[t], gap[tile * tools + t]);
    }
  }
  // If everything is near, search again after a cell of motion, so that the lists become shorter again.
  for (double& r : room) r = r > 1e28 ? 4 * margin : r - kReserve * margin;
  run_.state.look.room = std::move(room);
  run_.state.look.travel.assign(tools, 0);
}

void ContactLists::list(const std::vector<std::int32_t>& near) {
  const Program& program = run_.loaded.program();
  Backend& backend = run_.backend();
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
