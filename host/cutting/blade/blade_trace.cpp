#include "cutting/blade/blade_trace.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pliant {
namespace {

constexpr double kSpacing = 0.5;  ///< of a blade's points, and between rows of them, in edges
constexpr double kNear = 1.5;     ///< material up to here carries a point, in edges
constexpr double kReach = 8;      ///< beyond it a point of a blade does not go with the body, in edges
constexpr double kLongest =
    4;  ///< longest side of a triangle at rest, in edges: longer ones lead from one part of a body to another
constexpr int kMostRows = 1024;
/// Maximum number of points of all rows of one move, far more than any blade needs: a damaged checkpoint could request
/// millions.
constexpr double kMostPoints = 1 << 18;
constexpr int kRangeSamples = 64;
constexpr std::size_t kFarNodes = 256;
constexpr std::int64_t kMostPlaces = 1 << 16;  ///< of a row; a blade that slides along itself by more is sampled more coarsely

/// The same formula wherever a point of a blade is meant: the same bits.
Vec3d point_of(const BladeSegment& blade, std::int64_t place, int levels) {
  const std::int64_t places = std::int64_t{1} << levels;
  if (place == 0) return blade[0];
  if (place == places) return blade[1];
  return vec::add(blade[0], vec::mul(vec::sub(blade[1], blade[0]), static_cast<double>(place) / static_cast<double>(places)));
}

Vec3d between(const Vec3d& a, const Vec3d& b, double t) {
  return t == 0 ? a : t == 1 ? b : vec::add(a, vec::mul(vec::sub(b, a), t));
}

int levels_of(const BladeSegment& blade, double edge) {
  const double points = vec::norm(vec::sub(blade[1], blade[0])) / (kSpacing * edge);
  if (!(points < 1e9)) return kMostLevels;
  return points > 1 ? std::min(kMostLevels, std::ilogb(points) + 1) : 0;
}

/// Shares [from, to] of the way from box `a` to box `b` on which it may meet `reach`; empty if from > to.
std::array<double, 2> times_in(const vec::Box& reach, const vec::Box& a, const vec::Box& b) {
  double from = 0, to = 1;
  const auto keep_above = [&](double start, double end) {  // where start + t (end - start) >= 0
    if (start < 0 && end < 0) to = -1;
    if (start < 0 && end >= 0) from = std::max(from, start / (start - end));
    if (start >= 0 && end < 0) to = std::min(to, start / (start - end));
  };
  for (int k = 0; k < 3; ++k) {
    keep_above(reach.upper[k] - a.lower[k], reach.upper[k] - b.lower[k]);
    keep_above(a.upper[k] - reach.lower[k], b.upper[k] - reach.lower[k]);
  }
  return {from, to};
}

vec::Box box_of(const std::vector<Vec3d>& points) {
  vec::Box box;
  for (const Vec3d& p : points) box.extend(p);
  return box;
}

}  // namespace

BladeSweep::BladeSweep(const CutTopology& body, std::span<const Vec3d> x, const SweptPairs& pairs, double edge)
    : body_(body), x_(x), pairs_(pairs), edge_(edge) {
  for (const Vec3d& p : x) {
    if (vec::finite(p)) reach_.extend(p);
  }
  for (int k = 0; k < 3; ++k) {
    reach_.lower[k] -= kReach * edge;
    reach_.upper[k] += kReach * edge;
  }
}

/// Where the points that go with the body are now.
BladeSweep::Row BladeSweep::stored(const BladeTrace& front) const {
  Row row{front.levels, 0, {}};
  if (front.points.empty()) return row;
  row.first = front.points.front().place;
  for (std::int64_t p = row.first; p <= front.points.back().place; ++p) {
    row.vertices.push_back({{}, point_of(front.blade, p, front.levels)});
  }
  for (const TracePoint& p : front.points) {
    Vertex& v = row.vertices[static_cast<std::size_t>(p.place - row.first)];
    if (p.node >= 0) {
      v.now = vec::add(x_[p.node], p.carried.rest);
    } else {
      v = {p.carried, present_position(body_, x_, p.carried)};
    }
  }
  return row;
}

