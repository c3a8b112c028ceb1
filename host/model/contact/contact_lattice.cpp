// Contact points on lattice bodies: samples of the triangles, combined by half cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "geometry/vec.h"
#include "model/contact/contact.h"
#include "model/contact/contact_samples.h"
#include "model/elements/body_mesh.h"
#include "model/model.h"

namespace pliant {
namespace {

using Slots = std::array<std::int32_t, 8>;
using Index = std::array<std::int64_t, 3>;

/// Triangles are subdivided until no edge is longer than this fraction of a cell.
constexpr double kSample = 0.25;

/// Minimum area of a point, as a fraction of a cell's face.
constexpr double kLeastArea = 1e-6;

/// Depth below the surface at which a sample's cell is determined, as a fraction of a cell, since the surface may lie between
/// two cells.
constexpr double kInside = 1e-3;

/// Shape [slots]: the node of a body in each slot; -1: none of its nodes.
std::vector<std::int32_t> nodes_of_slots(const ModelBody& body, std::int32_t slots) {
  std::vector<std::int32_t> node(static_cast<std::size_t>(slots), -1);
  for (std::size_t n = 0; n < body.slot.size(); ++n)
    node[static_cast<std::size_t>(body.slot[n])] = static_cast<std::int32_t>(n);
  return node;
}

/// Samples a lattice body: every triangle is divided into samples, and the samples in one half of a cell (in x, y and z) that
/// face the same way become one point.
class LatticeSampler {
 public:
  LatticeSampler(const Model& model, std::int32_t body, bool patches)
      : model_(model), b_(model.bodies[body]), body_(body), d_(b_.spacing), patches_(patches) {}

  void sample(ContactPoints& points) {
    for (std::int32_t t = b_.first_triangle; t < b_.first_triangle + b_.triangles; ++t) divide(t);
    if (patches_) list_halves();
    // In the order of the body's nodes: their slots depend on which of its cells are finite elements.
    const std::vector<std::int32_t> node = nodes_of_slots(b_, model_.slots);
    std::vector<Group> numbered = groups_;
    for (Group& g : numbered) {
      for (std::int32_t& n : g.nodes) n = node[static_cast<std::size_t>(n)];
    }
    std::vector<std::size_t> order(groups_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return numbered[i] < numbered[k]; });
    const Members members = members_of_groups();
    for (const std::size_t group : order) gather(members.of(group), points);
  }

 private:
  /// Samples that become one point: in one half of a cell, and facing the same way.
  struct Group {
    int side = 0, half = 0;
    Slots nodes{};
    bool operator<(const Group& other) const {
      return std::tie(side, half, nodes) < std::tie(other.side, other.half, other.nodes);
    }
    bool operator==(const Group& other) const { return side == other.side && half == other.half && nodes == other.nodes; }
  };
  struct HashOfGroup {
    std::size_t operator()(const Group& g) const {
      std::uint64_t hash = 8 * static_cast<std::uint64_t>(g.side) + static_cast<std::uint64_t>(g.half);
      for (const std::int32_t n : g.nodes) hash = (hash ^ static_cast<std::uint64_t>(n)) * 0x9e3779b97f4a7c15U;
      return static_cast<std::size_t>(hash ^ hash >> 32);
    }
  };
  /// Samples of a triangle have its normal and the same area.
  struct Facet {
    Vec3d normal{};  ///< of unit length
    double area = 0;
  };
  struct HashOfHalf {
    std::size_t operator()(const std::pair<Index, int>& half) const {
      auto hash = static_cast<std::uint64_t>(half.second);
      for (const std::int64_t i : half.first) hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15U;
      return static_cast<std::size_t>(hash ^ hash >> 32);
    }
  };
  struct Sample {
    std::uint32_t group = 0, facet = 0;
    Vec3d local{};  ///< position in its cell, in [0, 1]
    Vec3d x{};
  };
  struct Members {
    std::vector<std::uint32_t> offset, samples;
    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t group) const {
      return std::span(samples).subspan(offset[group], offset[group + 1] - offset[group]);
    }
  };
  [[nodiscard]] const Group& of(const Sample& s) const { return groups_[s.group]; }

