// Decomposition ("subdivision" in Mendoza et al.): crossed tetrahedra become smaller ones whose faces follow the cut.
#include <algorithm>
#include <map>
#include <numeric>

#include "cutting/topology/cut_cell.h"
#include "geometry/vec.h"
#include "tearing/method.h"
#include "tearing/sweep_probe.h"

namespace pliant {
namespace {

using Triangle = std::array<std::int32_t, 3>;

/// Nodes 0, 1, 2, 3 and their divided edges; everything by numbers of nodes in the new mesh.
struct Divided {
  std::array<std::int32_t, 4> corner{};
  std::array<std::int32_t, 6> middle{};  ///< of kTetEdges, -1: not crossed
  std::array<int, 4> label{};            ///< component: corners that uncrossed edges join
  [[nodiscard]] std::int32_t at(int i, int j) const { return middle[kTetEdgeOf[i][j]]; }
};

/// A quadrilateral by its corners in order becomes two triangles at its lowest node: the same on both sides.
void add_quad(const std::array<std::int32_t, 4>& q, std::vector<Triangle>& out) {
  const auto lowest = std::min_element(q.begin(), q.end()) - q.begin();
  const auto v = [&](std::ptrdiff_t k) { return q[static_cast<std::size_t>((lowest + k) % 4)]; };
  out.push_back({v(0), v(1), v(2)});
  out.push_back({v(0), v(2), v(3)});
}

/// The triangles of one face of a divided tetrahedron, outward.
void add_face(const Divided& d, const std::array<int, 3>& face, std::vector<Triangle>& out) {
  std::array<std::int32_t, 3> c{}, m{};  // m[k] between c[k] and c[k + 1]
  int split = 0, whole = 0, crossed = 0;
  for (int k = 0; k < 3; ++k) {
    c[k] = d.corner[face[k]];
    m[k] = d.at(face[k], face[(k + 1) % 3]);
    split += m[k] >= 0;
    (m[k] >= 0 ? crossed : whole) = k;
  }
  if (split == 0) out.push_back(c);
  if (split == 1) {
    const int a = crossed, b = (a + 1) % 3, o = (a + 2) % 3;
    out.push_back({c[a], m[a], c[o]});
    out.push_back({m[a], c[b], c[o]});
  }
  if (split == 2) {  // the corner between the crossed edges lies opposite the whole one
    const int a = whole, b = (a + 1) % 3, o = (a + 2) % 3;
    out.push_back({c[o], m[o], m[b]});
    add_quad({c[a], c[b], m[b], m[o]}, out);
  }
  if (split == 3) {
    for (int k = 0; k < 3; ++k) out.push_back({c[k], m[k], m[(k + 2) % 3]});
    out.push_back(m);
  }
}

class Decomposer {
 public:
  explicit Decomposer(const ElementMesh& mesh) : mesh_(mesh) { out_.mesh.nodes = mesh.nodes; }

  MethodResult run(std::span<const SweepTriangle> sweep) {
    vec::Box box;
    for (const Vec3d& x : mesh_.nodes) box.extend(x);
    probe_ = std::make_unique<SweepProbe>(box, mean_edge(mesh_), sweep);
    for (std::size_t n = 0; n < mesh_.nodes.size(); ++n) out_.node_from.push_back(static_cast<std::int32_t>(n));
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) divide(static_cast<std::int32_t>(t));
    part();
    return std::move(out_);
  }

 private:
  std::int32_t add_node(const Vec3d& x) {
    out_.mesh.nodes.push_back(x);
    out_.node_from.push_back(-1);
    return static_cast<std::int32_t>(out_.mesh.nodes.size()) - 1;
  }

  /// The node on an edge, -1 if the sweep does not cross it.
  std::int32_t middle(std::int32_t a, std::int32_t b) {
    const NodePair pair = node_pair(a, b);
    const auto [at, added] = middle_.try_emplace(pair, -1);
    if (!added) return at->second;
    const Vec3d& from = mesh_.nodes[pair[0]];
    const Vec3d& to = mesh_.nodes[pair[1]];
    double share = 0;
    if (!probe_->between(probe_->point(from, pair[0]), from, probe_->point(to, pair[1]), to, &share)) return -1;
    share = std::clamp(share, kLeastCrossing, 1 - kLeastCrossing);
    at->second = add_node(vec::add(from, vec::mul(vec::sub(to, from), share)));
    return at->second;
  }

  void divide(std::int32_t t) {
    Divided d;
    d.corner = mesh_.tets[t];
    std::iota(d.label.begin(), d.label.end(), 0);
    int crossed = 0;
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = kTetEdges[e];
      d.middle[e] = middle(d.corner[i], d.corner[j]);
      crossed += d.middle[e] >= 0;
    }
    if (crossed == 0) {
      add(t, 0, d.corner);
      return;
    }
    ++out_.crossed;
    for (std::size_t e = 0; e < 6; ++e) {
      if (d.middle[e] >= 0) continue;
      const int a = d.label[kTetEdges[e][0]], b = d.label[kTetEdges[e][1]];
      for (int& l : d.label) l = l == std::max(a, b) ? std::min(a, b) : l;
    }
    for (int v = 0; v < 4; ++v) {
      if (crossed == 3 && std::count(d.label.begin(), d.label.end(), d.label[v]) == 1) {
        corner_off(t, d, v);
        return;
      }
    }
    if (crossed == 4 && std::count(d.label.begin(), d.label.end(), 0) == 2) {
      halves(t, d);
      return;
    }
    fan(t, d);
  }

