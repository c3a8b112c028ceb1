// The finite elements, one file each. Interface of element_STEM.h: a struct, named in PLIANT_ELEMENTS, with
//   info                          the constant ElementInfo
//   record(x, material, what)     the kernel data of an element with these corners [m]; throws Error, whose message begins with
//                                 `what`, if the element is inverted
//   cube_record(edge, ...)        the same for a cube of a lattice, independent of the rounding of its corners
//   volume(record)                undeformed [m^3]
//   frequency(record, material)   an upper bound of its highest undeformed angular frequency [rad/s] with lumped mass. With
//                                 A = sum_a grad N_a grad N_a^T the stiffness per volume is at most
//                                 lambda tr A + 2 mu lambda_max(A)
//   for_each_point(record, f)     calls f(gradients [corners][3] [1/m], weight [m^3]) for each quadrature point
//   cost(law, uniform)            ElementCost of its kernel; `law`: operations of the law at a point
//   hourglass_energy(record, u)   [J], and hourglass_bound(record, u) of its stiffness [N/m]: contributions besides the points
// Corners of hexahedra are in bit order: corner a at bits (x, y, z) = (a & 1, a >> 1 & 1, a >> 2 & 1).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pliant {

/// ELEMENT(STEM, TYPE), in the order of ElementKind. The first with a number of corners is the usual one (usual_element).
#define PLIANT_ELEMENTS(ELEMENT) \
  ELEMENT(tet4, Tet4)            \
  ELEMENT(tet4anp, Tet4Anp)      \
  ELEMENT(hex8, Hex8)            \
  ELEMENT(hex8full, Hex8Full)

#define PLIANT_ELEMENT_KIND(stem, type) stem,
enum class ElementKind { PLIANT_ELEMENTS(PLIANT_ELEMENT_KIND) };
#undef PLIANT_ELEMENT_KIND

#define PLIANT_ELEMENT_ONE(stem, type) +1
inline constexpr std::size_t element_count = 0 PLIANT_ELEMENTS(PLIANT_ELEMENT_ONE);
#undef PLIANT_ELEMENT_ONE

/// Properties of an element that other code needs without depending on the element.
struct ElementInfo {
  const char* word;     ///< name in a scene file
  const char* what;     ///< description for users
  const char* kernel;   ///< force kernel of its element lists
  const char* buffers;  ///< prefix of its buffers' names
  const char* cell;     ///< its shape, for messages: "tetrahedron", "hexahedron"
  const char* cells;    ///< the plural
  int corners;          ///< 4 or 8
  int record;           ///< numbers per element in the kernel data
  int weighted;         ///< index of the number that is multiplied by the share of a full element; -1: shares are separate
  int force;            ///< force numbers per element: three per corner
  bool averaged;        ///< dilation is averaged over the elements at each node; requires a law with a volumetric part
  bool hourglass;       ///< has hourglass control for the modes without strain
  const char* brick;    ///< force kernel of lattice cells stored in bricks (kernels/layout.h); null: they are lists
  bool statics;         ///< supported by the static solver
  bool splits;          ///< volume meshes of it can be cut, and tear face by face
  bool reference;       ///< accurate in bending and at any Poisson's ratio: what `plan` compares the others with
  int trial;            ///< place in the order in which `plan` tries elements: the most accurate for their cost come first
};

/// Memory traffic [bytes] and operations (an fma is two) per element and step. Each datum counts once; cache hits do not
/// count.
struct ElementCost {
  double bytes = 0;
  double texels = 0;  ///< number of reads of each node's texel
  double flops = 0;
};

const ElementInfo& element_info(ElementKind kind);
/// In the order of PLIANT_ELEMENTS.
std::span<const ElementKind, element_count> all_elements();
/// The first element with so many corners: what a body is made of if its scene does not say.
ElementKind usual_element(int corners);
/// The element whose lattice cells are stored in bricks (ElementInfo::brick). There is one layout of bricks, so one element.
ElementKind brick_element();
/// The element of references, see ElementInfo::reference.
ElementKind reference_element();
inline const char* to_string(ElementKind kind) { return element_info(kind).word; }

/// Permutation between VTK's corner order of a hexahedron and bit order; it is its own inverse.
inline constexpr std::array<int, 8> kVtkFromBits{0, 1, 3, 2, 4, 5, 7, 6};

}  // namespace pliant
