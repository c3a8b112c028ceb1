// Bodies and tools that begin inside each other.
#pragma once
#include <optional>

#include "model/model.h"

namespace pliant {

/// Throws Error (bad_input) where a body begins more than `allowed` [m] inside another one, or in the same place.
void refuse_overlap(const Model& model, double allowed);

/// A point of a tool inside a body at the start.
struct ToolInside {
  std::size_t body = 0;
  double depth = 0;  ///< below the body's surface [m]
  Vec3d point{};     ///< [m]
};
/// The deepest point of a tool whose shape stands at `at`: a tool that lies inside a body as a whole has no points of the
/// body's surface inside it. Nothing of a half space.
std::optional<ToolInside> tool_inside(const Model& model, const ToolForm& form, const ToolMoment& moment, const Pose& at);

}  // namespace pliant
