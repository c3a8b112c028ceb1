#include "simulation/edits/blade_fronts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/vec.h"
#include "tearing/breaking.h"

namespace pliant {
namespace {

constexpr double kPerEdge = 2;  ///< samples per typical edge
constexpr std::int32_t kMostSamples = 512;
constexpr double kOffSurface = 0.25;  ///< a sample that cut nothing and is this far off has left [edges]
constexpr double kOutOfCut =
    4;  ///< one that has cut, beyond the way that it has cut: until then it finds its cut again [edges]
constexpr double kSideways = 1;  ///< a front point that is this far beside the sample is no longer its own [edges]
constexpr double kBeside = 1.5;  ///< what goes with the last sample that cuts, so that edges at a side are cut [edges]
constexpr double kBehind = 1, kAhead = 0.25;  ///< where a sample looks for a surface, besides its way [edges]
constexpr double kRounding = 1e-6;            ///< [edges]
constexpr double kBefore = 0.1;               ///< above the surface the first sweep of a front begins [edges]
constexpr double kFacing = -0.2;              ///< a surface whose normal is less against the edge than this is passed along
constexpr double kTurns = 0.2;                ///< cosine up to which a moving edge in tissue keeps pressing forward
constexpr double kLost = 0.5;                 ///< of the integrity is lost where tissue has given way ...
constexpr double kLostIn = 0.25;              ///< ... half of that within this way [edges]
constexpr double kNeverGives = 1e30;          ///< F* of tissue without a toughness [N]

FrontKind kind_of(const FrontSample& s) { return static_cast<FrontKind>(s.kind); }
void set_kind(FrontSample& s, FrontKind kind) { s.kind = static_cast<std::int32_t>(kind); }

/// Place at which a ray from `from` along the unit vector `n` crosses a triangle [m], and the cosine between n and its normal.
struct Crossing {
  double at = 0, facing = 0;
};
std::optional<Crossing> crossing(const Vec3d& from, const Vec3d& n, const std::array<Vec3d, 3>& t) {
  const Vec3d a = vec::sub(t[1], t[0]), b = vec::sub(t[2], t[0]), normal = vec::cross(a, b);
  const double size = vec::norm(normal), against = vec::dot(normal, n);
  if (!(size > 0) || std::abs(against) < 1e-9 * size) return {};
  const double at = vec::dot(vec::sub(t[0], from), normal) / against;
  const Vec3d r = vec::sub(vec::add(from, vec::mul(n, at)), t[0]);
  const double s = vec::dot(vec::cross(r, b), normal) / (size * size), q = vec::dot(vec::cross(a, r), normal) / (size * size);
  if (s < -1e-9 || q < -1e-9 || s + q > 1 + 1e-9) return {};
  return Crossing{at, against / size};
}

}  // namespace

double typical_edge(const Model& model) {
  double edge = HUGE_VAL;
  for (const ModelBody& b : model.bodies) {
    // A regular tetrahedron of volume V has edges of 2.04 V^(1/3).
    const double own =
        b.spacing > 0 ? b.spacing : 2.04 * std::cbrt(b.volume / static_cast<double>(std::max<std::int64_t>(b.elements(), 1)));
    edge = std::min(edge, own);
  }
  return edge;
}

double integrity_left(double depth, double edge) { return 1 - kLost * (depth / (depth + kLostIn * edge)); }

std::int32_t sample_count(const Blade& blade, double edge) {
  double longest = 0;
  for (const auto& r : blade.path) longest = std::max(longest, vec::norm({r[4] - r[1], r[5] - r[2], r[6] - r[3]}));
  const double parts = std::ceil(kPerEdge * longest / edge);
  return 1 + static_cast<std::int32_t>(std::clamp(parts, 1.0, kMostSamples - 1.0));
}

double top_speed(const Blade& blade) {
  double speed = 0;
  for (std::size_t i = 1; i < blade.path.size(); ++i) {
    const auto &a = blade.path[i - 1], &b = blade.path[i];
    for (std::size_t end : {1U, 4U}) {
      speed = std::max(speed, vec::norm({b[end] - a[end], b[end + 1] - a[end + 1], b[end + 2] - a[end + 2]}) / (b[0] - a[0]));
    }
  }
  return speed;
}

struct BladeFronts::Edge {
  const Blade& blade;
  double size = 0;     ///< mean edge of elements [m]
  double spacing = 0;  ///< of the samples [m]
  double time = 0;
  Vec3d along{};         ///< unit vector
  Vec3d motion{};        ///< of its middle until the next update, across the edge [m]
  std::vector<Vec3d> x;  ///< samples [m]

