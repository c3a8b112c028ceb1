#include "lattice/lattice_cell.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pliant {
namespace {

constexpr std::array<int, 3> kStride{1, 4, 16};
constexpr std::array<std::array<int, 2>, 3> kOthers{{{1, 2}, {0, 2}, {0, 1}}};
// Samples that have an upper neighbour along the axis.
constexpr std::array<std::uint64_t, 3> kHasUpper{0x7777777777777777, 0x0FFF0FFF0FFF0FFF, 0x0000FFFFFFFFFFFF};
// Crossings closer than this, in units of the spacing, are one (an edge met by both of its triangles).
constexpr double kSame = 1e-9;
// A sample this close to the surface joins no group: its side is decided on its own.
constexpr double kTouching = 1e-6;

int bit_of(int axis, int line, int i) {
  return i * kStride[axis] + (line & 3) * kStride[kOthers[axis][0]] + (line >> 2) * kStride[kOthers[axis][1]];
}

double sample_at(int i) { return (i + 0.5) / 4; }

// Far from the rims of holes the winding number varies slowly between crossings: there one value serves a whole group of
// samples unless it is near 0.5.
constexpr double kRimCells = 4;
bool settled(double w) { return std::abs(std::abs(w) - 0.5) > 0.3; }

std::uint64_t flood(std::uint64_t seed, std::uint64_t within, const std::array<std::uint64_t, 3>& links) {
  std::uint64_t now = seed, before = 0;
  while (now != before) {
    before = now;
    for (int a = 0; a < 3; ++a) now |= ((now & links[a]) << kStride[a]) | ((now >> kStride[a]) & links[a]);
    now &= within;
  }
  return now;
}

}  // namespace

double CellSampler::winding(const Vec3d& local) {
  ++work_;
  return surface_.winding(vec::add(lower_, vec::mul(local, spacing_)));
}

void CellSampler::sample(const std::array<std::int32_t, 3>& index, std::vector<CellPart>& parts) {
  for (int a = 0; a < 3; ++a) lower_[a] = origin_[a] + spacing_ * index[a];
  vec::Box box{lower_, vec::add(lower_, {spacing_, spacing_, spacing_})};
  const double margin = kSame * spacing_;
  box.extend(vec::sub(box.lower, {margin, margin, margin}));
  box.extend(vec::add(box.upper, {margin, margin, margin}));
  surface_.tree().overlapping(box, triangles_);
  const Vec3d middle{0.5, 0.5, 0.5};
  near_rim_ = surface_.rim_distance(vec::add(lower_, vec::mul(middle, spacing_))) < kRimCells * spacing_;
  if (triangles_.empty() && !near_rim_) {
    const double w = winding(middle);
    if (settled(w)) {
      if (std::abs(w) > 0.5) parts.push_back(CellPart::full(index));
      return;
    }
  }
  for (auto& axis : lines_) {
    for (auto& line : axis) line.clear();
  }
  crossings_ = {};
  for (auto& lengths : length_) lengths.fill(0);
  shell_.fill(-1);
  open_ = {};
  for (const std::int32_t t : triangles_) cross(t);
  sort_lines();
  mark_free();
  classify();
  linked_ = free_;
  for (int axis = 0; axis < 3; ++axis) {
    for (int line = 0; line < 16; ++line) walk(axis, line);
  }
  collect(index, parts);
}

// Meet the triangle with the 48 lines. The edge tests are inclusive with a margin: a crossing found twice does no harm, one
// that is missed would let the inside leak out.
void CellSampler::cross(std::int32_t triangle) {
  const TriangleMesh& mesh = surface_.mesh();
  std::array<Vec3d, 3> p;
  double size = 1;
  for (int c = 0; c < 3; ++c) {
    p[c] = vec::mul(vec::sub(mesh.vertices[mesh.triangles[triangle][c]], lower_), 1 / spacing_);
    for (const double x : p[c]) size = std::max(size, std::abs(x));
  }
  const double slack = 1e-13 * size * size;
  for (int axis = 0; axis < 3; ++axis) {
    const int b = kOthers[axis][0], c = kOthers[axis][1];
    const auto edge = [&](const Vec3d& u, const Vec3d& v, double y, double z) {
      return (v[b] - u[b]) * (z - u[c]) - (v[c] - u[c]) * (y - u[b]);
    };
    const double area = edge(p[0], p[1], p[2][b], p[2][c]);
    if (std::abs(area) <= slack) continue;  // seen edge-on: its neighbours catch the line
    const auto [low_b, high_b] = std::minmax({p[0][b], p[1][b], p[2][b]});
    const auto [low_c, high_c] = std::minmax({p[0][c], p[1][c], p[2][c]});
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    const double sign = area > 0 ? 1 : -1;
    const int jump = (area > 0) == (axis == 1) ? 1 : -1;  // leaving through an outward face lowers the winding number
    for (int v = 0; v < 4; ++v) {
      const double z = sample_at(v);
      if (z < low_c - kSame || z > high_c + kSame) continue;
      for (int u = 0; u < 4; ++u) {
        const double y = sample_at(u);
        if (y < low_b - kSame || y > high_b + kSame) continue;
        const double e0 = edge(p[1], p[2], y, z), e1 = edge(p[2], p[0], y, z), e2 = edge(p[0], p[1], y, z);
        if (sign * e0 < -slack || sign * e1 < -slack || sign * e2 < -slack) continue;
        double at = (e0 * p[0][axis] + e1 * p[1][axis] + e2 * p[2][axis]) / area;
        at = std::clamp(at, low, high);
        if (at < -kSame || at > 1 + kSame) continue;
        if (at < kSame) at = 0;
        if (at > 1 - kSame) at = 1;
        lines_[axis][u + 4 * v].push_back({at, jump, 1, surface_.orientation().shell[triangle]});
      }
    }
  }
}

