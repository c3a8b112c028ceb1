#include "geometry/polygon.h"

#include <algorithm>
#include <cmath>

namespace pliant::overlay {
namespace {

using Points = std::vector<FlatPoint>;
using Ring = std::vector<std::int32_t>;

constexpr double kFlat = 1e-9;    // sine of the angle at a corner that counts as straight
constexpr double kTouch = 1e-12;  // relative distance at which a corner touches a side

double cross(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
double length2(const FlatPoint& a, const FlatPoint& b) { return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y); }
bool same_place(const FlatPoint& a, const FlatPoint& b) { return a.x == b.x && a.y == b.y; }

class EarClipper {
 public:
  EarClipper(const Points& points, const Ring& ring) : points_(points), ring_(ring) {
    const auto n = static_cast<int>(ring.size());
    next_.resize(ring.size());
    previous_.resize(ring.size());
    convex_.resize(ring.size());
    quality_.resize(ring.size());
    for (int i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
    for (int i = 0; i < n; ++i) convex_[i] = is_convex(i);
    for (int i = 0; i < n; ++i) quality_[i] = quality(i, true);
    left_ = n;
  }

  void clip(std::vector<std::array<std::int32_t, 3>>& out) {
    int start = 0;
    while (left_ > 2) {
      const int ear = left_ == 3 ? start : choose(start);
      const int before = previous_[ear], after = next_[ear];
      out.push_back({ring_[before], ring_[ear], ring_[after]});
      next_[before] = after;
      previous_[after] = before;
      --left_;
      start = after;
      for (const int i : {before, after}) convex_[i] = is_convex(i);
      for (const int i : {before, after}) quality_[i] = quality(i, true);
    }
  }

 private:
  const FlatPoint& at(int i) const { return points_[ring_[i]]; }

  char is_convex(int i) const {
    const FlatPoint &a = at(previous_[i]), &b = at(i), &c = at(next_[i]);
    const double turn = cross(a, b, c);
    return turn > 0 && turn * turn > kFlat * kFlat * length2(a, b) * length2(b, c) ? 1 : 0;
  }

  // Larger for a better-shaped ear; not positive for a corner that must not be cut off.
  double quality(int i, bool strict) const {
    const FlatPoint &a = at(previous_[i]), &b = at(i), &c = at(next_[i]);
    if ((a.lines & c.lines) != 0) return -HUGE_VAL;
    const double longest = std::max({length2(a, b), length2(b, c), length2(c, a)});
    if (strict && (convex_[i] == 0 || blocked(i))) return 0;
    return longest > 0 ? cross(a, b, c) / longest : 0;
  }

  bool blocked(int ear) const {
    const FlatPoint &a = at(previous_[ear]), &b = at(ear), &c = at(next_[ear]);
    const double limit = -kTouch * std::max({length2(a, b), length2(b, c), length2(c, a)});
    const int last = previous_[ear];
    for (int i = next_[next_[ear]]; i != last; i = next_[i]) {
      if (convex_[i] != 0) continue;
      const FlatPoint& p = at(i);
      if (same_place(p, a) || same_place(p, b) || same_place(p, c)) continue;
      if (cross(a, b, p) >= limit && cross(b, c, p) >= limit && cross(c, a, p) >= limit) return true;
    }
    return false;
  }

  int best(int start) const {
    int chosen = start;
    for (int i = next_[start]; i != start; i = next_[i]) {
      if (quality_[i] > quality_[chosen]) chosen = i;
    }
    return chosen;
  }

  int choose(int start) {
    int ear = best(start);
    if (quality_[ear] > 0) return ear;
    int i = start;  // a corner that became convex may have freed others
    do {
      quality_[i] = quality(i, true);
      i = next_[i];
    } while (i != start);
    ear = best(start);
    if (quality_[ear] > 0) return ear;
    std::vector<double> loose(quality_.size(), 0);
    do {
      loose[i] = quality(i, false);
      i = next_[i];
    } while (i != start);
    quality_.swap(loose);
    ear = best(start);
    quality_.swap(loose);
    return ear;
  }

  const Points& points_;
  const Ring& ring_;
  std::vector<int> next_, previous_;
  std::vector<char> convex_;
  std::vector<double> quality_;
  int left_ = 0;
};

bool contains(const Points& points, const Ring& ring, const FlatPoint& p) {
  bool in = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const FlatPoint &a = points[ring[i]], &b = points[ring[j]];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
  }
  return in;
}

// Whether q lies between the two sides that meet in corner i of a ring.
bool in_cone(const Points& points, const Ring& ring, std::size_t i, const FlatPoint& q) {
  const std::size_t n = ring.size();
  const FlatPoint &a = points[ring[(i + n - 1) % n]], &o = points[ring[i]], &b = points[ring[(i + 1) % n]];
  if (same_place(a, b)) return true;
  if (cross(a, o, b) > 0) return cross(o, q, a) > 0 && cross(q, o, b) > 0;
  return !(cross(o, q, b) >= 0 && cross(q, o, a) >= 0);
}

bool meets(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c, const FlatPoint& d) {
  if (same_place(a, c) || same_place(a, d) || same_place(b, c) || same_place(b, d)) return false;
  const double limit = kTouch * std::max(length2(a, b), length2(c, d));
  const double u = cross(a, b, c), v = cross(a, b, d), s = cross(c, d, a), t = cross(c, d, b);
  const auto apart = [limit](double x, double y) { return (x > limit && y > limit) || (x < -limit && y < -limit); };
  if (apart(u, v) || apart(s, t)) return false;
  if (std::max({std::abs(u), std::abs(v), std::abs(s), std::abs(t)}) > limit) return true;
  const double ab = length2(a, b);  // on one line: do they overlap?
  const double pc = ((c.x - a.x) * (b.x - a.x) + (c.y - a.y) * (b.y - a.y)) / ab;
  const double pd = ((d.x - a.x) * (b.x - a.x) + (d.y - a.y) * (b.y - a.y)) / ab;
  return std::max(pc, pd) > 0 && std::min(pc, pd) < 1;
}

bool meets(const Points& points, const Ring& ring, const FlatPoint& a, const FlatPoint& b) {
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    if (meets(a, b, points[ring[j]], points[ring[i]])) return true;
  }
  return false;
}

struct Bridge {
  double length2 = 0;
  std::size_t outer = 0, inner = 0;
};

// Join a hole to an outline by a pair of sides, the shortest that meets nothing.
void join(const Points& points, Ring& ring, const Ring& hole, const std::vector<const Ring*>& others) {
  std::vector<Bridge> bridges;
  for (std::size_t o = 0; o < ring.size(); ++o) {
    for (std::size_t h = 0; h < hole.size(); ++h) {
      const FlatPoint &a = points[ring[o]], &b = points[hole[h]];
      if ((a.lines & b.lines) == 0) bridges.push_back({length2(a, b), o, h});
    }
  }
  if (bridges.empty()) bridges.push_back({0, 0, 0});
  std::sort(bridges.begin(), bridges.end(), [](const Bridge& x, const Bridge& y) { return x.length2 < y.length2; });
  Bridge chosen = bridges.front();
  for (const Bridge& bridge : bridges) {
    const FlatPoint &a = points[ring[bridge.outer]], &b = points[hole[bridge.inner]];
    if (!in_cone(points, ring, bridge.outer, b) || !in_cone(points, hole, bridge.inner, a)) continue;
    if (meets(points, ring, a, b) || meets(points, hole, a, b)) continue;
    if (std::any_of(others.begin(), others.end(), [&](const Ring* r) { return meets(points, *r, a, b); })) continue;
    chosen = bridge;
    break;
  }
  Ring joined(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(chosen.outer) + 1);
  for (std::size_t h = 0; h <= hole.size(); ++h) joined.push_back(hole[(chosen.inner + h) % hole.size()]);
  joined.insert(joined.end(), ring.begin() + static_cast<std::ptrdiff_t>(chosen.outer), ring.end());
  ring.swap(joined);
}

/// The outline that a hole belongs to. A corner of the hole may lie on the border of the polygon, where none contains it.
std::size_t outline_around(const Points& points, const std::vector<Loop>& loops, const std::vector<std::size_t>& outlines,
                           const Loop& hole) {
  std::size_t owner = 0;
  for (const std::int32_t corner : hole.corners) {
    double smallest = HUGE_VAL;
    for (const std::size_t o : outlines) {
      if (hole.group >= 0 && loops[o].group == hole.group) continue;
      const double area = loop_area(points, loops[o].corners);
      if (area >= smallest || !contains(points, loops[o].corners, points[corner])) continue;
      owner = o;
      smallest = area;
    }
    if (smallest < HUGE_VAL) return owner;
  }
  double largest = -HUGE_VAL;
  for (const std::size_t o : outlines) {
    if (hole.group >= 0 && loops[o].group == hole.group) continue;
    const double area = loop_area(points, loops[o].corners);
    if (area > largest) owner = o;
    largest = std::max(largest, area);
  }
  return owner;
}

}  // namespace

