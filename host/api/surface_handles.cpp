#include "api/surface_handles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace pliant::api {
namespace {

constexpr double kPeriod = 0.002;  ///< update interval of the grab springs [s]
constexpr double kCatchUp = 0.2;   ///< time in which the integral part removes the spring's remaining error [s]
constexpr double kFree = 0.25;     ///< largest fraction of a free patch's momentum balance that one update may change
constexpr double kHandful = 2;     ///< radius of a grab in edges of cells where none is given
constexpr double kStrain = 3;      ///< largest force over Young's modulus times the square of the radius
constexpr double kStretch = 0.25;  ///< and over the modulus times the body's cross-section, of a cube of its volume
constexpr std::int32_t kAnySteps = 1 << 20;

Vec3d limited(const Vec3d& v, double most) {
  const double size = std::hypot(v[0], v[1], v[2]);
  if (size <= most) return v;
  return {v[0] * most / size, v[1] * most / size, v[2] * most / size};
}

double edge_of(const ModelBody& body) {
  if (body.spacing > 0) return body.spacing;
  return std::cbrt(body.volume / static_cast<double>(std::max<std::int64_t>(body.elements(), 1)));
}

/// Marks the nodes `own` and those within `radius` of the point `x` that elements within it connect with them, so that a hand
/// does not hold the other side of a cut.
std::vector<char> handful_of(const ModelBody& body, const std::vector<NodeShare>& own, const Vec3d& x, double radius) {
  std::vector<char> held(body.slot.size()), near(body.slot.size());
  for (std::size_t n = 0; n < near.size(); ++n) {
    const Vec3d& at = body.rest[n];
    near[n] = std::hypot(at[0] - x[0], at[1] - x[1], at[2] - x[2]) <= radius ? 1 : 0;
  }
  for (const NodeShare& n : own) held[static_cast<std::size_t>(n.node)] = near[static_cast<std::size_t>(n.node)] = 1;
  std::vector<std::span<const std::int32_t>> elements;  // those that may connect any
  const auto marked = [](const std::vector<char>& marks) {
    return [&marks](std::int32_t n) { return marks[static_cast<std::size_t>(n)] != 0; };
  };
  const auto collect = [&](const auto& all) {
    for (const auto& nodes : all) {
      if (std::any_of(nodes.begin(), nodes.end(), marked(near))) elements.emplace_back(nodes);
    }
  };
  collect(body.hexes);
  collect(body.tets);
  for (bool more = true; more;) {
    more = false;
    for (const std::span<const std::int32_t> nodes : elements) {
      if (std::none_of(nodes.begin(), nodes.end(), marked(held))) continue;
      for (const std::int32_t n : nodes) {
        if (marked(held)(n) || !marked(near)(n)) continue;
        held[static_cast<std::size_t>(n)] = 1;
        more = true;
      }
    }
  }
  return held;
}

}  // namespace

SurfaceHandles::SurfaceHandles(std::shared_ptr<const Model> model, const Scene& scene) {
  for (const Body& b : scene.bodies) materials_.push_back(b.material);
  set_model(std::move(model));
}

void SurfaceHandles::set_model(std::shared_ptr<const Model> model) {
  model_ = std::move(model);
  node_of_.assign(static_cast<std::size_t>(model_->slots), {});
  for (std::size_t b = 0; b < model_->bodies.size(); ++b) {
    const auto& slots = model_->bodies[b].slot;
    for (std::size_t n = 0; n < slots.size(); ++n) {
      node_of_[static_cast<std::size_t>(slots[n])] = {b, static_cast<std::int64_t>(n)};
    }
  }
}

