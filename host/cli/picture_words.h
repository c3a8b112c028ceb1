// The options of pictures on the command line.
#pragma once
#include <string>

#include "render/picture.h"

namespace CLI {
class App;
}

namespace pliant::cli {

struct PictureWords {
  std::string size, color, range;
  int samples = 0;

  void add_to(CLI::App& app);
  /// The first of them that was given, "--size", or "".
  [[nodiscard]] std::string given() const;
  /// Parses the options. Throws Error with the allowed values.
  [[nodiscard]] render::PictureOptions options() const;
};

}  // namespace pliant::cli
