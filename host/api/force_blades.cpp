#include "api/force_blades.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/first_refusal.h"
#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant::api {
namespace {

std::vector<std::string> names_by_force(const Scene& scene) {
  std::vector<std::string> names;
  for (const Blade& b : scene.blades) {
    if (b.cuts == BladeCuts::by_force) names.push_back(b.name);
  }
  return names;
}

}  // namespace

ForceBlades::ForceBlades(const Scene& scene) : names_(names_by_force(scene)) {}

bool ForceBlades::knows(const std::string& name) const { return std::find(names_.begin(), names_.end(), name) != names_.end(); }

void ForceBlades::drive(const std::string& name, const BladeSegment& to, double seconds) {
  if (!knows(name)) {
    const std::string all = names_.empty() ? "there are none" : fmt::format("there are '{}'", fmt::join(names_, "', '"));
    throw Error(ErrorCode::usage, fmt::format("the scene has no blade '{}' that cuts by force; {}", name, all));
  }
  if (!vec::finite(to[0]) || !vec::finite(to[1]) || to[0] == to[1] || !std::isfinite(seconds) || seconds < 0) {
    throw Error(ErrorCode::usage, fmt::format("blade '{}': got a segment from [{}] m to [{}] m within {} s; allowed are two "
                                              "different finite points and a finite time that is not negative",
                                              name, fmt::join(to[0], ", "), fmt::join(to[1], ", "), seconds));
  }
  const std::lock_guard lock(mutex_);
  Request* const last = asked_.newest([&](const Request& r) { return r.name == name; });
  Request* const before = asked_.newest([&](const Request& r) { return r.name == name && &r < last; });
  // Of several pending drives the last one is kept, and the first, which may place the blade.
  if (seconds > 0 && before != nullptr && last->seconds > 0 && before->seconds >= 0) {
    *last = {name, to, seconds};
  } else {
    asked_.push({name, to, seconds});
  }
}

void ForceBlades::lift(const std::string& name) {
  const std::lock_guard lock(mutex_);
  asked_.push({name});
}

void ForceBlades::hold_back() {
  const std::lock_guard lock(mutex_);
  asked_.hold_back();
}

void ForceBlades::go_on() {
  const std::lock_guard lock(mutex_);
  asked_.go_on();
}

void ForceBlades::add_save_point() {
  const std::lock_guard lock(mutex_);
  asked_.add_save_point();
}

void ForceBlades::remove_save_point() {
  const std::lock_guard lock(mutex_);
  asked_.remove_save_point();
}

void ForceBlades::renew(const Simulation& simulation, bool keep_requests) {
  {
    const std::lock_guard lock(mutex_);
    if (!keep_requests) asked_.clear();
    asked_.go_on();
  }
  note(simulation);
}

std::vector<BladeForce> ForceBlades::forces() const {
  const std::lock_guard lock(mutex_);
  return forces_;
}

void ForceBlades::apply(Simulation& simulation) {
  std::vector<Request> doing;
  {
    const std::lock_guard lock(mutex_);
    doing = asked_.take();
    if (doing.empty()) return;
  }
  FirstRefusal refusal;
  for (const Request& r : doing) {
    refusal.attempt([&] {
      if (r.seconds < 0) {
        simulation.lift_blade_by_force(r.name);
      } else {
        simulation.drive_blade(r.name, r.to, r.seconds);
      }
    });
  }
  note(simulation);
  refusal.rethrow();
}

void ForceBlades::note(const Simulation& simulation) {
  if (names_.empty()) return;
  std::vector<BladeForce> forces;
  const RunState& state = simulation.state();
  const double now = simulation.time();
  for (const Blade& blade : simulation.scene().blades) {
    if (blade.cuts != BladeCuts::by_force) continue;
    const std::size_t number = forces.size();
    const Wrench felt = simulation.press().last_force(number);
    const FaceLoad on_faces = simulation.press().last_on_faces(number);
    const BladeSegment at = blade_place(state.driven_blades, blade, now);
    BladeForce f;
    f.name = blade.name;
    f.a = at[0];
    f.b = at[1];
    f.present = blade_present(state.driven_blades, blade, now, now);
    const auto own = state.pressed.find(blade.name);
    const bool touches = own != state.pressed.end() && own->second.touches();
    if (f.present && (touches || on_faces.normal != 0)) {
      static_cast<Wrench&>(f) = felt;
      f.face_force = on_faces.force;
      f.face_normal = on_faces.normal;
    }
    f.pressing = f.force != f.face_force;
    f.work = simulation.press().work(number);
    if (own != state.pressed.end()) {
      f.face_work = f.work - own->second.work;
      f.max_force = own->second.max_force;
      f.fracture = own->second.fracture_now();
      f.gave_way = own->second.first;
    }
    forces.push_back(std::move(f));
  }
  const std::lock_guard lock(mutex_);
  forces_ = std::move(forces);
}

}  // namespace pliant::api
