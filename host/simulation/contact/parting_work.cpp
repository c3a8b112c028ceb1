#include "simulation/contact/parting_work.h"

#include <algorithm>
#include <utility>

#include "geometry/vec.h"
#include "layout.h"
#include "schedule/program_layout.h"

namespace pliant {
namespace {

constexpr std::size_t kSlots = PLIANT_TOUCH_SLOTS;

std::vector<std::int32_t> ints(const RunContext& run, const char* name) {
  return run.backend().read_ints(run.loaded.program().find(name));
}
std::vector<double> reals(const RunContext& run, const char* name) {
  return run.backend().read_reals(run.loaded.program().find(name));
}

/// Visits the pairs at their lower points: lower, upper, slot, minus the depth that it is left.
template <class Visit>
void for_pairs(const RunContext& run, const Visit& visit) {
  const std::vector<std::int32_t> near = ints(run, "contact_near");
  const auto touches = [](std::int32_t tile) { return (tile & PLIANT_TOUCH_BIT) != 0; };
  if (std::none_of(near.begin(), near.end(), touches)) return;  // without reading megabytes of pairs
  const std::vector<std::int32_t> partner = ints(run, "touch_partner");
  const std::vector<double> pair = reals(run, "touch_pair");
  for (std::size_t i = 0; i < run.model().contact->size(); ++i) {
    if (!touches(near[i / PLIANT_TILE])) continue;
    for (std::size_t s = 0; s < kSlots; ++s) {
      const std::int32_t j = partner[tile_base(i, kSlots) + s * PLIANT_TILE] - 1;
      if (j < 0) break;
      const double* numbers = &pair[tile_base(i, kSlots * PLIANT_TOUCH_PAIR) + s * PLIANT_TOUCH_PAIR * PLIANT_TILE];
      if (static_cast<std::size_t>(j) > i && numbers[0] > 0) visit(static_cast<std::int32_t>(i), j, s, numbers[PLIANT_TILE]);
    }
  }
}

/// The forces of the last step.
class Pushes {
 public:
  Pushes(const RunContext& run, double quantum)
      : quantum_(quantum), force_(ints(run, "touch_force")), place_(reals(run, "touch_place")) {}
  /// Returns the part along the normal [N].
  [[nodiscard]] double of(std::int32_t lower, std::int32_t upper, std::size_t slot) const {
    const std::int32_t* f = &force_[tile_base(static_cast<std::size_t>(lower), kSlots * PLIANT_TOUCH_FORCE) +
                                    slot * PLIANT_TOUCH_FORCE * PLIANT_TILE];
    if (f[std::ptrdiff_t{3} * PLIANT_TILE] == 0) return 0;
    const Vec3d push{double(f[0]), double(f[PLIANT_TILE]), double(f[std::ptrdiff_t{2} * PLIANT_TILE])};
    const Vec3d facing = vec::sub(normal(upper), normal(lower));
    const double length = vec::norm(facing);
    return length > 0 ? std::max(0.0, quantum_ * vec::dot(push, facing) / length) : 0;
  }

 private:
  [[nodiscard]] Vec3d normal(std::int32_t point) const {
    const double* n = &place_[static_cast<std::size_t>(point) * PLIANT_TOUCH_PLACE + 8];
    return {n[0], n[1], n[2]};
  }
  double quantum_;
  std::vector<std::int32_t> force_;
  std::vector<double> place_;
};

}  // namespace

const PartingWork::Left* PartingWork::find(const std::vector<Left>& list, const Left& pair) {
  const auto found = std::lower_bound(list.begin(), list.end(), pair, less);
  return found != list.end() && !less(pair, *found) ? &*found : nullptr;
}

double PartingWork::before_search(double quantum) {
  before_.clear();
  for_pairs(run_, [&](std::int32_t i, std::int32_t j, std::size_t slot, double offset) {
    if (offset < 0) before_.push_back({i, j, slot, offset, 0});
  });
  std::sort(before_.begin(), before_.end(), less);
  if (before_.empty() || !(quantum > 0)) return 0;
  const Pushes pushes(run_, quantum);
  double sum = 0;
  for (Left& l : before_) {
    l.force = pushes.of(l.lower, l.upper, l.slot);
    if (const Left* then = find(after_, l)) sum += l.force * std::min(0.0, l.offset - then->offset);
  }
  return sum;
}

void PartingWork::after_search(double quantum) {
  quantum_ = quantum;
  raised_.clear();
  after_.clear();
  if (before_.empty()) return;
  for_pairs(run_, [&](std::int32_t i, std::int32_t j, std::size_t slot, double offset) {
    const Left now{i, j, slot, offset, 0};
    const Left* had = find(before_, now);
    if (had != nullptr || offset < 0) after_.push_back(now);
    if (had != nullptr && offset > had->offset) raised_.push_back({i, j, slot, offset - had->offset, had->force});
  });
  std::sort(after_.begin(), after_.end(), less);
}

double PartingWork::after_step() {
  if (raised_.empty()) return 0;
  const Pushes pushes(run_, quantum_);
  double sum = 0;
  for (const Left& l : raised_) sum += 0.5 * (l.force + pushes.of(l.lower, l.upper, l.slot)) * l.offset;
  raised_.clear();
  return sum;
}

}  // namespace pliant
