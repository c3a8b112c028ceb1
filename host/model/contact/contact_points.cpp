// Contact points on surfaces: samples of the triangles, combined by half cells.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <unordered_map>

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

/// Depth of a soft shell, as a fraction of a cell.
constexpr double kShell = 0.25;

/// Depth below the surface at which a sample's cell is determined, as a fraction of a cell, since the surface may lie between
/// two cells.
constexpr double kInside = 1e-3;

/// Index 0 to 5 of the axis and sign closest to a normal.
int side_of(const Vec3d& normal) {
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c) {
    if (std::abs(normal[c]) > std::abs(normal[axis])) axis = c;
  }
  return static_cast<int>(2 * axis) + (normal[axis] < 0 ? 1 : 0);
}

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
    for (std::size_t i = 0; i < samples_.size() && patches_; ++i)
      halves_.insert({half_cell(samples_[i]), of(samples_[i]).side});
    // In the order of the body's nodes: their slots depend on which of its cells are finite elements.
    const std::vector<std::int32_t> node = nodes_of_slots(b_, model_.slots);
    std::vector<Group> numbered = groups_;
    for (Group& g : numbered) {
      for (std::int32_t& n : g.nodes) n = node[static_cast<std::size_t>(n)];
    }
    std::vector<std::size_t> order(groups_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return numbered[i] < numbered[k]; });
    const std::vector<std::vector<std::size_t>> members = members_of_groups();
    for (const std::size_t group : order) gather(members[group], points);
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
  struct Sample {
    std::size_t group = 0;
    Vec3d local{};        ///< position in its cell, in [0, 1]
    Vec3d x{}, normal{};  ///< normal of unit length
    double area = 0;
  };
  [[nodiscard]] const Group& of(const Sample& s) const { return groups_[s.group]; }

  /// Index of a group. Neighbouring samples mostly have the same.
  [[nodiscard]] std::size_t group_of(const Group& group) {
    if (!groups_.empty() && groups_[last_] == group) return last_;
    const auto [found, added] = index_.try_emplace(group, groups_.size());
    if (added) groups_.push_back(group);
    return last_ = found->second;
  }
  /// [groups] the samples of each, in the order of the triangles.
  [[nodiscard]] std::vector<std::vector<std::size_t>> members_of_groups() const {
    std::vector<std::vector<std::size_t>> members(groups_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) members[samples_[i].group].push_back(i);
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
    const Vec3d unit = vec::mul(normal, 1 / vec::norm(normal)), inwards = vec::mul(normal, -kInside * d_ / vec::norm(normal));
    const int side = side_of(normal);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 2 * (n - i) - 1; ++j) {  // small triangles of row i, every second one inverted
        const double up = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
        const int pair = j / 2;
        const double a = (i + up) / n, b = (pair + up) / n;
        add(between(x, {1 - a - b, a, b}), places, unit, inwards, side, area / (static_cast<double>(n) * n));
      }
    }
  }

  /// `normal`: of unit length; `inwards`: from a sample to where its cell is determined [m].
  void add(const Vec3d& x, const std::array<Place, 3>& places, const Vec3d& normal, const Vec3d& inwards, int side,
           double area) {
    Sample s;
    s.x = x;
    s.normal = normal;
    s.area = area;
    const Place place = choose(vec::add(x, inwards), places);
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
  [[nodiscard]] Place choose(const Vec3d& x, const std::array<Place, 3>& places) {
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
    Place best;
    for (const Place& copy : found->second) {
      int shared = 0;
      for (const Place& place : places) {
        for (const std::int32_t n : copy.nodes)
          shared += std::find(place.nodes.begin(), place.nodes.end(), n) != place.nodes.end();
      }
      if (shared > most) {
        most = shared;
        best = copy;
      }
    }
    return best;
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
  void gather(const std::vector<std::size_t>& members, ContactPoints& points) const {
    Vec3d middle{}, normal{};
    double area = 0;
    for (const std::size_t i : members) {
      normal = vec::add(normal, vec::mul(samples_[i].normal, samples_[i].area));
      middle = vec::add(middle, vec::mul(samples_[i].x, samples_[i].area));
      area += samples_[i].area;
    }
    if (area < kLeastArea * d_ * d_) return;  // too small for a reliable normal
    middle = vec::mul(middle, 1 / area);
    std::size_t best = members.front();
    double least = vec::norm(vec::sub(samples_[best].x, middle));
    for (const std::size_t i : members) {
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
  std::vector<Sample> samples_;
  std::vector<Group> groups_;
  std::unordered_map<Group, std::size_t, HashOfGroup> index_;
  std::size_t last_ = 0;
  std::map<Index, std::vector<Place>> cells_;
  std::set<std::pair<Index, int>> halves_;
};

/// Morton code of a point in a box of 1024^3.
std::uint64_t morton(const Vec3d& x, const vec::Box& box) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, box.upper[a] - box.lower[a]);
  std::uint64_t code = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto cell = static_cast<std::uint64_t>(longest > 0 ? (x[a] - box.lower[a]) / longest * 1023 : 0);
    for (std::size_t bit = 0; bit < 10; ++bit) code |= (cell >> bit & 1) << (3 * bit + a);
  }
  return code;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::size_t i : order) sorted.push_back(values[i]);
  values = std::move(sorted);
}

}  // namespace

