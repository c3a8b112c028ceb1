#include "options.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace window {

Options read(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const char* const value = i + 1 < argc ? argv[i + 1] : "";
    float x = 0, y = 0, to_x = 0, to_y = 0;
    if (word == "--screenshot") {
      o.screenshot = value;
    } else if (word == "--seconds") {
      o.seconds = std::atof(value);
    } else if (word == "--pull" && std::sscanf(value, "%f,%f", &x, &y) == 2) {
      o.pull = {x, y};
    } else if (word == "--cut" && std::sscanf(value, "%f,%f,%f,%f", &x, &y, &to_x, &to_y) == 4) {
      o.cut = {x, y, to_x, to_y};
    } else if (word == "--depth" && std::sscanf(value, "%f", &o.depth) == 1) {
    } else if (word == "--probe" && std::sscanf(value, "%f", &o.probe) == 1) {
    } else if (word == "--grasp" && std::sscanf(value, "%f", &o.grasp) == 1) {
    } else if (word == "--set" && std::strchr(value, '=') != nullptr) {
      o.set = value;
    } else if (word == "--live" && i + 1 < argc) {
      o.live.emplace_back(value);
    } else if (word == "--tool" && i + 1 < argc) {
      o.tool.emplace_back(value);
    } else if (word == "--color") {
      o.color = value;
    } else if (word == "--size" && std::sscanf(value, "%dx%d", &o.width, &o.height) == 2) {
    } else if (word[0] != '-' && o.scene.empty()) {
      o.scene = word;
      continue;
    } else {
      throw std::runtime_error("not understood: " + word);
    }
    ++i;
  }
  if (o.scene.empty()) {
    throw std::runtime_error(
        "usage: window SCENE [--screenshot FILE] [--seconds T] [--pull X,Y] [--cut X,Y,X,Y] [--depth D] [--probe D] [--grasp "
        "D] "
        "[--set LABEL=VALUE] [--color FIELD] [--live DEVICE]... [--tool NAME]... [--size WxH]");
  }
  return o;
}

}  // namespace window
