// Selections, curves, boundary conditions, loads and probes of a scene (scene.h).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pliant {

/// A vector x, y, z.
using Vec3d = std::array<double, 3>;
/// A selection by undeformed position [m], by number, or by a tag of the mesh file. It selects nodes; for pressures it
/// selects surface triangles and for inclusions elements, both by their centres.
struct RegionSpec {
  /// The kind of selection.
  enum class Kind {
    all,      ///< everything
    box,      ///< between a and b
    sphere,   ///< within radius of a
    plane,    ///< the side of the plane through a that the normal b points to
    nodes,    ///< by node number
    surface,  ///< inside a closed surface from a file
    region    ///< by a tag in the body's mesh file
  };
  Kind kind = Kind::all;            ///< determines which of the following members are used
  Vec3d a{};                        ///< box: lower corner; sphere: centre; plane: a point
  Vec3d b{};                        ///< box: upper corner; plane: normal, which points to the selected side
  double radius = 0;                ///< sphere [m]
  std::vector<std::int64_t> nodes;  ///< nodes: numbers within the body
  std::string surface_file = {};    ///< surface: mesh file (OBJ, STL, PLY, ...); the body's scale and translate apply to it

  std::string region_name = {};    ///< region: name of the tag (a physical group of Gmsh); empty: region_number is used
  std::int64_t region_number = 0;  ///< region: number of the tag
  std::string region_data = {};    ///< region: name of the array that holds the tags; empty: the default (docs/scene.md)
  int region_dimension = 0;        ///< region: 2 for tagged faces, 3 for tagged elements, 0 for either

  /// Selects everything.
  static RegionSpec all() { return {}; }
  /// Selects all between two corners [m], bounds included.
  static RegionSpec box(const Vec3d& lower, const Vec3d& upper) { return {Kind::box, lower, upper, 0, {}}; }
  /// Selects all within `radius` [m] of a point [m].
  static RegionSpec sphere(const Vec3d& centre, double radius) { return {Kind::sphere, centre, {}, radius, {}}; }
  /// Selects the side of the plane through `point` [m] to which `normal` points.
  static RegionSpec plane(const Vec3d& point, const Vec3d& normal) { return {Kind::plane, point, normal, 0, {}}; }
  /// Selects nodes by number within the body.
  static RegionSpec of_nodes(std::vector<std::int64_t> numbers) { return {Kind::nodes, {}, {}, 0, std::move(numbers)}; }
  /// Selects the inside of a closed surface from a mesh file.
  static RegionSpec inside(std::string file) { return {Kind::surface, {}, {}, 0, {}, std::move(file)}; }
  /// Selects the elements or faces with this tag number in the body's mesh file.
  static RegionSpec tagged(std::int64_t number) {
    RegionSpec r{Kind::region, {}, {}, 0, {}};
    r.region_number = number;
    return r;
  }
  /// Selects the elements or faces with this tag name in the body's mesh file.
  static RegionSpec tagged(std::string name) {
    RegionSpec r{Kind::region, {}, {}, 0, {}};
    r.region_name = std::move(name);
    return r;
  }
};

/// A factor over time, for loads and prescribed motion.
struct CurveSpec {
  std::string kind = "constant";             ///< constant, ramp, smooth or table
  double start = 0;                          ///< start time [s]
  double duration = 1;                       ///< ramp and smooth: time from factor 0 to factor 1 [s]
  std::vector<std::array<double, 2>> table;  ///< table: (time [s], factor), times ascending
};

/// Nodes fixed in the given axes.
struct FixedSpec {
  RegionSpec where;          ///< the nodes
  std::string axes = "xyz";  ///< any of x, y, z
};

/// A right-handed rotation about a fixed axis.
struct RotationSpec {
  Vec3d axis{0, 0, 1};  ///< direction, of any non-zero length
  Vec3d about{};        ///< a point on the axis [m]
  double angle = 0;     ///< [degrees] at factor 1
};

/// Nodes with prescribed motion.
struct PrescribedSpec {
  RegionSpec where;                                   ///< the nodes
  std::array<std::optional<double>, 3> displacement;  ///< at factor 1 [m]; absent components stay free
  CurveSpec curve;                                    ///< the factor over time
  std::optional<RotationSpec> rotate = std::nullopt;  ///< instead of a displacement: rotation about an axis
  std::string axes = "xyz";                           ///< components that the rotation prescribes
};

/// An affine field of the undeformed position X: offset + linear (X - about).
struct FieldSpec {
  Vec3d offset{};                 ///< [m/s] or [m]
  std::array<Vec3d, 3> linear{};  ///< rows [1/s] or [1]
  Vec3d about{};                  ///< [m]
};

/// Initial motion. The fields of several entries add up.
struct InitialSpec {
  RegionSpec where;                       ///< the nodes
  std::optional<FieldSpec> velocity;      ///< initial velocity [m/s]
  std::optional<FieldSpec> displacement;  ///< initial displacement [m]
};

/// A total force [N], distributed over the selected nodes: in a lattice in proportion to their mass, in a mesh equally.
struct ForceSpec {
  RegionSpec where;  ///< the nodes
  Vec3d force{};     ///< total force [N] at factor 1
  CurveSpec curve;   ///< the factor over time
};

/// Follower pressure [Pa], which acts along the inward normal of the deformed surface.
struct PressureSpec {
  RegionSpec where;     ///< the surface triangles
  double pressure = 0;  ///< [Pa] at factor 1
  CurveSpec curve;      ///< the factor over time
};

/// A probe at a point, at selected nodes or between a tool and a body, evaluated by World::probes().
struct ProbeSpec {
  std::string name;                  ///< unique
  std::optional<Vec3d> point;        ///< undeformed position [m]; absent: the nodes of `where`
  RegionSpec where;                  ///< nodes of `body`; not together with a point
  std::string body;                  ///< name of the body; empty: the only one; not together with a point
  std::vector<std::string> between;  ///< instead: a tool or a body, and another body (or none: all); quantity interpenetration
  std::vector<std::string> quantities;  ///< names as in ProbeValue::quantity, in output order; empty: position, displacement,
                                        ///< velocity, or interpenetration
};

}  // namespace pliant
