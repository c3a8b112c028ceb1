// How far tools reach into the bodies of a scene, and bodies into each other.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/vec.h"
#include "pliant/tool.h"
#include "simulation/measure/tool_shapes.h"

namespace pliant {

/// Measures on request; keeps the surfaces of tools from one time to the next.
class Interpenetrations {
 public:
  /// All tools in all bodies, then all pairs of bodies, in the order of the model; those with a volume above 0. The simulation
  /// is not changed. Bodies without a closed surface are left out, and tools that are parked.
  std::vector<Interpenetration> now(Simulation& simulation);
  /// Names of the bodies that are left out: their surface is open, absent, or not finite.
  std::vector<std::string> left_out(Simulation& simulation);

 private:
  struct Part {
    TriangleMesh mesh;
    vec::Box box;
  };
  void follow(Simulation& simulation);
  /// The present surface of each body; without triangles if it is left out.
  [[nodiscard]] std::vector<Part> bodies(Simulation& simulation) const;

  std::shared_ptr<const Model> model_;  ///< that the following belongs to
  std::vector<char> closed_;            ///< per body
  /// A cap a tenth of the radius deep has its volume within 1e-3 (tests/model/tool_mesh_test.cpp).
  ToolShapes shapes_{256, true};
};

/// The sum of those between the two names: a tool or a body, and a body. An empty second name: the overlaps of the first with
/// all bodies and, for a body, those of others with it. The deepest point is that of all.
Interpenetration sum_between(const std::vector<Interpenetration>& found, const std::string& first, const std::string& second);

}  // namespace pliant
