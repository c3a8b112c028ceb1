#include "bench/haptics/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "backends/choice/backends.h"
#include "geometry/vec.h"
#include "geometry/wrench.h"
#include "haptics/driven_part.h"
#include "pliant/error.h"

namespace pliant::bench::haptics {
namespace {

using pliant::haptics::BufferForce;
using pliant::haptics::BufferMessage;
using pliant::haptics::BufferSource;
using pliant::haptics::DrivenPart;
using Clock = std::chrono::steady_clock;

/// Gives the tool or blade of this name a path through the poses of a stroke at these times [s].
void put_on_path(Scene& scene, const std::string& name, const Stroke& stroke, const std::vector<double>& times) {
  for (ContactTool& t : scene.tools) {
    if (t.name != name) continue;
    t.path.clear();
    for (const double time : times) {
      const Pose p = stroke(time);
      t.path.push_back({time, p.position[0], p.position[1], p.position[2], p.turn[0], p.turn[1], p.turn[2], p.turn[3]});
    }
    return;
  }
  for (Blade& b : scene.blades) {
    if (b.name != name) continue;
    const auto first = b.path.at(0);
    const double length = vec::norm({first[4] - first[1], first[5] - first[2], first[6] - first[3]});
    b.path.clear();
    for (const double time : times) {
      const BladeSegment e = pliant::haptics::blade_edge(stroke(time), length);
      b.path.push_back({time, e[0][0], e[0][1], e[0][2], e[1][0], e[1][1], e[1][2]});
    }
    return;
  }
  throw Error(ErrorCode::usage, "there is no tool or blade \"" + name + "\"");
}

/// Steps until `time`, in batches that end there. `seen` receives the time and the force of every step.
template <class F>
void run_until(Simulation& s, double time, const std::string& name, const F& seen) {
  while (!s.divergence()) {
    const auto left = static_cast<std::int64_t>(std::floor((time - s.time()) / s.dt() + 1e-6));
    if (left < 1) return;
    const std::int64_t before = s.step();
    s.advance(s.next_batch(left));
    const DrivenPart part = DrivenPart::find(s, name).value();
    const std::vector<Wrench>& forces = part.step_forces(s);
    const std::size_t parts = part.is_blade() ? s.press().names().size() : s.contact().tools().size();
    const std::int64_t known = static_cast<std::int64_t>(forces.size() / parts);
    for (std::int64_t step = before + 1; step <= s.step(); ++step) {  // where a blade is near nothing, no forces are known
      const std::int64_t k = step - (s.step() - known) - 1;
      seen(s.state().clock.time_at(step), k >= 0 ? forces[static_cast<std::size_t>(k) * parts + part.index()] : Wrench{});
    }
  }
}

/// Messages travel for `delay` frames; each has its own slot until it is replaced.
std::size_t session_slots(const SessionOptions& options) { return static_cast<std::size_t>(std::ceil(options.delay)) + 3; }

/// Where the instrument will be `ahead` seconds after `t`, if it goes on as in the last moments.
Pose predicted(const Stroke& stroke, double t, double ahead) {
  constexpr double kPast = 0.01;  // [s]
  Pose now = stroke(t);
  if (ahead > 0) {
    const Vec3d before = stroke(t - kPast).position;
    now.position = vec::add(now.position, vec::mul(vec::sub(now.position, before), ahead / kPast));
  }
  return now;
}

/// Where a hand is too quick for the simulation, its tool stays (haptics/instrument.cpp).
void try_drive(Simulation& s, const std::string& tool, const Pose& to, double seconds) {
  try {
    const DrivenPart part = DrivenPart::find(s, tool).value();
    part.drive(s, part.within_reach(s, to, seconds), seconds);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal || error.code() == ErrorCode::device) throw;
  }
}

}  // namespace

ForceTrace full_model(Scene scene, const std::string& tool, const Stroke& stroke, double seconds, double rate,
                      const std::function<void(Simulation&, double)>& edit, double frame) {
  std::vector<double> times;
  for (double t = 0; t <= seconds + 2 / rate; t += 1 / rate) times.push_back(t);  // a blade is nowhere behind its path
  put_on_path(scene, tool, stroke, times);
  SimulationOptions steps;  // no larger than the ticks, so that it resolves as much
  {
    const Simulation probe(scene, open_backend("cpu"));
    steps.dt = 1 / (rate * std::ceil(1 / (rate * probe.dt()) - 1e-6));
  }
  Simulation s(scene, open_backend("cpu"), steps);
  ForceTrace trace{1 / rate, {}};
  double before = 0;
  Wrench last;
  const auto seen = [&](double time, const Wrench& f) {
    while ((static_cast<double>(trace.wrench.size()) + 1) / rate <= time + 1e-12) {  // interpolated between two steps
      const double at = (static_cast<double>(trace.wrench.size()) + 1) / rate, share = (at - before) / (time - before);
      trace.wrench.push_back(plus(last, scaled(minus(f, last), share)));
    }
    before = time;
    last = f;
  };
  for (double t = frame; edit && t < seconds; t += frame) {
    run_until(s, t, tool, seen);
    edit(s, t);
  }
  run_until(s, seconds, tool, seen);
  return trace;
}

