// The command line of the window.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace window {

struct Options {
  std::string scene, screenshot;
  double seconds = 0.5;
  std::optional<std::array<float, 2>> pull;
  std::optional<std::array<float, 4>> cut;
  float depth = 1, probe = 0, grasp = 0;
  std::string set;                      ///< LABEL=VALUE
  std::string color;                    ///< a field of World::vertex_values()
  std::vector<std::string> live, tool;  ///< devices, and the tools that they drive
  int width = 1024, height = 768;
};

/// Throws std::runtime_error for what is not understood.
Options read(int argc, char** argv);

}  // namespace window