  /// One corner against three: a tetrahedron and a prism.
  void corner_off(std::int32_t t, const Divided& d, int v) {
    std::array<int, 3> o{};
    int k = 0;
    for (int i = 0; i < 4; ++i) {
      if (i != v) o[k++] = i;
    }
    const Triangle top{d.at(v, o[0]), d.at(v, o[1]), d.at(v, o[2])};
    add(t, d.label[v], {d.corner[v], top[0], top[1], top[2]});
    prism(t, d.label[o[0]], top, {d.corner[o[0]], d.corner[o[1]], d.corner[o[2]]});
  }

  /// Two corners against two: two prisms.
  void halves(std::int32_t t, const Divided& d) {
    std::array<int, 2> near{}, far{};
    int n = 0, f = 0;
    for (int i = 0; i < 4; ++i) (d.label[i] == d.label[0] ? near[n++] : far[f++]) = i;
    for (const auto& [side, other] : {std::pair{near, far}, std::pair{far, near}}) {
      prism(t, d.label[side[0]], {d.corner[side[0]], d.at(side[0], other[0]), d.at(side[0], other[1])},
            {d.corner[side[1]], d.at(side[1], other[0]), d.at(side[1], other[1])});
    }
  }

  /// Between the triangles a and b, whose corners are joined in order: three tetrahedra at its lowest node.
  void prism(std::int32_t t, int label, const Triangle& a, const Triangle& b) {
    std::array<std::int32_t, 6> v{a[0], a[1], a[2], b[0], b[1], b[2]};
    const auto lowest = std::min_element(v.begin(), v.end()) - v.begin();
    const auto turn = [&](int k) { return static_cast<std::size_t>((lowest + k) % 3); };
    const Triangle &mine = lowest < 3 ? a : b, &other = lowest < 3 ? b : a;
    std::vector<Triangle> opposite{other};
    add_quad({mine[turn(1)], mine[turn(2)], other[turn(2)], other[turn(1)]}, opposite);
    for (const Triangle& f : opposite) add(t, label, {v[static_cast<std::size_t>(lowest)], f[0], f[1], f[2]});
  }

  /// Any other pattern: from the centroid to the divided faces.
  void fan(std::int32_t t, const Divided& d) {
    Vec3d middle{};
    for (const std::int32_t n : d.corner) middle = vec::add(middle, vec::mul(mesh_.nodes[n], 0.25));
    const std::int32_t centre = add_node(middle);
    for (const auto& face : kTetFaces) {
      std::vector<Triangle> triangles;
      add_face(d, face, triangles);
      int lowest = face[0];  // a triangle without a corner goes with the face's lowest node, like on the other side
      for (const int k : face) lowest = d.corner[k] < d.corner[lowest] ? k : lowest;
      for (const Triangle& f : triangles) {
        int label = d.label[lowest];
        for (const int k : face) {
          if (std::find(f.begin(), f.end(), d.corner[k]) != f.end()) label = d.label[k];
        }
        add(t, label, {f[0], f[1], f[2], centre});
      }
    }
  }

  void add(std::int32_t t, int label, std::array<std::int32_t, 4> tet) {
    const auto& x = out_.mesh.nodes;
    const Vec3d& o = x[tet[0]];
    const double volume = vec::dot(vec::cross(vec::sub(x[tet[1]], o), vec::sub(x[tet[2]], o)), vec::sub(x[tet[3]], o));
    if (volume < 0) std::swap(tet[2], tet[3]);
    out_.mesh.tets.push_back(tet);
    out_.mesh.fill.push_back(mesh_.fill[t]);
    out_.element_from.push_back(t);
    label_.push_back(label);
  }

  /// Open the faces between parts of one tetrahedron that belong to different components.
  void part() {
    std::vector<std::uint8_t> cut(out_.mesh.tets.size(), 0);
    const auto neighbors = element_neighbors(out_.mesh.tets);
    for (std::size_t t = 0; t < cut.size(); ++t) {
      for (int f = 0; f < 4; ++f) {
        const std::int32_t other = neighbors[t][f].tet;
        if (other < 0 || out_.element_from[other] != out_.element_from[t] || label_[other] == label_[t]) continue;
        cut[t] |= static_cast<std::uint8_t>(1 << f);
      }
    }
    const std::vector<std::int32_t> from = part_at_faces(out_.mesh.tets, out_.mesh.nodes.size(), cut);
    for (std::size_t n = out_.mesh.nodes.size(); n < from.size(); ++n) {
      out_.mesh.nodes.push_back(out_.mesh.nodes[from[n]]);
      out_.node_from.push_back(out_.node_from[from[n]]);
    }
  }

  const ElementMesh& mesh_;
  MethodResult out_;
  std::unique_ptr<SweepProbe> probe_;
  std::map<NodePair, std::int32_t> middle_;
  std::vector<int> label_;
};

}  // namespace

MethodResult decompose_crossed(const ElementMesh& mesh, std::span<const SweepTriangle> sweep) {
  const ElementMesh parts = kuhn_tetrahedra(mesh);
  return Decomposer(parts).run(sweep);
}

}  // namespace pliant