void SurfaceHandles::follow(std::shared_ptr<const Model> model) {
  const std::lock_guard lock(mutex_);
  if (model == model_) return;
  set_model(std::move(model));
  // Restoring a state before a cut may remove vertices and nodes.
  std::erase_if(grabs_, [&](const auto& entry) { return !has(entry.second.vertex); });
  std::erase_if(traces_, [&](const auto& entry) { return !grabs_.contains(entry.first); });
  std::erase_if(pushes_, [&](const auto& entry) { return !has(entry.first); });
  std::erase_if(node_pushes_, [&](const auto& entry) {
    return entry.first.second >= static_cast<std::int64_t>(model_->bodies[entry.first.first].slot.size());
  });
  for (auto& [id, grab] : grabs_) hold(grab);
  changed_ = changed_ || !pushes_.empty() || !node_pushes_.empty();
}

bool SurfaceHandles::has(const SurfaceVertex& vertex) const {
  return vertex.body < model_->bodies.size() && vertex.local >= 0 && vertex.local < model_->bodies[vertex.body].vertices;
}

void SurfaceHandles::check_vertex(const SurfaceVertex& vertex) const {
  if (has(vertex)) return;
  throw Error(ErrorCode::usage, fmt::format("there is no vertex {} of body {} any more", vertex.local, vertex.body));
}

std::vector<NodeShare> SurfaceHandles::nodes_of(const SurfaceVertex& vertex) const {
  std::vector<NodeShare> nodes;
  const auto v = static_cast<std::size_t>(model_->bodies[vertex.body].first_vertex) + static_cast<std::size_t>(vertex.local);
  for (std::size_t a = 0; a < 8; ++a) {
    if (model_->surface.weights[v][a] == 0) continue;
    const auto [body, node] = node_of_[static_cast<std::size_t>(model_->surface.nodes[v][a])];
    nodes.push_back({body, node, model_->surface.weights[v][a]});
  }
  return nodes;
}

/// Finds the nodes of a grab. Only nodes with a reserved force, which move the surface, can be held.
void SurfaceHandles::hold(Grab& g) const {
  const std::size_t b = g.vertex.body;
  const ModelBody& body = model_->bodies[b];
  const double r = g.options.radius > 0 ? g.options.radius : kHandful * edge_of(body);
  g.point = nodes_of(g.vertex);
  g.rest = model_->surface.rest[static_cast<std::size_t>(body.first_vertex) + static_cast<std::size_t>(g.vertex.local)];
  const std::vector<char> handful = handful_of(body, g.point, g.rest, r);
  g.patch.clear();
  g.mass = 0;
  for (const NodeForce& f : model_->forces) {
    const auto [of, n] = node_of_[static_cast<std::size_t>(f.slot)];
    if (!f.reserved || of != b) continue;
    if (handful[static_cast<std::size_t>(n)] == 0) continue;
    const double mass = model_->mass[static_cast<std::size_t>(f.slot)];
    g.patch.push_back({b, n, mass});
    g.mass += mass;
  }
  for (NodeShare& p : g.patch) p.share /= g.mass;
  // A disk of radius r on a half-space has the stiffness 2 E r / (1 - nu^2); half of that cannot overshoot at rest.
  const double young = materials_[b].moduli.young(), size = std::max(r, edge_of(body));
  g.stiffness = g.options.stiffness > 0 ? g.options.stiffness : young * size;
  const double area = std::cbrt(body.volume * body.volume);
  g.max_force = g.options.max_force > 0 ? g.options.max_force : young * std::min(kStrain * size * size, kStretch * area);
}

GrabId SurfaceHandles::grab(const SurfaceVertex& vertex, const GrabOptions& options) {
  if (!(options.radius >= 0 && options.stiffness >= 0 && options.max_force >= 0)) {
    throw Error(ErrorCode::usage, "radius, stiffness and max_force of a grab must be 0 or more");
  }
  const std::lock_guard lock(mutex_);
  check_vertex(vertex);
  Grab g;
  g.vertex = vertex;
  g.options = options;
  hold(g);
  grabs_.emplace(++last_id_, std::move(g));
  return last_id_;
}

