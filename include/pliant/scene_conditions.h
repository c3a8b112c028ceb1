// What holds, moves, loads and measures a body in a scene in code (scene.h): selections, curves, and the entries that use them.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pliant {

/// x, y, z.
using Vec3d = std::array<double, 3>;
/// A set of nodes chosen by rest position [m], by number, or by a tag of the mesh file. For pressures the centres of surface
/// triangles are chosen, for inclusions the centres of elements.
struct RegionSpec {
  /// How it chooses.
  enum class Kind {
    all,      ///< everything
    box,      ///< between a and b
    sphere,   ///< within radius of a
    plane,    ///< on the side of the plane through a to which b points
    nodes,    ///< by number
    surface,  ///< inside a closed surface from a file
    region    ///< by a tag of the body's mesh file
  };
  Kind kind = Kind::all;            ///< decides which of the others count
  Vec3d a{};                        ///< box: lower corner; sphere: centre; plane: a point
  Vec3d b{};                        ///< box: upper corner; plane: normal, the side it points to is chosen
  double radius = 0;                ///< sphere [m]
  std::vector<std::int64_t> nodes;  ///< numbers in the body
  std::string surface_file = {};    ///< surface: OBJ, STL, PLY, ...; the body's scale and translate apply to it

  std::string region_name = {};    ///< region: its name (a physical group of Gmsh); empty: region_number counts
  std::int64_t region_number = 0;  ///< region: the tag itself
  std::string region_data = {};    ///< region: the array of the file that holds the tags; empty: the usual one (docs/scene.md)
  int region_dimension = 0;        ///< region: 2 for tagged faces, 3 for tagged elements, 0 for whichever has the tag

  /// Everything.
  static RegionSpec all() { return {}; }
  /// Between two corners [m], bounds included.
  static RegionSpec box(const Vec3d& lower, const Vec3d& upper) { return {Kind::box, lower, upper, 0, {}}; }
  /// Within a radius [m] of a point [m].
  static RegionSpec sphere(const Vec3d& centre, double radius) { return {Kind::sphere, centre, {}, radius, {}}; }
  /// The side of a plane to which its normal points.
  static RegionSpec plane(const Vec3d& point, const Vec3d& normal) { return {Kind::plane, point, normal, 0, {}}; }
  /// Nodes by their numbers in the body.
  static RegionSpec of_nodes(std::vector<std::int64_t> numbers) { return {Kind::nodes, {}, {}, 0, std::move(numbers)}; }
  /// The inside of a closed surface.
  static RegionSpec inside(std::string file) { return {Kind::surface, {}, {}, 0, {}, std::move(file)}; }
  /// The elements or faces to which the body's mesh file gives a number.
  static RegionSpec tagged(std::int64_t number) {
    RegionSpec r{Kind::region, {}, {}, 0, {}};
    r.region_number = number;
    return r;
  }
  /// The elements or faces to which the body's mesh file gives a name.
  static RegionSpec tagged(std::string name) {
    RegionSpec r{Kind::region, {}, {}, 0, {}};
    r.region_name = std::move(name);
    return r;
  }
};

/// A factor over time, for loads and prescribed motion.
struct CurveSpec {
  std::string kind = "constant";             ///< constant, ramp, smooth or table
  double start = 0;                          ///< [s]
  double duration = 1;                       ///< [s], ramp and smooth: from 0 to 1 within it
  std::vector<std::array<double, 2>> table;  ///< table: (time [s], factor), times ascending
};

/// Nodes that stay where they are, in the axes named.
struct FixedSpec {
  RegionSpec where;          ///< which nodes
  std::string axes = "xyz";  ///< one to three letters of xyz
};

/// A rotation about an axis in space, right-handed.
struct RotationSpec {
  Vec3d axis{0, 0, 1};  ///< its direction, of any length but zero
  Vec3d about{};        ///< a point on it [m]
  double angle = 0;     ///< [degrees] at factor 1
};

/// Nodes that move as told.
struct PrescribedSpec {
  RegionSpec where;                                   ///< which nodes
  std::array<std::optional<double>, 3> displacement;  ///< [m]; an absent component stays free
  CurveSpec curve;                                    ///< the factor over time
  std::optional<RotationSpec> rotate = std::nullopt;  ///< instead of a displacement: on circles about an axis
  std::string axes = "xyz";                           ///< components that the rotation prescribes
};

/// An affine field of the place X at rest: offset + linear (X - about).
struct FieldSpec {
  Vec3d offset{};                 ///< [m/s] or [m]
  std::array<Vec3d, 3> linear{};  ///< rows [1/s] or [1]
  Vec3d about{};                  ///< [m]
};

/// Motion at the start; what several entries give a node is added up.
struct InitialSpec {
  RegionSpec where;                       ///< which nodes
  std::optional<FieldSpec> velocity;      ///< [m/s]
  std::optional<FieldSpec> displacement;  ///< [m]
};

/// A force [N] shared equally by the chosen nodes.
struct ForceSpec {
  RegionSpec where;  ///< which nodes
  Vec3d force{};     ///< total [N] at factor 1
  CurveSpec curve;   ///< the factor over time
};

/// Follower pressure [Pa] along the inward normal of the deformed surface.
struct PressureSpec {
  RegionSpec where;     ///< which triangles of the surface
  double pressure = 0;  ///< [Pa] at factor 1
  CurveSpec curve;      ///< the factor over time
};

/// What World::probes() tells of a point, or of chosen nodes.
struct ProbeSpec {
  std::string name;                     ///< different for every probe
  std::optional<Vec3d> point;           ///< at rest [m]; absent: the nodes of `where`
  RegionSpec where;                     ///< which nodes of `body`; not beside a point
  std::string body;                     ///< its name; empty: the only one; not beside a point
  std::vector<std::string> quantities;  ///< ProbeValue::quantity, in the order wanted; empty: position, displacement, velocity
};

}  // namespace pliant
