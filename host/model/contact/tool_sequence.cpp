#include "model/contact/tool_sequence.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>

#include "geometry/parallel.h"
#include "mesh_io/mesh_io.h"
#include "pliant/error.h"

namespace pliant {
namespace {

/// Number of grid cells along the longest side of a mesh.
constexpr double kGridCells = 64;
/// Maximum number of grid nodes of one mesh, however thin its parts are.
constexpr double kMostNodes = 4194304;
/// Maximum number of values of all grids of a sequence: 600 MB on the device.
constexpr std::int64_t kMostValues = 150'000'000;
/// Number of points of a mesh used in its registration, and of iterations.
constexpr std::size_t kPoints = 2000;
constexpr int kIterations = 30;
/// A motion whose mean square displacement along the points' normals is below this fraction of the whole is undetermined: the
/// facets of a sphere do not determine its rotation.
constexpr double kFree = 2e-3;

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

/// Centroid of the volume inside a closed surface.
Vec3d centroid(const TriangleMesh& mesh) {
  Vec3d sum{};
  double volume = 0;
  const Vec3d o = mesh.vertices.front();
  for (const auto& t : mesh.triangles) {
    const Vec3d a = vec::sub(mesh.vertices[static_cast<std::size_t>(t[0])], o),
                b = vec::sub(mesh.vertices[static_cast<std::size_t>(t[1])], o),
                c = vec::sub(mesh.vertices[static_cast<std::size_t>(t[2])], o);
    const double v = vec::dot(a, vec::cross(b, c)) / 6;
    volume += v;
    sum = vec::add(sum, vec::mul(vec::add(vec::add(a, b), c), v / 4));
  }
  return volume > 0 ? vec::add(o, vec::mul(sum, 1 / volume)) : o;
}

struct Sample {
  Vec3d place{};
  double area = 0;
};

/// Centroids of some triangles, with the areas that they represent.
std::vector<Sample> samples(const TriangleMesh& mesh) {
  std::vector<Sample> out;
  const std::size_t stride = mesh.triangles.size() / kPoints + 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const auto& corner = mesh.triangles[t];
    const Vec3d a = mesh.vertices[static_cast<std::size_t>(corner[0])], b = mesh.vertices[static_cast<std::size_t>(corner[1])],
                c = mesh.vertices[static_cast<std::size_t>(corner[2])];
    const double area = 0.5 * vec::norm(vec::cross(vec::sub(b, a), vec::sub(c, a)));
    if (area > 0) out.push_back({vec::mul(vec::add(vec::add(a, b), c), 1.0 / 3), area});
  }
  return out;
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Normal equations of a small motion (rotation about `centre`, translation) that moves points onto their nearest planes.
struct Fit {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  double area = 0, squares = 0;

