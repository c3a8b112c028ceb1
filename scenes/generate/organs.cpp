#include "scenes/generate/organs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <system_error>

#include "pliant/error.h"
#include "scenes/generate/surface_nets.h"

namespace pliant {
namespace {

// Smooth union (k > 0 rounds the seam over that length) and its relatives, on functions that grow roughly like distances.
double join(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * h * k / 6;
}
double cut(double a, double b, double k) { return -join(-a, b, k); }  // a without b
double common(double a, double b, double k) { return -join(-a, -b, k); }

// About the distance to an ellipsoid: exact on it, first order beside it.
double ellipsoid(const Vec3d& p, const Vec3d& centre, const Vec3d& radii) {
  Vec3d q{}, g{};
  for (int a = 0; a < 3; ++a) {
    q[a] = (p[a] - centre[a]) / radii[a];
    g[a] = q[a] / radii[a];
  }
  const double k0 = vec::norm(q), k1 = vec::norm(g);
  return k1 > 0 ? k0 * (k0 - 1) / k1 : -*std::min_element(radii.begin(), radii.end());
}

double capsule(const Vec3d& p, const Vec3d& a, const Vec3d& b, double ra, double rb) {
  const Vec3d ab = vec::sub(b, a), ap = vec::sub(p, a);
  const double t = std::clamp(vec::dot(ap, ab) / vec::dot(ab, ab), 0.0, 1.0);
  return vec::norm(vec::sub(ap, vec::mul(ab, t))) - (ra + t * (rb - ra));
}

Vec3d turn(const Vec3d& p, int axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Vec3d q = p;
  q[u] = c * p[u] + s * p[v];
  q[v] = -s * p[u] + c * p[v];
  return q;
}

// Metres throughout; shapes are brought to their nominal size afterwards.

double apple(const Vec3d& p) {
  // Broad shoulders above, narrower and faintly five-lobed below, a deep dimple for the stalk and a shallow one for the calyx.
  const double r = std::hypot(p[0], p[2]), angle = std::atan2(p[2], p[0]);
  const double below = std::clamp(-p[1] / 0.036, 0.0, 1.0);
  const double lobes = 1 + 0.05 * below * below * std::cos(5 * angle) * std::min(1.0, r / 0.01);
  const double shoulder = 1 + 3.2 * p[1];
  double d = ellipsoid({p[0] / (shoulder * lobes), p[1], p[2] / (shoulder * lobes)}, {0, 0, 0}, {0.0385, 0.0375, 0.0385});
  d = cut(d, ellipsoid(p, {0, 0.042, 0}, {0.0095, 0.021, 0.0095}), 0.022);
  d = cut(d, ellipsoid(p, {0, -0.041, 0}, {0.008, 0.011, 0.008}), 0.014);
  return d;
}

double liver(const Vec3d& p) {
  // A dome under the diaphragm, thick on the right (-x), flattening towards the left lobe (+x).
  const double taper = 1 - 3.2 * std::clamp(p[0] + 0.03, -0.03, 0.13);
  double d = ellipsoid({p[0], p[1] - 0.12 * p[0], p[2] / taper}, {-0.015, -0.02, 0}, {0.118, 0.088, 0.066});
  d = join(d, ellipsoid(p, {-0.062, -0.045, 0.004}, {0.05, 0.06, 0.052}), 0.04);
  // The lower border climbs from the right to the left; the visceral face behind it is hollow.
  const double border = (0.42 * (p[0] + 0.06) - (p[1] + 0.088)) / std::hypot(1.0, 0.42);
  d = common(d, border, 0.05);
  d = cut(d, ellipsoid(turn(p, 2, 18), {0.03, -0.105, -0.06}, {0.12, 0.085, 0.085}), 0.035);
  // Groove of the vena cava behind, cardiac impression on top, fundus notch and notch of the round ligament in the front edge.
  d = cut(d, capsule(p, {-0.022, 0.09, -0.072}, {-0.022, -0.06, -0.066}, 0.014, 0.014), 0.02);
  d = cut(d, ellipsoid(p, {0.045, 0.083, 0.012}, {0.06, 0.03, 0.05}), 0.04);
  d = cut(d, ellipsoid(turn(p, 2, 20), {0.006, -0.066, 0.02}, {0.008, 0.026, 0.05}), 0.024);
  d = cut(d, ellipsoid(p, {-0.024, -0.086, 0.025}, {0.014, 0.018, 0.05}), 0.02);
  return d;
}

double kidney(const Vec3d& p) {
  // A bean: an ellipsoid bent around the hilum at +x, with the sinus opening into it.
  const double bend = 4.0 * p[1] * p[1];
  const Vec3d q{p[0] - bend + 0.006, p[1], p[2] - 0.1 * p[0]};
  double d = ellipsoid(q, {0, 0, 0}, {0.0265, 0.054, 0.0245});
  d = join(d, ellipsoid(q, {0.002, 0.026, 0}, {0.025, 0.027, 0.0235}), 0.012);
  d = join(d, ellipsoid(q, {0.002, -0.027, 0}, {0.026, 0.027, 0.0245}), 0.012);
  d = cut(d, ellipsoid(p, {0.030, 0, 0.002}, {0.017, 0.017, 0.012}), 0.016);
  d = cut(d, capsule(p, {0.012, 0.0, 0.002}, {0.05, 0.0, 0.004}, 0.006, 0.011), 0.010);
  return d;
}

struct Organ {
  double (*body)(const Vec3d&);
  Vec3d extent;  // nominal size [m]; 0 keeps the proportion of the others
  double step;
};

// Move the box to the origin and stretch it to the nominal size.
void fit(TriangleMesh& mesh, const Vec3d& extent) {
  vec::Box box;
  for (const Vec3d& v : mesh.vertices) box.extend(v);
  const Vec3d centre = vec::mul(vec::add(box.lower, box.upper), 0.5);
  Vec3d factor{1, 1, 1};
  double mean = 0;
  int given = 0;
  for (int a = 0; a < 3; ++a) {
    if (extent[a] == 0) continue;
    factor[a] = extent[a] / (box.upper[a] - box.lower[a]);
    mean += factor[a];
    ++given;
  }
  for (int a = 0; a < 3; ++a) factor[a] = extent[a] == 0 ? mean / given : factor[a];
  for (Vec3d& v : mesh.vertices) {
    for (int a = 0; a < 3; ++a) v[a] = factor[a] * (v[a] - centre[a]);
  }
}

TriangleMesh make_organ(const Organ& organ) {
  constexpr double kReach = 0.16;
  TriangleMesh mesh = surface_nets(organ.body, {{-kReach, -kReach, -kReach}, {kReach, kReach, kReach}}, organ.step);
  fit(mesh, organ.extent);
  return mesh;
}

// Each face of the box is a grid of squares of about edge `step`; vertices on edges are shared.
TriangleMesh make_box(const Vec3d& extent, double step) {
  TriangleMesh mesh;
  std::array<int, 3> n{};
  for (int a = 0; a < 3; ++a) n[a] = static_cast<int>(std::lround(extent[a] / step));
  std::map<std::array<int, 3>, std::int32_t> ids;
  const auto vertex = [&](const std::array<int, 3>& g) {
    const auto [at, added] = ids.try_emplace(g, static_cast<std::int32_t>(mesh.vertices.size()));
    if (added) {
      Vec3d p{};
      for (int a = 0; a < 3; ++a) p[a] = extent[a] * (static_cast<double>(g[a]) / n[a] - 0.5);
      mesh.vertices.push_back(p);
    }
    return at->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      for (int j = 0; j < n[v]; ++j) {
        for (int i = 0; i < n[u]; ++i) {
          std::array<std::int32_t, 4> q{};
          for (int c = 0; c < 4; ++c) {
            std::array<int, 3> g{};
            g[axis] = side * n[axis];
            g[u] = i + (c == 1 || c == 2 ? 1 : 0);
            g[v] = j + (c >= 2 ? 1 : 0);
            q[c] = vertex(g);
          }
          if (side == 0) std::swap(q[1], q[3]);
          mesh.triangles.push_back({q[0], q[1], q[2]});
          mesh.triangles.push_back({q[0], q[2], q[3]});
        }
      }
    }
  }
  return mesh;
}

TriangleMesh make_cylinder(double radius, double length) {
  constexpr int kAround = 64, kAlong = 24, kRings = 6;
  TriangleMesh mesh;
  // One sheet from pole to pole: rings growing over the lower cap, up the side, shrinking over the upper cap.
  std::vector<std::array<double, 2>> profile;  // (radius, height)
  for (int r = 1; r <= kRings; ++r) profile.push_back({radius * r / kRings, -length / 2});
  for (int s = 1; s <= kAlong; ++s) profile.push_back({radius, length * (static_cast<double>(s) / kAlong - 0.5)});
  for (int r = kRings - 1; r >= 1; --r) profile.push_back({radius * r / kRings, length / 2});
  mesh.vertices.push_back({0, -length / 2, 0});
  for (const auto& [r, y] : profile) {
    for (int a = 0; a < kAround; ++a) {
      const double angle = 2 * std::numbers::pi * a / kAround;
      mesh.vertices.push_back({r * std::cos(angle), y, r * std::sin(angle)});
    }
  }
  mesh.vertices.push_back({0, length / 2, 0});
  const auto top = static_cast<std::int32_t>(mesh.vertices.size() - 1);
  const int rings = static_cast<int>(profile.size());
  for (int a = 0; a < kAround; ++a) {
    const int b = (a + 1) % kAround, last = 1 + (rings - 1) * kAround;
    mesh.triangles.push_back({0, 1 + a, 1 + b});
    for (int r = 0; r + 1 < rings; ++r) {
      const int low = 1 + r * kAround, high = low + kAround;
      mesh.triangles.push_back({low + a, high + a, high + b});
      mesh.triangles.push_back({low + a, high + b, low + b});
    }
    mesh.triangles.push_back({top, last + b, last + a});
  }
  return mesh;
}

// A thick tube along x: rings that grow over one end, go along the outside, shrink over the other end and come back inside.
TriangleMesh make_tube(double inner, double outer, double length) {
  constexpr int kAround = 48, kAlong = 20, kEnd = 2;
  std::vector<std::array<double, 2>> profile;  // (radius, x)
  profile.reserve(2 * (kAlong + kEnd));
  for (int r = 0; r < kEnd; ++r) profile.push_back({inner + (outer - inner) * r / kEnd, -length / 2});
  for (int s = 0; s < kAlong; ++s) profile.push_back({outer, length * (static_cast<double>(s) / kAlong - 0.5)});
  for (int r = 0; r < kEnd; ++r) profile.push_back({outer - (outer - inner) * r / kEnd, length / 2});
  for (int s = 0; s < kAlong; ++s) profile.push_back({inner, length * (0.5 - static_cast<double>(s) / kAlong)});
  TriangleMesh mesh;
  for (const auto& [r, x] : profile) {
    for (int a = 0; a < kAround; ++a) {
      const double angle = 2 * std::numbers::pi * a / kAround;
      mesh.vertices.push_back({x, r * std::cos(angle), r * std::sin(angle)});
    }
  }
  const int rings = static_cast<int>(profile.size());
  for (int a = 0; a < kAround; ++a) {
    const int b = (a + 1) % kAround;
    for (int r = 0; r < rings; ++r) {
      const int low = r * kAround, high = (r + 1) % rings * kAround;
      mesh.triangles.push_back({low + a, low + b, high + b});
      mesh.triangles.push_back({low + a, high + b, high + a});
    }
  }
  return mesh;
}

}  // namespace

