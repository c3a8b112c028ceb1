// Contact data: points on the surfaces of the bodies, and the shapes of the tools.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/node_grid.h"
#include "scene/contact_tool.h"

namespace pliant {

struct Model;
struct Scene;

/// Embedding weights of contact points are multiples of 1 / contact_weight_unit with sum exactly one, so that fixed-point
/// forces are distributed to the nodes without remainder.
inline constexpr std::int32_t contact_weight_unit = 4096;

/// A plane that bounds a surface patch; without a normal it bounds nothing.
struct PatchSide {
  Vec3d normal{};        ///< outward, unit length
  double distance = 0;   ///< from the contact point [m]
  bool goes_on = false;  ///< whether the surface continues beyond it in the same direction
};

/// Contact points on the surface, about half a cell apart (three per face of a volume mesh), independent of its triangle
/// size.
struct ContactPoints {
  std::vector<Vec3d> rest;                           ///< [m]
  std::vector<std::array<std::int32_t, 8>> nodes;    ///< slots; unused entries repeat a node that has a weight, with weight 0
  std::vector<std::array<std::int32_t, 8>> weights;  ///< in units of 1 / contact_weight_unit, non-negative
  std::vector<double> area;                          ///< undeformed area of the surface that the point represents [m^2]
  std::vector<std::int32_t> body;
  std::vector<Vec3d> normal;  ///< undeformed outward unit normal
  std::vector<std::array<PatchSide, 6>>
      sides;                  ///< bounds of the surface that the point represents; empty unless a tool has edges
  std::vector<double> apart;  ///< distance between the points around it [m]
  std::vector<char> joined;   ///< whether most of it hangs on nodes of the other side of a cut; empty as `sides`
  double spacing = 0;         ///< of the coarsest body: cell size, or mean edge of its surface [m]
  /// Extent of the surface patch around a point, large enough that patches leave no gap [m].
  [[nodiscard]] double reach(std::size_t i) const;
  [[nodiscard]] std::size_t size() const { return rest.size(); }
};

/// A mesh of a sequence. Its own frame follows the rigid motion of the sequence (tool_sequence.cpp).
struct ToolFrame {
  Pose pose;             ///< of its own frame in the tool's frame
  TriangleMesh surface;  ///< in its own frame
};

/// A tool shape as the kernels use it (kernels/contact/contact_shape.cl).
struct ToolForm {
  ToolShape shape = ToolShape::sphere;
  double radius = 0;                         ///< [m]
  Vec3d first{}, second{};                   ///< [m]; half space: `second` is the unit normal; box, face of a blade:
                                             ///< `second` is half its size; face: `first` is its side and slopes (FaceSlopes)
  NodeGrid grid;                             ///< of a mesh, in its own frame
  std::vector<double> distance;              ///< [nodes] signed distances at its nodes [m]
  bool grips = false;                        ///< it may hold tissue (ContactTool::grip)
  bool edges = false;                        ///< use contact along edges where the tool is thin (ContactTool::edges)
  double thickness = 1e30;                   ///< mesh: twice its volume over its area [m]
  double reach = 0;                          ///< largest distance of a point from the tool's origin [m]; half space: 0
  TriangleMesh surface;                      ///< mesh only, for pictures
  double frames_per_second = 0;              ///< sequence only
  std::vector<std::array<double, 2>> times;  ///< given surfaces: when the shape begins to become a frame, and has it [s]
  std::vector<ToolFrame> frames;             ///< of a sequence or given; `distance` is [frames][nodes]
};

/// State of a shape at a time: its pose in the tool's frame; a shape with frames interpolates `frame` and the next one, which
/// has the weight `share`.
struct ToolMoment {
  Pose pose;
  std::int32_t frame = 0;
  double share = 0;
};
ToolMoment tool_moment(const ToolForm& form, double time);

using ToolForms = std::vector<ToolForm>;

/// Contact law of a tool (ContactTool).
struct ContactLaw {
  double stiffness = 0, exponent = 1, alpha = 0, friction = 0;
  double core = 0;  ///< depth beyond which contact is rigid [m]
};

/// Builds the form of a tool. Throws Error (bad_input) for a mesh that cannot be read or is not closed.
ToolForm tool_form(const ContactTool& tool);

/// A point on an edge of a tool, in the tool's frame, treated as a ball (kernels/contact/contact_edge.cl).
struct EdgePoint {
  Vec3d place{};      ///< [m]
  double radius = 0;  ///< [m]
};

/// Returns points along the edges of a tool with ContactTool::edges, as far apart as contact points; none if the tool is
/// thick enough for contact points.
std::vector<EdgePoint> edge_points(const ToolForm& form, const ContactPoints& points);

/// Signed distance of a point in the tool's frame (for a sequence in the frame's own), as in the kernels but in double [m].
double tool_distance(const ToolForm& form, const Vec3d& y, const ToolMoment& moment = {});

/// Returns the contact points of all bodies; `patches`: with their sides, which tools with edges need.
ContactPoints contact_points(const Model& model, bool patches);

/// Returns the contact points of a model whose bodies are those of `before`, in other slots.
std::shared_ptr<const ContactPoints> contact_of_same_bodies(const Model& before, const Model& now);

/// Tangents of a contact point. Deformed, they are F t1 = t1 + sum_a first_a u_a and F t2 likewise; t1, t2 and the undeformed
/// normal are orthonormal.
struct ContactTangents {
  Vec3d t1{}, t2{};
  std::array<std::array<std::int32_t, 8>, 2> units{};  ///< in units of 1 / (contact_weight_unit * spacing); their sum is zero
  std::array<double, 8> first{}, second{};             ///< the same [1/m]
};
ContactTangents contact_tangents(const ContactPoints& points, std::size_t point, const std::vector<Vec3d>& rest);

/// Returns the surface patch of a point, PLIANT_PATCH numbers (kernels/contact/contact_patch.cl).
/// `joined`: nothing parts the cut that it lies on.
std::vector<double> contact_patch(const ContactPoints& points, std::size_t point, const std::vector<Vec3d>& rest, bool joined);

/// Fills Model::contact and, if unset, Model::tools. Does nothing if the scene has no contact.
void add_contact(const Scene& scene, Model& model);

}  // namespace pliant
