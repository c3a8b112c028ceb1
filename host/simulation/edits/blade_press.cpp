#include "simulation/edits/blade_press.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "scene/blade_face.h"
#include "schedule/contact/blade_data.h"
#include "simulation/edits/blade_fronts.h"

namespace pliant {
namespace {

constexpr double kLeastHeight = 3;        ///< of faces [cells]
constexpr double kBesideFaces = 1.0 / 3;  ///< largest thickness where cuts follow faces of elements [cells]

bool presses(const FrontSample& s) {
  return s.kind == static_cast<std::int32_t>(FrontKind::ahead) || s.kind == static_cast<std::int32_t>(FrontKind::held);
}

/// The least side of the boxes around the bodies is at most this [m].
double widest_body(const Model& model) {
  double widest = 0;
  for (const ModelBody& body : model.bodies) {
    vec::Box box;
    for (const Vec3d& p : body.rest) box.extend(p);
    widest =
        std::max(widest, std::min({box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]}));
  }
  return widest;
}

/// Faces begin a cell behind the edge, rise over a third of the height and fall over another one (contact_face.cl).
void check_faces(const Blade& blade, double cell) {
  const auto refuse = [&](const char* key, double got, double most, const char* allowed) {
    throw Error(ErrorCode::bad_input, fmt::format("blade '{}': got a \"{}\" of {} m; allowed is {}", blade.name, key, got,
                                                  fmt::format(fmt::runtime(allowed), most)));
  };
  if (blade.method == BladeMethod::separation && blade.thickness > kBesideFaces * cell) {
    refuse("thickness", blade.thickness, kBesideFaces * cell,
           "up to {:.4g} m, a third of a cell, because with \"separation\" a cut lies beside the blade");
  }
  if (blade.thickness > cell) refuse("thickness", blade.thickness, cell, "up to {:.4g} m, a cell, which a cut opens");
  if (blade.height < kLeastHeight * cell) {
    refuse("height", blade.height, kLeastHeight * cell,
           "at least {:.4g} m, three cells: behind its edge a cut opens a cell at a time");
  }
}

}  // namespace

void BladePress::start(const Model& model) {
  first_.assign(1, 0);
  if (!cuts_by_force(run_.scene)) return;
  run_.settings.blade_edge = typical_edge(model);
  const double edge = run_.settings.blade_edge, widest = widest_body(model);
  for (std::size_t b = 0; b < run_.scene.blades.size(); ++b) {
    const Blade& blade = run_.scene.blades[b];
    if (blade.cuts != BladeCuts::by_force) continue;
    if (2 * blade.edge > widest) {
      throw Error(
          ErrorCode::bad_input,
          fmt::format("blade '{}': got an \"edge\" of radius {} m; allowed is up to half of the thickness of a body, {} m",
                      blade.name, blade.edge, widest / 2));
    }
    if (blade.has_faces() && model.contact != nullptr) check_faces(blade, model.contact->spacing);
    names_.push_back(blade.name);
    blades_.push_back(b);
    first_.push_back(first_.back() + static_cast<std::size_t>(sample_count(blade, edge)));
  }
  run_.settings.force_blades = static_cast<std::int32_t>(names_.size());
  run_.settings.blade_samples = static_cast<std::int32_t>(first_.back());
}

template <class Visit>
void BladePress::for_samples(Visit&& visit) const {
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const auto found = run_.state.pressed.find(names_[k]);
    if (found == run_.state.pressed.end()) continue;
    std::vector<FrontSample>& samples = found->second.samples;
    for (std::size_t i = 0; i < samples.size(); ++i) visit(k, first_[k] + i, samples[i], found->second);
  }
}

bool BladePress::near() const {
  return std::any_of(run_.state.pressed.begin(), run_.state.pressed.end(), [](const auto& blade) {
    return std::any_of(blade.second.samples.begin(), blade.second.samples.end(), presses);
  });
}

void BladePress::begin_batch(std::int32_t steps) {
  if (names_.empty()) return;
  pressing_ = near();
  *run_.loaded.program().near_samples = pressing_ ? 1 : 0;
  if (!pressing_) return;
  upload_poses(steps);
  upload_nodes(samples());
}

