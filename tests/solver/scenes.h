// Small scenes and backends that the solver tests share.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "backends/backends.h"
#include "simulation/simulation.h"
#include "support/opencl.h"
#include "support/source_dir.h"

namespace pliant::testing {

/// A soft cube of 0.1 m that is held at the bottom while its top is pressed down by `press` [m] within `duration` [s]; `extra`
/// are further keys of the scene, each followed by a comma.
inline Scene pressed_cube(double press, const std::string& extra = "", double young = 3000,
                          const std::string& law = "neo-hookean", double duration = 0.2) {
  const std::string text = R"({"format": "pliant-scene/1", )" + extra + R"("gravity": [0, -9.81, 0],
    "bodies": [{"name": "cube", "surface": "meshes/cube.obj", "lattice": {"spacing": 0.02}, "element": "hex8",
      "material": {"law": ")" +
                           law + R"(", "young": )" + std::to_string(young) +
                           R"(, "poisson": 0.4, "density": 1000, "damping": 5},
      "fixed": [{"plane": [[0, -0.049, 0], [0, -1, 0]]}],
      "prescribed": [{"plane": [[0, 0.049, 0], [0, 1, 0]], "displacement": [0, )" +
                           std::to_string(-press) + R"(, 0], "curve": "smooth", "duration": )" + std::to_string(duration) +
                           "}]}]}";
  return parse_scene(text, test::source_dir() + "/scenes/pressed_cube.json");
}

using test::has_opencl;

}  // namespace pliant::testing
