// Broad phase of contact: searches now and then for contact points near something, and lists their tiles for the contact
// passes.
#pragma once
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Broad-phase margin [m]: a point counts as near a tool within this distance, in addition to the distance travelled until
/// the next search.
double contact_margin(const Model& model);

/// A search (Program::look) takes place at multiples of contact_look_every steps, and only if something may have moved far
/// enough since the last one to come near. The contact passes then run over the listed tiles, or not at all if there are
/// none.
class ContactLists {
 public:
  /// Upper bound of the distance that any point of a tool moves between two times [m].
  using Motion = std::function<double(std::size_t tool, double from, double to)>;

  explicit ContactLists(RunContext& run) : run_(run) {}

  /// Call before each step of the current batch. Searches if a search is due; rebuilds the lists if the model or state was
  /// replaced.
  void update(std::int32_t step_in_batch, const Motion& motion);
  /// Called before (true) and after (false) a search for pairs of tissue.
  using AtSearch = std::function<void(bool before)>;
  /// `at_search` may be empty.
  void follow_searches(AtSearch at_search) { at_search_ = std::move(at_search); }

 private:
  /// Which searches are due.
  struct Due {
    bool tools = false, tissue = false;
  };
  [[nodiscard]] Due due_after_motion(std::int64_t step, const Motion& motion);
  [[nodiscard]] double largest_increment();
  void look(const Due& due, std::int32_t step_in_batch, std::int64_t step);
  void list(const std::vector<std::int32_t>& near);
  void measure_room(const std::vector<std::int32_t>& near);

  RunContext& run_;
  AtSearch at_search_;
  std::int64_t loaded_ = -1;  ///< LoadedModel::changes() when the lists were built
};

}  // namespace pliant