void CellSampler::sort_lines() {
  for (int axis = 0; axis < 3; ++axis) {
    for (auto& line : lines_[axis]) {
      std::sort(line.begin(), line.end(), [](const Crossing& x, const Crossing& y) {
        return x.at != y.at ? x.at < y.at : x.shell != y.shell ? x.shell < y.shell : x.jump < y.jump;
      });
      std::size_t kept = 0;
      for (const Crossing& c : line) {
        if (kept > 0 && c.at - line[kept - 1].at <= kSame) {
          ++line[kept - 1].merged;
        } else {
          line[kept++] = c;
        }
      }
      line.resize(kept);
      crossings_[axis] += static_cast<int>(kept);
    }
  }
}

void CellSampler::mark_free() {
  free_ = kHasUpper;
  for (int axis = 0; axis < 3; ++axis) {
    for (int line = 0; line < 16; ++line) {
      for (const Crossing& c : lines_[axis][line]) {
        for (int i = 0; i < 3; ++i) {
          if (c.at > sample_at(i) - kTouching && c.at < sample_at(i + 1) + kTouching) {
            free_[axis] &= ~(std::uint64_t{1} << bit_of(axis, line, i));
          }
        }
      }
    }
  }
}

// Samples that no crossing separates lie on the same side of a closed surface, so one winding number serves them all. Through a
// hole it changes gradually: then every sample has its own.
void CellSampler::classify() {
  inside_ = 0;
  std::uint64_t left = kAllSamples;
  while (left != 0) {
    const int seed = std::countr_zero(left);
    const std::uint64_t bit = std::uint64_t{1} << seed;
    std::uint64_t group = near_rim_ ? bit : flood(bit, left, free_);
    const double w = winding(sample_point(seed));
    if (!surface_.orientation().closed() && !settled(w)) group = bit;
    left &= ~group;
    if (std::abs(w) > 0.5) inside_ |= group;
    for (std::uint64_t rest = group; rest != 0; rest &= rest - 1) winding_[std::countr_zero(rest)] = w;
  }
}

// Intervals between crossings `first` .. `last` (in walking order, `step` = +1 or -1) from sample `from` to position `end`,
// which is sample `to` or, if to < 0, a face of the cell. Adds inside lengths; returns true if no void lies on the way.
bool CellSampler::segment(int axis, int line, int first, int last, int step, double end, int from, int to) {
  const auto& crossings = lines_[axis][line];
  Vec3d point = sample_point(from);
  const double start = point[axis], middle = to < 0 ? end : (start + end) / 2;
  double at = start, w = winding_[from];
  bool solid = true;
  const auto interval = [&](double until) {
    const double length = std::abs(until - at);
    if (length <= kSame) return;
    if (std::abs(w) <= 0.5) {
      solid = false;
      return;
    }
    // What lies beyond the middle of the segment belongs to the sample at its other end.
    const double split = to < 0 ? until : std::clamp(middle, std::min(at, until), std::max(at, until));
    length_[axis][from] += std::abs(split - at);
    if (to >= 0) length_[axis][to] += std::abs(until - split);
  };
  for (int i = first; i != last; i += step) {
    const Crossing& c = crossings[i];
    interval(c.at);
    const double next = i + step != last ? crossings[i + step].at : end;
    if (i + step == last && to >= 0) {
      w = winding_[to];
    } else if (!near_rim_ && c.merged == 1 && std::abs(w - std::round(w)) < 0.25) {
      w += step * c.jump;
    } else if (std::abs(next - c.at) > kSame) {
      point[axis] = (c.at + next) / 2;
      w = winding(point);
    }
    at = c.at;
  }
  if (first == last && to >= 0) {  // nothing between two samples: each answers for its half (they may differ across a hole)
    interval(middle);
    at = middle;
    w = winding_[to];
  }
  interval(end);
  return solid;
}

