#include "model/contact/registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/vec.h"

namespace pliant {
namespace {

/// A motion whose mean square displacement along the points' normals is below this fraction of the whole is undetermined: the
/// facets of a sphere do not determine its rotation.
constexpr double kFree = 2e-3;

struct Sample {
  Vec3d place{};
  double area = 0;
};

/// Centroids of some triangles, with the areas that they represent.
std::vector<Sample> samples(const TriangleMesh& mesh, std::size_t points) {
  std::vector<Sample> out;
  const std::size_t stride = mesh.triangles.size() / points + 1;
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

Fit fit_of(const std::vector<Sample>& points, const FindSurface& find, const Pose& pose, const Vec3d& centre) {
  Fit fit;
  for (const Sample& s : points) {
    const Vec3d x = place_back(pose, s.place);
    if (const auto near = find(x)) fit.add(vec::sub(x, centre), near->normal, near->gap, near->distance, s.area);
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

Pose registered(const TriangleMesh& mesh, const FindSurface& find, const Vec3d& centre, double radius, const Pose& guess,
                const RegistrationEffort& effort) {
  const std::vector<Sample> points = samples(mesh, effort.points);
  Pose pose = guess, best = guess;
  double least = HUGE_VAL;
  for (int i = 0; i < effort.iterations; ++i) {
    const Fit fit = fit_of(points, find, pose, centre);
    if (!(fit.area > 0)) break;
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

Pose registered(const TriangleMesh& mesh, const SurfaceDistance& surface, const Pose& guess) {
  const Vec3d centre = centroid(surface.mesh());
  double radius = 0;
  for (const Vec3d& v : surface.mesh().vertices) radius = std::max(radius, vec::norm(vec::sub(v, centre)));
  const auto find = [&](const Vec3d& x) -> std::optional<NearSurface> {
    const ClosestPoint near = surface.closest(x);
    const auto& corner = surface.mesh().triangles[static_cast<std::size_t>(near.triangle)];
    const Vec3d a = surface.mesh().vertices[static_cast<std::size_t>(corner[0])],
                b = surface.mesh().vertices[static_cast<std::size_t>(corner[1])],
                c = surface.mesh().vertices[static_cast<std::size_t>(corner[2])];
    const Vec3d across = vec::cross(vec::sub(b, a), vec::sub(c, a));
    const double size = vec::norm(across);
    if (!(size > 0)) return {};
    const Vec3d normal = vec::mul(across, 1 / size);
    return NearSurface{normal, vec::dot(vec::sub(x, near.point), normal), near.distance};
  };
  return registered(mesh, find, centre, radius, guess);
}

Pose registration_guess(const TriangleMesh& mesh, const TriangleMesh& before, const Pose& pose_before) {
  Pose guess;
  guess.position = centroid(mesh);
  guess.turn = pose_before.turn;
  guess.position = vec::sub(guess.position, place({{}, guess.turn}, centroid(before)));
  return guess;
}

}  // namespace pliant
