#include "simulation/measure/drift.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/disjoint_sets.h"
#include "model/elements/each_element.h"

namespace pliant {
namespace {

void join(DisjointSets& sets, std::span<const std::int32_t> slots) {
  for (const std::int32_t s : slots) sets.join(slots.front(), s);
}

}  // namespace

void Drift::find_loose_pieces() {
  model_ = run_.loaded.shared_model();
  loose_.clear();
  const Model& m = *model_;
  DisjointSets sets(static_cast<std::size_t>(m.slots));
  for_each_element(m, [&](const ElementView& e) { join(sets, e.slots); });
  for (const SpringBatch& batch : m.links.springs) {
    for (std::size_t s = 0; s < batch.size(); ++s) {
      if (!batch.whole(s)) continue;
      for (const std::int32_t p : batch.points[s]) {
        join(sets, m.links.points.slots[p]);
        sets.join(m.links.points.slots[batch.points[s][0]].front(), m.links.points.slots[p].front());
      }
    }
  }
  for (const MembraneBatch& batch : m.links.membranes) {
    for (const auto& triangle : batch.points) {
      for (const std::int32_t p : triangle) {
        join(sets, m.links.points.slots[p]);
        sets.join(m.links.points.slots[triangle[0]].front(), m.links.points.slots[p].front());
      }
    }
  }
  for (const FlsmBatch& batch : m.flsm) join(sets, m.bodies[static_cast<std::size_t>(batch.body)].slot);
  std::vector<char> held(static_cast<std::size_t>(m.slots), false);
  for (const Constraint& c : m.constraints) held[static_cast<std::size_t>(sets.find(c.slot))] = true;
  std::vector<std::int32_t> piece_of(static_cast<std::size_t>(m.slots), -1);
  for (std::int32_t s = 0; s < static_cast<std::int32_t>(m.mass.size()); ++s) {
    const auto set = static_cast<std::size_t>(sets.find(s));
    if (!(m.mass[static_cast<std::size_t>(s)] > 0) || held[set]) continue;
    if (piece_of[set] < 0) {
      piece_of[set] = static_cast<std::int32_t>(loose_.size());
      loose_.emplace_back();
    }
    loose_[static_cast<std::size_t>(piece_of[set])].slots.push_back(s);
  }
  for (Piece& piece : loose_) {
    for (std::size_t c = 0; c < 3; ++c) {
      double low = std::numeric_limits<double>::max(), high = -low;
      for (const std::int32_t s : piece.slots) {
        low = std::min(low, m.rest[static_cast<std::size_t>(s)][c]);
        high = std::max(high, m.rest[static_cast<std::size_t>(s)][c]);
      }
      piece.size = std::max(piece.size, high - low);
    }
  }
  std::erase_if(loose_, [](const Piece& piece) { return !(piece.size > 0); });
}

void Drift::follow() {
  // Integrators that store earlier displacements, and relaxation, would need these shifted as well.
  if (!integrator_info(run_.scene.integrator).keeps_increment || run_.scene.relaxation.enabled) return;
  if (model_ != run_.loaded.shared_model()) find_loose_pieces();
  if (loose_.empty()) return;
  std::vector<double> u = run_.loaded.u();
  std::vector<double>& offset = run_.state.offset;
  const std::vector<double> before = offset;
  for (const Piece& piece : loose_) {
    const double unit = std::ldexp(1.0, std::ilogb(piece.size) - 4);
    for (std::size_t c = 0; c < 3; ++c) {
      double mean = 0;
      for (const std::int32_t s : piece.slots) mean += u[4 * static_cast<std::size_t>(s) + c];
      mean /= static_cast<double>(piece.slots.size());
      if (!(std::abs(mean) > piece.size)) continue;  // also skips NaN
      const double flown = unit * std::round(mean / unit);
      if (offset.empty()) offset.resize(3 * static_cast<std::size_t>(run_.model().slots));
      for (const std::int32_t s : piece.slots) {
        u[4 * static_cast<std::size_t>(s) + c] -= flown;
        offset[3 * static_cast<std::size_t>(s) + c] += flown;
      }
    }
  }
  if (offset == before) return;
  run_.loaded.write_u(u);
  move_references(before);
  run_.place_surface();
}

void Drift::move_references(const std::vector<double>& before) {
  const std::vector<FlsmBatch>& batches = run_.model().flsm;
  for (std::size_t i = 0; i < batches.size(); ++i) {
    const BufferId id = run_.loaded.program().find(fmt::format("flsm_reference/{}", i));
    if (id < 0) continue;
    std::vector<double> reference = run_.backend().read_reals(id);
    const std::size_t first = 3 * static_cast<std::size_t>(batches[i].slot.front());
    for (std::size_t c = 0; c < 3; ++c) {
      const double flown = run_.state.offset[first + c] - (before.empty() ? 0 : before[first + c]);
      reference[c] -= flown;
      reference[4 + c] -= flown;
    }
    run_.backend().write_reals(id, reference);
  }
}

}  // namespace pliant