void SurfaceHandles::move(GrabId id, const Vec3d& target) {
  for (const double x : target) {
    if (!std::isfinite(x)) throw Error(ErrorCode::usage, fmt::format("the target of a grab has the coordinate {}", x));
  }
  const std::lock_guard lock(mutex_);
  const auto found = grabs_.find(id);
  if (found == grabs_.end()) throw Error(ErrorCode::usage, fmt::format("there is no grab {}", id));
  found->second.target = target;
}

std::vector<ForceSample> SurfaceHandles::trace(GrabId id, std::int64_t after) {
  const std::lock_guard lock(mutex_);
  if (!grabs_.contains(id)) throw Error(ErrorCode::usage, fmt::format("there is no grab {}", id));
  return traces_[id].after(after);
}

GrabState SurfaceHandles::state(GrabId id) {
  const std::lock_guard lock(mutex_);
  const auto found = grabs_.find(id);
  if (found == grabs_.end()) throw Error(ErrorCode::usage, fmt::format("there is no grab {}", id));
  return found->second.felt;
}

void SurfaceHandles::release(GrabId id) {
  const std::lock_guard lock(mutex_);
  if (grabs_.erase(id) == 0) throw Error(ErrorCode::usage, fmt::format("there is no grab {}", id));
  traces_.erase(id);
  changed_ = true;
}

void SurfaceHandles::push(const SurfaceVertex& vertex, const Vec3d& force) {
  for (const double x : force) {
    if (!std::isfinite(x)) {
      throw Error(ErrorCode::usage,
                  fmt::format("a force on vertex {} of body {} has the component {}", vertex.local, vertex.body, x));
    }
  }
  const std::lock_guard lock(mutex_);
  check_vertex(vertex);
  pushes_[vertex] = force;
  if (force == Vec3d{}) pushes_.erase(vertex);
  changed_ = true;
}

void SurfaceHandles::push_node(std::size_t body, std::int64_t node, const Vec3d& force) {
  const std::lock_guard lock(mutex_);
  if (body >= model_->bodies.size() || node < 0 || node >= static_cast<std::int64_t>(model_->bodies[body].slot.size())) {
    throw Error(ErrorCode::usage, fmt::format("there is no node {} of body {}", node, body));
  }
  const std::int32_t slot = model_->bodies[body].slot[static_cast<std::size_t>(node)];
  if (std::none_of(model_->forces.begin(), model_->forces.end(),
                   [&](const NodeForce& f) { return f.reserved && f.slot == slot; })) {
    throw Error(ErrorCode::usage, fmt::format("node {} of body {} moves no vertex of the surface", node, body));
  }
  for (const double x : force) {
    if (!std::isfinite(x)) throw Error(ErrorCode::usage, fmt::format("a force on node {} has the component {}", node, x));
  }
  node_pushes_[{body, node}] = force;
  if (force == Vec3d{}) node_pushes_.erase({body, node});
  changed_ = true;
}

void SurfaceHandles::move_focus(const Vec3d& position) {
  for (const double x : position) {
    if (!std::isfinite(x)) throw Error(ErrorCode::usage, fmt::format("the position of the tool has the coordinate {}", x));
  }
  const std::lock_guard lock(mutex_);
  focus_ = position;
}

void SurfaceHandles::hold_back() {
  const std::lock_guard lock(mutex_);
  holds_back_ = true;
  focus_.reset();
}

void SurfaceHandles::go_on() {
  const std::lock_guard lock(mutex_);
  holds_back_ = false;
}

void SurfaceHandles::clear() {
  const std::lock_guard lock(mutex_);
  grabs_.clear();
  traces_.clear();
  pushes_.clear();
  node_pushes_.clear();
  focus_.reset();
  changed_ = true;
}