  /// Index of a group. A sample mostly has that of the last one in the same half of a cell.
  [[nodiscard]] std::uint32_t group_of(const Group& group) {
    std::uint32_t& last = last_[static_cast<std::size_t>(group.half)];
    if (last < groups_.size() && groups_[last] == group) return last;
    const auto [found, added] = index_.try_emplace(group, static_cast<std::uint32_t>(groups_.size()));
    if (added) groups_.push_back(group);
    return last = found->second;
  }
  /// [groups] the samples of each, in the order of the triangles.
  [[nodiscard]] Members members_of_groups() const {
    Members members;
    members.offset.assign(groups_.size() + 1, 0);
    for (const Sample& s : samples_) ++members.offset[s.group + 1];
    std::partial_sum(members.offset.begin(), members.offset.end(), members.offset.begin());
    members.samples.resize(samples_.size());
    std::vector<std::uint32_t> next = members.offset;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      members.samples[next[samples_[i].group]++] = static_cast<std::uint32_t>(i);
    return members;
  }

  /// A cell in which a vertex is embedded.
  struct Place {
    Slots nodes{};
    Vec3d corner{};  ///< its low corner [m]
  };

  [[nodiscard]] Place place_of(std::int32_t vertex) const {
    const ModelSurface& s = model_.surface;
    Place place{s.nodes[vertex], s.rest[vertex]};
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t c = 0; c < 3; ++c) {
        if ((a >> c & 1) != 0) place.corner[c] -= s.weights[vertex][a] * d_;
      }
    }
    return place;
  }

  void divide(std::int32_t t) {
    const auto& triangle = model_.surface.triangles[t];
    std::array<Vec3d, 3> x{};
    for (std::size_t c = 0; c < 3; ++c) x[c] = model_.surface.rest[triangle[c]];
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) longest = std::max(longest, vec::norm(vec::sub(x[c], x[(c + 1) % 3])));
    const Vec3d normal = vec::cross(vec::sub(x[1], x[0]), vec::sub(x[2], x[0]));
    const double area = vec::norm(normal) / 2;
    if (!(area > 0)) return;
    const int n = std::max(1, static_cast<int>(std::ceil(longest / (kSample * d_))));
    std::array<Place, 3> places;
    for (std::size_t c = 0; c < 3; ++c) places[c] = place_of(triangle[c]);
    const Vec3d inwards = vec::mul(normal, -kInside * d_ / vec::norm(normal));
    const int side = side_of(normal);
    facets_.push_back({vec::mul(normal, 1 / vec::norm(normal)), area / (static_cast<double>(n) * n)});
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 2 * (n - i) - 1; ++j) {  // small triangles of row i, every second one inverted
        const double up = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
        const int pair = j / 2;
        const double a = (i + up) / n, b = (pair + up) / n;
        add(between(x, {1 - a - b, a, b}), places, inwards, side);
      }
    }
  }

  /// `inwards`: from a sample to where its cell is determined [m].
  void add(const Vec3d& x, const std::array<Place, 3>& places, const Vec3d& inwards, int side) {
    Sample s;
    s.x = x;
    s.facet = static_cast<std::uint32_t>(facets_.size() - 1);
    const Place& place = choose(vec::add(x, inwards), places);
    Group group{side, 0, place.nodes};
    for (std::size_t c = 0; c < 3; ++c) {
      s.local[c] = std::clamp((x[c] - place.corner[c]) / d_, 0.0, 1.0);
      if (s.local[c] >= 0.5) group.half |= 1 << c;
    }
    s.group = group_of(group);
    samples_.push_back(s);
  }

  [[nodiscard]] double outside(const Vec3d& x, const Place& place) const {
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double local = (x[c] - place.corner[c]) / d_;
      most = std::max({most, -local, local - 1});
    }
    return most;
  }

  /// Of the cells of the triangle's corners, returns the one that contains the sample. For a coarse triangle: the copy of the
  /// sample's own cell that shares most nodes with the corners' cells.
  [[nodiscard]] const Place& choose(const Vec3d& x, const std::array<Place, 3>& places) {
    std::size_t nearest = 0;
    double least = outside(x, places[0]);
    for (std::size_t c = 1; c < 3 && least > 0; ++c) {
      const double out = outside(x, places[c]);
      if (out >= least) continue;
      least = out;
      nearest = c;
    }
    if (least < 1e-6) return places[nearest];
    if (cells_.empty()) list_cells();
    const auto found = cells_.find(index_of(vec::sub(x, {d_ / 2, d_ / 2, d_ / 2})));
    if (found == cells_.end()) return places[nearest];
    int most = -1;
    const Place* best = nullptr;
    for (const Place& copy : found->second) {
      int shared = 0;
      for (const Place& place : places) {
        for (const std::int32_t n : copy.nodes)
          shared += std::find(place.nodes.begin(), place.nodes.end(), n) != place.nodes.end();
      }
      if (shared > most) {
        most = shared;
        best = &copy;
      }
    }
    return *best;
  }

  /// Grid index of a low corner.
  [[nodiscard]] Index index_of(const Vec3d& corner) const {
    Index index{};
    for (std::size_t c = 0; c < 3; ++c) index[c] = std::llround((corner[c] - b_.rest[0][c]) / d_);
    return index;
  }

  void list_cells() {
    const auto add_cell = [&](const Slots& local) {
      Place place;
      for (std::size_t a = 0; a < 8; ++a) place.nodes[a] = b_.slot[local[a]];
      place.corner = b_.rest[local[0]];
      cells_[index_of(place.corner)].push_back(place);
    };
    for (const auto& hex : b_.hexes) {
      Slots bits{};
      for (std::size_t a = 0; a < 8; ++a) bits[a] = hex[static_cast<std::size_t>(kVtkFromBits[a])];
      add_cell(bits);
    }
    for (std::size_t e = 0; e + 5 < b_.tets.size(); e += 6) add_cell(cell_corners(&b_.tets[e]));
  }

  /// Bounds of the half cell.
  [[nodiscard]] PatchSides sides_of(const Sample& s) const {
    PatchSides sides{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double low = (of(s).half >> c & 1) != 0 ? 0.5 : 0;
      for (const int way : {1, -1}) {
        PatchSide& side = sides[2 * c + (way > 0 ? 0 : 1)];
        side.normal[c] = way;
        side.distance = (way > 0 ? low + 0.5 - s.local[c] : s.local[c] - low) * d_;
        side.goes_on = goes_on(s, c, way);
      }
    }
    return sides;
  }

  /// The half of a cell that a sample lies in.
  [[nodiscard]] Index half_cell(const Sample& s) const {
    Index index{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double corner = s.x[c] - s.local[c] * d_;
      index[c] = 2 * std::llround((corner - b_.rest[0][c]) / d_) + (of(s).half >> c & 1);
    }
    return index;
  }

  void list_halves() {
    std::pair<Index, int> last;
    for (const Sample& s : samples_) {
      const std::pair<Index, int> half{half_cell(s), of(s).side};
      if (half == last && !halves_.empty()) continue;
      halves_.insert(half);
      last = half;
    }
  }

  /// Returns true if a neighbouring half cell has surface with the same orientation, possibly half a cell higher or lower.
  [[nodiscard]] bool goes_on(const Sample& s, std::size_t axis, int way) const {
    Index next = half_cell(s);
    next[axis] += way;
    const int side = of(s).side;
    const auto up = static_cast<std::size_t>(side / 2);
    for (const int rise : {0, 1, -1}) {
      Index at = next;
      at[up] += rise;
      if (halves_.count({at, side}) != 0) return true;
    }
    return false;
  }

  /// Makes one point of a group, at the sample nearest to the group's mean position.
  void gather(std::span<const std::uint32_t> members, ContactPoints& points) const {
    Vec3d middle{}, normal{};
    double area = 0;
    for (const std::uint32_t i : members) {
      const Facet& facet = facets_[samples_[i].facet];
      normal = vec::add(normal, vec::mul(facet.normal, facet.area));
      middle = vec::add(middle, vec::mul(samples_[i].x, facet.area));
      area += facet.area;
    }
    if (area < kLeastArea * d_ * d_) return;  // too small for a reliable normal
    middle = vec::mul(middle, 1 / area);
    std::uint32_t best = members.front();
    double least = vec::norm(vec::sub(samples_[best].x, middle));
    for (const std::uint32_t i : members) {
      const double distance = vec::norm(vec::sub(samples_[i].x, middle));
      if (distance >= least) continue;
      least = distance;
      best = i;
    }
    const Sample& s = samples_[best];
    std::array<double, 8> weights{};
    for (std::size_t a = 0; a < 8; ++a) {
      weights[a] = 1;
      for (std::size_t c = 0; c < 3; ++c) weights[a] *= (a >> c & 1) != 0 ? s.local[c] : 1 - s.local[c];
    }
    add_contact_point(points, s.x, of(s).nodes, weights, area, body_, normal, d_ / 2);
    if (patches_) points.sides.push_back(sides_of(s));
  }

  const Model& model_;
  const ModelBody& b_;
  std::int32_t body_;
  double d_;
  bool patches_;
  std::vector<Facet> facets_;
  std::vector<Sample> samples_;
  std::vector<Group> groups_;
  std::unordered_map<Group, std::uint32_t, HashOfGroup> index_;
  std::array<std::uint32_t, 8> last_{};
  std::map<Index, std::vector<Place>> cells_;
  std::unordered_set<std::pair<Index, int>, HashOfHalf> halves_;
};

}  // namespace

void sample_lattice(const Model& model, std::int32_t body, bool patches, ContactPoints& points) {
  LatticeSampler(model, body, patches).sample(points);
}

}  // namespace pliant
