// The work that contact does on tissue as it parts pairs that began inside each other (kernels/contact/touch_pair.cl).
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// A search lowers the depth that a pair is left, like a tool that advances by as much between two steps: where the pair
/// pushes, that is work, the mean of its forces before and after times the way. What the steps until the next search leave it
/// again (touch_press) takes work back. Reads some buffers at each search.
class PartingWork {
 public:
  explicit PartingWork(const RunContext& run) : run_(run) {}

  /// Call before a search for pairs. `quantum`: of the forces in the step before [N]; 0: they are not known. Returns the work
  /// since the last search, at most 0 [J].
  double before_search(double quantum);
  /// Call after it. `quantum`: of the forces in the step that follows [N].
  void after_search(double quantum);
  /// Returns true after a search until the step that follows it has been counted.
  [[nodiscard]] bool pending() const { return !raised_.empty(); }
  /// Call after that step. Returns the work of the search [J].
  double after_step();
  /// Call where that step is taken back.
  void drop() { raised_.clear(); }

 private:
  /// A pair that is left some depth.
  struct Left {
    std::int32_t lower = 0, upper = 0;  ///< its points
    std::size_t slot = 0;               ///< of the pair at the lower point
    double offset = 0;                  ///< minus the depth that it is left; in raised_ the change of that [m]
    double force = 0;                   ///< part along the normal before the search [N]
  };
  static bool less(const Left& a, const Left& b) { return std::pair(a.lower, a.upper) < std::pair(b.lower, b.upper); }
  static const Left* find(const std::vector<Left>& list, const Left& pair);

  const RunContext& run_;
  std::vector<Left> before_, after_, raised_;  ///< at the last search; before_ and after_ in the order of their points
  double quantum_ = 0;
};

}  // namespace pliant