  Edge(const Blade& b, const BladeDrives& driven, std::size_t samples, double length, double now, double until)
      : blade(b), size(length), time(now) {
    const BladeSegment at = blade_place(driven, b, now), next = blade_place(driven, b, until);
    const Vec3d span = vec::sub(at[1], at[0]);
    spacing = vec::norm(span) / static_cast<double>(samples - 1);
    along = vec::mul(span, 1 / vec::norm(span));
    motion = vec::mul(vec::add(vec::sub(next[0], at[0]), vec::sub(next[1], at[1])), 0.5);
    motion = vec::sub(motion, vec::mul(along, vec::dot(motion, along)));
    for (std::size_t i = 0; i < samples; ++i) {
      x.push_back(vec::add(at[0], vec::mul(span, static_cast<double>(i) / static_cast<double>(samples - 1))));
    }
  }
};

std::vector<CutEdges> BladeFronts::update(EditedBodies& bodies, const std::vector<double>& u, double until) {
  const double now = run_.state.clock.time();
  std::vector<CutEdges> edges(run_.scene.bodies.size());
  x_.clear();
  for (std::size_t b = 0; b < edges.size(); ++b) x_.push_back(run_.loaded.positions(u, b));
  std::optional<PresentSurface> surface;
  const double size = run_.settings.blade_edge;
  for (const Blade& b : run_.scene.blades) {
    if (b.cuts != BladeCuts::by_force) continue;
    PressedBlade& blade = run_.state.pressed[b.name];
    blade.samples.resize(static_cast<std::size_t>(sample_count(b, size)));
    if (!blade_present(run_.state.driven_blades, b, now, until)) {
      std::fill(blade.samples.begin(), blade.samples.end(), FrontSample{});
      strokes_.look(b.name, blade.samples, {}, bodies, x_);
      continue;
    }
    const Edge edge(b, run_.state.driven_blades, blade.samples.size(), size, now, until);
    if (!(edge.spacing > 0)) continue;  // its ends pass through each other
    std::vector<char> held;
    for (const FrontSample& s : blade.samples) held.push_back(kind_of(s) == FrontKind::held ? 1 : 0);
    let_go(blade, edge, bodies);
    give_way(blade, edge, bodies, edges);
    turn(blade, edge);
    if (!surface) surface.emplace(run_.model(), u);
    meet(blade, edge, bodies, *surface);
    strokes_.look(b.name, blade.samples, held, bodies, x_);
    for (std::size_t i = 0; i < blade.samples.size(); ++i) {
      FrontSample& s = blade.samples[i];
      s.pressed = 0;
      const bool end = i == 0 || i + 1 == blade.samples.size();
      s.limit = kind_of(s) == FrontKind::ahead || kind_of(s) == FrontKind::held
                    ? limit(b, s, (end ? 0.5 : 1) * edge.spacing, bodies)
                    : 0;
    }
  }
  return edges;
}

/// The edge presses where it goes, and while it is drawn out of its cut, where it went.
void BladeFronts::turn(PressedBlade& blade, const Edge& edge) const {
  const double way = vec::norm(edge.motion);
  if (!(way > 1e-9 * edge.size)) return;
  const Vec3d forward = vec::mul(edge.motion, 1 / way);
  const bool held = std::any_of(blade.samples.begin(), blade.samples.end(),
                                [](const FrontSample& s) { return kind_of(s) == FrontKind::held; });
  if (!held || vec::dot(forward, blade.normal) > kTurns) blade.normal = forward;
}

void BladeFronts::let_go(PressedBlade& blade, const Edge& edge, EditedBodies& bodies) const {
  for (std::size_t i = 0; i < blade.samples.size(); ++i) {
    FrontSample& s = blade.samples[i];
    if (kind_of(s) == FrontKind::ahead) set_kind(s, s.pressed > 0 ? FrontKind::held : FrontKind::none);
    if (kind_of(s) != FrontKind::held) continue;
    const auto b = static_cast<std::size_t>(s.body);
    const Vec3d d = vec::sub(edge.x[i], front_place(bodies.topology(b), x_[b], s.point));
    const double gap = vec::dot(d, blade.normal) - s.advance;
    const double side = vec::norm(vec::sub(d, vec::mul(blade.normal, vec::dot(d, blade.normal))));
    const bool left =
        s.depth + s.advance > 0 ? gap < -(s.depth + s.advance + kOutOfCut * edge.size) : gap < -kOffSurface * edge.size;
    if (left || side > kSideways * edge.size) s = {};
  }
}

/// Where tissue has given way the front goes through it to where the edge is, less what is elastic.
void BladeFronts::give_way(PressedBlade& blade, const Edge& edge, EditedBodies& bodies, std::vector<CutEdges>& edges) {
  for (std::size_t b = 0; b < edges.size(); ++b) {
    const bool cuts = std::any_of(blade.samples.begin(), blade.samples.end(), [&](const FrontSample& s) {
      return kind_of(s) == FrontKind::held && s.advance > 0 && static_cast<std::size_t>(s.body) == b;
    });
    if (!cuts) continue;
    if (blade.first < 0) blade.first = edge.time;
    sweep(blade, edge, bodies, b, edges[b]);
    bodies.keep_allowed(b, edges[b]);
  }
}

/// The rows of a sweep: per sample whether it takes part, where its front is and where it goes.
struct BladeFronts::Sweep {
  std::vector<char> takes;
  std::vector<MaterialPoint> point;
  std::vector<Vec3d> from, until;