/// Places in reach of the body at any time of the move: [first, last], empty if first > last.
std::array<std::int64_t, 2> BladeSweep::range(const BladeTrace& front, const BladeSegment& to, int levels) const {
  const double places = std::ldexp(1.0, levels);
  double first = HUGE_VAL, last = -HUGE_VAL;
  if (!front.points.empty()) {
    first = std::floor(std::ldexp(front.points.front().place, levels - front.levels));
    last = std::ceil(std::ldexp(front.points.back().place, levels - front.levels));
  }
  for (int k = 0; k <= kRangeSamples; ++k) {
    const double t = static_cast<double>(k) / kRangeSamples;
    const vec::Box a{between(front.blade[0], to[0], t), between(front.blade[0], to[0], t)};
    const vec::Box b{between(front.blade[1], to[1], t), between(front.blade[1], to[1], t)};
    const auto [from, until] = times_in(reach_, a, b);
    if (from > until) continue;
    first = std::min(first, std::floor(from * places));
    last = std::max(last, std::ceil(until * places));
  }
  if (first > last) return {1, 0};
  return {static_cast<std::int64_t>(std::max(first, 0.0)), static_cast<std::int64_t>(std::min(last, places))};
}

BladeSweep::Vertex BladeSweep::vertex(const Vec3d& p, InverseMap& map) const {
  Vertex v{{}, p};
  if (reach_.distance2(p) == 0) v.carried = map.find(p);
  if (pairs_.faces_end && v.carried.cell >= 0 && in_gap(v)) end_at_face(v);
  return v;
}

/// Moves the material of a vertex that lies outside its tetrahedron to the border of that.
void BladeSweep::end_at_face(Vertex& v) const {
  MaterialPoint& m = v.carried;
  double sum = 0;
  for (double& w : m.weight) sum += w = std::max(w, 0.0);
  m.rest = {};
  for (std::size_t a = 0; a < 4; ++a) {
    m.weight[a] /= sum;
    const int corner = body_.mesh().shape->tets[m.tet][a];
    m.rest = vec::add(m.rest, vec::mul(body_.mesh().rest[body_.mesh().cells[m.cell][corner]], m.weight[a]));
  }
}

BladeSweep::Row BladeSweep::mapped(int levels, std::int64_t first, const std::vector<Vec3d>& points, InverseMap& map) const {
  Row row{levels, first, {}};
  for (const Vec3d& p : points) row.vertices.push_back(vertex(p, map));
  return row;
}

void BladeSweep::move(BladeTrace& front, const BladeSegment& to) {
  int levels = levels_of(to, edge_);
  while (levels > 0 && range(front, to, levels)[1] - range(front, to, levels)[0] > kMostPlaces) --levels;
  const auto [first, last] = range(front, to, levels);
  const Row known = stored(front);
  const auto was = [&](std::int64_t place) {
    const std::int64_t i = place - known.first;
    if (i >= 0 && i < static_cast<std::int64_t>(known.vertices.size())) return known.vertices[static_cast<std::size_t>(i)].now;
    return point_of(front.blade, place, known.levels);
  };
  const int finer = levels - known.levels;
  std::vector<Vec3d> from, until;
  for (std::int64_t p = first; p <= last; ++p) {
    const std::int64_t i = finer >= 0 ? p >> finer : p << -finer;
    const double part = finer > 0 ? std::ldexp(static_cast<double>(p - (i << finer)), -finer) : 0;
    from.push_back(part > 0 ? between(was(i), was(i + 1), part) : was(i));
    until.push_back(point_of(to, p, levels));
  }
  auto [low, high] = range(front, to, known.levels);
  if (high - low > kMostPlaces) {
    low = known.first;
    high = known.first + static_cast<std::int64_t>(known.vertices.size()) - 1;
  }
  const vec::Box start = box_of(from), end = box_of(until);
  const auto [begin, finish] = times_in(reach_, start, end);
  front.blade = to;
  front.levels = levels;
  front.points.clear();
  if (from.empty() || begin > finish) return;
  vec::Box region = start;
  region.extend(end);
  InverseMap map(body_, x_, region, edge_, kNear * edge_);
  double longest = 0;
  for (std::size_t i = 0; i < from.size(); ++i) longest = std::max(longest, vec::norm(vec::sub(until[i], from[i])));
  const double wanted = std::ceil(longest * (finish - begin) / (kSpacing * edge_));
  const double most = std::clamp(kMostPoints / static_cast<double>(from.size()), 1.0, double{kMostRows});
  const int rows = std::max(1, static_cast<int>(wanted < most ? wanted : most));
  Row before;
  if (begin > 0) {
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < from.size(); ++i) points.push_back(between(from[i], until[i], begin));
    before = mapped(levels, first, points, map);
  } else {  // the very points that the last sweep ended with, and the blade next to them
    before = {known.levels, low, {}};
    for (std::int64_t p = low; p <= high; ++p) {
      const Vertex* v = known.at(p);
      before.vertices.push_back(v != nullptr ? *v : vertex(was(p), map));
    }
  }
  for (int k = 1; k <= rows; ++k) {
    const double t = k == rows ? finish : begin + (finish - begin) * k / rows;
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < from.size(); ++i) points.push_back(between(from[i], until[i], t));
    Row row = mapped(levels, first, points, map);
    strip(before, row);
    before = std::move(row);
  }
  if (finish == 1) keep(front, before);
}

