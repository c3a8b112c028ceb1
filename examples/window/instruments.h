// Instruments in the window: those of the scene, a probe and a grasper, moved with six degrees of freedom.
#pragma once
#include <pliant/world.h>

#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "drawing.h"

namespace window {

inline pliant::Vec3d wide(Vec3 v) { return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])}; }

using Turn = std::array<double, 4>;  ///< unit quaternion x, y, z, w

class Instruments {
 public:
  /// `size`: diagonal of the bodies [m], which the sizes of probe and grasper follow.
  /// `others`: tools that somebody else moves.
  Instruments(pliant::World& world, Drawing& drawing, float size, std::vector<std::string> others)
      : world_(world), drawing_(drawing), size_(size), others_(std::move(others)) {}

  /// Adds what is missing: the scene's tools, each an instrument. Call after the World was built or reset.
  void follow_scene();
  /// Adds a probe or a grasper, or takes the one that is there, with its tip at a point and its handle along `back`.
  void take_probe(Vec3 at, Vec3 back);
  void take_grasper(Vec3 at, Vec3 back);
  /// Takes the instrument with this number; a number beyond the last: none.
  void take(std::size_t number);
  void put_down() { active_ = kNone; }
  [[nodiscard]] bool held() const { return active_ != kNone; }
  [[nodiscard]] std::vector<std::string> labels() const;
  [[nodiscard]] std::size_t active() const { return active_; }

  void move(Vec3 by);
  void turn(Vec3 axis, float angle);
  void close(bool closed) { closed_ = closed; }
  /// Sends the held instrument on its way for the next `seconds`, no faster than contact follows.
  void drive(double seconds);

  /// Force of the tissue on the held instrument [N].
  [[nodiscard]] double force() const { return force_; }
  /// Hands shapes that are new or change to the drawing. Waits for the worker: call while it is idle.
  void fetch_shapes(double time);
  /// Hands the poses to the drawing.
  void draw();

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};
  struct Instrument {
    std::string label;
    std::vector<std::string> tools;  ///< the two jaws of a grasper
    bool moved = false;              ///< true once the mouse has moved it: it no longer follows the scene's path
    pliant::Vec3d at{};
    Turn turn{0, 0, 0, 1};
  };
  std::size_t find(const std::string& label) const;
  void add(const std::string& label, const std::vector<pliant::ToolSpec>& tools, const pliant::Vec3d& at, const Turn& turn);
  void take_up(const std::string& label, const std::vector<pliant::ToolSpec>& tools, Vec3 at, Vec3 back);
  void send(const Instrument& instrument, double seconds);
  void draw_blades();

  pliant::World& world_;
  Drawing& drawing_;
  float size_;
  std::vector<std::string> others_;
  std::vector<Instrument> all_;
  std::size_t active_ = kNone;
  pliant::Vec3d wanted_{};
  Turn wanted_turn_{0, 0, 0, 1};
  bool closed_ = false;
  double opening_ = 1;  ///< share of the grasper's opening
  double force_ = 0;
  struct Shape {
    pliant::SurfaceSpec surface;
    bool changes = false;
  };
  std::map<std::string, Shape> shapes_;
  double next_look_ = 0;
  std::set<std::string> edges_;  ///< of blades, by their names in the drawing
};

}  // namespace window