std::vector<std::string> shape_names() {
  return {"apple", "liver", "kidney", "beam", "cube", "block", "sheet", "cylinder", "tube"};
}

TriangleMesh make_shape(const std::string& name) {
  if (name == "apple") return make_organ({apple, {0.08, 0, 0.08}, 0.0022});
  if (name == "liver") return make_organ({liver, {0.22, 0.15, 0.12}, 0.0042});
  if (name == "kidney") return make_organ({kidney, {0.06, 0.11, 0.05}, 0.0022});
  if (name == "beam") return make_box({0.1, 0.02, 0.02}, 0.005);
  if (name == "cube") return make_box({0.1, 0.1, 0.1}, 0.01);
  if (name == "block") return make_box({0.12, 0.04, 0.08}, 0.004);
  if (name == "sheet") return make_box({0.16, 0.008, 0.06}, 0.004);
  if (name == "cylinder") return make_cylinder(0.02, 0.1);
  if (name == "tube") return make_tube(0.0105, 0.024, 0.1);
  throw Error(
      ErrorCode::bad_input,
      fmt::format("no shape is called '{}'; known: apple, liver, kidney, beam, cube, block, sheet, cylinder, tube", name));
}

void write_obj_text(const TriangleMesh& mesh, const std::string& comment, const std::string& path) {
  std::string text = fmt::format("# {}\n", comment);
  for (const Vec3d& v : mesh.vertices) text += fmt::format("v {:.6g} {:.6g} {:.6g}\n", v[0], v[1], v[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  const std::string partial = path + ".partial";
  std::FILE* out = std::fopen(partial.c_str(), "wb");
  bool good = out != nullptr && std::fwrite(text.data(), 1, text.size(), out) == text.size();
  if (out != nullptr) good = std::fclose(out) == 0 && good;
  std::error_code code;
  if (good) std::filesystem::rename(partial, path, code);
  if (!good || code) {
    std::filesystem::remove(partial, code);
    throw Error(ErrorCode::bad_input, fmt::format("'{}' cannot be written", path));
  }
}

}  // namespace pliant