  void add(const Vec3d& arm, const Vec3d& normal, double gap, double distance, double of_area) {
    const Vec3d turn = vec::cross(arm, normal);
    Vector6 row;
    row << turn[0], turn[1], turn[2], normal[0], normal[1], normal[2];
    matrix += of_area * row * row.transpose();
    right -= of_area * gap * row;
    area += of_area;
    squares += of_area * distance * distance;
  }
  /// Gauss-Newton step in the determined motions; rotations are scaled with `radius`.
  [[nodiscard]] Vector6 motion(double radius) const {
    Vector6 scale;
    scale << 1 / radius, 1 / radius, 1 / radius, 1, 1, 1;
    const Eigen::SelfAdjointEigenSolver<Matrix6> modes(scale.asDiagonal() * (matrix / area) * scale.asDiagonal());
    const Vector6 pull = modes.eigenvectors().transpose() * (scale.asDiagonal() * (right / area));
    Vector6 along = Vector6::Zero();
    for (int i = 0; i < 6; ++i) {
      if (modes.eigenvalues()[i] > kFree) along[i] = pull[i] / modes.eigenvalues()[i];
    }
    return scale.asDiagonal() * (modes.eigenvectors() * along);
  }
};

Fit fit_of(const std::vector<Sample>& points, const SurfaceDistance& surface, const Pose& pose, const Vec3d& centre) {
  Fit fit;
  for (const Sample& s : points) {
    const Vec3d x = place_back(pose, s.place);
    const ClosestPoint near = surface.closest(x);
    const auto& corner = surface.mesh().triangles[static_cast<std::size_t>(near.triangle)];
    const Vec3d a = surface.mesh().vertices[static_cast<std::size_t>(corner[0])],
                b = surface.mesh().vertices[static_cast<std::size_t>(corner[1])],
                c = surface.mesh().vertices[static_cast<std::size_t>(corner[2])];
    const Vec3d across = vec::cross(vec::sub(b, a), vec::sub(c, a));
    const double size = vec::norm(across);
    if (!(size > 0)) continue;
    const Vec3d normal = vec::mul(across, 1 / size);
    fit.add(vec::sub(x, centre), normal, vec::dot(vec::sub(x, near.point), normal), near.distance, s.area);
  }
  return fit;
}

/// Converts a small motion of body points, x' = x + turn x (x - centre) + move, to the inverse motion of the frame's pose.
Pose moved_back(const Pose& pose, const Vector6& by, const Vec3d& centre) {
  const Vec3d turn{by[0], by[1], by[2]}, move{by[3], by[4], by[5]};
  const double angle = vec::norm(turn), s = angle > 0 ? std::sin(angle / 2) / angle : 0.5;
  Pose motion{{}, {turn[0] * s, turn[1] * s, turn[2] * s, std::cos(angle / 2)}};
  motion.position = vec::sub(vec::add(centre, move), place(motion, centre));  // x' = R (x - centre) + centre + move
  const Pose inverse{place_back(motion, {}), {-motion.turn[0], -motion.turn[1], -motion.turn[2], motion.turn[3]}};
  return compose(pose, inverse);
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

void lay_grid(const vec::Box& box, double thickness, ToolForm& form) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, box.upper[a] - box.lower[a]);
  const auto nodes = [&](double spacing) {
    double count = 1;
    for (std::size_t a = 0; a < 3; ++a) count *= std::ceil((box.upper[a] - box.lower[a]) / spacing) + 2 * kToolGridBeyond + 1;
    return count;
  };
  form.spacing = std::min(longest / kGridCells, thickness / 2);
  while (nodes(form.spacing) > kMostNodes) form.spacing *= 1.1;
  for (std::size_t a = 0; a < 3; ++a) {
    form.origin[a] = box.lower[a] - kToolGridBeyond * form.spacing;
    form.size[a] = static_cast<std::int32_t>(std::ceil((box.upper[a] - box.lower[a]) / form.spacing)) + 2 * kToolGridBeyond + 1;
  }
}

void append_distances(const SurfaceDistance& surface, ToolForm& form) {
  const std::int64_t row = form.size[0], rows = std::int64_t{form.size[1]} * form.size[2];
  std::vector<double> exact(static_cast<std::size_t>(row * rows));
  parallel_for(rows, [&](std::int64_t r) {
    const Vec3d start{form.origin[0], form.origin[1] + static_cast<double>(r % form.size[1]) * form.spacing,
                      form.origin[2] + static_cast<double>(r / form.size[1]) * form.spacing};
    double before = form.spacing, sign = 1;  // the row starts outside
    for (std::int64_t i = 0; i < row; ++i) {
      const Vec3d x{start[0] + static_cast<double>(i) * form.spacing, start[1], start[2]};
      const double distance = surface.closest(x).distance;
      // The surface is crossed between two nodes only if it is nearer to both than they are to each other.
      if (before <= form.spacing && distance <= form.spacing) sign = surface.inside(x) ? -1 : 1;
      before = distance;
      exact[static_cast<std::size_t>(r * row + i)] = sign * distance;
    }
  });
  // Linear interpolation of a curved function is too high by h^2/12 of its Laplacian on average over a cell, which would make
  // a ball too small. Subtracting this at the nodes corrects the mean.
  const std::array<std::int64_t, 3> step{1, row, row * form.size[1]};
  std::vector<double> mean = exact;
  parallel_for(rows, [&](std::int64_t r) {
    if (r % form.size[1] == 0 || r % form.size[1] == form.size[1] - 1 || r < form.size[1] || r >= rows - form.size[1]) return;
    for (std::int64_t n = r * row + 1; n < (r + 1) * row - 1; ++n) {
      const auto value = [&](std::int64_t at) { return exact[static_cast<std::size_t>(at)]; };
      double around = -6 * value(n);
      for (const std::int64_t s : step) around += value(n - s) + value(n + s);
      mean[static_cast<std::size_t>(n)] -= around / 12;
    }
  });
  form.distance.insert(form.distance.end(), mean.begin(), mean.end());
}

Pose registered(const TriangleMesh& mesh, const SurfaceDistance& surface, const Pose& guess) {
  const std::vector<Sample> points = samples(mesh);
  const Vec3d centre = centroid(surface.mesh());
  double radius = 0;
  for (const Vec3d& v : surface.mesh().vertices) radius = std::max(radius, vec::norm(vec::sub(v, centre)));
  Pose pose = guess, best = guess;
  double least = HUGE_VAL;
  for (int i = 0; i < kIterations; ++i) {
    const Fit fit = fit_of(points, surface, pose, centre);
    if (fit.squares < least) {
      least = fit.squares;
      best = pose;
    }
    const Vector6 motion = fit.motion(radius);
    if (!(motion.head<3>().norm() * radius + motion.tail<3>().norm() > 1e-9 * radius)) break;
    pose = moved_back(pose, motion, centre);
  }
  return best;
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
    pose.position = centroid(mesh);
    if (!surfaces.empty()) {
      pose.turn = form.frames.back().pose.turn;
      // Move this frame's centroid to the position of the previous one in its own frame.
      const Vec3d last = centroid(form.frames.back().surface);
      pose.position = vec::sub(pose.position, place({{}, pose.turn}, last));
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
  lay_grid(box, 1e30, form);
  const std::int64_t nodes = std::int64_t{form.size[0]} * form.size[1] * form.size[2];
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
  const auto last = static_cast<double>(form.frames.size() - 1);
  const double at = std::clamp(time * form.frames_per_second, 0.0, last);
  now.frame = static_cast<std::int32_t>(at);
  now.share = at - now.frame;
  const auto f = static_cast<std::size_t>(now.frame);
  now.pose = now.share > 0 ? between(form.frames[f].pose, form.frames[f + 1].pose, now.share) : form.frames[f].pose;
  return now;
}

}  // namespace pliant