ContactPoints contact_points(const Model& model, bool patches) {
  ContactPoints points;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const auto body = static_cast<std::int32_t>(b);
    double spacing = model.bodies[b].spacing;
    if (spacing > 0) {
      LatticeSampler(model, body, patches).sample(points);
    } else {
      spacing = sample_faces(model, body, patches, points);
    }
    points.spacing = std::max(points.spacing, spacing);
  }
  vec::Box box;
  for (const Vec3d& x : points.rest) box.extend(x);
  std::vector<std::uint64_t> code(points.size());
  for (std::size_t i = 0; i < code.size(); ++i) code[i] = morton(points.rest[i], box);
  // Points of a tile have the same orientation, so that the two faces of a cut are in different tiles.
  std::vector<int> side(points.size());
  for (std::size_t i = 0; i < side.size(); ++i) side[i] = side_of(points.normal[i]);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
    return std::tie(points.body[i], side[i], code[i]) < std::tie(points.body[k], side[k], code[k]);
  });
  reorder(points.rest, order);
  reorder(points.nodes, order);
  reorder(points.weights, order);
  reorder(points.area, order);
  reorder(points.body, order);
  reorder(points.normal, order);
  reorder(points.apart, order);
  if (patches) reorder(points.sides, order);
  const auto is_face = [](const ToolForm& form) { return form.shape == ToolShape::blade_face; };
  if (patches) points.joined.assign(points.size(), 0);
  if (patches && std::any_of(model.tools->begin(), model.tools->end(), is_face)) points.joined = joined_points(points);
  return points;
}

void add_contact(const Scene& scene, Model& model) {
  if (scene.tools.empty() && !scene.contact) return;
  if (model.tools == nullptr) {
    auto forms = std::make_shared<ToolForms>();
    for (const ContactTool& tool : scene.tools) forms->push_back(tool_form(tool));
    model.tools = forms;
  }
  model.contact_laws.clear();
  for (const ContactTool& tool : scene.tools)
    model.contact_laws.push_back({tool.stiffness, tool.exponent, tool.alpha, tool.friction, 0});
  model.tissue_contact = scene.contact;
  const bool patches = std::any_of(scene.tools.begin(), scene.tools.end(), [](const ContactTool& t) { return t.edges; });
  if (model.contact == nullptr || (patches && model.contact->sides.empty()))
    model.contact = std::make_shared<const ContactPoints>(contact_points(model, patches));
  // A soft shell extends to a quarter of a cell; "auto" contact is rigid at once.
  for (ContactLaw& law : model.contact_laws) law.core = law.stiffness > 0 ? kShell * model.contact->spacing : 0;
}

}  // namespace pliant