/// Spring and damper between the target and the mean of the patch that they act on, which takes energy out of every mode, and
/// an integral part that grows until the vertex is at its target. `period`: time until the next update [s]; the gains are
/// limited to the stability range of explicit steps of a free patch.
Vec3d SurfaceHandles::pull(const Grab& grab, Pull& state, const Vec3d& position, const Vec3d& mean, double time,
                           double period) const {
  const double k = std::min(grab.stiffness, kFree * grab.mass / (period * period));
  const double c = std::min(2 * std::sqrt(k * grab.mass), kFree * grab.mass / period);
  const double elapsed = std::max(0.0, time - state.time);  // a batch may have been taken back
  Vec3d force{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double speed = elapsed > 0 ? (mean[i] - state.before[i]) / elapsed : 0;
    state.held[i] += k * std::min(1.0, elapsed / kCatchUp) * (state.target[i] - position[i]);
    force[i] = k * (state.target[i] - mean[i]) + state.held[i] - c * speed;
  }
  state.held = limited(state.held, grab.max_force);
  state.before = mean;
  state.time = time;
  return limited(force, grab.max_force);
}

void SurfaceHandles::renew() {
  const std::lock_guard lock(mutex_);
  traces_.clear();
  pulls_.clear();
  limits_.clear();
  changed_ = true;
}

std::int32_t SurfaceHandles::apply(Simulation& simulation) {
  follow(simulation.shared_model());
  std::map<GrabId, Grab> grabs;
  std::vector<HostForce> forces;
  {
    const std::lock_guard lock(mutex_);
    if (focus_ && !holds_back_) simulation.set_focus(*std::exchange(focus_, std::nullopt));
    if (grabs_.empty() && !changed_) return kAnySteps;
    changed_ = false;
    grabs = grabs_;
    for (const auto& [vertex, force] : pushes_) {
      for (const NodeShare& n : nodes_of(vertex)) {
        forces.push_back({n.body, n.node, {n.share * force[0], n.share * force[1], n.share * force[2]}});
      }
    }
    for (const auto& [at, force] : node_pushes_) forces.push_back({at.first, at.second, force});
  }
  std::erase_if(pulls_, [&](const auto& entry) { return !grabs.contains(entry.first); });
  const auto steps = static_cast<std::int32_t>(std::clamp(kPeriod / simulation.dt(), 1.0, 64.0));
  std::map<std::size_t, std::vector<Vec3d>> displacements;
  for (auto& [id, grab] : grabs) {
    const std::size_t body = grab.vertex.body;
    if (!displacements.contains(body)) displacements[body] = simulation.displacements(body);
    const std::vector<Vec3d>& u = displacements[body];
    const auto moved = [&u, rest = grab.rest](const std::vector<NodeShare>& nodes) {
      Vec3d at = rest;
      for (const NodeShare& n : nodes) {
        for (std::size_t c = 0; c < 3; ++c) at[c] += n.share * u[static_cast<std::size_t>(n.node)][c];
      }
      return at;
    };
    const Vec3d position = moved(grab.point), mean = moved(grab.patch);
    const auto [state, first] = pulls_.try_emplace(id, Pull{position, mean, {}, simulation.time()});
    if (grab.target) state->second.target = *grab.target;
    const Vec3d f = pull(grab, state->second, position, mean, simulation.time(), steps * simulation.dt());
    grab.felt.force = f;
    for (std::size_t c = 0; c < 3; ++c) grab.felt.gap[c] = state->second.target[c] - position[c];
    const double size = std::hypot(f[0], f[1], f[2]);
    if (!std::exchange(grab.felt.limited, size >= 0.999 * grab.max_force) && grab.felt.limited)
      limits_.push_back({id, position, size});
    for (const NodeShare& n : grab.patch) {
      forces.push_back({n.body, n.node, {n.share * f[0], n.share * f[1], n.share * f[2]}});
    }
  }
  simulation.set_forces(std::move(forces));
  const std::lock_guard lock(mutex_);
  for (const auto& [id, grab] : grabs) {
    const auto found = grabs_.find(id);
    if (found == grabs_.end()) continue;
    found->second.felt = grab.felt;
    ForceTrace& trace = traces_[id];
    trace.forget_after(simulation.step());
    trace.add({{grab.felt.force, {}}, simulation.step() + 1, simulation.time() + simulation.dt()});
  }
  return grabs.empty() ? kAnySteps : steps;
}

}  // namespace pliant::api
