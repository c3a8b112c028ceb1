#include "model/contact/tool_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>

#include "geometry/band_distance.h"
#include "geometry/parallel.h"
#include "mesh_io/mesh_io.h"
#include "model/contact/registration.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Maximum number of values of all grids of a sequence: 600 MB on the device.
constexpr std::int64_t kMostValues = 150'000'000;

/// "frame10" comes after "frame9": runs of digits are compared as numbers.
bool before_by_name(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    while (i < a.size() && a[i] == '0') ++i;
    while (j < b.size() && b[j] == '0') ++j;
    std::size_t m = i, n = j;
    while (m < a.size() && digit(a[m])) ++m;
    while (n < b.size() && digit(b[n])) ++n;
    if (m - i != n - j) return m - i < n - j;
    const int order = a.compare(i, m - i, b, j, n - j);
    if (order != 0) return order < 0;
    i = m, j = n;
  }
  return a.size() - i < b.size() - j || (a.size() - i == b.size() - j && a < b);
}

std::vector<std::filesystem::path> mesh_files(const ContactTool& tool) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(tool.mesh, error)) {
    std::string kind = entry.path().extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (entry.is_regular_file(error) && (kind == ".obj" || kind == ".ply" || kind == ".stl" || kind == ".off"))
      files.push_back(entry.path());
  }
  if (files.empty()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: tool '{}': the folder {} {}, expected a folder with a closed surface per "
                            "frame (.obj, .ply, .stl or .off)",
                            tool.pointer, tool.name, tool.mesh.string(),
                            std::filesystem::is_directory(tool.mesh, error) ? "has no surface" : "cannot be read"));
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return before_by_name(a.filename().string(), b.filename().string()); });
  return files;
}

}  // namespace

TriangleMesh read_tool_mesh(const ContactTool& tool, const std::filesystem::path& file) {
  TriangleMesh mesh = read_surface(file);
  for (Vec3d& v : mesh.vertices) v = vec::mul(v, tool.scale);
  return mesh;
}

void check_closed(const ContactTool& tool, const std::filesystem::path& file, const SurfaceDistance& surface) {
  if (surface.orientation().closed()) return;
  throw Error(ErrorCode::bad_input, fmt::format("{}: tool '{}': the surface {} has {} open edges, expected a closed surface",
                                                tool.pointer, tool.name, file.string(), surface.orientation().rim.size()));
}

NodeGrid lay_grid(const vec::Box& box, double thickness, const GridDetail& detail) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, box.upper[a] - box.lower[a]);
  const auto along = [&](std::size_t a, double spacing) {
    return std::ceil((box.upper[a] - box.lower[a]) / spacing) + 2 * kToolGridBeyond + 1;
  };
  NodeGrid grid;
  grid.spacing = std::min(longest / detail.cells, thickness / 2);
  while (along(0, grid.spacing) * along(1, grid.spacing) * along(2, grid.spacing) > detail.most_nodes) grid.spacing *= 1.1;
  for (std::size_t a = 0; a < 3; ++a) {
    grid.origin[a] = box.lower[a] - kToolGridBeyond * grid.spacing;
    grid.size[a] = static_cast<std::int32_t>(along(a, grid.spacing));
  }
  return grid;
}

void append_distances(const SurfaceDistance& surface, ToolForm& form) {
  const std::int64_t row = form.grid.size[0], rows = std::int64_t{form.grid.size[1]} * form.grid.size[2];
  std::vector<double> exact(static_cast<std::size_t>(row * rows));
  parallel_for(rows, [&](std::int64_t r) {
    const Vec3d start{form.grid.origin[0], form.grid.origin[1] + static_cast<double>(r % form.grid.size[1]) * form.grid.spacing,
                      form.grid.origin[2] + static_cast<double>(r / form.grid.size[1]) * form.grid.spacing};
    double before = form.grid.spacing, sign = 1;  // the row starts outside
    for (std::int64_t i = 0; i < row; ++i) {
      const Vec3d x{start[0] + static_cast<double>(i) * form.grid.spacing, start[1], start[2]};
      const double distance = surface.closest(x).distance;
      // The surface is crossed between two nodes only if it is nearer to both than they are to each other.
      if (before <= form.grid.spacing && distance <= form.grid.spacing) sign = surface.inside(x) ? -1 : 1;
      before = distance;
      exact[static_cast<std::size_t>(r * row + i)] = sign * distance;
    }
  });
  const std::vector<double> mean = with_right_means(exact, form.grid.size);
  form.distance.insert(form.distance.end(), mean.begin(), mean.end());
}

void load_sequence(const ContactTool& tool, ToolForm& form) {
  form.frames_per_second = tool.frames_per_second;
  vec::Box box;
  std::vector<std::unique_ptr<SurfaceDistance>> surfaces;
  for (const std::filesystem::path& file : mesh_files(tool)) {
    TriangleMesh mesh = read_tool_mesh(tool, file);
    {
      const SurfaceDistance outward(mesh);
      check_closed(tool, file, outward);
      mesh = outward.mesh();
    }
    Pose pose;
    if (surfaces.empty()) {
      pose.position = centroid(mesh);
    } else {
      pose = registration_guess(mesh, form.frames.back().surface, form.frames.back().pose);
      pose = registered(mesh, *surfaces.back(), pose);
    }
    for (Vec3d& v : mesh.vertices) {
      form.reach = std::max(form.reach, vec::norm(v));
      v = place_back(pose, v);
      box.extend(v);
    }
    surfaces.push_back(std::make_unique<SurfaceDistance>(mesh));
    form.frames.push_back({pose, surfaces.back()->mesh()});
  }
  form.grid = lay_grid(box, 1e30);
  const std::int64_t nodes = form.grid.nodes();
  const auto frames = static_cast<std::int64_t>(surfaces.size());
  if (nodes * frames > kMostValues) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: tool '{}': the folder {} has {} surfaces, expected at most {} of this size", tool.pointer,
                            tool.name, tool.mesh.string(), frames, kMostValues / nodes));
  }
  form.distance.reserve(static_cast<std::size_t>(nodes * frames));
  for (const auto& surface : surfaces) append_distances(*surface, form);
}

ToolMoment tool_moment(const ToolForm& form, double time) {
  ToolMoment now;
  if (form.frames.empty()) return now;
  if (form.times.empty()) {
    const auto last = static_cast<double>(form.frames.size() - 1);
    const double at = std::clamp(time * form.frames_per_second, 0.0, last);
    now.frame = static_cast<std::int32_t>(at);
    now.share = at - now.frame;
  } else {
    const auto next = std::find_if(form.times.begin() + 1, form.times.end(), [&](const auto& t) { return time < t[1]; });
    now.frame = static_cast<std::int32_t>(next - form.times.begin() - 1);
    if (next != form.times.end()) now.share = std::max(0.0, (time - (*next)[0]) / ((*next)[1] - (*next)[0]));
  }
  const auto f = static_cast<std::size_t>(now.frame);
  now.pose = now.share > 0 ? between(form.frames[f].pose, form.frames[f + 1].pose, now.share) : form.frames[f].pose;
  return now;
}

}  // namespace pliant
