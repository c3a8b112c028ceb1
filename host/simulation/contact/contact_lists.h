// Which contact points are near something: asked now and then, and listed for the passes of the steps that follow.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "simulation/state/run_context.h"

namespace pliant {

/// Looks (Program::look) take place at steps that are multiples of contact_look_every, and only when what has moved since the
/// last one may have come near something. Passes then run over the tiles that are near, and over none where none is.
/// A point is looked after when it is nearer than this, beside what it moves until the next look [m].
double contact_margin(const Model& model);

class ContactLists {
 public:
  /// How far any point of a tool moves between two times, at most [m].
  using Motion = std::function<double(std::size_t tool, double from, double to)>;

  explicit ContactLists(RunContext& run) : run_(run) {}

  /// Before a step of the current batch: look where a look is due, and list what is near where the lists do not hold any more.
  void update(std::int32_t step_in_batch, const Motion& motion);

 private:
  /// Which looks are due.
  struct Due {
    bool tools = false, tissue = false;
  };
  [[nodiscard]] Due due_after_motion(std::int64_t step, const Motion& motion);
  [[nodiscard]] double largest_increment();
  void look(const Due& due, std::int32_t step_in_batch, std::int64_t step);
  void list(const std::vector<std::int32_t>& near);
  void measure_room(const std::vector<std::int32_t>& near);

  RunContext& run_;
  std::int64_t loaded_ = -1;  ///< LoadedModel::changes() that the lists belong to
};

}  // namespace pliant