  Sweep(const PressedBlade& blade, const Edge& edge, const CutTopology& body, const std::vector<Vec3d>& x, std::size_t b)
      : takes(blade.samples.size()), point(takes.size()), from(takes.size()), until(takes.size()) {
    const Vec3d& n = blade.normal;
    std::vector<double> gap(takes.size());
    for (std::size_t i = 0; i < takes.size(); ++i) {
      const FrontSample& s = blade.samples[i];
      if (kind_of(s) != FrontKind::held || static_cast<std::size_t>(s.body) != b) continue;
      takes[i] = 1;
      point[i] = s.point;
      from[i] = until[i] = front_place(body, x, s.point);
      gap[i] = vec::dot(vec::sub(edge.x[i], from[i]), n) - s.advance;
      if (s.advance > 0) until[i] = vec::sub(edge.x[i], vec::mul(n, gap[i]));
      if (s.advance > 0 && s.depth == 0) {  // edges in the surface, where the front stood, are crossed too
        point[i] = {};
        from[i] = vec::sub(from[i], vec::mul(n, kBefore * edge.size));
      }
    }
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(kBeside * edge.size / edge.spacing));
    for (std::ptrdiff_t i = 0; i < std::ssize(takes); ++i) {
      if (takes[i] != 0) continue;
      for (std::ptrdiff_t k = 1; k <= reach && takes[i] == 0; ++k) {
        for (const std::ptrdiff_t j : {i - k, i + k}) {
          if (j < 0 || j >= std::ssize(takes) || takes[j] != 1) continue;
          follow(blade, edge, body, x, b, static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                 gap[static_cast<std::size_t>(j)]);
          break;
        }
      }
    }
  }
  /// Sample i, which touches nothing, goes with sample j.
  void follow(const PressedBlade& blade, const Edge& edge, const CutTopology& body, const std::vector<Vec3d>& x, std::size_t b,
              std::size_t i, std::size_t j, double gap) {
    const FrontSample &s = blade.samples[i], &lead = blade.samples[j];
    if (!(lead.depth + lead.advance > 0)) return;
    takes[i] = 2;
    until[i] = vec::sub(edge.x[i], vec::mul(blade.normal, gap));
    if (kind_of(s) == FrontKind::beside && static_cast<std::size_t>(s.body) == b) {
      point[i] = s.point;
      from[i] = front_place(body, x, s.point);
      if (lead.advance == 0) until[i] = from[i];
    } else {
      from[i] = vec::sub(edge.x[i], vec::mul(blade.normal, gap + lead.advance + (lead.depth == 0 ? kBefore * edge.size : 0)));
    }
  }
};

