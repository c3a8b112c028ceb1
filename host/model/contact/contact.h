// What takes part in contact: points on the surfaces of the bodies, and the shapes of the tools.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "scene/contact_tool.h"

namespace pliant {

struct Model;
struct Scene;

/// Embedding weights of contact points are multiples of 1 / contact_weight_unit that sum to exactly one: forces in fixed point
/// are shared among the nodes without a remainder.
inline constexpr std::int32_t contact_weight_unit = 4096;

/// A plane that bounds a patch of surface; one without a normal bounds nothing.
struct PatchSide {
  Vec3d normal{};        ///< outward, of unit length
  double distance = 0;   ///< from the point [m]
  bool goes_on = false;  ///< whether the surface goes on behind it, the same way
};

/// Points on the surface, about half a cell apart (three per face of a volume mesh), however fine the surface's triangles are.
struct ContactPoints {
  std::vector<Vec3d> rest;                           ///< [m]
  std::vector<std::array<std::int32_t, 8>> nodes;    ///< slots; unused ones repeat one that has a weight, with weight 0
  std::vector<std::array<std::int32_t, 8>> weights;  ///< in units of 1 / contact_weight_unit, not negative
  std::vector<double> area;                          ///< of the surface that it stands for, at rest [m^2]
  std::vector<std::int32_t> body;
  std::vector<Vec3d> normal;  ///< outward, at rest, of unit length
  std::vector<std::array<PatchSide, 6>>
      sides;                  ///< of the part of the surface that it stands for; empty where no tool has edges
  std::vector<double> apart;  ///< how far from each other points around it are [m]
  double spacing = 0;         ///< of the coarsest body's cells, or the mean edge of its surface [m]
  /// How far the patch of surface around a point goes, so that patches leave no gap [m].
  [[nodiscard]] double reach(std::size_t i) const;
  [[nodiscard]] std::size_t size() const { return rest.size(); }
};

/// A mesh of a sequence. Its own frame follows the rigid part of what the sequence does (tool_sequence.cpp).
struct ToolFrame {
  Pose pose;             ///< of its own frame in the tool's
  TriangleMesh surface;  ///< in its own frame
};

/// A shape as the kernels know it (kernels/contact/contact_shape.cl).
struct ToolForm {
  ToolShape shape = ToolShape::sphere;
  double radius = 0;                   ///< [m]
  Vec3d first{}, second{};             ///< [m]; of a half space `second` is the unit normal; of a box `second` is half its size
  Vec3d origin{};                      ///< of the grid of signed distances [m]
  double spacing = 0;                  ///< of this grid [m]
  std::array<std::int32_t, 3> size{};  ///< nodes of this grid
  std::vector<double> distance;        ///< [nodes] signed distance, x fastest [m]
  bool edges = false;                  ///< to be met as edges where it is thin (ContactTool::edges)
  double thickness = 1e30;             ///< of a mesh: twice its volume over its area [m]
  double reach = 0;                    ///< farthest point from the tool's origin [m]; of a half space 0
  TriangleMesh surface;                ///< of a mesh, for pictures
  double frames_per_second = 0;        ///< of a sequence
  std::vector<ToolFrame> frames;       ///< of a sequence; `distance` has [frames][nodes]
};

/// Where a shape stands in its tool's frame at a time: a sequence is mixed of two frames, the second with this share.
struct ToolMoment {
  Pose pose;
  std::int32_t frame = 0;
  double share = 0;
};
ToolMoment tool_moment(const ToolForm& form, double time);

using ToolForms = std::vector<ToolForm>;

/// How a tool pushes (ContactTool).
struct ContactLaw {
  double stiffness = 0, exponent = 1, alpha = 0, friction = 0;
  double core = 0;  ///< depth from which the tool is hard [m]
};

/// Throws Error (bad_input) for a mesh that cannot be read or is not closed.
ToolForm tool_form(const ContactTool& tool);

/// A point on an edge of a tool, in the tool's frame, which is met as a ball (kernels/contact/contact_edge.cl).
struct EdgePoint {
  Vec3d place{};      ///< [m]
  double radius = 0;  ///< [m]
};

/// Points along the edges of a tool with ContactTool::edges, as far apart as points of contact; none of one that is so thick
/// that these feel it.
std::vector<EdgePoint> edge_points(const ToolForm& form, const ContactPoints& points);

/// Signed distance of a point in the tool's frame (of a sequence in its frame's own), as the kernels have it but in double [m].
double tool_distance(const ToolForm& form, const Vec3d& y, const ToolMoment& moment = {});

/// Points of all bodies on the model's surface; `patches`: with their sides, which edges of tools need.
ContactPoints contact_points(const Model& model, bool patches);

/// A contact point's deformed tangents are F t1 = t1 + sum_a first_a u_a and F t2; t1, t2 and the normal at rest are
/// orthonormal.
struct ContactTangents {
  Vec3d t1{}, t2{};
  std::array<std::array<std::int32_t, 8>, 2> units{};  ///< of 1 / (contact_weight_unit * spacing); they sum to zero
  std::array<double, 8> first{}, second{};             ///< the same [1/m]
};
ContactTangents contact_tangents(const ContactPoints& points, std::size_t point, const std::vector<Vec3d>& rest);

/// The patch of surface that a point stands for, PLIANT_PATCH numbers (kernels/contact/contact_edge.cl).
std::vector<double> contact_patch(const ContactPoints& points, std::size_t point, const std::vector<Vec3d>& rest);

/// Fill Model::contact and, if it has none yet, Model::tools. Nothing where nothing touches anything.
void add_contact(const Scene& scene, Model& model);

}  // namespace pliant
