// A scene in code: plain data in SI units, with the words of the scene file (docs/scene.md). Defaults are those of the file
// where it has one; young, poisson, lattice_nodes and the duration of a curve are required there and have a value here. A body
// with a volume_file of tetrahedra has to say its element. Nothing is checked until a World is made of it; messages then name
// the place as in a scene file, for example "/bodies/0/material/young".
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pliant/export.h"
#include "pliant/scene_conditions.h"
#include "pliant/tool.h"

namespace pliant {

/// Three indices, counter-clockwise from outside.
using Triangle = std::array<std::int32_t, 3>;

/// A triangle surface in memory. It may have small holes and need not be oriented consistently.
struct SurfaceSpec {
  std::vector<Vec3d> vertices;      ///< [m], shape [vertices]
  std::vector<Triangle> triangles;  ///< shape [triangles]
};

/// The surface of a box: 8 vertices, 12 triangles. Corners in [m].
PLIANT_API SurfaceSpec box_surface(const Vec3d& lower, const Vec3d& upper);

/// An isotropic hyperelastic material. The laws and their parameters are listed in docs/scene.md.
struct MaterialSpec {
  std::string law = "neo-hookean";           ///< by its word
  double young = 3000;                       ///< Young's modulus at small strain [Pa]
  std::string young_field;                   ///< instead: an array of the body's mesh with that of each element; empty: none
  double poisson = 0.45;                     ///< in (-1, 0.5)
  std::map<std::string, double> parameters;  ///< instead of both: by their keys, {{"mu", 1000}, {"kappa", 50000}}
  double density = 1000;                     ///< [kg/m^3]
  double damping = 0;                        ///< mass-proportional damping rate [1/s]
  double viscosity = 0;                      ///< of shear [Pa s]
  double bulk_viscosity = 0;                 ///< [Pa s]
  double hourglass = 1;                      ///< factor on the hourglass stiffness of hex8
  std::optional<double> toughness;           ///< stress at which it tears [Pa]; absent: it does not
  std::optional<double> integrity;           ///< share of the toughness that is left, in (0, 1]
};

/// A part of a body with another material; later entries win where they overlap.
struct InclusionSpec {
  RegionSpec where;       ///< which elements
  MaterialSpec material;  ///< of these elements
};

/// How the nodes of a body move: finite elements (tled), shape matching (flsm), or both (hybrid), as docs/scene.md describes.
struct ModelSpec {
  std::string type = "tled";         ///< tled, hybrid or flsm
  double ratio = 0.5;                ///< hybrid: share of the nodes that finite elements move, in [0, 1]
  std::optional<Vec3d> seed;         ///< hybrid: the operational region grows from here [m]
  std::string follow;                ///< hybrid: what the operational region follows: "focus", a blade, a tool, "host/BLADE"
  std::optional<RegionSpec> region;  ///< hybrid: a box or a sphere, instead of ratio and seed: the operational region
  std::string goals = "held";        ///< hybrid: held or extrapolated between the steps of shape matching
  std::string coupling = "conservative";  ///< hybrid: conservative, or one-sided
  bool cut = true;                        ///< hybrid, flsm: whether blades cut the shape-matching part
  std::optional<double> beta;             ///< hybrid: stiffness of the interface [N/m]; absent or 0: automatic
  int width = 2;                          ///< half-width of the regions of shape matching, in cells
  std::optional<double> alpha;            ///< stiffness of shape matching in (0, 1]; absent: see young
  std::optional<double> young;  ///< its modulus [Pa] instead of alpha; without both a hybrid's material's, else alpha = 0.5
  double damping = 0;           ///< per-region damping, in [0, 1]
  int substeps = 1;             ///< hybrid: steps of finite elements per step of shape matching
};

/// One body: its shape, what it is made of, and what holds and loads it.
struct BodySpec {
  std::string name = "body";               ///< unique in the scene
  SurfaceSpec surface;                     ///< either this,
  std::string surface_file;                ///< or a triangle mesh (OBJ, STL, PLY, 3DS, glTF),
  std::string volume_file;                 ///< or a volume mesh (Gmsh, VTK, VTU, TetGen), taken as it is
  double scale = 1;                        ///< applied to the coordinates first
  Vec3d translate{};                       ///< [m], after scaling
  double lattice_spacing = 0;              ///< edge of a cell [m]; 0: from lattice_nodes
  std::int64_t lattice_nodes = 2000;       ///< about this many nodes, where no spacing is given
  std::string element = "hex8";            ///< tet4, tet4anp, hex8 or hex8full
  MaterialSpec material;                   ///< of all elements that are in no inclusion
  ModelSpec model;                         ///< finite elements, shape matching or both
  std::vector<InclusionSpec> inclusions;   ///< parts of another material
  std::vector<FixedSpec> fixed;            ///< nodes that stay
  std::vector<PrescribedSpec> prescribed;  ///< nodes that move as told
  std::vector<ForceSpec> forces;           ///< dead loads
  std::vector<PressureSpec> pressures;     ///< follower loads
  Vec3d velocity{};                        ///< initial [m/s]
  Vec3d angular_velocity{};                ///< initial, about the centre of mass [rad/s]
  std::vector<InitialSpec> initial;        ///< fields of velocity and displacement at the start, added to these
};

/// A segment on a prescribed path; it cuts while it moves.
struct BladeSpec {
  std::string name;                         ///< different for every blade; empty: blade0, blade1, ...
  std::vector<std::array<double, 7>> path;  ///< (time [s], both ends [m]), at least two rows, times ascending
  std::optional<double> start;              ///< it does not cut before [s]
  std::optional<double> end;                ///< ... nor after [s]
};

/// Adaptive damping towards static equilibrium.
struct RelaxationSpec {
  double tolerance = 1e-5;          ///< done at |R - F| <= tolerance * |largest of R, F|
  std::int64_t max_steps = 100000;  ///< give up after so many steps
};

/// Everything that a World is made of.
struct SceneSpec {
  std::string name = "scene";                ///< for people
  Vec3d gravity{};                           ///< [m/s^2] at factor 1
  CurveSpec gravity_curve;                   ///< the factor over time
  double dt = 0;                             ///< [s]; 0: automatic
  double safety = 0.9;                       ///< share of the stable step that an automatic step takes, in (0, 1]
  std::string integrator = "increment";      ///< increment, textbook or forward-euler
  std::string inverted = "recover";          ///< elements with J <= 0: recover or stop
  double least_fill = 0.05;                  ///< of a cell where blades cut, as a share of a full cell's mass, 0 to 1
  double least_step = 0.1;                   ///< floor of an automatic step, as a share of the first, 0 (none) to 1
  double break_stretch = 4;                  ///< of an edge, beyond which it parts in a scene that is cut or tears; 0: none
  std::optional<RelaxationSpec> relaxation;  ///< absent: none
  std::vector<BladeSpec> blades;             ///< blades that cut what they sweep over
  std::vector<ToolSpec> tools;               ///< rigid tools that touch the bodies
  std::optional<ContactSpec> contact;        ///< absent: tissue passes through itself
  std::vector<std::array<double, 4>>
      focus_path;                 ///< (time [s], x, y, z [m]) of the focus, which operational regions can follow
  std::vector<BodySpec> bodies;   ///< at least one
  std::vector<ProbeSpec> probes;  ///< what World::probes() tells
};

}  // namespace pliant
