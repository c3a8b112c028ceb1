// What the bodies are coloured by in the window.
#pragma once
#include <pliant/world.h>

#include <algorithm>
#include <string>
#include <vector>

#include "drawing.h"

namespace window {

/// Values of the vertices, and a scale that follows them: up at once, down slowly.
class Coloring {
 public:
  /// Call while the worker rests. `field`: of World::vertex_values(); empty: tissue.
  void update(const pliant::World& world, const std::string& field) {
    values_.clear();
    if (field.empty()) return;
    values_ = world.vertex_values(field);
    float most = 0;
    for (const float value : values_) most = std::max(most, value);
    most_ = field == field_ ? std::max(most, 0.98F * most_) : most;
    field_ = field;
  }
  void apply(Drawing& drawing) const { drawing.set_values(values_, most_); }
  [[nodiscard]] float most() const { return most_; }

 private:
  std::string field_;
  std::vector<float> values_;
  float most_ = 0;
};

}  // namespace window
