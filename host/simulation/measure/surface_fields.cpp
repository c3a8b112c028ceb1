#include "simulation/measure/surface_fields.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "material/response.h"
#include "simulation/measure/contact_pressure.h"

namespace pliant {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d eigen_of(const Vec3d& v) { return {v[0], v[1], v[2]}; }

/// Signs of a hexahedron's corners in VTK order.
constexpr int kHexSigns[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                 {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

struct ElementState {
  Matrix3d f = Matrix3d::Identity();
  double volume = 0;
};

/// dx/dX from the tangents of the rest and the deformed shape.
void set_gradient(ElementState& e, const Matrix3d& rest, const Matrix3d& moved, double volume_per_determinant) {
  e.volume = rest.determinant() * volume_per_determinant;
  if (e.volume > 0) e.f = moved * rest.inverse();
}

template <std::size_t N>
ElementState element_state(const std::array<std::int32_t, N>& nodes, const std::vector<Vec3d>& rest,
                           const std::vector<Vec3d>& u) {
  ElementState e;
  Matrix3d before = Matrix3d::Zero(), after = Matrix3d::Zero();
  for (std::size_t a = 0; a < N; ++a) {
    const auto n = static_cast<std::size_t>(nodes[a]);
    const Vector3d x = eigen_of(rest[n]), moved = x + eigen_of(u[n]);
    for (int c = 0; c < 3; ++c) {
      double slope = 0;  // of the node's shape function along the element's own coordinate c, at its centre
      if constexpr (N == 8) {
        slope = kHexSigns[a][c] / 8.0;
      } else {
        slope = a == 0 ? -1 : static_cast<int>(a) == c + 1 ? 1 : 0;
      }
      before.col(c) += slope * x;
      after.col(c) += slope * moved;
    }
  }
  set_gradient(e, before, after, N == 8 ? 8.0 : 1.0 / 6);
  return e;
}

class NodeAverage {
 public:
  explicit NodeAverage(std::size_t nodes) : sum_(nodes), weight_(nodes) {}
  template <std::size_t N>
  void add(const std::array<std::int32_t, N>& nodes, double weight, double value) {
    if (!(weight > 0) || !std::isfinite(value)) return;
    for (const std::int32_t n : nodes) {
      sum_[static_cast<std::size_t>(n)] += weight * value;
      weight_[static_cast<std::size_t>(n)] += weight;
    }
  }
  [[nodiscard]] std::vector<double> values() const {
    std::vector<double> out(sum_.size());
    for (std::size_t n = 0; n < out.size(); ++n) out[n] = weight_[n] > 0 ? sum_[n] / weight_[n] : 0;
    return out;
  }

 private:
  std::vector<double> sum_, weight_;
};

double value_of(const Strain& s, ColorBy by) {
  switch (by) {
    case ColorBy::energy:
      return s.energy;
    case ColorBy::green_strain:
      return s.green;
    case ColorBy::almansi_strain:
      return s.almansi;
    default:
      return s.mises;
  }
}

std::vector<double> node_values(const Body& scene_body, const ModelBody& body, const std::vector<Vec3d>& u, ColorBy by) {
  NodeAverage average(body.rest.size());
  const ElementStrains of = element_strains(scene_body, body, u);
  const auto add = [&](const auto& elements) {
    for (std::size_t e = 0; e < elements.size(); ++e) average.add(elements[e], of.volume[e], value_of(of.strain[e], by));
  };
  add(body.tets);
  add(body.hexes);  // a body has elements of one kind
  return average.values();
}

/// Values at vertices from values by slot.
std::vector<float> embed(const Model& model, const std::vector<double>& by_slot) {
  const ModelSurface& s = model.surface;
  std::vector<float> out(s.rest.size());
  for (std::size_t v = 0; v < out.size(); ++v) {
    double value = 0;
    for (std::size_t a = 0; a < 8; ++a) value += s.weights[v][a] * by_slot[static_cast<std::size_t>(s.nodes[v][a])];
    out[v] = static_cast<float>(value);
  }
  return out;
}

}  // namespace

const std::vector<ColorInfo>& colors() {
  static const std::vector<ColorInfo> all{{ColorBy::none, "none", "", ""},
                                          {ColorBy::displacement, "displacement", "displacement", "m"},
                                          {ColorBy::energy, "energy", "strain energy density", "J/m^3"},
                                          {ColorBy::mises, "mises", "von Mises stress", "Pa"},
                                          {ColorBy::green_strain, "green_strain", "equivalent Green strain", "1"},
                                          {ColorBy::almansi_strain, "almansi_strain", "equivalent Almansi strain", "1"},
                                          {ColorBy::pressure, "pressure", "contact pressure", "Pa"},
                                          {ColorBy::model, "model", "", ""}};
  return all;
}

const ColorInfo& color_info(ColorBy by) {
  return *std::find_if(colors().begin(), colors().end(), [&](const ColorInfo& c) { return c.by == by; });
}

std::optional<ColorBy> color_by(const std::string& word) {
  const auto found = std::find_if(colors().begin(), colors().end(), [&](const ColorInfo& c) { return word == c.word; });
  if (found == colors().end()) return std::nullopt;
  return found->by;
}

Strain strain_of(const std::array<double, 9>& row_major, const Material& m) {
  const Matrix3d f = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(row_major.data());
  const Matrix3d h = f - Matrix3d::Identity();
  Response response;
  Strain out;
  const auto deviator = [](const Matrix3d& e) { return (e - e.trace() / 3 * Matrix3d::Identity()).norm(); };
  out.green = std::sqrt(2.0 / 3) * deviator(green_strain(h));
  if (const auto almansi = almansi_strain(h)) out.almansi = std::sqrt(2.0 / 3) * deviator(*almansi);
  if (!respond(m, h, false, response)) return out;
  out.energy = response.energy;
  if (const auto sigma = cauchy_stress(m, h)) {
    out.mises = std::sqrt(1.5) * deviator(*sigma);
    const Matrix3d& s = *sigma;
    out.stress = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  }
  return out;
}

ElementStrains element_strains(const Body& scene_body, const ModelBody& body, const std::vector<Vec3d>& u) {
  ElementStrains out;
  const bool varied = !body.materials.modulus.empty();
  Material own;
  const auto add = [&](const auto& elements) {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const ElementState state = element_state(elements[e], body.rest, u);
      std::array<double, 9> f{};
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(f.data()) = state.f;
      if (varied) own = material_of(scene_body, body.materials, e);
      out.strain.push_back(strain_of(f, varied ? own : material_of(scene_body, body.materials.index[e])));
      out.volume.push_back(state.volume);
    }
  };
  add(body.tets);
  add(body.hexes);
  return out;
}

std::vector<float> vertex_values(const Scene& scene, const Model& model, const BodyDisplacements& u, ColorBy by) {
  std::vector<double> by_slot(static_cast<std::size_t>(model.slots));
  if (by == ColorBy::displacement) {
    // |sum w u|, not sum w |u|: the way that the vertex itself has gone.
    std::array<std::vector<float>, 3> component;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t b = 0; b < u.size(); ++b) {
        for (std::size_t n = 0; n < u[b].size(); ++n) by_slot[static_cast<std::size_t>(model.bodies[b].slot[n])] = u[b][n][c];
      }
      component[c] = embed(model, by_slot);
    }
    std::vector<float> out(component[0].size());
    for (std::size_t v = 0; v < out.size(); ++v) out[v] = std::hypot(component[0][v], component[1][v], component[2][v]);
    return out;
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const std::vector<double> values = node_values(scene.bodies[b], model.bodies[b], u[b], by);
    for (std::size_t n = 0; n < values.size(); ++n) by_slot[static_cast<std::size_t>(model.bodies[b].slot[n])] = values[n];
  }
  return embed(model, by_slot);
}

std::vector<float> vertex_values(const Simulation& simulation, ColorBy by) {
  if (by == ColorBy::pressure) return contact_pressures(simulation);
  BodyDisplacements u;
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b) u.push_back(simulation.displacements(b));
  return vertex_values(simulation.scene(), simulation.model(), u, by);
}

std::vector<float> vertex_kinds(const Model& model) {
  std::vector<int> kind(static_cast<std::size_t>(model.slots), 0);
  for (const FlsmBatch& batch : model.flsm) {
    for (std::size_t i = 0; i < batch.slot.size(); ++i) {
      kind[static_cast<std::size_t>(batch.slot[i])] = static_cast<std::int32_t>(i) < batch.own ? 2 : 1;
    }
  }
  std::vector<float> out(3 * model.surface.rest.size());
  for (std::size_t v = 0; v < model.surface.rest.size(); ++v) {
    for (std::size_t a = 0; a < 8; ++a) {
      const int k = kind[static_cast<std::size_t>(model.surface.nodes[v][a])];
      out[3 * v + static_cast<std::size_t>(k)] += static_cast<float>(model.surface.weights[v][a]);
    }
  }
  return out;
}

}  // namespace pliant