SessionReport run_session(Scene scene, const std::string& tool, const Stroke& stroke, const SessionOptions& options,
                          const SessionParts& parts) {
  put_on_path(scene, tool, stroke, {0});
  Simulation s(scene, open_backend("cpu"));
  SessionReport out;
  out.felt.period = 1 / options.haptic_rate;
  const double frame = 1 / options.frame_rate, dt = 1 / options.haptic_rate;
  const std::size_t slots = session_slots(options);
  const auto stalled = [&](double t) { return t > options.stalled_from && t < options.stalled_until; };
  std::int64_t made = 0, taken = 0;
  out.ticks = static_cast<std::int64_t>(std::llround(options.seconds * options.haptic_rate));
  for (std::int64_t k = 1; k <= out.ticks; ++k) {
    const double t = static_cast<double>(k) * dt;
    // Frame n takes the tool to where it will be when it ends, as seen from when it begins.
    while (static_cast<double>(made) * frame < t - 1e-12) {
      const double end = static_cast<double>(made) * frame;
      if (stalled(end)) {
        ++made;
        ++taken;
        continue;
      }
      if (made > 0) {
        if (parts.edit) parts.edit(s, end);
        try_drive(s, tool, predicted(stroke, end - frame, options.predict * frame), frame);
        run_until(s, s.time() + frame, tool, [](double, const Wrench&) {});
      }
      parts.made(s, static_cast<std::size_t>(made++) % slots);
    }
    while (taken < made && (static_cast<double>(taken) + options.delay - 1) * frame < t - 1e-12)
      parts.arrived(static_cast<std::size_t>(taken++) % slots);
    const auto start = Clock::now();
    out.felt.wrench.push_back(parts.tick(stroke(t), dt));
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    out.tick_seconds += took;
    out.worst_tick = std::max(out.worst_tick, took);
  }
  return out;
}

SessionReport with_buffer(Scene scene, const std::string& tool, const Stroke& stroke, const SessionOptions& options,
                          const std::function<void(Simulation&, double)>& edit) {
  BufferSource source(tool, options.rings);
  BufferForce force(options.lead);
  SessionReport seen;
  std::vector<std::unique_ptr<BufferMessage>> messages(session_slots(options));
  for (auto& m : messages) m = std::make_unique<BufferMessage>();
  SessionParts parts;
  parts.edit = edit;
  parts.made = [&](Simulation& s, std::size_t slot) {
    source.fill(s, force.in_use(), *messages[slot]);
    if (!messages[slot]->covered) ++seen.uncovered;
  };
  parts.arrived = [&](std::size_t slot) {
    const BufferMessage& message = *messages[slot];
    force.receive(message, 1 / options.frame_rate);
    seen.built = static_cast<std::int64_t>(message.generation);
    if (message.model == nullptr) return;
    seen.elements = std::max(seen.elements, message.model->part().elements);
    seen.nodes = std::max(seen.nodes, static_cast<std::int64_t>(message.model->part().slot.size()));
    seen.substeps = message.model->substeps();
  };
  parts.tick = [&](const Pose& pose, double dt) { return force.tick(pose, dt); };
  SessionReport out = run_session(std::move(scene), tool, stroke, options, parts);
  out.built = seen.built;
  out.uncovered = seen.uncovered;
  out.elements = seen.elements;
  out.nodes = seen.nodes;
  out.substeps = seen.substeps;
  out.resets = static_cast<std::int64_t>(force.resets());
  return out;
}

ForceError compare(const ForceTrace& felt, const ForceTrace& expected, double start) {
  ForceError e;
  std::size_t count = 0;
  for (std::size_t k = 0; k < felt.wrench.size() && k < expected.wrench.size(); ++k) {
    if (static_cast<double>(k + 1) * felt.period < start) continue;
    const double difference = vec::norm(vec::sub(felt.wrench[k].force, expected.wrench[k].force));
    const double size = vec::norm(expected.wrench[k].force);
    e.most = std::max(e.most, difference);
    e.largest = std::max(e.largest, size);
    e.rms += difference * difference;
    e.size += size * size;
    ++count;
  }
  if (count > 0) {
    e.rms = std::sqrt(e.rms / static_cast<double>(count));
    e.size = std::sqrt(e.size / static_cast<double>(count));
  }
  return e;
}

}  // namespace pliant::bench::haptics
