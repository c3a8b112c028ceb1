#include "simulation/state/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "program/hash.h"
#include "scene/keys.h"
#include "simulation/contact/tool_changes.h"
#include "simulation/recovery/limits.h"

namespace pliant {
namespace {

bool held_by_nodes(const Buffer& b) { return b.role == BufferRole::state && b.carry != Carry::drop; }

class Hash {
 public:
  /// The length counts, so that what belongs to one block cannot move to the next unseen.
  void add(const void* data, std::size_t bytes) {
    const std::uint64_t length = bytes;
    all_.add(&length, sizeof length);
    all_.add(data, bytes);
  }
  void add(double number) { add(&number, sizeof number); }
  void add(const std::string& text) { add(text.data(), text.size()); }
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  void add(const Blade& blade) {
    add(blade.name);
    add(blade.start);
    add(blade.end);
    add(blade.path);
    if (blade.method != BladeMethod::virtual_nodes) add(word_of(blade_method_words(), blade.method));
    if (blade.cuts != BladeCuts::by_force) return;
    for (const double number : {blade.sharpness, blade.edge, blade.friction}) add(number);
    if (!blade.has_faces()) return;
    for (const double number : {blade.thickness, blade.height}) add(number);
    for (const double number : blade.back_at_first()) add(number);
  }
  void add(const Program& program) {
    for (const Buffer& b : program.buffers) {
      if (b.role != BufferRole::constant && !held_by_nodes(b)) continue;  // other state does not begin with values of a model
      add(b.name);
      add(b.reals);
      add(b.ints);
    }
    for (const Pass& p : program.step) {
      add(p.kernel);
      for (const auto& [name, number] : p.defines) {
        add(name);
        add(&number, sizeof number);
      }
      for (const Arg& a : p.args) {
        if (const double* real = std::get_if<double>(&a)) add(real, sizeof *real);
      }
    }
  }
  [[nodiscard]] std::uint64_t value() const { return all_.value(); }

 private:
  Hasher all_;
};

/// Parts in their order; what is added belongs to the last one.
class Parts {
 public:
  void part(const char* name) {
    parts_.emplace_back().name = name;
    hash_ = Hash();
  }
  template <class... T>
  void add(const T&... values) {
    (hash_.add(values), ...);
    parts_.back().hash = hash_.value();
  }
  [[nodiscard]] std::vector<ModelPart> take() { return std::move(parts_); }

 private:
  std::vector<ModelPart> parts_;
  Hash hash_;
};

const NamedBytes* find(const Snapshot& snapshot, const std::string& name) {
  for (const NamedBytes& named : snapshot.buffers) {
    if (named.name == name) return &named;
  }
  return nullptr;
}

}  // namespace

std::vector<ModelPart> parts_of(const Scene& scene, const RunSettings& settings, const Model& model, const Program& program,
                                const Program& surface) {
  Parts parts;
  const auto part = [&](const char* name) { parts.part(name); };
  const auto add = [&](const auto&... values) { parts.add(values...); };
  const auto add_curve = [&](const Curve& c) {
    add(static_cast<double>(c.kind), c.start, c.duration, static_cast<double>(c.of), c.angle, c.table);
  };
  // Reserved forces and prepared cuts are part of the model. Hosts choose them (WorldOptions), and `run --resume` follows.
  if (scene.interactive) part(kInteractive);
  if (scene.cuttable) part(kCutting);
  part("curves");
  for (const Curve& c : model.curves) add_curve(c);
  part("gravity");
  for (const double g : scene.gravity) add(g);
  add_curve(scene.gravity_curve);
  part("dt");
  add(scene.dt, settings.automatic ? 0.0 : settings.first_dt);
  part("safety");
  add(scene.safety);
  part("integrator");
  add(static_cast<double>(scene.integrator));
  part("relaxation");
  add(static_cast<double>(scene.relaxation.enabled));
  if (scene.relaxation.enabled) add(scene.relaxation.tolerance);
  part("inverted");
  add(static_cast<double>(scene.inverted));
  part("least_step");
  add(scene.least_step);
  part("break_stretch");
  add(scene.break_stretch, static_cast<double>(scene.cuttable));
  part("blades");
  for (const Blade& blade : scene.blades) add(blade);
  part("focus");
  add(scene.focus.path);
  for (const Body& body : scene.bodies) {
    if (!body.model.follow.empty() && body.model.follow != kFocus) add(body.model.follow);
  }
  part("tools");
  for (const ContactTool& tool : scene.tools) add(tool.name, tool.path);
  if (!scene.joins.empty()) part("joins");
  for (const Join& join : scene.joins) add(join.break_stretch, join.break_force);
  if (!scene.changes.empty()) part("changes");
  for (const SceneChange& change : scene.changes) add(change.time, change.text);
  part("what the solver derives from the scene");
  add(static_cast<double>(settings.batch_steps), static_cast<double>(settings.tears), static_cast<double>(settings.blade_steps),
      settings.curves_end, settings.increment_floor, settings.displacement_grid);
  // Last, because some of the other parts also affect the passes.
  part("bodies (their meshes, materials, models, what holds and loads them)");
  add(program, surface);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (!scene.bodies[b].model.cut) add(static_cast<double>(b));
  }
  return parts.take();
}