void BladePress::upload_poses(std::int32_t steps) {
  const std::size_t rows = static_cast<std::size_t>(run_.settings.batch_steps) + 1;
  const Clock& clock = run_.state.clock;
  poses_.clear();
  std::vector<double> pose;
  const auto last = static_cast<std::int64_t>(steps);
  for (std::int64_t row = -1; row < static_cast<std::int64_t>(rows); ++row) {
    for (const std::size_t b : blades_) {
      double time = clock.time_at(clock.step + std::min(row, last));
      if (row < 0) {
        const Blade& own = run_.scene.blades[b];
        time = since_jump(run_.state.driven_blades, own.name, time, clock.time(), [&](double t) { return own.at(t); });
      }
      const BladeSegment at = blade_place(run_.state.driven_blades, run_.scene.blades[b], time);
      poses_.push_back({at[0], vec::sub(at[1], at[0])});
      if (row < 0) continue;
      for (const Vec3d& v : poses_.back()) pose.insert(pose.end(), v.begin(), v.end());
    }
  }
  run_.backend().write_reals(run_.loaded.program().find("blade_pose"), pose);
}

void BladePress::write_sample(const FrontSample& s, std::size_t row, BladeSamples& out) const {
  const Model& model = run_.model();
  const auto b = static_cast<std::size_t>(s.body);
  Vec3d rest{};
  std::size_t at = blade_sample_nodes * row;
  for (const FrontCarrier& c : front_carriers(*edits_.cut_topology(b), s.point)) {
    const std::int32_t slot = model.bodies[b].slot[static_cast<std::size_t>(c.node)];
    out.node[at] = slot;
    out.weight[at++] = c.weight;
    Vec3d x = model.rest[static_cast<std::size_t>(slot)];
    for (std::size_t k = 0; k < 3 && !run_.state.offset.empty(); ++k)
      x[k] += run_.state.offset[3 * static_cast<std::size_t>(slot) + k];
    rest = vec::add(rest, vec::mul(x, c.weight));
  }
  std::copy(rest.begin(), rest.end(), &out.data[blade_sample_numbers * row]);
  out.data[blade_sample_numbers * row + 6] = s.limit;
  out.front[2 * row] = s.advance;
  out.front[2 * row + 1] = s.pressed;
  out.depth[row] = s.depth;
}

BladeSamples BladePress::samples(std::optional<std::size_t> only) const {
  BladeSamples out(only ? first_[*only + 1] - first_[*only] : first_.back());
  for_samples([&](std::size_t blade, std::size_t i, const FrontSample& s, const PressedBlade& own) {
    if (!presses(s) || (only && blade != *only)) return;
    const std::size_t row = only ? i - first_[blade] : i;
    write_sample(s, row, out);
    double* data = &out.data[blade_sample_numbers * row];
    std::copy(own.normal.begin(), own.normal.end(), data + 3);
    data[7] = run_.scene.blades[blades_[blade]].friction;
    data[8] = static_cast<double>(i - first_[blade]) / static_cast<double>(first_[blade + 1] - first_[blade] - 1);
    data[9] = only ? 0 : static_cast<double>(blade);
  });
  out.share_out();
  out.edge = run_.settings.blade_edge;
  return out;
}

/// Writes the samples, and for each node that one of them moves the list of these.
void BladePress::upload_nodes(const BladeSamples& n) {
  const std::vector<char>& axes = run_.loaded.free();
  const BladeNodes nodes = blade_nodes(n, [&](std::int32_t slot) {
    const std::size_t base = 3 * static_cast<std::size_t>(slot);
    return (axes[base] != 0 ? 1 : 0) | (axes[base + 1] != 0 ? 2 : 0) | (axes[base + 2] != 0 ? 4 : 0);
  });
  const Program& program = run_.loaded.program();
  Backend& backend = run_.backend();
  backend.write_ints(program.find("blade_node"), n.node);
  backend.write_ints(program.find("blade_slot"), nodes.slot);
  backend.write_ints(program.find("blade_free"), nodes.free);
  backend.write_ints(program.find("blade_first"), nodes.first);
  backend.write_ints(program.find("blade_entry"), nodes.entry);
  backend.write_reals(program.find("blade_weight"), n.weight);
  backend.write_reals(program.find("blade_share"), n.share);
  backend.write_reals(program.find("blade_data"), n.data);
  backend.write_reals(program.find("blade_front"), n.front);
}

void BladePress::read_fronts() {
  const std::vector<double> front = run_.backend().read_reals(run_.loaded.program().find("blade_front"));
  for_samples([&](std::size_t, std::size_t i, FrontSample& s, const PressedBlade&) {
    if (!presses(s)) return;
    s.advance = front[2 * i];
    s.pressed = front[2 * i + 1];
  });
}

