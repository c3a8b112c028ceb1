// Haptic devices that drive tools of the scene in the window (docs/haptic_devices.md).
#pragma once
#include <pliant/haptics.h>
#include <pliant/world.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace window {

class Hands {
 public:
  /// Opens a device for each text and couples it with the tool at the same place in `tools`, which may be left out where the
  /// scene has one tool and there is one device. Throws pliant::Error or std::runtime_error.
  Hands(pliant::World& world, const std::vector<std::string>& devices, std::vector<std::string> tools);

  [[nodiscard]] bool empty() const { return loops_.empty(); }
  /// The tools that they drive: the mouse must leave them alone.
  [[nodiscard]] const std::vector<std::string>& tools() const { return tools_; }
  /// Wall time since the last call, at most `most` [s]: a second of the World is a second of a hand, however slow the drawing.
  /// What the machine cannot keep up with is given up.
  double passed(double most);
  /// What each hand feels, a line each.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  std::vector<std::string> tools_;
  std::vector<std::unique_ptr<pliant::HapticLoop>> loops_;
  std::chrono::steady_clock::time_point last_{};  ///< of passed()
};

}  // namespace window
