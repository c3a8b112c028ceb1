// Small scenes and backends that the solver tests share.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "backends/choice/backends.h"
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

/// A cube that is thrown on a table faster than its first step stands; `more`: further tools, each after a comma.
inline Scene thrown_cube(const std::string& more = "") {
  return parse_scene(R"({"format": "pliant-scene/1", "gravity": [0, 0, 0], "duration": 0.1, "bodies": [{"name": "cube",
    "surface": "meshes/cube.obj", "lattice": {"spacing": 0.02}, "velocity": [0, -3, 0],
    "material": {"young": 3000, "poisson": 0.4, "density": 1000, "damping": 5}}],
    "tools": [{"name": "table", "shape": {"half_space": [[0, -0.055, 0], [0, 1, 0]]}})" +
                         more + "]}",
                     test::source_dir() + "/scenes/thrown.json");
}

using test::has_opencl;

}  // namespace pliant::testing
