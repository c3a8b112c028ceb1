#include "model/contact/given_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/orient.h"
#include "geometry/vec.h"
#include "model/contact/registration.h"
#include "model/contact/tool_sequence.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Coarser than the grid of a sequence, since it is filled while the scene runs.
constexpr GridDetail kDetail{32, 131072};
/// Room for a surface to grow within its grid, as a fraction of its longest side, on every side.
constexpr double kRoom = 0.125;
/// A surface whose longest side is shorter than this fraction of its grid's gets a finer grid.
constexpr double kSmall = 0.4;

[[noreturn]] void refuse(const std::string& tool, const std::string& what) {
  throw Error(ErrorCode::bad_input, fmt::format("tool \"{}\": the surface {}, expected a closed surface", tool, what));
}

vec::Box box_of(const TriangleMesh& mesh) {
  vec::Box box;
  for (const Vec3d& v : mesh.vertices) box.extend(v);
  return box;
}

double longest_side(const vec::Box& box) {
  return std::max({box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
}

/// Whether as many triangles run along every edge one way as the other way.
bool is_balanced(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> forward, backward;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint32_t>(t[k]), b = static_cast<std::uint32_t>(t[(k + 1) % 3]);
      auto& list = a < b ? forward : backward;
      list.push_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b));
    }
  }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return forward == backward;
}

void check_numbers(const std::string& tool, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) refuse(tool, "has no triangles");
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  for (const Vec3d& v : mesh.vertices) {
    if (!vec::finite(v)) refuse(tool, fmt::format("has a vertex [{}, {}, {}]", v[0], v[1], v[2]));
  }
  for (const auto& t : mesh.triangles) {
    for (const std::int32_t v : t) {
      if (v < 0 || v >= count) refuse(tool, fmt::format("has a triangle with vertex {} of {}", v, count));
    }
  }
}

/// Turns a closed surface outward.
void close_outward(const std::string& tool, TriangleMesh& mesh) {
  if (is_balanced(mesh)) {
    if (signed_volume(mesh) < 0) {
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    }
  } else if (const OrientationReport report = orient_outward(mesh); !report.closed()) {
    refuse(tool, fmt::format("has {} open edges", report.rim.size()));
  }
  const double longest = longest_side(box_of(mesh));
  if (!(signed_volume(mesh) > 1e-9 * longest * longest * longest)) refuse(tool, "encloses no volume");
}

/// A grid around a box with room on every side.
NodeGrid grid_around(vec::Box box, double thickness) {
  const double room = kRoom * longest_side(box);
  for (std::size_t a = 0; a < 3; ++a) {
    box.lower[a] -= room;
    box.upper[a] += room;
  }
  return lay_grid(box, thickness, kDetail);
}

/// Whether a box leaves the margin of the grid free, beyond which distances are not stored.
bool is_within(const vec::Box& box, const NodeGrid& grid) {
  for (std::size_t a = 0; a < 3; ++a) {
    const double beyond = kToolGridBeyond * grid.spacing, upper = grid.origin[a] + (grid.size[a] - 1) * grid.spacing;
    if (box.lower[a] < grid.origin[a] + beyond || box.upper[a] > upper - beyond) return false;
  }
  return true;
}

double longest_side(const NodeGrid& grid) { return grid.spacing * *std::max_element(grid.size.begin(), grid.size.end()); }

void fill(const NodeGrid& grid, GivenSurface& given) {
  given.distance =
      std::make_shared<const std::vector<double>>(with_right_means(band_distances(given.surface, grid), grid.size));
}

/// Finds a surface by the distances on its grid and their gradient; nothing beyond the grid.
FindSurface by_grid(const NodeGrid& grid, const std::vector<double>& distance) {
  return [&grid, &distance](const Vec3d& x) -> std::optional<NearSurface> {
    const GridSample sample = interpolate(grid, distance.data(), x);
    const double length = vec::norm(sample.slope);
    if (sample.beyond != Vec3d{} || !(length > 0)) return {};
    return NearSurface{vec::mul(sample.slope, 1 / length), sample.value, sample.value};
  };
}

}  // namespace

GivenSurfaces first_surface(const ContactTool& tool) {
  const SurfaceDistance outward(read_tool_mesh(tool, tool.mesh));
  check_closed(tool, tool.mesh, outward);
  GivenSurfaces first{grid_around(box_of(outward.mesh()), mesh_thickness(outward.mesh())),
                      {{0, 0, {}, outward.mesh(), nullptr}}};
  fill(first.grid, first.surfaces.front());
  return first;
}

