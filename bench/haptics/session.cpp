#include "bench/haptics/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "backends/choice/backends.h"
#include "geometry/vec.h"
#include "pliant/error.h"

namespace pliant::bench::haptics {
namespace {

using pliant::haptics::BufferForce;
using pliant::haptics::BufferMessage;
using pliant::haptics::BufferSource;
using Clock = std::chrono::steady_clock;

ContactTool& tool_of(Scene& scene, const std::string& name) {
  for (ContactTool& t : scene.tools) {
    if (t.name == name) return t;
  }
  throw Error(ErrorCode::usage, "there is no tool \"" + name + "\"");
}

std::array<double, 8> path_point(double t, const Pose& p) {
  return {t, p.position[0], p.position[1], p.position[2], p.turn[0], p.turn[1], p.turn[2], p.turn[3]};
}

std::size_t index_of(const Simulation& s, const std::string& name) {
  const auto& tools = s.contact().tools();
  return static_cast<std::size_t>(
      std::find_if(tools.begin(), tools.end(), [&](const ContactTool& t) { return t.name == name; }) - tools.begin());
}

/// Steps until `time`, in batches that end there. `seen` receives the time and the force of every step.
template <class F>
void run_until(Simulation& s, double time, std::size_t tool, const F& seen) {
  while (!s.divergence()) {
    const auto left = static_cast<std::int64_t>(std::floor((time - s.time()) / s.dt() + 1e-6));
    if (left < 1) return;
    s.advance(s.next_batch(left));
    const auto& forces = s.contact().step_forces();
    const std::size_t tools = s.contact().tools().size(), steps = forces.size() / tools;
    for (std::size_t k = 0; k < steps; ++k) {
      const std::int64_t step = s.step() - static_cast<std::int64_t>(steps - 1 - k);
      seen(s.state().clock.time_at(step), forces[k * tools + tool]);
    }
  }
}

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

}  // namespace

ForceTrace full_model(Scene scene, const std::string& tool, const Stroke& stroke, double seconds, double rate) {
  ContactTool& own = tool_of(scene, tool);
  own.path.clear();
  for (double t = 0; t <= seconds + 1e-9; t += 1 / rate) own.path.push_back(path_point(t, stroke(t)));
  SimulationOptions steps;  // no larger than the ticks, so that it resolves as much
  {
    const Simulation probe(scene, open_backend("cpu"));
    steps.dt = 1 / (rate * std::ceil(1 / (rate * probe.dt()) - 1e-6));
  }
  Simulation s(scene, open_backend("cpu"), steps);
  ForceTrace trace{1 / rate, {}};
  double before = 0;
  Wrench last;
  run_until(s, seconds, index_of(s, tool), [&](double time, const StepForce& f) {
    while ((static_cast<double>(trace.wrench.size()) + 1) / rate <= time + 1e-12) {  // interpolated between two steps
      const double at = (static_cast<double>(trace.wrench.size()) + 1) / rate, share = (at - before) / (time - before);
      Wrench w;
      for (std::size_t c = 0; c < 3; ++c) {
        w.force[c] = last.force[c] + share * (f.force[c] - last.force[c]);
        w.torque[c] = last.torque[c] + share * (f.torque[c] - last.torque[c]);
      }
      trace.wrench.push_back(w);
    }
    before = time;
    last = {f.force, f.torque};
  });
  return trace;
}

SessionReport with_buffer(Scene scene, const std::string& tool, const Stroke& stroke, const SessionOptions& options) {
  ContactTool& own = tool_of(scene, tool);
  own.path = {path_point(0, stroke(0))};
  Simulation s(scene, open_backend("cpu"));
  BufferSource source(tool, options.rings);
  BufferForce force(options.lead);
  SessionReport out;
  out.felt.period = 1 / options.haptic_rate;
  const double frame = 1 / options.frame_rate, dt = 1 / options.haptic_rate;
  // Messages travel for `delay` frames; each has its own slot until it is replaced.
  const std::size_t slots = static_cast<std::size_t>(std::ceil(options.delay)) + 3;
  std::vector<std::unique_ptr<BufferMessage>> messages(slots);
  for (auto& m : messages) m = std::make_unique<BufferMessage>();
  std::int64_t made = 0, taken = 0;
  const auto ticks = static_cast<std::int64_t>(std::llround(options.seconds * options.haptic_rate));
  for (std::int64_t k = 1; k <= ticks; ++k) {
    const double t = static_cast<double>(k) * dt;
    // Frame n takes the tool to where it was when the frame began; its result arrives `delay` frames after that.
    while (static_cast<double>(made) * frame < t - 1e-12) {
      const double begin = static_cast<double>(made) * frame;
      BufferMessage& message = *messages[static_cast<std::size_t>(made) % slots];
      if (made > 0) {
        s.tools().drive(tool, predicted(stroke, begin - frame, options.predict * frame), frame);
        run_until(s, begin, index_of(s, tool), [](double, const StepForce&) {});
      }
      source.fill(s, force.in_use(), message);
      if (!message.covered) ++out.uncovered;
      ++made;
    }
    while (taken < made && (static_cast<double>(taken) + options.delay - 1) * frame < t - 1e-12) {
      const BufferMessage& message = *messages[static_cast<std::size_t>(taken++) % slots];
      force.receive(message, frame);
      out.built = static_cast<std::int64_t>(message.generation);
      if (message.model != nullptr) {
        out.elements = std::max(out.elements, message.model->part().elements);
        out.nodes = std::max(out.nodes, static_cast<std::int64_t>(message.model->part().slot.size()));
      }
    }
    const auto start = Clock::now();
    out.felt.wrench.push_back(force.tick(stroke(t), dt));
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    out.tick_seconds += took;
    out.worst_tick = std::max(out.worst_tick, took);
  }
  out.ticks = ticks;
  if (force.buffer() != nullptr) out.substeps = force.buffer()->substeps();
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
