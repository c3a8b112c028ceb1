// A scene as plain data in SI units. Words such as "hex8" are those of the scene file (docs/scene.md), and so are the
// defaults; young, poisson, lattice_nodes and CurveSpec::duration, which the file requires, have default values here. A body
// with a volume_file of tetrahedra must set its element. A World checks the scene when it is constructed; messages name the
// place as in a scene file, for example "/bodies/0/material/young".
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
#include "pliant/scene_links.h"
#include "pliant/tool.h"

namespace pliant {

/// Three vertex indices, counter-clockwise as seen from outside.
using Triangle = std::array<std::int32_t, 3>;

/// A triangle surface in memory. Small holes and inconsistent orientation are repaired.
struct SurfaceSpec {
  std::vector<Vec3d> vertices;      ///< [m], shape [vertices]
  std::vector<Triangle> triangles;  ///< shape [triangles]
};

/// Returns the surface of a box with the given corners [m]: 8 vertices and 12 triangles.
PLIANT_API SurfaceSpec box_surface(const Vec3d& lower, const Vec3d& upper);

/// An isotropic hyperelastic material. docs/scene.md lists the laws and their parameters.
struct MaterialSpec {
  std::string law = "neo-hookean";  ///< name of the law
  double young = 3000;              ///< Young's modulus at small strain [Pa]
  std::string young_field;  ///< instead of young: name of a cell array of the body's mesh that holds the modulus of each
                            ///< element [Pa]; empty: unused
  double poisson = 0.45;    ///< Poisson's ratio, in (-1, 0.5)
  std::map<std::string, double>
      parameters;                   ///< instead of both: the law's own parameters by key, {{"mu", 1000}, {"kappa", 50000}}
  double density = 1000;            ///< [kg/m^3]
  double damping = 0;               ///< mass-proportional damping rate [1/s]
  double viscosity = 0;             ///< shear viscosity [Pa s]
  double bulk_viscosity = 0;        ///< bulk viscosity [Pa s]
  double stiffness_damping = 0;     ///< time b of the damping b K, K the stiffness at rest (Rayleigh) [s]
  double hourglass = 1;             ///< factor on the hourglass stiffness of hex8
  std::optional<double> toughness;  ///< stress at which the material tears [Pa]; absent: it does not tear
  std::optional<double> integrity;  ///< remaining fraction of the toughness, in (0, 1]
};

/// A part of a body with a different material. Where inclusions overlap, the last one applies.
struct InclusionSpec {
  RegionSpec where;       ///< which elements
  MaterialSpec material;  ///< their material
};

/// How a body's nodes move: finite elements (tled), shape matching (flsm), or both (hybrid). See docs/scene.md.
struct ModelSpec {
  std::string type = "tled";              ///< tled, hybrid, flsm or mass-spring
  double ratio = 0.5;                     ///< hybrid: fraction of the nodes that finite elements move, in [0, 1]
  std::optional<Vec3d> seed;              ///< hybrid: point from which the operational region grows [m]
  std::string follow;                     ///< hybrid: target of the operational region: "focus", a blade, a tool, "host/BLADE"
  std::optional<RegionSpec> region;       ///< hybrid: box or sphere that is the operational region, instead of ratio and seed
  std::string goals = "held";             ///< hybrid: goals between two steps of shape matching, held or extrapolated
  std::string coupling = "conservative";  ///< hybrid: conservative or one-sided
  bool cut = true;                        ///< hybrid, flsm: whether blades cut the shape-matching part
  std::optional<double> beta;             ///< hybrid: stiffness of the interface [N/m]; absent or 0: automatic
  int width = 2;                          ///< half-width of the shape-matching regions, in cells
  std::optional<double> alpha;            ///< stiffness of shape matching in (0, 1]; absent: from young
  std::optional<double> young;  ///< modulus of the shape-matching part [Pa], instead of alpha; without both: a hybrid uses its
                                ///< material's, flsm alpha = 0.5
  double damping = 0;           ///< per-region damping, in [0, 1]
  int substeps = 1;             ///< hybrid: finite-element steps per step of shape matching; 0: automatic
  SpringSpec spring;            ///< mass-spring: law of the springs
  bool edge_springs = true;     ///< mass-spring: springs along the edges of the tetrahedra
};

/// One body: shape, material, model, boundary conditions and loads.
struct BodySpec {
  std::string name = "body";               ///< unique within the scene
  SurfaceSpec surface;                     ///< shape: either a triangle surface in memory,
  std::string surface_file;                ///< or a triangle mesh (OBJ, STL, PLY, 3DS, glTF),
  std::string volume_file;                 ///< or a volume mesh file (Gmsh, VTK, VTU, TetGen), whose cells become the elements
  double scale = 1;                        ///< factor on the coordinates
  Vec3d translate{};                       ///< offset [m], applied after scale
  double lattice_spacing = 0;              ///< edge length of a cell [m]; 0: from lattice_nodes
  std::int64_t lattice_nodes = 2000;       ///< approximate number of nodes if no spacing is given
  double thickness = 0;                    ///< [m]; > 0: the surface is a sheet, a layer of tetrahedra instead of a lattice
  std::string element = "hex8";            ///< tet4, tet4anp, hex8 or hex8full; hex8 means tet4 for a sheet
  MaterialSpec material;                   ///< material outside the inclusions
  ModelSpec model;                         ///< finite elements, shape matching or both
  std::optional<MembraneSpec> membrane;    ///< absent: none
  std::vector<VesselSpec> vessels;         ///< vessels inside
  std::vector<SpringListSpec> springs;     ///< springs between given nodes, in addition to those of the model
  std::vector<InclusionSpec> inclusions;   ///< parts with a different material
  std::vector<FixedSpec> fixed;            ///< fixed nodes
  std::vector<PrescribedSpec> prescribed;  ///< nodes with prescribed motion
  std::vector<ForceSpec> forces;           ///< dead loads
  std::vector<PressureSpec> pressures;     ///< follower loads
  Vec3d velocity{};                        ///< initial velocity [m/s]
  Vec3d angular_velocity{};                ///< initial angular velocity about the centre of mass [rad/s]
  std::vector<InitialSpec> initial;        ///< initial fields of velocity and displacement, added to the two above
};

/// A line segment on a prescribed path, which cuts the surface that it sweeps.
struct BladeSpec {
  std::string name;                         ///< unique; empty: blade0, blade1, ...
  std::vector<std::array<double, 7>> path;  ///< (time [s], both ends [m]), at least two rows, times ascending
  std::optional<double> start;              ///< start of cutting [s]; absent: start of the path
  std::optional<double> end;                ///< end of cutting [s]; absent: end of the path
  std::string cuts = "always";              ///< always: all that it sweeps; by-force: what gives way to its edge
  std::string method = "virtual-nodes";     ///< or separation, decomposition, removal; of all blades and cuts of a scene
  std::optional<double> sharpness;          ///< by-force: kappa, the smaller the sharper; absent: 1
  std::optional<double> edge;               ///< by-force: radius of the edge [m], required
  std::optional<double> friction;           ///< by-force: between blade and tissue; absent: 0
  std::optional<double> thickness;          ///< by-force: it has two faces, this far apart [m]; absent: it has none
  std::optional<double> height;             ///< how far its faces reach back from the edge [m]; needed with a thickness
  std::optional<Vec3d> back;                ///< from the edge to the back; absent: against the first motion of the path
};

/// A change of parameters while the scene runs. Absent members change nothing; the supports of a body are replaced as a whole,
/// and nodes are held where they are at that moment.
struct ChangeSpec {
  double time = 0;                              ///< when it happens [s]; World::change() makes it at once
  std::optional<Vec3d> gravity;                 ///< [m/s^2], constant from then on
  std::string body;                             ///< the body that the rest belongs to; empty: the only body of the scene
  std::optional<std::int64_t> inclusion;        ///< the material is that of this inclusion of the body
  std::optional<MaterialSpec> material;         ///< new material
  std::optional<double> damping;                ///< the damping rate alone [1/s]
  std::optional<ModelSpec> model;               ///< new numbers of the same type of model
  std::optional<std::vector<FixedSpec>> fixed;  ///< the body's supports from then on; an empty list releases it
};

/// Dynamic relaxation: adaptive damping towards static equilibrium.
struct RelaxationSpec {
  double tolerance = 1e-5;          ///< converged at |R - F| <= tolerance * larger of the external and reaction forces
  std::int64_t max_steps = 100000;  ///< maximum number of steps
};

/// A complete scene.
struct SceneSpec {
  std::string name = "scene";            ///< name, for display only
  Vec3d gravity{};                       ///< [m/s^2] at factor 1
  CurveSpec gravity_curve;               ///< factor on gravity over time
  double dt = 0;                         ///< time step [s]; 0: automatic
  double safety = 0.9;                   ///< fraction of the stable step used by an automatic step, in (0, 1]
  std::string integrator = "increment";  ///< increment, textbook or forward-euler
  std::string inverted = "recover";      ///< treatment of elements with J <= 0: recover or stop
  double least_fill = 0.05;              ///< minimum fill of a cell in cut scenes, as a fraction of a full cell's mass, 0 to 1
  double least_step = 0.1;               ///< lower bound of an automatic step as a fraction of the first one, 0 (none) to 1
  double break_stretch =
      4;  ///< stretch beyond which an edge at a cut parts; elsewhere four times this; 0: never (docs/scene.md)
  std::optional<RelaxationSpec> relaxation;       ///< absent: a dynamic simulation
  std::vector<BladeSpec> blades;                  ///< blades on prescribed paths
  std::vector<ToolSpec> tools;                    ///< rigid tools in contact with the bodies
  std::optional<ContactSpec> contact;             ///< contact between tissue and tissue; absent: none
  std::vector<std::array<double, 4>> focus_path;  ///< path of the focus, which regions can follow: (time [s], x, y, z [m])
  std::vector<BodySpec> bodies;                   ///< at least one
  std::vector<JoinSpec> joins;                    ///< springs between bodies
  std::vector<ProbeSpec> probes;                  ///< evaluated by World::probes()
  std::vector<ChangeSpec> changes;                ///< parameters that change; times do not descend
};

}  // namespace pliant