GivenSurfaces next_surface(const std::string& tool, TriangleMesh mesh, double time, GivenSurfaces before) {
  check_numbers(tool, mesh);
  close_outward(tool, mesh);
  GivenSurface& last = before.surfaces.back();
  if (!(time > last.time) || !std::isfinite(time)) {
    throw Error(ErrorCode::usage, fmt::format("tool \"{}\": a surface for {} s after one for {} s, expected times that rise",
                                              tool, time, last.time));
  }
  if (last.distance == nullptr) fill(before.grid, last);
  const vec::Box box_before = box_of(last.surface);
  const double radius = 0.5 * vec::norm(vec::sub(box_before.upper, box_before.lower));
  constexpr RegistrationEffort kEffort{500, 10};
  GivenSurface next{time, 0, registration_guess(mesh, last.surface, last.pose), {}, nullptr};
  next.pose = registered(mesh, by_grid(before.grid, *last.distance), centroid(last.surface), radius, next.pose, kEffort);
  for (Vec3d& v : mesh.vertices) v = place_back(next.pose, v);
  vec::Box box = box_of(mesh);
  next.surface = std::move(mesh);
  if (before.surfaces.size() == most_given_surfaces) before.surfaces.erase(before.surfaces.begin());
  if (!is_within(box, before.grid) || longest_side(box) < kSmall * longest_side(before.grid)) {
    double thickness = mesh_thickness(next.surface);
    for (GivenSurface& one : before.surfaces) {
      box.extend(box_of(one.surface));
      thickness = std::min(thickness, mesh_thickness(one.surface));
      one.distance = nullptr;
    }
    before.grid = grid_around(box, thickness);
  }
  fill(before.grid, next);
  before.surfaces.push_back(std::move(next));
  return before;
}

void append_surface(const std::string& tool, GivenSurfaces& all, const GivenSurfaces& next, double now) {
  std::vector<GivenSurface>& list = all.surfaces;
  if (list.size() == most_given_surfaces) {
    if (list[1].time > now) {
      throw Error(ErrorCode::usage,
                  fmt::format("tool \"{}\": {} surfaces are still to come at {} s, expected at most {} at a time", tool,
                              list.size() - 1, now, most_given_surfaces - 1));
    }
    list.erase(list.begin());
  }
  GivenSurface added = next.surfaces.back();
  const double span = added.time - next.surfaces[next.surfaces.size() - 2].time;
  added.begin = std::max(list.back().time, now);
  if (!(added.time > added.begin)) added.time = added.begin + span;
  if (!(next.grid == all.grid)) {
    all.grid = next.grid;
    for (GivenSurface& surface : list) surface.distance = nullptr;
  }
  list.push_back(std::move(added));
}

ToolForm tool_form(const ContactTool& tool, GivenSurfaces& given) {
  ToolForm form;
  form.shape = ToolShape::mesh;
  form.grid = given.grid;
  for (std::size_t i = 0; i < most_given_surfaces; ++i) {  // always as many, so that buffers keep their sizes
    GivenSurface& one = given.surfaces[std::min(i, given.surfaces.size() - 1)];
    if (one.distance == nullptr) fill(given.grid, one);
    form.times.push_back({one.begin, one.time});
    form.frames.push_back({one.pose, one.surface});
    form.distance.insert(form.distance.end(), one.distance->begin(), one.distance->end());
    for (const Vec3d& v : one.surface.vertices) form.reach = std::max(form.reach, vec::norm(place(one.pose, v)));
  }
  form.edges = tool.edges;
  form.grips = tool.grip.has_value();
  return form;
}

void check_given(const std::string& tool, const GivenSurfaces& given) {
  const auto damaged = [&](const char* what) {
    throw Error(ErrorCode::bad_input, fmt::format("the surfaces of tool \"{}\" are damaged: {}", tool, what));
  };
  if (given.surfaces.empty() || given.surfaces.size() > most_given_surfaces) damaged("their number");
  double nodes = 1;
  for (const std::int32_t n : given.grid.size) nodes *= n >= 2 ? n : 1e30;
  if (!(nodes <= kDetail.most_nodes) || !(given.grid.spacing > 0) || !std::isfinite(given.grid.spacing) ||
      !vec::finite(given.grid.origin)) {
    damaged("their grid");
  }
  for (std::size_t i = 0; i < given.surfaces.size(); ++i) {
    const GivenSurface& one = given.surfaces[i];
    if (!good_pose(one.pose) || !std::isfinite(one.time) ||
        (i > 0 && !(one.begin >= given.surfaces[i - 1].time && one.time > one.begin)))
      damaged("their motion");
    check_numbers(tool, one.surface);
    if (!is_within(box_of(one.surface), given.grid)) damaged("one lies outside their grid");
  }
}

}  // namespace pliant
