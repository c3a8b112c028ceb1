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
#include "integrators/integrator.h"
#include "material/material.h"
#include "scene/blade.h"
#include "scene/contact_tool.h"
#include "scene/curve.h"
#include "scene/lattice_spec.h"
#include "scene/motion.h"
#include "scene/selection.h"

namespace pliant {

struct SceneProbes;
struct TriangleMesh;

/// A part of a body with another material (a stiff inclusion). Later entries win where they overlap.
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
  std::optional<Rotation> rotate{};            ///< instead of a displacement
  std::array<bool, 3> axes{true, true, true};  ///< the components that the rotation prescribes
  [[nodiscard]] bool moves(int axis) const { return rotate ? axes[axis] : displacement[axis].has_value(); }
};

/// A force shared by the chosen nodes: of a lattice in proportion to their mass, of a mesh equally.
struct Force {
  Selection where;
  Vec3d force{};  ///< in total [N]
  Curve curve;
};

/// Follower pressure on the chosen part of the surface: acts along the inward normal of the deformed surface.
struct Pressure {
  Selection where;      ///< applied to surface triangle centroids
  double pressure = 0;  ///< [Pa]
  Curve curve;
};

/// Which nodes of a body follow finite elements (TLED) and which follow fast lattice shape matching (FLSM).
enum class ModelType { tled, hybrid, flsm };
const char* to_string(ModelType type);

/// The key "model" of a body. FLSM: Rivers and James 2007; hybrid: Hybrid Deformation Model, eq. 1 to 9.
struct DeformationModel {
  ModelType type = ModelType::tled;
  double ratio = 0.5;         ///< hybrid: share of the body's nodes in the operational region, in [0, 1]
  std::optional<Vec3d> seed;  ///< hybrid: the operational region grows from here [m]; absent: from the first surface vertex
  std::optional<Selection> region;  ///< hybrid: operational are the cells with their centre in here, instead of ratio and seed
  double beta = 0;                  ///< stiffness of the interface [N/m]; 0: "auto", alpha m / H^2 of each node
  int width = 2;                    ///< half-width w of the regions in cells, 1 to 5
  double alpha = 0.5;               ///< in (0, 1]
  double young = 0;                 ///< "stiffness": {"young": E} [Pa] chooses alpha instead; 0: alpha as it stands
  bool matched = false;             ///< young is the material's, for nothing was said: as far as an alpha of 1 reaches
  double damping = 0;               ///< per-region damping, in [0, 1] per step
  int substeps = 1;                 ///< steps of TLED per step of FLSM, 1 to 64
  bool extrapolate = false;         ///< "goals": "extrapolated" instead of "held" between steps of FLSM
  bool conservative = true;  ///< "coupling": "conservative" gives the reaction of the interface back, "one-sided" does not
  bool cut = true;           ///< "cut": false: a blade passes through the shape-matching part without effect
  std::string follow;  ///< the operational region moves with what has this name: kFocus, a blade or a tool; empty: it stays
  std::optional<std::vector<std::int32_t>> cells;  ///< set in code: the operational cells, once a region has moved
  std::string pointer;                             ///< JSON pointer ("/bodies/0/model")
};

struct Body {
  std::string name;
  std::filesystem::path surface;  ///< triangle mesh to be filled with a lattice; empty if `mesh` is given
  std::shared_ptr<const TriangleMesh> surface_in_memory;  ///< set in code: instead of the file, which names it in messages
  std::filesystem::path mesh;  ///< tetrahedral (or hexahedral) volume mesh; empty if `surface` is given
  double scale = 1;            ///< applied to the file's coordinates first
  Vec3d translate{};           ///< [m], after scaling
  LatticeSpec lattice;         ///< used with `surface`
  ElementKind element = ElementKind::hex8;
  DeformationModel model;
  Material material;
  std::vector<Inclusion> inclusions;
  std::vector<Fixed> fixed;
  std::vector<Prescribed> prescribed;
  std::vector<Force> forces;
  std::vector<Pressure> pressures;
  Vec3d velocity{};          ///< initial velocity [m/s]
  Vec3d angular_velocity{};  ///< initial angular velocity about the centre of mass [rad/s]
  std::vector<Initial> initial;
  std::string pointer;  ///< JSON pointer ("/bodies/0")
};

/// Dynamic relaxation: adaptive damping towards static equilibrium.
struct Relaxation {
  bool enabled = false;
  double tolerance = 1e-5;  ///< stop at |R - F| <= tolerance * |largest of R, F|
  std::int64_t max_steps = 100000;
};

/// The key "solver": what `pliant run` does with the scene.
struct StaticSolver {
  bool enabled = false;     ///< "type": "static" instead of "dynamic"
  bool linear = false;      ///< small displacements
  int load_steps = 0;       ///< 0: "auto"
  double tolerance = 1e-8;  ///< |R - F| <= tolerance * largest of |R|, |F|
  int order = 1;            ///< 2: tetrahedra get a node in the middle of every edge
};

/// What becomes of an element whose J is not positive: it goes on and comes back, or the run ends.
enum class Inverted { recover, stop };

struct Scene {
  std::string name;            ///< file stem, or what the caller set
  std::filesystem::path file;  ///< empty if built in code
  Vec3d gravity{0, 0, 0};      ///< [m/s^2] at factor 1
  Curve gravity_curve;         ///< over time
  double dt = 0;               ///< [s]; 0 means automatic
  double safety = 0.9;         ///< share of the stable step that an automatic step takes
  double duration = 1;         ///< [s] simulated by `run` when neither --steps nor --seconds is given
  Integrator integrator = Integrator::increment;
  Inverted inverted = Inverted::recover;
  Relaxation relaxation;
  StaticSolver solver;
  Focus focus;
  std::vector<ContactTool> tools;
  std::optional<TissueContact> contact;  ///< of tissue with tissue; none: it passes through itself
  std::vector<Blade> blades;
  SceneView view;
  std::shared_ptr<const SceneProbes> probes;  ///< what `run` writes down over time (scene/probe.h); null: nothing
  double break_stretch = 4;                   ///< of an edge, beyond which it parts in a scene that is cut; 0: none does
  double least_step = 0.1;                    ///< floor of an automatic step, as a share of the first; 0: none
  double least_fill = 0.05;  ///< of a cell where blades cut, as a share of a full cell's mass; 0: what it holds
  bool cuttable = false;     ///< set in code: something may be cut though there are no blades
  bool interactive = false;  ///< set in code: the Model reserves a force on every node that moves a vertex of the surface
  std::vector<Body> bodies;
  /// [m/s^2] at a time [s].
  [[nodiscard]] Vec3d gravity_at(double time) const;
};

/// Read and validate a scene file. Throws Error with the file, the JSON pointer, the value and what is allowed.
/// Relative mesh paths become relative to the scene file. Meshes themselves are not opened.
Scene load_scene(const std::filesystem::path& file);
/// The same from text; `file` is used in messages and to resolve relative paths.
Scene parse_scene(const std::string& text, const std::filesystem::path& file);
/// The text of a scene file: parse_scene(scene_to_json(s), s.file) gives the same scene, moduli to the last bit.
std::string scene_to_json(const Scene& scene);

}  // namespace pliant