std::uint64_t hash_of(const std::vector<ModelPart>& parts) {
  Hash hash;
  for (const ModelPart& part : parts) {
    hash.add(part.name);
    hash.add(&part.hash, sizeof part.hash);
  }
  return hash.value();
}

bool has_part(const std::vector<ModelPart>& parts, const char* name) {
  return std::any_of(parts.begin(), parts.end(), [&](const ModelPart& part) { return part.name == name; });
}

std::string differing(const std::vector<ModelPart>& taken, const std::vector<ModelPart>& own) {
  std::string names;
  for (const char* option : {kInteractive, kCutting}) {
    const bool had = has_part(taken, option), has = has_part(own, option);
    if (had != has)
      names +=
          fmt::format("{}{} ({} there, {} here)", names.empty() ? "" : ", ", option, had ? "on" : "off", has ? "on" : "off");
  }
  if (!names.empty()) return names;  // other parts differ because of these
  for (const ModelPart& part : own) {
    if (std::find(taken.begin(), taken.end(), part) == taken.end()) names += (names.empty() ? "" : ", ") + part.name;
  }
  return names;
}

Snapshot take_snapshot(const RunContext& run, const RunReports& reports) {
  const Program& program = run.loaded.program();
  Snapshot snapshot{parts_of(run.scene, run.settings, run.model(), program, run.loaded.surface()),
                    run.backend().info().real_bytes == 8 ? "double" : "float",
                    run.state,
                    reports,
                    {}};
  for (std::size_t id = 0; id < program.buffers.size(); ++id) {
    if (program.buffers[id].role != BufferRole::state) continue;
    snapshot.buffers.push_back({program.buffers[id].name, run.backend().read_bytes(static_cast<BufferId>(id))});
  }
  return snapshot;
}

std::uint64_t deep_hash(const Snapshot& snapshot) {
  Hash hash;
  const std::uint64_t made_of = hash_of(snapshot.made_of);
  hash.add(&made_of, sizeof made_of);
  hash.add(write_state(snapshot.state));
  for (const NamedBytes& buffer : snapshot.buffers) {
    hash.add(buffer.name);
    hash.add(buffer.bytes);
  }
  return hash.value();
}

static void need(bool good, const char* what) {
  if (!good) throw Error(ErrorCode::bad_input, fmt::format("its run state is damaged: {}", what));
}

/// Each drive begins after the one before.
template <class Drive>
static bool good_times(const std::vector<Drive>& drives) {
  double last = -std::numeric_limits<double>::infinity();
  for (const Drive& d : drives) {
    if (!std::isfinite(d.start) || !std::isfinite(d.end) || d.end < d.start || !(d.start > last)) return false;
    last = d.start;
  }
  return !drives.empty();
}

static void check_drives(const RunState& state, const Scene& scene) {
  for (const auto& [name, drives] : state.driven_blades) {
    const bool known = std::any_of(scene.blades.begin(), scene.blades.end(), [&, own = &name](const Blade& b) {
      return b.name == *own && b.cuts == BladeCuts::by_force;
    });
    need(known && good_times(drives), "a driven blade");
    for (const BladeDrive& drive : drives) {
      for (const BladeSegment& s : {drive.from, drive.to}) {
        need(vec::finite(s[0]) && vec::finite(s[1]) && s[0] != s[1], "a driven blade is not finite or has no length");
      }
    }
  }
  const std::vector<ContactTool> tools = known_tools(scene, state.tools);
  for (const auto& driven : state.driven) {
    const bool known = std::any_of(tools.begin(), tools.end(), [&](const ContactTool& t) { return t.name == driven.first; });
    const bool poses = std::all_of(driven.second.begin(), driven.second.end(),
                                   [](const ToolDrive& d) { return good_pose(d.from) && good_pose(d.to); });
    need(known && poses && good_times(driven.second), "a driven tool");
  }
}

