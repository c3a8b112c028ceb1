#include "simulation/recovery/calm.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "model/elements/each_element.h"
#include "simulation/recovery/limits.h"

namespace pliant {
namespace {

class Calm {
 public:
  Calm(RunContext& run, double share) : run_(run), share_(share), w_(run.loaded.w()), elements_(run.model().mass.size()) {
    for_each_element(run.model(), [&](const ElementView& e) {
      for (const std::int32_t s : e.slots) elements_[s] = std::min(elements_[s] + 1, 2);
    });
  }

  void element(std::span<const std::int32_t> slots, double volume) {
    const std::vector<double>& mass = run_.model().mass;
    double sum = 0, held = 0;
    bool lone = true;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), held_mean = Eigen::Vector3d::Zero();
    for (const std::int32_t n : slots) {
      const auto s = static_cast<std::size_t>(n);
      lone = lone && elements_[s] == 1;
      if (!moves(s)) {
        held += 1;
        held_mean += increment(s);
        continue;
      }
      sum += mass[s];
      mean += mass[s] * increment(s);
    }
    if (!(sum > 0)) return;
    mean /= sum;
    // Not for links of shape matching, whose nodes move several steps at once while held ones move one.
    if (held > 0 && slots.size() > 2) mean = held_mean / held;
    double most = 0;
    for (const std::int32_t n : slots) {
      const auto s = static_cast<std::size_t>(n);
      if (moves(s)) most = std::max(most, (increment(s) - mean).norm());
    }
    const double edge = std::cbrt(volume), allowed = share_ * (lone ? kLone : 1) * edge;
    done.fastest = std::max(done.fastest, most / edge);
    if (!(most > allowed)) return;
    ++done.elements;
    for (const std::int32_t n : slots) {
      const auto s = static_cast<std::size_t>(n);
      if (moves(s)) increment(s) = mean + allowed / most * (increment(s) - mean);
    }
  }

  void write() { run_.loaded.write_w(w_); }

  Calmed done;

 private:
  [[nodiscard]] bool moves(std::size_t s) const {
    const std::vector<char>& is_free = run_.loaded.free();
    return is_free[3 * s] && is_free[3 * s + 1] && is_free[3 * s + 2];
  }
  [[nodiscard]] Eigen::Map<Eigen::Vector3d> increment(std::size_t s) { return Eigen::Map<Eigen::Vector3d>(w_.data() + 4 * s); }

  RunContext& run_;
  double share_;
  std::vector<double> w_;
  std::vector<int> elements_;  ///< [slots] number of elements: 0, 1, or 2 for more
};

}  // namespace

Calmed calm(RunContext& run, double share) {
  Calm calm(run, share);
  for_each_element(run.model(), [&](const ElementView& e) { calm.element(e.slots, e.volume()); });
  for (const FlsmBatch& batch : run.model().flsm) {
    for (std::size_t i = 0; i < batch.slot.size(); ++i) {
      for (const int side : {1, 3, 5}) {  // the next node along x, y and z
        const std::int32_t n = batch.link[i][side];
        if (n < 0 || static_cast<std::size_t>(n) >= batch.slot.size()) continue;
        const std::int32_t pair[] = {batch.slot[i], batch.slot[static_cast<std::size_t>(n)]};
        calm.element(pair, std::pow(batch.spacing, 3));
      }
    }
  }
  if (calm.done.elements > 0) calm.write();
  return calm.done;
}

}  // namespace pliant
