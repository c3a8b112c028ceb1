// The finite elements, a file each. What an element_STEM.h gives is a struct, named in PLIANT_ELEMENTS, with
//   info                          the constant ElementInfo
//   record(x, material, what)     the numbers that its kernel reads of an element with these corners [m]; throws Error, whose
//                                 message begins with `what`, where the element is inside out
//   cube_record(edge, ...)        the same of a cube of a lattice, exact whatever the rounding of its corners
//   volume(record)                at rest [m^3]
//   frequency(record, material)   an upper bound of its highest angular frequency [rad/s] at rest with lumped mass. With
//                                 A = sum_a grad N_a grad N_a^T the stiffness per volume is at most
//                                 lambda tr A + 2 mu lambda_max(A)
//   for_each_point(record, f)     f(gradients [corners][3] [1/m], weight [m^3]) for each quadrature point
//   cost(law, uniform)            ElementCost of its kernel; `law`: operations of the law at a point
//   hourglass_energy(record, u)   [J], and hourglass_bound(record, u) of its stiffness [N/m]: what it has beside its points
// Corners of hexahedra come in bit order: corner a at bits (x, y, z) = (a & 1, a >> 1 & 1, a >> 2 & 1).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pliant {

/// ELEMENT(STEM, TYPE), in the order of ElementKind.
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

/// What the layers need to know of an element without looking at a single one.
struct ElementInfo {
  const char* word;     ///< its name in a scene file
  const char* what;     ///< for people
  const char* kernel;   ///< the force kernel of its lists
  const char* buffers;  ///< what the names of its buffers begin with
  const char* cell;     ///< what it is made of, for messages: "tetrahedron", "hexahedron"
  const char* cells;    ///< the same for several
  int corners;          ///< 4 or 8
  int record;           ///< numbers per element that the kernel reads
  int weighted;   ///< of these, the one that the kernel finds times the share of a full element; -1: shares stand by themselves
  int force;      ///< numbers of force per element that it leaves: three per corner
  bool averaged;  ///< dilation is averaged over the elements at each node, which takes a law with a volumetric part
  bool hourglass;  ///< hourglass control keeps the modes without strain
  bool bricks;     ///< cells of a lattice are kept in bricks (kernels/layout.h)
  bool statics;    ///< the static solver has it
  bool splits;     ///< a volume mesh of it can be cut, and tears face by face
};

/// Counted traffic [bytes] and operations (an fma is two) per element and step: each datum once, what a cache serves not at
/// all.
struct ElementCost {
  double bytes = 0;
  double texels = 0;  ///< how often the texel of each node is read
  double flops = 0;
};

const ElementInfo& element_info(ElementKind kind);
/// In the order of PLIANT_ELEMENTS.
std::span<const ElementKind, element_count> all_elements();
inline const char* to_string(ElementKind kind) { return element_info(kind).word; }

/// VTK's corner order of a hexahedron from bit order, and back: the same permutation both ways.
inline constexpr std::array<int, 8> kVtkFromBits{0, 1, 3, 2, 4, 5, 7, 6};

}  // namespace pliant
