// A scene as plain data, in SI units, exactly as the JSON file says it. No geometry is loaded here.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "elements/element.h"
#include "elements/membrane.h"
#include "integrators/integrator.h"
#include "material/material.h"
#include "scene/blade.h"
#include "scene/change.h"
#include "scene/contact_tool.h"
#include "scene/curve.h"
#include "scene/lattice_spec.h"
#include "scene/motion.h"
#include "scene/selection.h"
#include "scene/spring.h"
#include "scene/vessel.h"

namespace pliant {

struct SceneProbes;
struct TriangleMesh;

/// A part of a body with a different material (e.g. a stiff inclusion). Where inclusions overlap, the last one applies.
struct Inclusion {
  Selection where;  ///< applied to element centroids
  Material material;
};

struct Fixed {
  Selection where;
  std::array<bool, 3> axes{true, true, true};
};

struct Prescribed {
  Selection where;
  std::array<std::optional<double>, 3> displacement;  ///< [m]; an absent component (null in JSON) stays free
  Curve curve;
  std::optional<Rotation> rotate{};            ///< instead of a displacement: rotation
  std::array<bool, 3> axes{true, true, true};  ///< components that the rotation prescribes
  [[nodiscard]] bool moves(int axis) const { return rotate ? axes[axis] : displacement[axis].has_value(); }
};

/// A force distributed over the selected nodes: in a lattice in proportion to their mass, in a mesh equally.
struct Force {
  Selection where;
  Vec3d force{};  ///< total force [N]
  Curve curve;
};

/// Follower pressure on the selected part of the surface, along the inward normal of the deformed surface.
struct Pressure {
  Selection where;      ///< applied to surface triangle centroids
  double pressure = 0;  ///< [Pa]
  Curve curve;
};

/// Method that moves a body's nodes: finite elements (TLED), fast lattice shape matching (FLSM), both in parts of it, or
/// springs along the edges of its tetrahedra.
enum class ModelType { tled, hybrid, flsm, mass_spring };
const char* to_string(ModelType type);

/// The key "model" of a body. FLSM: Rivers and James 2007; hybrid: Hybrid Deformation Model, eq. 1 to 9.
struct DeformationModel {
  ModelType type = ModelType::tled;
  double ratio = 0.5;         ///< hybrid: fraction of the body's nodes in the operational region, in [0, 1]
  std::optional<Vec3d> seed;  ///< hybrid: point from which the operational region grows [m]; absent: the first surface vertex
  std::optional<Selection> region;  ///< hybrid: cells with their centre in it are operational, instead of ratio and seed
  double beta = 0;                  ///< stiffness of the interface [N/m]; 0: "auto", alpha m / H^2 of each node
  int width = 2;                    ///< half-width w of the regions in cells, 1 to 5
  double alpha = 0.5;               ///< in (0, 1]
  double young = 0;                 ///< "stiffness": {"young": E} [Pa] determines alpha; 0: alpha is used directly
  bool matched = false;             ///< young is the material's by default; limited to the stiffness of an alpha of 1
  double damping = 0;               ///< per-region damping, in [0, 1] per step
  int substeps = 1;                 ///< steps of TLED per step of FLSM, 1 to 64; 0: "auto"
  bool extrapolate = false;         ///< "goals": "extrapolated" instead of "held" between steps of FLSM
  bool conservative =
      true;         ///< "coupling": "conservative" returns the reaction of the interface to the regions, "one-sided" does not
  bool cut = true;  ///< "cut": false: blades do not affect the shape-matching part
  std::string
      follow;  ///< target that the operational region follows: the name of a blade or tool, or kFocus (blade.h); empty: nothing
  std::optional<std::vector<std::int32_t>> cells;  ///< set in code: the operational cells, after a region has moved
  Spring spring;                                   ///< mass-spring
  bool edge_springs = true;                        ///< mass-spring: springs along the edges of the tetrahedra
  std::string pointer;                             ///< JSON pointer ("/bodies/0/model")
  /// Whether shape matching moves some of its nodes.
  [[nodiscard]] bool matches() const { return type == ModelType::hybrid || type == ModelType::flsm; }
};

struct Body {
  std::string name;
  std::filesystem::path surface;  ///< triangle mesh to be filled with a lattice; empty if `mesh` is given
  std::shared_ptr<const TriangleMesh> surface_in_memory;  ///< set in code: instead of the file, which names it in messages
  std::filesystem::path mesh;  ///< tetrahedral (or hexahedral) volume mesh; empty if `surface` is given
  double scale = 1;            ///< applied to the file's coordinates first
  Vec3d translate{};           ///< [m], after scaling
  LatticeSpec lattice;         ///< used with `surface`
  double thickness = 0;        ///< > 0: the `surface` is a sheet of this thickness, without a lattice [m]
  bool plain = false;  ///< a lattice becomes a volume mesh of its cells, whose surface is theirs: where blades have another
                       ///< method than virtual nodes
  ElementKind element = usual_element(8);  ///< of lattices
  DeformationModel model;
  Material material;
  std::vector<Inclusion> inclusions;
  std::optional<Membrane> membrane;  ///< on its whole surface
  std::vector<Vessel> vessels;       ///< inside
  std::vector<SpringList> springs;   ///< between given nodes
  std::vector<Fixed> fixed;
  std::vector<Prescribed> prescribed;
  std::vector<Force> forces;
  std::vector<Pressure> pressures;
  Vec3d velocity{};          ///< initial velocity [m/s]
  Vec3d angular_velocity{};  ///< initial angular velocity about the centre of mass [rad/s]
  std::vector<Initial> initial;
  std::string pointer;  ///< JSON pointer ("/bodies/0")
  /// Otherwise it is a volume mesh, from a file or of a sheet.
  [[nodiscard]] bool has_lattice() const { return mesh.empty() && thickness == 0; }
};

/// Dynamic relaxation: adaptive damping towards static equilibrium.
struct Relaxation {
  bool enabled = false;
  double tolerance = 1e-5;  ///< stop at |R - F| <= tolerance * larger of the external and reaction forces
  std::int64_t max_steps = 100000;
};

/// The key "solver": dynamic or static solution by `pliant run`.
struct StaticSolver {
  bool enabled = false;     ///< "type": "static" instead of "dynamic"
  bool linear = false;      ///< small displacements
  int load_steps = 0;       ///< 0: "auto"
  double tolerance = 1e-8;  ///< |R - F| <= tolerance * largest of |R|, |F|
  int order = 1;            ///< 2: tetrahedra get a node in the middle of every edge
};

/// Treatment of elements with J <= 0: continue and recover, or end the run.
enum class Inverted { recover, stop };

struct Scene {
  std::string name;            ///< file stem, or as set by the caller
  std::filesystem::path file;  ///< empty if built in code
  Vec3d gravity{0, 0, 0};      ///< [m/s^2] at factor 1
  Curve gravity_curve;         ///< over time
  double dt = 0;               ///< [s]; 0 means automatic
  double safety = 0.9;         ///< fraction of the stable step used by an automatic step
  double duration = 1;         ///< [s] simulated by `run` when neither --steps nor --seconds is given
  Integrator integrator = Integrator::increment;
  Inverted inverted = Inverted::recover;
  Relaxation relaxation;
  StaticSolver solver;
  Focus focus;
  std::vector<ContactTool> tools;
  std::optional<TissueContact> contact;  ///< contact of tissue with tissue; absent: none
  std::vector<Blade> blades;
  SceneView view;
  std::shared_ptr<const SceneProbes> probes;  ///< output of `run` over time (scene/probe.h); null: none
  double break_stretch = 4;                   ///< stretch beyond which an edge at a cut parts; 0: never
  double least_step = 0.1;                    ///< lower bound of an automatic step as a fraction of the first; 0: none
  double least_fill = 0.05;  ///< minimum fill of a cell in cut scenes, as a fraction of a full cell's mass; 0: the actual fill
  bool cuttable = false;     ///< set in code: prepare for cuts although there are no blades
  bool interactive = false;  ///< set in code: reserve a force on every node that moves a surface vertex
  std::vector<Body> bodies;
  std::vector<Join> joins;
  std::vector<SceneChange> changes;  ///< times do not descend
  /// [m/s^2] at a time [s].
  [[nodiscard]] Vec3d gravity_at(double time) const;
};

/// Reads and validates a scene file. Throws Error with the file, the JSON pointer, the value and the allowed values. Relative
/// mesh paths become relative to the scene file. Mesh files are not opened.
Scene load_scene(const std::filesystem::path& file);
/// Returns true if a blade of the scene cuts by force: its materials' toughness then belongs to blades, and nothing tears.
bool cuts_by_force(const Scene& scene);
/// Returns the method of the scene's blades, which all cuts of a program have, too.
BladeMethod blade_method(const Scene& scene);
/// Returns true if the scene's blades part bodies along the faces of their elements.
bool parts_along_faces(const Scene& scene);
/// Returns true if they divide or remove elements of plain meshes: decomposition or removal.
bool remakes_elements(const Scene& scene);
/// The same from text; `file` is used in messages and to resolve relative paths.
Scene parse_scene(const std::string& text, const std::filesystem::path& file);
/// The text of a scene file: parse_scene(scene_to_json(s), s.file) gives the same scene, moduli to the last bit.
std::string scene_to_json(const Scene& scene);

}  // namespace pliant