void BladePress::end_batch(std::int32_t steps) {
  if (names_.empty()) return;
  felt_ = {};
  felt_.batch_end = run_.state.clock.step;
  felt_.batch_clock = run_.state.clock;
  const auto done = static_cast<std::size_t>(std::max(steps, 0));
  const bool faces = done > 0 && contact_.batch_end() == run_.state.clock.step && has_faces();
  if (done == 0 || (!pressing_ && !faces)) return;
  felt_.step_forces.resize(done * names_.size());
  if (pressing_) add_edges(done);
  if (faces) add_faces(done);
  for (std::size_t i = 0; i < felt_.step_forces.size(); ++i) {
    const auto own = run_.state.pressed.find(names_[i % names_.size()]);
    if (own != run_.state.pressed.end())
      own->second.max_force = std::max(own->second.max_force, vec::norm(felt_.step_forces[i].force));
  }
}

void BladePress::add_edges(std::size_t steps) {
  read_fronts();
  const std::size_t blades = names_.size(), samples = first_.back();
  const std::vector<double> force = run_.backend().read_reals(run_.loaded.program().find("blade_force"));
  for (std::size_t step = 0; step < steps; ++step) {
    for_samples([&](std::size_t k, std::size_t i, const FrontSample&, PressedBlade& own) {
      const double* f = &force[blade_force_numbers * (step * samples + i)];
      const Vec3d on_blade{-f[0], -f[1], -f[2]};
      const double place = static_cast<double>(i - first_[k]) / static_cast<double>(first_[k + 1] - first_[k] - 1);
      Wrench& sum = felt_.step_forces[step * blades + k];
      const auto at = [&](std::size_t row) {
        const auto& pose = poses_[row * blades + k];
        return vec::add(pose[0], vec::mul(pose[1], place));
      };
      // A force acts from the middle of the step before to that of the next one.
      own.work -= 0.5 * vec::dot(on_blade, vec::sub(at(step + 2), at(step)));
      sum.force = vec::add(sum.force, on_blade);
      sum.torque = vec::add(sum.torque, vec::cross(vec::mul(poses_[(step + 2) * blades + k][1], place - 0.5), on_blade));
    });
  }
}

void BladePress::add_faces(std::size_t steps) {
  const std::size_t blades = names_.size(), tools = contact_.tools().size();
  felt_.on_faces.resize(steps * blades);
  for (std::size_t k = 0; k < blades; ++k) {
    for (const std::size_t t : faces(k)) {
      const ContactTool& face = contact_.tools()[t];
      for (std::size_t step = 0; step < steps; ++step) {
        const Wrench& on_face = contact_.step_forces()[step * tools + t];
        if (on_face.force == Vec3d{}) continue;
        const auto end = run_.state.clock.step - static_cast<std::int64_t>(steps - step) + 1;
        const Pose at = contact_.pose(t, run_.state.clock.time_at(end));
        const Vec3d arm = vec::sub(at.position, place(at, {0, -0.5 * face.size[1], 0}));  // from the middle of the edge
        const Vec3d across = vec::sub(place(at, {static_cast<double>(face.side), 0, 0}), at.position);
        FaceLoad load;
        load.force = on_face.force;
        load.torque = vec::add(on_face.torque, vec::cross(arm, on_face.force));
        FaceLoad& sum = felt_.on_faces[step * blades + k];
        sum.normal -= vec::dot(across, on_face.force);
        for (Wrench* of : {static_cast<Wrench*>(&sum), &felt_.step_forces[step * blades + k]}) {
          of->force = vec::add(of->force, load.force);
          of->torque = vec::add(of->torque, load.torque);
        }
      }
    }
  }
}

bool BladePress::has_faces() const {
  return std::any_of(blades_.begin(), blades_.end(), [&](std::size_t b) { return run_.scene.blades[b].has_faces(); });
}

std::vector<std::size_t> BladePress::faces(std::size_t blade) const {
  std::vector<std::size_t> both;
  for (std::size_t t = 0; t < contact_.tools().size(); ++t) {
    const ContactTool& tool = contact_.tools()[t];
    if (is_face(tool) && tool.blade->name == names_[blade]) both.push_back(t);
  }
  return both;
}

Wrench BladePress::last_force(std::size_t blade) const {
  if (felt_.step_forces.size() < names_.size() || felt_.batch_end != run_.state.clock.step) return {};
  return felt_.step_forces[felt_.step_forces.size() - names_.size() + blade];
}

FaceLoad BladePress::last_on_faces(std::size_t blade) const {
  if (felt_.on_faces.size() < names_.size() || felt_.batch_end != run_.state.clock.step) return {};
  return felt_.on_faces[felt_.on_faces.size() - names_.size() + blade];
}

double BladePress::work(std::size_t blade) const {
  const auto own = run_.state.pressed.find(names_[blade]);
  double sum = own == run_.state.pressed.end() ? 0 : own->second.work;
  for (const std::size_t t : faces(blade)) sum += contact_.history(t).work;
  return sum;
}

}  // namespace pliant
