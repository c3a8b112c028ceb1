// Fields that can colour a surface: values of elements, averaged to nodes and embedded to vertices. All in double from the
// deformation gradient at the centre of each element; nothing of these shares code with the kernels.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "simulation/simulation.h"

namespace pliant {

enum class ColorBy { none, displacement, energy, mises, green_strain, almansi_strain, pressure, model };
struct ColorInfo {
  ColorBy by;
  const char* word;   ///< of --color
  const char* title;  ///< of the bar; empty: no values and no bar
  const char* unit;
};
/// All that a surface can be coloured by.
const std::vector<ColorInfo>& colors();
const ColorInfo& color_info(ColorBy by);
/// Nothing for another word.
std::optional<ColorBy> color_by(const std::string& word);

/// Displacements [m] of every body's nodes, in the order of ModelBody::rest.
using BodyDisplacements = std::vector<std::vector<Vec3d>>;

/// One value per vertex of the surface: |u| [m], strain energy per rest volume [J/m^3], von Mises stress of the Cauchy stress
/// [Pa], or the equivalent strain of Green's or Almansi's strain. Node values are averages over the node's elements weighted by
/// rest volume. Nodes that shape matching moves have a deformation gradient like all others; their stress is what the body's
/// material would answer.
std::vector<float> vertex_values(const Scene& scene, const Model& model, const BodyDisplacements& u, ColorBy by);

/// The same of the present state, and contact pressures (contact_pressure.h).
std::vector<float> vertex_values(const Simulation& simulation, ColorBy by);

/// [3 * vertices] shares of finite elements, interface and shape matching in the nodes that move a vertex.
std::vector<float> vertex_kinds(const Model& model);

/// Strain energy per rest volume [J/m^3] and von Mises stress [Pa] at the gradient f (row-major); 0 and 0 where the
/// law has no value, as most where det f <= 0; sigma = P f^T / J, 0 where det f <= 0. Equivalent strains sqrt(2/3 e : e) of the
/// deviator e of Green's strain, and of Almansi's, 0 where det f <= 0: for small strains mises is 3 mu times each.
struct Strain {
  double energy = 0, mises = 0, green = 0, almansi = 0;
  std::array<double, 6> stress{};  ///< Cauchy stress xx, yy, zz, xy, yz, xz [Pa]; 0 where mises is
};
Strain strain_of(const std::array<double, 9>& f, const Material& material);

/// Of the elements of a body at their centres, in the order of its tetrahedra and hexahedra.
struct ElementStrains {
  std::vector<Strain> strain;
  std::vector<double> volume;  ///< at rest, of the whole element, whatever its fill [m^3]
};
/// `u`: displacements of the body's nodes [m].
ElementStrains element_strains(const Body& scene_body, const ModelBody& body, const std::vector<Vec3d>& u);

}  // namespace pliant