std::vector<MaterialPoint> BladeSweep::advance(std::span<const MaterialPoint> carried, std::span<const Vec3d> from,
                                               std::span<const Vec3d> until) {
  vec::Box region;
  double longest = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    region.extend(from[i]);
    region.extend(until[i]);
    longest = std::max(longest, vec::norm(vec::sub(until[i], from[i])));
  }
  InverseMap map(body_, x_, region, edge_, kNear * edge_);
  const int rows = std::max(1, static_cast<int>(std::min(std::ceil(longest / (kSpacing * edge_)), double{kMostRows})));
  Row before{0, 0, {}};
  for (std::size_t i = 0; i < from.size(); ++i) {
    before.vertices.push_back(carried[i].cell >= 0 ? Vertex{carried[i], from[i]} : vertex(from[i], map));
  }
  for (int k = 1; k <= rows; ++k) {
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < from.size(); ++i) points.push_back(between(from[i], until[i], static_cast<double>(k) / rows));
    Row row = mapped(0, 0, points, map);
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (from[i] == until[i] && carried[i].cell >= 0) row.vertices[i].carried = carried[i];  // where tissue holds
    }
    strip(before, row);
    before = std::move(row);
  }
  std::vector<MaterialPoint> out;
  for (const Vertex& v : before.vertices) out.push_back(v.carried);
  return out;
}

/// Triangles between two rows, of which one may have more points.
void BladeSweep::strip(const Row& a, const Row& b) {
  const Row &coarse = b.levels >= a.levels ? a : b, &fine = b.levels >= a.levels ? b : a;
  const int levels = fine.levels - coarse.levels;
  const std::int64_t ratio = std::int64_t{1} << levels, half = std::max<std::int64_t>(1, ratio / 2);
  const std::int64_t last = coarse.first + static_cast<std::int64_t>(coarse.vertices.size()) - 1;
  const std::int64_t fine_last = fine.first + static_cast<std::int64_t>(fine.vertices.size()) - 1;
  for (std::int64_t i = coarse.first; i < last; ++i) {
    const Vertex *left = coarse.at(i), *right = coarse.at(i + 1);
    const std::int64_t begin = std::max<std::int64_t>(0, fine.first - i * ratio);
    const std::int64_t end = std::min(ratio, fine_last - i * ratio);
    for (std::int64_t k = begin; k < end; ++k) {
      triangle(k < half ? left : right, fine.at(i * ratio + k + 1), fine.at(i * ratio + k));
    }
    triangle(left, right, fine.at(i * ratio + half));
  }
}