void check_state(const RunState& state, const Model& model, const Scene& scene) {
  const auto good_clock = [&](const Clock& c) {
    need(c.dt > 0 && std::isfinite(c.dt) && std::isfinite(c.origin_time), "its step is no positive, finite number");
    need(c.origin_step >= 0 && c.step >= c.origin_step && c.step < (std::int64_t{1} << 62), "its numbers of steps");
  };
  good_clock(state.clock);
  if (state.kept) good_clock(state.kept->clock);
  const StepLimit& limit = state.limit;
  need(limit.stable_dt >= 0 && limit.dt_ceiling > 0 && limit.dt_backoff > 0 && limit.dt_backoff <= 1, "its limits of the step");
  const RelaxationState& r = state.relaxation;
  need(std::isfinite(r.damping) && (!state.kept || std::isfinite(state.kept->damping)), "its damping is not finite");
  const std::size_t texels = 4 * static_cast<std::size_t>(model.slots);
  need(r.u.size() == r.force.size() && (r.u.size() == r.v.size() || (r.v.empty() && !model.flsm.empty())) &&
           std::isfinite(r.time) && (r.u.empty() || r.u.size() == texels) &&
           (r.middle.empty() || r.middle.size() == r.u.size()) && (r.steady.empty() || r.steady.size() == r.u.size()) &&
           std::isfinite(r.largest),
       "what relaxation remembers");
  need(scene.relaxation.enabled || (!r.equilibrium && r.u.empty()), "it relaxes, and the scene does not");
  for (const SweepTriangle& t : state.pending.triangles) {
    for (const Vec3d& p : t) need(vec::finite(p), "a pending triangle is not finite");
  }
  const auto good_segment = [&](const BladeSegment& s) {
    need(vec::finite(s[0]) && vec::finite(s[1]), "a blade is not finite");
  };
  for (const BladeMove& move : state.pending.moves) {
    good_segment(move.from);
    for (const BladeSegment& s : move.to) good_segment(s);
  }
  for (const auto& [name, segment] : state.blades.placed) good_segment(segment);
  need(!state.blades.seen || std::isfinite(*state.blades.seen), "the time of its blades");
  for (const HostForce& f : state.forces) {
    need(f.body < model.bodies.size() && f.node >= 0 && vec::finite(f.force), "a force of the host");
  }
  need(!state.focus || vec::finite(*state.focus), "the focus is not finite");
  check_drives(state, scene);
  need((state.offset.empty() || state.offset.size() == 3 * static_cast<std::size_t>(model.slots)) &&
           std::all_of(state.offset.begin(), state.offset.end(), [](double o) { return std::isfinite(o); }),
       "how far loose pieces have flown");
  need(state.topology_version >= 0, "its number of edits");
  need(state.most_substeps == 0 || state.most_substeps == kSafeSubsteps, "its substeps of shape matching");
}

void check_report(const RunReports& reports, const RunState& state, const Scene& scene) {
  const std::size_t tools = scene.tools.size();
  if (reports.now.tools.size() != tools || (state.kept && reports.kept.tools.size() != tools))
    throw Error(ErrorCode::bad_input, "its report is damaged: it is of other tools");
  const auto on_a_body = [&](const auto& of) {
    return of.body >= 0 && static_cast<std::size_t>(of.body) < scene.bodies.size() && vec::finite(of.rest) &&
           vec::finite(of.place) && std::isfinite(of.time);
  };
  const auto good_attempt = [&](const StrokeAttempt& a) { return on_a_body(a) && a.from >= 0 && a.to >= 0; };
  for (const RunReport* report : {&reports.now, &reports.kept}) {
    for (const auto& [name, own] : report->strokes) {
      const bool known = std::any_of(scene.blades.begin(), scene.blades.end(), [&, wanted = &name](const Blade& b) {
        return b.name == *wanted && b.cuts == BladeCuts::by_force;
      });
      const bool good = std::all_of(own.contacts.begin(), own.contacts.end(), on_a_body) &&
                        std::all_of(own.last.begin(), own.last.end(), good_attempt) && own.last.size() <= BladeStrokes::kMost &&
                        own.attempts >= static_cast<std::int64_t>(own.last.size());
      if (!known || !good) throw Error(ErrorCode::bad_input, "its report is damaged: the strokes of its blades");
    }
  }
}

void check_ballast(const RunState& state, const Model& model) {
  std::int32_t last = -1;
  for (const NodeInertia& b : state.ballast) {
    const bool good = b.slot > last && b.slot < model.slots && model.mass[static_cast<std::size_t>(b.slot)] > 0 &&
                      b.inertia > 0 && std::isfinite(b.inertia);
    if (!good) throw Error(ErrorCode::bad_input, "its run state is damaged: the inertia given to a node");
    last = b.slot;
  }
}

void check_buffers(const Snapshot& snapshot, const Program& program) {
  for (const Buffer& buffer : program.buffers) {
    if (buffer.role != BufferRole::state) continue;
    const NamedBytes* match = find(snapshot, buffer.name);
    const std::size_t expected = buffer.values() * (snapshot.real_type == "double" && !buffer.is_int() ? 8 : 4);
    if (match == nullptr || match->bytes.size() != expected) {
      throw Error(ErrorCode::bad_input, fmt::format("buffer {} has {} bytes, the scene needs {}", buffer.name,
                                                    match == nullptr ? 0 : match->bytes.size(), expected));
    }
  }
}

void write_buffers(const Snapshot& snapshot, LoadedModel& loaded) {
  const Program& program = loaded.program();
  for (std::size_t i = 0; i < program.buffers.size(); ++i) {
    const Buffer& buffer = program.buffers[i];
    if (buffer.role != BufferRole::state) continue;
    loaded.write_bytes(static_cast<BufferId>(i), find(snapshot, buffer.name)->bytes);
  }
}

}  // namespace pliant
