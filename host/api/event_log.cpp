#include "api/event_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "geometry/vec.h"
#include "model/pieces.h"
#include "scene/blade_face.h"
#include "simulation/contact/sunken_tool.h"

namespace pliant::api {
namespace {

constexpr double kDeep = 0.5, kShallow = 0.4;  // [cells] a tool becomes deep and ceases to be

std::vector<std::int64_t> pieces_of_all(const Model& model) {
  std::vector<std::int64_t> pieces;
  for (const ModelBody& body : model.bodies) pieces.push_back(pieces_of(body));
  return pieces;
}

}  // namespace

Event event_of(std::string kind, std::string subject, double amount, std::string text, const std::optional<Vec3d>& at) {
  return {std::move(kind), std::move(subject), 0, 0, at.has_value(), at.value_or(Vec3d{}), amount, std::move(text)};
}

void EventLog::add(Event event) {
  const std::lock_guard lock(mutex_);
  if (events_.size() == kMost) events_.pop_front();
  events_.push_back(std::move(event));
}

void EventLog::add(const Simulation& simulation, Event event) {
  event.step = simulation.step();
  event.time = simulation.time();
  add(std::move(event));
}

std::vector<Event> EventLog::take() {
  const std::lock_guard lock(mutex_);
  std::vector<Event> events(std::make_move_iterator(events_.begin()), std::make_move_iterator(events_.end()));
  events_.clear();
  return events;
}

std::vector<CutAttempt> EventLog::take_attempts() {
  const std::lock_guard lock(mutex_);
  std::vector<CutAttempt> attempts(std::make_move_iterator(attempts_.begin()), std::make_move_iterator(attempts_.end()));
  attempts_.clear();
  return attempts;
}

void EventLog::renew(const Simulation& simulation) {
  const RunReport& report = simulation.report();
  opened_ = simulation.state().opened;
  topology_ = simulation.topology_version();
  calmed_ = report.inversions.calmed;
  inverted_ = report.inversions.last;
  made_again_ = report.made_again;
  diverged_ = simulation.divergence().has_value();
  pieces_ = pieces_of_all(simulation.model());
  deep_.clear();
  passed_.clear();
  at_work_ = simulation.backend().at_work().name;
  gave_way_.clear();
  for (const auto& [name, blade] : simulation.state().pressed) gave_way_[name] = blade.first >= 0;
  attempts_seen_.clear();
  {
    const std::lock_guard lock(mutex_);
    attempts_.clear();
  }
  for (const auto& [name, strokes] : report.strokes) attempts_seen_[name] = strokes.attempts;
}

void EventLog::look_at_pieces(const Simulation& simulation) {
  const std::int64_t version = simulation.topology_version();
  if (std::exchange(topology_, version) == version) return;
  std::vector<std::int64_t> before = std::exchange(pieces_, pieces_of_all(simulation.model()));
  before.resize(pieces_.size());
  for (std::size_t b = 0; b < pieces_.size(); ++b) {
    if (pieces_[b] == before[b]) continue;
    const std::string& body = simulation.model().bodies[b].name;
    const std::string text = fmt::format("body '{}' has {} pieces, {} before", body, pieces_[b], before[b]);
    add(simulation, event_of("pieces", body, static_cast<double>(pieces_[b]), text, simulation.edited_at()));
  }
}

void EventLog::look_at_tools(const Simulation& simulation) {
  const std::vector<ToolHistory>& felt = simulation.report().tools;
  const std::vector<ContactTool>& tools = simulation.contact().tools();
  if (tools.empty() || simulation.model().contact == nullptr) return;
  for (std::size_t t = 0; t < std::min(felt.size(), tools.size()); ++t) {
    if (is_face(tools[t])) continue;  // it stands in what its edge has opened
    look_at_sunken(simulation, tools[t].name, felt[t].sunk);
    const double cells = felt[t].now.depth / simulation.model().contact->spacing;
    bool& deep = deep_[tools[t].name];
    if ((cells > (deep ? kShallow : kDeep)) == deep) continue;
    deep = !deep;
    if (!deep) continue;
    const std::string text = fmt::format("tool '{}' is {:.2g} cells deep in tissue", tools[t].name, cells);
    add(simulation, event_of("deep", tools[t].name, cells, text, simulation.contact().pose(t, simulation.time()).position));
  }
}

void EventLog::look_at_sunken(const Simulation& simulation, const std::string& tool, const SunkenTool& sunk) {
  const double cells = sunk.cells();
  const bool passed = cells > sunken_cells;
  if (std::exchange(passed_[tool], passed) || !passed) return;
  const std::string& body = simulation.model().bodies[static_cast<std::size_t>(sunk.body)].name;
  const std::string text = fmt::format(
      "tool '{}' stands {:.3g} m ({:.2g} cells) below the surface of body '{}', which has let it through or does not yield",
      tool, sunk.depth, cells, body);
  add(simulation, event_of("passed", tool, cells, text, sunk.where));
}

void EventLog::look_at_backend(const Simulation& simulation) {
  const std::string& now = simulation.backend().at_work().name;
  if (std::exchange(at_work_, now) == now) return;
  add(simulation, event_of("backend", now, 0, fmt::format("{} computes from here on, with the same bits", now)));
}

void EventLog::look_at_blades(const Simulation& simulation) {
  for (const auto& [name, blade] : simulation.state().pressed) {
    if (blade.first < 0 || std::exchange(gave_way_[name], true)) continue;
    const auto own = std::find_if(simulation.scene().blades.begin(), simulation.scene().blades.end(),
                                  [&, wanted = &name](const Blade& b) { return b.name == *wanted; });
    const BladeSegment at = blade_place(simulation.state().driven_blades, *own, simulation.time());
    const Vec3d middle = vec::mul(vec::add(at[0], at[1]), 0.5);
    const std::string text = fmt::format("tissue gave way to blade '{}' at up to {:.4g} N", name, blade.max_force);
    add(simulation, event_of("gave_way", name, blade.max_force, text, middle));
  }
}

void EventLog::look_at_strokes(const Simulation& simulation) {
  for (const auto& [name, strokes] : simulation.report().strokes) {
    const std::int64_t seen = std::exchange(attempts_seen_[name], strokes.attempts);
    if (seen >= strokes.attempts) continue;
    const std::lock_guard lock(mutex_);
    strokes.after(seen, [&, blade = &name](const StrokeAttempt& a) {
      if (attempts_.size() == kMost) attempts_.pop_front();
      const std::string& body = simulation.scene().bodies[static_cast<std::size_t>(a.body)].name;
      attempts_.push_back({*blade, body, a.stroke, a.from, a.to, a.time, a.place, a.rest, a.gave_way});
    });
  }
}

void EventLog::look(const Simulation& simulation) {
  const RunReport& report = simulation.report();
  const Inversions& inverted = report.inversions;
  const std::int64_t opened = simulation.state().opened;
  if (const std::int64_t more = opened - std::exchange(opened_, opened); more > 0) {
    const std::string text = fmt::format("{} edges parted under the load", more);
    add(simulation, event_of("opened", {}, static_cast<double>(more), text, simulation.edited_at()));
  }
  look_at_pieces(simulation);
  if (const std::int64_t before = std::exchange(inverted_, inverted.last); inverted.last > 0 && before == 0) {
    const std::string text = fmt::format("{} elements are turned inside out and driven back", inverted.last);
    add(simulation, event_of("inverted", inverted.body, static_cast<double>(inverted.last), text));
  }
  if (const std::int64_t more = inverted.calmed - std::exchange(calmed_, inverted.calmed); more > 0) {
    const std::string text = fmt::format("in {} elements, motion faster than waves was taken out", more);
    add(simulation, event_of("calmed", {}, static_cast<double>(more), text));
  }
  if (const std::int64_t more = report.made_again - std::exchange(made_again_, report.made_again); more > 0) {
    add(simulation, event_of("rolled_back", {}, static_cast<double>(more), "steps were made again, smaller"));
  }
  look_at_backend(simulation);
  look_at_tools(simulation);
  look_at_blades(simulation);
  look_at_strokes(simulation);
  const bool diverged = simulation.divergence().has_value();
  if (!std::exchange(diverged_, diverged) && diverged) {
    const Divergence& d = *simulation.divergence();
    add(simulation, event_of("diverged", d.body, static_cast<double>(d.element), d.message()));
  }
}

}  // namespace pliant::api