/// Whether a vertex lies in an open gap, not in material.
bool BladeSweep::in_gap(const Vertex& v) const {
  constexpr double kNone = 1e-9;
  if (pairs_.gap.empty()) return false;
  bool inside = true, open = true;
  for (std::size_t a = 0; a < 4; ++a) {
    const int corner = body_.mesh().shape->tets[v.carried.tet][a];
    inside = inside && v.carried.weight[a] > kNone;
    open = open && (v.carried.weight[a] <= kNone || pairs_.gap[body_.elements().nodes[v.carried.cell][corner]] > 0);
  }
  return open && !inside;
}

void BladeSweep::triangle(const Vertex* a, const Vertex* b, const Vertex* c) {
  if (a == nullptr || b == nullptr || c == nullptr) return;
  if (in_gap(*a) && in_gap(*b) && in_gap(*c)) return;  // from side to side it would pass through what sticks out of them
  const std::array<Vec3d, 3> rest{a->carried.rest, b->carried.rest, c->carried.rest};
  if (rest[0] == rest[1] || rest[1] == rest[2] || rest[2] == rest[0]) return;
  const Vec3d u = vec::sub(rest[1], rest[0]), v = vec::sub(rest[2], rest[0]), w = vec::sub(rest[2], rest[1]);
  const double limit = kLongest * kLongest * edge_ * edge_;
  // Written so that what is no number, as a damaged checkpoint may hold, is left out as well.
  if (!(vec::dot(u, u) <= limit && vec::dot(v, v) <= limit && vec::dot(w, w) <= limit)) return;
  const double size =
      std::max({vec::norm(vec::sub(b->now, a->now)), vec::norm(vec::sub(c->now, a->now)), vec::norm(vec::sub(c->now, b->now))});
  const Vec3d normal = vec::cross(u, v);
  const double area2 = vec::dot(normal, normal);
  pairs_.between.crossed(rest, [&](const NodePair& pair, double t) {
    if (crossed_.contains(pair) || body_.edges().contains(pair)) return;
    // A triangle between parts that have come near each other is wrong at rest: there the blade is not where the edge is.
    const Vec3d at = vec::sub(between(pairs_.rest[pair[0]], pairs_.rest[pair[1]], t), rest[0]);
    const double s = area2 > 0 ? std::clamp(vec::dot(vec::cross(at, v), normal) / area2, 0.0, 1.0) : 0.5;
    const double r = area2 > 0 ? std::clamp(vec::dot(vec::cross(u, at), normal) / area2, 0.0, 1.0) : 0.5;
    const Vec3d blade =
        vec::add(a->now, vec::add(vec::mul(vec::sub(b->now, a->now), s), vec::mul(vec::sub(c->now, a->now), r)));
    const Vec3d edge = between(pairs_.now[pair[0]], pairs_.now[pair[1]], t);
    if (vec::norm(vec::sub(blade, edge)) > edge_ + 0.5 * size) return;
    crossed_.emplace(pair, t);
  });
}

void BladeSweep::keep(BladeTrace& front, const Row& last) const {
  for (std::size_t i = 0; i < last.vertices.size(); ++i) {
    const Vertex& v = last.vertices[i];
    TracePoint point{static_cast<std::int32_t>(last.first + static_cast<std::int64_t>(i)), -1, v.carried};
    if (v.carried.cell < 0) {
      if (reach_.distance2(v.now) > 0) continue;
      point.node = nearest_node(v.now);
      if (point.node < 0) continue;
      point.carried.rest = vec::sub(v.now, x_[point.node]);
    }
    front.points.push_back(point);
  }
}

/// The nearest of some real nodes: what is far off moves with its part of the body closely enough.
std::int32_t BladeSweep::nearest_node(const Vec3d& p) const {
  const std::size_t nodes = pairs_.carriers, stride = nodes / kFarNodes + 1;
  std::int32_t best = -1;
  double distance2 = HUGE_VAL;
  for (std::size_t n = 0; n < nodes; n += stride) {
    const Vec3d d = vec::sub(x_[n], p);
    if (!(vec::dot(d, d) < distance2)) continue;
    distance2 = vec::dot(d, d);
    best = static_cast<std::int32_t>(n);
  }
  return best;
}

}  // namespace pliant
