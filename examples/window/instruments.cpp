#include "instruments.h"

#include <algorithm>
#include <cmath>

namespace window {
namespace {

using pliant::Vec3d;

constexpr double kStride = 0.02;        ///< [sizes] farthest motion in a frame
constexpr double kTurnStride = 0.1;     ///< [rad] likewise
constexpr double kOpening = 0.12;       ///< [sizes] between the open jaws of a grasper
constexpr double kJaw = 0.03;           ///< [sizes] thickness of a jaw
constexpr double kClosing = 0.05;       ///< share of the opening in a frame
constexpr double kLookForShapes = 0.5;  ///< [s] between two looks whether the shape of a tool changes

double length(const Vec3d& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Turn product(const Turn& a, const Turn& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Turn unit_turn(Turn q) {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& x : q) x /= norm;
  return q;
}

Turn about(Vec3 axis, double angle) {
  const Vec3d a = wide(unit(axis));
  const double s = std::sin(angle / 2);
  return {s * a[0], s * a[1], s * a[2], std::cos(angle / 2)};
}

/// The shortest rotation that takes the z axis to `to`.
Turn from_z(Vec3 to) {
  const Vec3 z{0, 0, 1}, axis = cross(z, to);
  const float sine = std::sqrt(dot(axis, axis));
  if (sine < 1e-6F) return to[2] > 0 ? Turn{0, 0, 0, 1} : Turn{1, 0, 0, 0};
  return about(axis, std::atan2(static_cast<double>(sine), static_cast<double>(to[2])));
}

Vec3d rotated(const Turn& q, const Vec3d& v) {
  const Turn r = product(product(q, {v[0], v[1], v[2], 0}), {-q[0], -q[1], -q[2], q[3]});
  return {r[0], r[1], r[2]};
}

/// A share of the way from one rotation to another.
Turn between(const Turn& from, Turn to, double share) {
  double same = 0;
  for (std::size_t i = 0; i < 4; ++i) same += from[i] * to[i];
  for (std::size_t i = 0; i < 4; ++i) to[i] = from[i] + share * ((same < 0 ? -to[i] : to[i]) - from[i]);
  return unit_turn(to);
}

double angle_between(const Turn& a, const Turn& b) {
  double same = 0;
  for (std::size_t i = 0; i < 4; ++i) same += a[i] * b[i];
  return 2 * std::acos(std::min(1.0, std::abs(same)));
}

}  // namespace

void Instruments::follow_scene() {
  all_.clear();
  active_ = kNone;
  next_look_ = 0;
  for (const pliant::ToolForce& t : world_.tool_forces()) {
    if (std::count(others_.begin(), others_.end(), t.name) == 0) all_.push_back({t.name, {t.name}, false, t.position, t.turn});
  }
}

std::size_t Instruments::find(const std::string& label) const {
  const auto found = std::find_if(all_.begin(), all_.end(), [&](const Instrument& i) { return i.label == label; });
  return found == all_.end() ? kNone : static_cast<std::size_t>(found - all_.begin());
}

std::vector<std::string> Instruments::labels() const {
  std::vector<std::string> names;
  for (const Instrument& i : all_) names.push_back(i.label);
  return names;
}

void Instruments::take(std::size_t number) {
  active_ = number < all_.size() ? number : kNone;
  if (active_ == kNone) return;
  Instrument& taken = all_[active_];
  if (!taken.moved) {
    for (const pliant::ToolForce& t : world_.tool_forces()) {
      if (t.name == taken.tools[0]) taken.at = t.position, taken.turn = t.turn;
    }
  }
  wanted_ = taken.at;
  wanted_turn_ = taken.turn;
}

void Instruments::take_up(const std::string& label, const std::vector<pliant::ToolSpec>& tools, Vec3 at, Vec3 back) {
  if (find(label) == kNone) {
    Instrument added{label, {}, true, wide(at), from_z(back)};
    for (const pliant::ToolSpec& given : tools) {
      pliant::ToolSpec tool = given;
      const Vec3d x = added.at;
      tool.path = {{0, x[0], x[1], x[2], added.turn[0], added.turn[1], added.turn[2], added.turn[3]}};
      try {
        world_.add_tool(tool);
      } catch (const pliant::Error&) {
        for (const std::string& name : added.tools) world_.remove_tool(name);  // half a grasper is none
        throw;
      }
      added.tools.push_back(tool.name);
    }
    all_.push_back(added);
    next_look_ = 0;
  }
  take(find(label));
}

void Instruments::take_probe(Vec3 at, Vec3 back) {
  const auto size = static_cast<double>(size_);
  pliant::ToolSpec probe;
  probe.name = "window probe";
  probe.shape = "capsule";
  probe.radius = 0.025 * size;
  probe.first = {0, 0, probe.radius};
  probe.second = {0, 0, size};
  probe.friction = 0.3;
  take_up("probe", {probe}, at, back);
}

/// The jaws close along x; their tips are at z = 0.
void Instruments::take_grasper(Vec3 at, Vec3 back) {
  const auto size = static_cast<double>(size_);
  std::vector<pliant::ToolSpec> jaws(2);
  for (std::size_t i = 0; i < 2; ++i) {
    const double x = (i == 0 ? -0.5 : 0.5) * (kOpening + kJaw) * size;
    jaws[i].name = i == 0 ? "window jaw 1" : "window jaw 2";
    jaws[i].shape = "capsule";
    jaws[i].radius = 0.5 * kJaw * size;
    jaws[i].first = {x, 0, jaws[i].radius};
    jaws[i].second = {x, 0, 0.5 * size};
    jaws[i].friction = 0.9;
  }
  opening_ = 1;
  take_up("grasper", jaws, at, back);
}

void Instruments::move(Vec3 by) {
  const Vec3d step = wide(by);
  for (std::size_t c = 0; c < 3; ++c) wanted_[c] += step[c];
}

void Instruments::turn(Vec3 axis, float angle) {
  wanted_turn_ = unit_turn(product(about(axis, static_cast<double>(angle)), wanted_turn_));
}

void Instruments::send(const Instrument& instrument, double seconds) {
  for (std::size_t i = 0; i < instrument.tools.size(); ++i) {
    Vec3d at = instrument.at;
    if (instrument.tools.size() == 2) {
      const double inward = (i == 0 ? 0.5 : -0.5) * (1 - opening_) * kOpening * static_cast<double>(size_);
      const Vec3d by = rotated(instrument.turn, {inward, 0, 0});
      for (std::size_t c = 0; c < 3; ++c) at[c] += by[c];
    }
    world_.drive_tool(instrument.tools[i], at, instrument.turn, seconds);
  }
}

void Instruments::drive(double seconds) {
  if (active_ == kNone) return;
  Instrument& held = all_[active_];
  Vec3d way;
  for (std::size_t c = 0; c < 3; ++c) way[c] = wanted_[c] - held.at[c];
  const double far = length(way), angle = angle_between(held.turn, wanted_turn_);
  const double opening =
      held.tools.size() < 2 ? opening_ : std::clamp(closed_ ? 0.0 : 1.0, opening_ - kClosing, opening_ + kClosing);
  if (far == 0 && angle < 1e-9 && opening == opening_) return;
  const double share =
      std::min({1.0, kStride * static_cast<double>(size_) / std::max(far, 1e-30), kTurnStride / std::max(angle, 1e-30)});
  const Instrument before = held;
  const double opened = opening_;
  for (std::size_t c = 0; c < 3; ++c) held.at[c] += share * way[c];
  held.turn = between(held.turn, wanted_turn_, share);
  held.moved = true;
  opening_ = opening;
  try {
    send(held, seconds);
  } catch (const pliant::Error&) {
    held = before;
    opening_ = opened;
    throw;
  }
}

void Instruments::fetch_shapes(double time) {
  const bool due = time >= next_look_;
  if (due) next_look_ = time + kLookForShapes;
  for (const pliant::ToolForce& t : world_.tool_forces()) {
    Shape& shape = shapes_[t.name];
    if (!due && !shape.changes && !shape.surface.vertices.empty()) continue;
    pliant::SurfaceSpec surface = world_.tool_surface(t.name);
    if (surface.vertices == shape.surface.vertices) continue;
    shape.changes = !shape.surface.vertices.empty();
    drawing_.set_tool(t.name, surface);
    shape.surface = std::move(surface);
  }
}

void Instruments::draw() {
  drawing_.hide_tools();
  Vec3d sum{};
  for (const pliant::ToolForce& t : world_.tool_forces()) {
    if (shapes_[t.name].surface.vertices.empty()) continue;
    const bool active = active_ != kNone && std::count(all_[active_].tools.begin(), all_[active_].tools.end(), t.name) > 0;
    for (std::size_t c = 0; c < 3 && active; ++c) sum[c] += t.force[c];
    drawing_.place_tool(t.name, pose_matrix(t.position, t.turn),
                        t.parked ? ToolLook::hidden
                        : active ? ToolLook::active
                                 : ToolLook::steel);
  }
  draw_blades();
  force_ = length(sum);
}

/// The edges of blades that cut by force, which have no faces of their own: bars, thin enough to see what they cut.
void Instruments::draw_blades() {
  constexpr double kThin = 0.012;  // of the edge's length
  for (const pliant::BladeForce& blade : world_.blade_forces()) {
    const Vec3d span{blade.b[0] - blade.a[0], blade.b[1] - blade.a[1], blade.b[2] - blade.a[2]};
    const double size = length(span);
    const std::string name = "edge of " + blade.name;
    if (!(size > 0) || (!blade.present && edges_.count(name) == 0)) continue;
    if (edges_.insert(name).second) {
      const double half = 0.5 * size, thin = kThin * size;
      drawing_.set_tool(name, pliant::box_surface({-half, -thin, -thin}, {half, thin, thin}));
    }
    // The shorter rotation from x to the edge's direction.
    const Vec3d d{span[0] / size, span[1] / size, span[2] / size};
    const double norm = std::sqrt(2 + 2 * d[0]);
    const std::array<double, 4> turn =
        norm > 1e-6 ? std::array<double, 4>{0, -d[2] / norm, d[1] / norm, norm / 2} : std::array<double, 4>{0, 0, 1, 0};
    const Vec3d middle{(blade.a[0] + blade.b[0]) / 2, (blade.a[1] + blade.b[1]) / 2, (blade.a[2] + blade.b[2]) / 2};
    drawing_.place_tool(name, pose_matrix(middle, turn), blade.present ? ToolLook::active : ToolLook::hidden);
  }
}

}  // namespace window
