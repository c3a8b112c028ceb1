// The small functions of the scene types.
#include <algorithm>
#include <cmath>

#include "scene/closed_surface.h"
#include "scene/keys.h"
#include "scene/mesh_region.h"
#include "scene/scene.h"

namespace pliant {

const char* to_string(ModelType type) { return word_of(model_words(), type).c_str(); }

namespace {

double largest_of(const Vec3d& v) { return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])}); }

double length_of(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

}  // namespace

// Nodes of a lattice or a mesh rarely lie on a face to the last bit, so every bound is widened by 1e-9 of the
// selection's own size and distance from the origin.
bool Selection::contains(const Vec3d& x, std::int64_t index) const {
  constexpr double relative = 1e-9;
  switch (kind) {
    case Kind::all:
      return true;
    case Kind::box: {
      const double slack = relative * std::max(largest_of(a), largest_of(b));
      for (int c = 0; c < 3; ++c) {
        if (!(x[c] >= a[c] - slack && x[c] <= b[c] + slack)) return false;
      }
      return true;
    }
    case Kind::sphere: {
      const double slack = relative * std::max(radius, largest_of(a));
      return length_of(x[0] - a[0], x[1] - a[1], x[2] - a[2]) <= radius + slack;
    }
    case Kind::plane: {
      const double slack = relative * std::max(largest_of(a), largest_of(x));
      const double distance = (x[0] - a[0]) * b[0] + (x[1] - a[1]) * b[1] + (x[2] - a[2]) * b[2];
      return distance >= -slack * length_of(b[0], b[1], b[2]);
    }
    case Kind::nodes:
      return std::binary_search(nodes.begin(), nodes.end(), index);
    case Kind::surface:
      return surface != nullptr && surface->contains(x);
    case Kind::region:
      return region != nullptr && region->contains(x, index);
  }
  return false;
}

namespace {

/// Of an angle in degrees, exact at multiples of 90: whole turns are taken off before anything is rounded.
double sine(double degrees) {
  const double rest = std::remainder(degrees, 360);
  if (std::fabs(rest) == 180) return 0;
  // Within 45 degrees of zero, where the sine is steep, or of a right angle, where the cosine is.
  if (std::fabs(rest) > 135) return std::sin((rest > 0 ? 180 - rest : -180 - rest) * M_PI / 180);
  if (std::fabs(rest) < 45) return std::sin(rest * M_PI / 180);
  return (rest > 0 ? 1 : -1) * std::cos((std::fabs(rest) - 90) * M_PI / 180);
}

}  // namespace

double Curve::value(double time) const {
  const double f = factor(time);
  if (of == Of::factor) return f;
  if (of == Of::sine) return sine(angle * f);
  const double half = sine(angle * f / 2);
  return -2 * half * half;  // nothing cancels at small angles
}

double Curve::factor(double time) const {
  if (kind == Kind::constant) return time >= start ? 1 : 0;
  if (kind == Kind::table) {
    if (table.empty()) return 1;
    const auto after = std::upper_bound(table.begin(), table.end(), time,
                                        [](double t, const std::array<double, 2>& row) { return t < row[0]; });
    if (after == table.begin()) return table.front()[1];
    if (after == table.end()) return table.back()[1];
    const std::array<double, 2>& left = *(after - 1);
    const std::array<double, 2>& right = *after;
    return left[1] + (right[1] - left[1]) * ((time - left[0]) / (right[0] - left[0]));
  }
  if (!(time > start)) return 0;
  if (time >= start + duration) return 1;
  const double s = (time - start) / duration;
  return kind == Kind::ramp ? s : s * s * s * (10 + s * (6 * s - 15));
}

double Curve::largest() const {
  if (kind != Kind::table || table.empty()) return 1;
  double most = 0;
  for (const std::array<double, 2>& row : table) most = std::max(most, std::fabs(row[1]));
  return most;
}

double Curve::end() const {
  double last = start + duration;
  if (!table.empty()) last = table.back()[0];
  return last;
}

Vec3d Scene::gravity_at(double time) const {
  if (gravity_curve.always()) return gravity;
  const double factor = gravity_curve.value(time);
  return {factor * gravity[0], factor * gravity[1], factor * gravity[2]};
}

Vec3d Focus::position(double time) const {
  if (path.empty()) return {};
  const auto place = [](const std::array<double, 4>& row) { return Vec3d{row[1], row[2], row[3]}; };
  const auto after =
      std::upper_bound(path.begin(), path.end(), time, [](double t, const std::array<double, 4>& row) { return t < row[0]; });
  if (after == path.begin()) return place(path.front());
  if (after == path.end()) return place(path.back());
  const Vec3d left = place(*(after - 1));
  const Vec3d right = place(*after);
  const double s = (time - (*(after - 1))[0]) / ((*after)[0] - (*(after - 1))[0]);
  return {left[0] + s * (right[0] - left[0]), left[1] + s * (right[1] - left[1]), left[2] + s * (right[2] - left[2])};
}

}  // namespace pliant
