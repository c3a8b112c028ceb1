// Bodies of the engine for a case: lattice or mesh, material, method, supports and consistent loads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "bench/accuracy/parts.h"
#include "geometry/mesh.h"
#include "io/obj.h"
#include "model/elements/body_mesh.h"
#include "simulation/step/coupling.h"

namespace pliant::bench::accuracy {
namespace {

namespace fs = std::filesystem;

/// A folder for a surface that goes when this object goes.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / fmt::format("pliant-accuracy-{:08x}", std::random_device{}())) {
    fs::create_directory(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

Vec3d size_at(const Problem& p, int refine) {
  Vec3d size = p.size;
  if (p.shape == Shape::cook) size[2] /= refine;  // plane strain: one layer of cubes
  return size;
}

/// The surface of the body as an OBJ file.
fs::path surface_of(const Problem& p, const fs::path& folder, int refine) {
  TriangleMesh mesh;
  const Vec3d size = size_at(p, refine);
  for (int a = 0; a < 8; ++a)
    mesh.vertices.push_back(shaped(p, {size[0] * (a & 1), size[1] * (a >> 1 & 1), size[2] * (a >> 2 & 1)}));
  constexpr int faces[6][4]{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  write_obj(folder / "body.obj", mesh);
  return folder / "body.obj";
}

Body plain_body(const Problem& p) {
  Body body;
  body.name = p.name;
  Material& m = body.material;
  m.set_moduli(Law::neo_hookean, Moduli::from_young(p.young, p.poisson));
  m.density = kDensity;
  return body;
}

/// Conforming elements of a tapered panel; boxes and organs are lattices.
BodyMesh panel(const Problem& p, const Method& method, int refine) {
  const bool tets = method.element == ElementKind::tet4 || method.element == ElementKind::tet4anp;
  std::array<int, 3> cells{p.cells[0] * refine, p.cells[1] * refine, 1};
  statics::Mesh mesh = statics::box_mesh(tets ? statics::Element::tet4 : statics::Element::hex8full, cells, size_at(p, refine));
  BodyMesh solid;
  for (const Vec3d& x : mesh.nodes) solid.nodes.push_back(shaped(p, x));
  for (std::int64_t e = 0; e < mesh.elements(); ++e) {
    const std::int32_t* n = mesh.nodes_of(e);
    if (tets) {
      solid.tets.push_back({n[0], n[1], n[2], n[3]});
    } else {
      solid.hexes.push_back({n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]});
    }
  }
  solid.fill.assign(static_cast<std::size_t>(mesh.elements()), 1.0);
  return solid;
}

void add_supports(const Problem& p, const BodyMesh& solid, const Curve& curve, Body& body) {
  std::map<std::pair<int, Vec3d>, std::vector<std::int64_t>> moved;
  std::map<int, std::vector<std::int64_t>> held;
  for (const Support& s : p.supports) {
    for (std::size_t n = 0; n < solid.nodes.size(); ++n) {
      if (!s.where(solid.nodes[n])) continue;
      const auto index = static_cast<std::int64_t>(n);
      if (s.displacement) {
        moved[{s.axes, s.displacement(solid.nodes[n])}].push_back(index);
      } else {
        held[s.axes].push_back(index);
      }
    }
  }
  const auto nodes = [](std::vector<std::int64_t> chosen) {
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    Selection where;
    where.kind = Selection::Kind::nodes;
    where.nodes = std::move(chosen);
    return where;
  };
  for (const auto& [axes, chosen] : held) {
    body.fixed.push_back({nodes(chosen), {(axes & 1) != 0, (axes & 2) != 0, (axes & 4) != 0}});
  }
  for (const auto& [how, chosen] : moved) {
    Prescribed entry;
    entry.where = nodes(chosen);
    for (int c = 0; c < 3; ++c) {
      if (how.first >> c & 1) entry.displacement[c] = how.second[c];
    }
    entry.curve = curve;
    body.prescribed.push_back(entry);
  }
}

/// Node forces that do the work of the tractions, with exactly their resultant.
void add_tractions(const Problem& p, const statics::Mesh& mesh, double depth, const Curve& curve, Body& body) {
  for (const Traction& t : p.tractions) {
    statics::Problem loaded;
    loaded.mesh = mesh;
    const double area = statics::add_traction(loaded, t.where, t.traction);
    std::map<std::int32_t, Vec3d> sums;
    for (const statics::Force& f : loaded.forces) sums[f.node] = vec::add(sums[f.node], f.force);
    for (const auto& [node, force] : sums) {
      Force entry;
      entry.where.kind = Selection::Kind::nodes;
      entry.where.nodes = {node};
      entry.force = vec::mul(force, t.width * depth / area);
      entry.curve = curve;
      body.forces.push_back(entry);
    }
  }
}

/// `longest`: the longest step of shape matching as stiff as the problem's material [s].
void choose_method(const Case& c, const std::function<double()>& longest, double spacing, double bound, Built& built) {
  const Problem& p = *c.problem;
  const Method& m = *c.method;
  DeformationModel& model = built.scene.bodies[0].model;
  model.type = m.type;
  model.pointer = "/bodies/0/model";
  if (m.type == ModelType::tled) return;
  model.width = m.width;
  model.young = p.young;
  if (m.type == ModelType::hybrid) {
    // E = k rho d^2 alpha / b with b = h^2 / (1 + c h / 2) <= h^2.
    const double k = m.width * (m.width + 1) / 3.0, largest = spacing * std::sqrt(k * kDensity / p.young);
    model.ratio = m.ratio;
    model.seed = p.seed;
    model.substeps = std::clamp(static_cast<int>(0.75 * largest / bound), 1, 16);
    return;
  }
  const double frame = 1.0 / 60, largest = longest();
  if (c.step == "1/60") {
    built.scene.dt = frame;
    model.alpha = 1;
    // As soft as the lattice is at this step, so that it settles as fast as it can.
    if (largest <= frame) {
      model.young = 0;
      built.scene.bodies[0].material.damping *= largest / frame;
    }
    return;
  }
  built.scene.dt = std::min(std::stod(c.step) * largest, frame);
}

/// All load entries share one curve: as many as there are nodes would cost every step.
void merge_curves(Model& model) {
  if (model.curves.size() < 2) return;
  model.curves.resize(2);
  for (Constraint& c : model.constraints) {
    for (std::int32_t& curve : c.curve) curve = std::min(curve, 1);
  }
  for (NodeForce& f : model.forces) f.curve = std::min(f.curve, 1);
}

}  // namespace

Vec3d shaped(const Problem& p, const Vec3d& x) {
  if (p.shape != Shape::cook) return x;
  // The panel's left edge runs from 0 to 44 mm, its right edge from 44 to 60 mm.
  const double s = x[0] / p.size[0], t = x[1] / p.size[1];
  return {x[0], 0.044 * s + (0.044 - 0.028 * s) * t, x[2]};
}

Curve load_curve(const Problem& p) {
  Curve curve;
  curve.kind = Curve::Kind::smooth;
  curve.duration = 3 / p.omega;
  return curve;
}

Built build(const Case& c, const fs::path& scenes) {
  const Problem& p = *c.problem;
  const Folder folder;
  Built built;
  Body body = plain_body(p);
  body.element = c.method->element;
  body.model.type = c.method->type;
  body.material.damping = 2 * p.omega;
  built.spacing = p.size[0] / (p.cells[0] * c.refine);
  std::vector<BodyMesh> solids;
  if (p.shape == Shape::cook && c.method->type == ModelType::tled) {
    solids.push_back(panel(p, *c.method, c.refine));
  } else {
    body.surface = p.shape == Shape::liver ? scenes / "meshes" / "liver.obj" : surface_of(p, folder.path(), c.refine);
    body.lattice.spacing = built.spacing;
    solids.push_back(make_body_mesh(body));
  }
  const BodyMesh& solid = solids[0];
  built.mesh = mesh_of(solid);
  const Curve curve = load_curve(p);
  add_supports(p, solid, curve, body);
  add_tractions(p, built.mesh, size_at(p, c.refine)[2], curve, body);
  built.scene.name = p.name;
  built.scene.gravity = p.gravity;
  built.scene.bodies.push_back(body);
  if (c.method->type == ModelType::tled || c.method->type == ModelType::hybrid) built.scene.safety = std::stod(c.step);
  const double wave = std::sqrt((body.material.moduli.lambda + 2 * body.material.moduli.mu) / kDensity);
  const auto longest = [&] {
    Scene scene = built.scene;
    scene.dt = 0;
    return longest_step(build_model(scene, solids), scene);
  };
  choose_method(c, longest, built.spacing, built.spacing / wave, built);
  Model model = build_model(built.scene, solids);
  merge_curves(model);
  built.model = std::make_shared<const Model>(std::move(model));
  return built;
}

statics::Mesh mesh_of(const BodyMesh& solid) {
  statics::Mesh mesh;
  mesh.nodes = solid.nodes;
  mesh.fill = solid.fill;
  mesh.element = solid.tets.empty() ? statics::Element::hex8full : statics::Element::tet4;
  for (const auto& t : solid.tets) mesh.corners.insert(mesh.corners.end(), t.begin(), t.end());
  for (const auto& h : solid.hexes) mesh.corners.insert(mesh.corners.end(), h.begin(), h.end());
  return mesh;
}

statics::Mesh lattice_mesh(const Problem& p, int cells, const fs::path& scenes) {
  Body body = plain_body(p);
  body.surface = scenes / "meshes" / "liver.obj";
  body.lattice.spacing = p.size[0] / cells;
  return mesh_of(make_body_mesh(body));
}

}  // namespace pliant::bench::accuracy