double loop_area(const Points& points, const Ring& loop) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) sum += cross(points[loop[0]], points[loop[i]], points[loop[i + 1]]);
  return sum;
}

std::vector<std::array<std::int32_t, 3>> triangulate(const Points& points, std::vector<Loop> loops) {
  std::vector<std::array<std::int32_t, 3>> out;
  std::vector<std::size_t> outlines, owner(loops.size(), 0);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i].hole) outlines.push_back(i);
  }
  for (std::size_t h = 0; h < loops.size(); ++h) {
    if (!loops[h].hole) continue;
    owner[h] = outline_around(points, loops, outlines, loops[h]);
    if (outlines.empty()) loops[h].hole = false;  // only by rounding: a loop that stands alone
  }
  for (std::size_t o = 0; o < loops.size(); ++o) {
    if (loops[o].hole) continue;
    std::vector<const Ring*> holes;
    for (std::size_t h = 0; h < loops.size(); ++h) {
      if (loops[h].hole && owner[h] == o) holes.push_back(&loops[h].corners);
    }
    Ring ring = loops[o].corners;
    while (!holes.empty()) {
      const Ring* hole = holes.back();
      holes.pop_back();
      join(points, ring, *hole, holes);
    }
    if (ring.size() > 2) EarClipper(points, ring).clip(out);
  }
  return out;
}

}  // namespace pliant::overlay