void CellSampler::walk(int axis, int line) {
  const auto& crossings = lines_[axis][line];
  const int count = static_cast<int>(crossings.size());
  int begin = 0;
  for (int k = 0; k < 5; ++k) {  // from the lower face, between samples, to the upper face
    int end = begin;
    while (end < count && (k == 4 || crossings[end].at < sample_at(k))) ++end;
    const int from = bit_of(axis, line, k == 0 ? 0 : k - 1), to = k == 0 || k == 4 ? -1 : bit_of(axis, line, k);
    const bool solid = k == 0 ? segment(axis, line, end - 1, begin - 1, -1, 0, from, -1)
                              : segment(axis, line, begin, end, 1, k == 4 ? 1 : sample_at(k), from, to);
    if (k == 0 && solid) open_[2 * axis] |= static_cast<std::uint16_t>(1U << line);
    if (k == 4 && solid) open_[2 * axis + 1] |= static_cast<std::uint16_t>(1U << line);
    if (to >= 0 && solid) linked_[axis] |= std::uint64_t{1} << from;
    if (to >= 0 && !solid) linked_[axis] &= ~(std::uint64_t{1} << from);
    if (end > begin) {
      const auto [low, high] = std::pair{crossings[begin].shell, crossings[end - 1].shell};
      shell_[from] = k == 0 ? high : low;
      if (to >= 0) shell_[to] = high;
    }
    begin = end;
  }
}

void CellSampler::add_part(const std::array<std::int32_t, 3>& index, std::uint64_t mask, bool thin, int axis,
                           std::vector<CellPart>& parts) {
  CellPart part;
  part.index = index;
  part.mask = mask;
  part.thin = thin;
  part.fill = 0;
  for (std::uint64_t rest = mask; rest != 0; rest &= rest - 1) {
    const int s = std::countr_zero(rest);
    part.fill += length_[axis][s] / 16;
    if (shell_[s] >= 0) part.shell = part.shell < 0 ? shell_[s] : std::min(part.shell, shell_[s]);
  }
  for (int a = 0; a < 3; ++a) {
    for (int line = 0; line < 16; ++line) {
      const auto has = [&](int i) { return ((mask >> bit_of(a, line, i)) & 1) != 0; };
      const auto bit = static_cast<std::uint16_t>(1U << line);
      if (has(0) && (thin || (open_[2 * a] & bit) != 0)) part.open[2 * a] |= bit;
      if (has(3) && (thin || (open_[2 * a + 1] & bit) != 0)) part.open[2 * a + 1] |= bit;
    }
  }
  parts.push_back(part);
}

void CellSampler::collect(const std::array<std::int32_t, 3>& index, std::vector<CellPart>& parts) {
  const int axis = static_cast<int>(std::max_element(crossings_.begin(), crossings_.end()) - crossings_.begin());
  const std::size_t begin = parts.size();
  const bool thin = inside_ == 0;
  std::uint64_t left = inside_;
  if (thin) {
    linked_ = kHasUpper;
    for (int s = 0; s < 64; ++s) {
      if (length_[0][s] + length_[1][s] + length_[2][s] > 0) left |= std::uint64_t{1} << s;
    }
  }
  double stray = 0;  // material too thin for a sample, in a cell whose other parts have samples: added to the largest part
  for (int s = 0; s < 64; ++s) stray += ((left >> s) & 1) == 0 ? length_[axis][s] / 16 : 0;
  while (left != 0) {
    const std::uint64_t mask = flood(left & (~left + 1), left, linked_);
    left &= ~mask;
    add_part(index, mask, thin, axis, parts);
  }
  if (parts.size() == begin) return;
  std::max_element(parts.begin() + begin, parts.end(), [](const CellPart& x, const CellPart& y) {
    return x.fill < y.fill;
  })->fill += stray;
  parts.erase(std::remove_if(parts.begin() + begin, parts.end(), [](const CellPart& p) { return !(p.fill >= kFillFloor); }),
              parts.end());
  for (auto p = parts.begin() + begin; p != parts.end(); ++p) p->fill = std::min(p->fill, 1.0);
}

}  // namespace pliant