void BladeFronts::sweep(PressedBlade& blade, const Edge& edge, EditedBodies& bodies, std::size_t b, CutEdges& edges) const {
  const Sweep all(blade, edge, bodies.topology(b), x_[b], b);
  BladeSweep blades = bodies.sweep(b, x_[b]);
  for (std::size_t i = 0; i < all.takes.size();) {
    std::size_t end = i;
    while (end < all.takes.size() && all.takes[end] != 0) ++end;
    if (end == i) {
      if (kind_of(blade.samples[i]) == FrontKind::beside) blade.samples[i] = {};
      ++i;
      continue;
    }
    const std::size_t n = end - i;
    const std::vector<MaterialPoint> now = blades.advance(std::span(all.point).subspan(i, n), std::span(all.from).subspan(i, n),
                                                          std::span(all.until).subspan(i, n));
    for (std::size_t k = 0; k < n; ++k) {
      FrontSample& s = blade.samples[i + k];
      const bool held = all.takes[i + k] == 1;
      if (held && s.advance == 0) continue;
      if (held) weaken(blade, s, edge);
      const double least = *std::min_element(now[k].weight.begin(), now[k].weight.end());
      s.body = static_cast<std::int32_t>(b);
      s.point = now[k];
      // A front that has come out on the far side only goes with the others.
      if (!held || least < -1e-3) set_kind(s, FrontKind::beside);
      if (now[k].cell < 0) s = {};
    }
    i = end;
  }
  edges.insert(blades.crossed().begin(), blades.crossed().end());
}

/// Counts what a sample's way took. Tissue that has given way resists less: its integrity falls with the way.
void BladeFronts::weaken(PressedBlade& blade, FrontSample& s, const Edge& edge) {
  ++(s.limit > 0 ? blade.by_contact : blade.by_stress);
  blade.fracture += s.limit * s.advance;
  const double before = integrity_left(s.depth, edge.size);
  s.depth += s.advance;
  s.advance = 0;
  s.zeta *= integrity_left(s.depth, edge.size) / before;
}

