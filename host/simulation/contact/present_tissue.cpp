#include "simulation/contact/present_tissue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "simulation/contact/tool_samples.h"

namespace pliant {
namespace {

constexpr double kStride = 0.5;  ///< distance between checks along a path, in cells
constexpr std::size_t kMostLooks = 4096;
constexpr std::size_t kSamplesOnTheWay = 16;

double angle_between(const Pose& a, const Pose& b) {
  double cosine = 0;
  for (std::size_t i = 0; i < 4; ++i) cosine += a.turn[i] * b.turn[i];
  return 2 * std::acos(std::min(1.0, std::abs(cosine)));
}

/// Upper bound of the distance that any point of a tool travels [m].
double travel(const ToolForm& form, const Pose& from, const Pose& to) {
  return vec::norm(vec::sub(to.position, from.position)) + angle_between(from, to) * form.reach;
}

}  // namespace

bool is_too_fast(const ToolForm& form, const Pose& from, const Pose& to, double seconds, double cell) {
  return travel(form, from, to) > tool_cells_per_second * cell * seconds;
}

double share_in_time(const ToolForm& form, const Pose& from, const Pose& to, double seconds, double cell) {
  const double way = travel(form, from, to), most = tool_cells_per_second * cell * seconds;
  return way > most ? most / way : 1;
}

PresentTissue::PresentTissue(const Model& model, std::vector<double> u) : model_(model), u_(std::move(u)) {
  const ContactPoints& points = *model_.contact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<double, 8> weights{};
    for (std::size_t a = 0; a < 8; ++a) weights[a] = double(points.weights[i][a]) / contact_weight_unit;
    points_.push_back(placed(points.rest[i], points.nodes[i].data(), weights.data()));
    box_.extend(points_.back());
  }
}

Vec3d PresentTissue::placed(const Vec3d& rest, const std::int32_t* nodes, const double* weights) const {
  Vec3d x = rest;
  for (std::size_t a = 0; a < 8; ++a) {
    if (weights[a] == 0) continue;
    const double* moved = &u_[4 * static_cast<std::size_t>(nodes[a])];
    for (std::size_t c = 0; c < 3; ++c) x[c] += weights[a] * moved[c];
  }
  return x;
}

/// Created on first use: not needed if a contact point already shows the overlap.
const SurfaceDistance* PresentTissue::surface() const {
  const ModelSurface& s = model_.surface;
  if (surface_ == nullptr && !s.triangles.empty()) {
    TriangleMesh mesh;
    mesh.triangles = s.triangles;
    for (std::size_t v = 0; v < s.rest.size(); ++v)
      mesh.vertices.push_back(placed(s.rest[v], s.nodes[v].data(), s.weights[v].data()));
    surface_ = std::make_unique<SurfaceDistance>(std::move(mesh));
  }
  return surface_.get();
}

/// The deepest contact point in a tool.
ToolOverlap PresentTissue::overlap_of_points(const ToolForm& form, const Pose& pose, double time) const {
  const ToolMoment moment = tool_moment(form, time);
  const Pose at = compose(pose, moment.pose);
  ToolOverlap most;
  if (form.shape != ToolShape::half_space && box_.distance2(pose.position) > form.reach * form.reach) return most;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double depth = -tool_distance(form, place_back(at, points_[i]), moment);
    if (depth > most.depth) most = {depth, model_.contact->body[i], points_[i]};
  }
  return most;
}

ToolOverlap PresentTissue::overlap(const ToolForm& form, const Pose& pose, double time, std::size_t samples) const {
  if (form.shape != ToolShape::half_space && box_.distance2(pose.position) > form.reach * form.reach) return {};
  ToolOverlap most = overlap_of_points(form, pose, time);
  const ToolMoment moment = tool_moment(form, time);
  const Pose at = compose(pose, moment.pose);
  for (const Vec3d& y : tool_samples(form, moment, samples)) {
    const Vec3d x = place(at, y);
    if (box_.distance2(x) > 0 || surface() == nullptr || !surface()->inside(x)) continue;
    const ClosestPoint near = surface()->closest(x);
    if (near.distance > most.depth)
      most = {near.distance, model_.surface.triangle_body[static_cast<std::size_t>(near.triangle)], x};
  }
  return most;
}

ToolOverlap PresentTissue::in_the_way(const ToolForm& form, const Pose& from, const Pose& to, double time) const {
  const double cell = model_.contact->spacing;
  double first = 0, last = 1;  // part of the path where the sphere around the tool can intersect the box around the tissue
  for (std::size_t c = 0; c < 3 && form.shape != ToolShape::half_space; ++c) {
    const double d = to.position[c] - from.position[c];
    const double lower = box_.lower[c] - form.reach - from.position[c], upper = box_.upper[c] + form.reach - from.position[c];
    if (d == 0 && (lower > 0 || upper < 0)) return {};
    if (d == 0) continue;
    first = std::max(first, std::min(lower / d, upper / d));
    last = std::min(last, std::max(lower / d, upper / d));
  }
  if (first > last) return {};
  const double allowed = std::max(tool_start_depth * cell, overlap(form, from, time, kSamplesOnTheWay).depth);
  const double looks = std::ceil((last - first) * travel(form, from, to) / (kStride * cell));
  const auto count = static_cast<std::size_t>(std::clamp(looks, 1.0, static_cast<double>(kMostLooks)));
  const auto look = [&](const auto& overlap_at) {
    for (std::size_t i = 0; i <= count; ++i) {
      const double s = first + (last - first) * static_cast<double>(i) / static_cast<double>(count);
      const ToolOverlap found = overlap_at(between(from, to, s));
      if (found.depth > allowed) return found;
    }
    return ToolOverlap{};
  };
  // Points of the tissue first: points of the tool need the surface, which takes far longer to make than to look at.
  const ToolOverlap found = look([&](const Pose& at) { return overlap_of_points(form, at, time); });
  return found.depth > 0 ? found : look([&](const Pose& at) { return overlap(form, at, time, kSamplesOnTheWay); });
}

void PresentTissue::refuse_inside(const std::string& name, const ToolForm& form, const Pose& pose, double time) const {
  const double allowed = tool_start_depth * model_.contact->spacing;
  const ToolOverlap found = overlap(form, pose, time);
  if (found.depth <= allowed) return;
  throw Error(ErrorCode::bad_input,
              fmt::format("tool '{}' begins inside body '{}', {:.3g} m deep at [{:.4g}, {:.4g}, {:.4g}]; expected at most "
                          "{:.3g} m (a quarter of a cell), which contact pushes out",
                          name, model_.bodies[static_cast<std::size_t>(found.body)].name, found.depth, found.where[0],
                          found.where[1], found.where[2], allowed));
}

void PresentTissue::refuse_in_the_way(const std::string& name, const ToolForm& form, const Pose& from, const Pose& to,
                                      double time, double seconds) const {
  const double cells = travel(form, from, to) / model_.contact->spacing;
  const ToolOverlap found = in_the_way(form, from, to, time);
  if (found.depth == 0) return;
  throw Error(
      ErrorCode::bad_input,
      fmt::format(
          "tool '{}' is driven {:.3g} cells in {:.3g} s, and body '{}' is in its way ({:.3g} m deep at [{:.4g}, {:.4g}, "
          "{:.4g}]); expected at most {:g} cells per second where tissue is, which takes {:.3g} s, or a way that is free",
          name, cells, seconds, model_.bodies[static_cast<std::size_t>(found.body)].name, found.depth, found.where[0],
          found.where[1], found.where[2], tool_cells_per_second, cells / tool_cells_per_second));
}

}  // namespace pliant