void BladeFronts::meet(PressedBlade& blade, const Edge& edge, EditedBodies& bodies, PresentSurface& surface) {
  const Vec3d& n = blade.normal;
  if (n == Vec3d{}) return;
  const double behind = kBehind * edge.size, ahead = kAhead * edge.size + std::max(0.0, vec::dot(edge.motion, n));
  vec::Box box;
  std::vector<vec::Box> rays(edge.x.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (kind_of(blade.samples[i]) == FrontKind::held) continue;
    rays[i].extend(vec::sub(edge.x[i], vec::mul(n, behind)));
    rays[i].extend(vec::add(edge.x[i], vec::mul(n, ahead)));
    for (double& lower : rays[i].lower) lower -= kRounding * edge.size;
    for (double& upper : rays[i].upper) upper += kRounding * edge.size;
    box.extend(rays[i]);
  }
  struct Hit {
    double behind = -HUGE_VAL, ahead = HUGE_VAL, facing = 0;
    std::int32_t body_behind = -1, body_ahead = -1;
  };
  std::vector<Hit> hits(edge.x.size());
  surface.within(box, [&](std::size_t t, const std::array<Vec3d, 3>& corners, const vec::Box& own) {
    const std::int32_t body = run_.model().surface.triangle_body[t];
    if (!bodies.meets_blades(static_cast<std::size_t>(body))) return;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!rays[i].overlaps(own)) continue;
      const std::optional<Crossing> c = crossing(edge.x[i], n, corners);
      if (!c || c->at < -behind || c->at > ahead) continue;
      Hit& hit = hits[i];
      if (c->at <= 0 && c->at > hit.behind) {
        hit.behind = c->at;
        hit.facing = c->facing;
        hit.body_behind = body;
      } else if (c->at > 0 && c->at < hit.ahead && c->facing < kFacing) {
        hit.ahead = c->at;
        hit.body_ahead = body;
      }
    }
  });
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const bool inside = hits[i].body_behind >= 0 && hits[i].facing < kFacing;
    const std::int32_t b = inside ? hits[i].body_behind : hits[i].body_ahead;
    if (b < 0) continue;
    const auto at = static_cast<std::size_t>(b);
    const Vec3d p = vec::add(edge.x[i], vec::mul(n, inside ? hits[i].behind : hits[i].ahead));
    InverseMap map = bodies.inverse_map(at, x_[at], {p, p}, bodies.edge(at));
    const MaterialPoint point = map.find(p);
    if (point.cell < 0) continue;
    FrontSample& sample = blade.samples[i];
    sample = {};
    set_kind(sample, FrontKind::ahead);
    sample.body = b;
    sample.point = point;
    sample.zeta = material(at, point.cell, bodies).integrity;
  }
}

Material BladeFronts::material(std::size_t body, std::int32_t cell, EditedBodies& bodies) {
  const auto known = materials_.find(body);
  const ElementMaterials& all =
      known != materials_.end()
          ? known->second
          : materials_.emplace(body, element_materials(run_.scene.bodies[body], bodies.uncut(body))).first->second;
  if (all.index.empty()) return material_of(run_.scene.bodies[body], 0);
  return material_of(run_.scene.bodies[body], all, static_cast<std::size_t>(bodies.whole_element(body, cell)));
}

/// F* = K_I kappa zeta dA on the footprint dA = 2 r l; 0 where the element below breaks by itself (Mendoza et al.).
double BladeFronts::limit(const Blade& blade, const FrontSample& s, double length, EditedBodies& bodies) {
  const auto b = static_cast<std::size_t>(s.body);
  const Material m = material(b, s.point.cell, bodies);
  if (m.toughness == 0) return kNeverGives;
  const BreakingLaw law{blade.sharpness, s.zeta, m.toughness};
  if (kind_of(s) == FrontKind::held) {
    const CutTopology& body = bodies.topology(b);
    const auto& corners = body.mesh().shape->tets[static_cast<std::size_t>(s.point.tet)];
    const auto& nodes = body.elements().nodes[static_cast<std::size_t>(s.point.cell)];
    std::array<Vec3d, 4> rest, now;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto corner = static_cast<std::size_t>(corners[a]);
      rest[a] = body.mesh().rest[static_cast<std::size_t>(body.mesh().cells[static_cast<std::size_t>(s.point.cell)][corner])];
      now[a] = x_[b][static_cast<std::size_t>(nodes[corner])];
    }
    const std::optional<Eigen::Matrix3d> stress = tet_stress(rest, now, m);
    if (stress && breaks(*stress, law)) return 0;
  }
  return m.toughness * blade.sharpness * s.zeta * 2 * blade.edge * length;
}

}  // namespace pliant
