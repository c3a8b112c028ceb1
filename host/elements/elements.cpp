#include "elements/elements.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

/// What the records of all one-point hexahedra begin with, and what follows from it.
struct OnePoint {
  OnePoint(const Corners8& x, const std::string& what) {
    // Mean gradients over the element (exact with 2 x 2 x 2 points), as Flanagan and Belytschko 1981: linear fields are exact.
    for (const GaussPoint& p : gauss_points(x, what)) {
      mean += p.weight * p.gradients;
      volume += p.weight;
    }
    mean /= volume;
    for (int a = 0; a < 8; ++a) {
      for (int c = 0; c < 3; ++c) record.push_back(mean(a, c));
    }
  }
  Corners8 mean = Corners8::Zero();
  double volume = 0;
  std::vector<double> record;
};

std::vector<double> full_record(const Corners8& x, const std::string& what) {
  std::vector<double> record;
  for (const GaussPoint& p : gauss_points(x, what)) {
    for (int a = 0; a < 8; ++a) {
      for (int c = 0; c < 3; ++c) record.push_back(p.gradients(a, c));
    }
    record.push_back(p.weight);
  }
  return record;
}

/// The first element of the list with a property that at least one has.
template <class Has>
ElementKind first_with(const Has& has) {
  const auto all = all_elements();
  return *std::find_if(all.begin(), all.end(), [&](ElementKind kind) { return has(element_info(kind)); });
}

}  // namespace

const ElementInfo& element_info(ElementKind kind) {
  return with_element(kind, [](auto e) -> const ElementInfo& { return decltype(e)::info; });
}

std::span<const ElementKind, element_count> all_elements() {
#define PLIANT_ELEMENT_KIND(stem, type) ElementKind::stem,
  static constexpr ElementKind all[] = {PLIANT_ELEMENTS(PLIANT_ELEMENT_KIND)};
#undef PLIANT_ELEMENT_KIND
  return all;
}

ElementKind usual_element(int corners) {
  return first_with([&](const ElementInfo& info) { return info.corners == corners; });
}

ElementKind brick_element() {
  return first_with([](const ElementInfo& info) { return info.brick != nullptr; });
}

ElementKind reference_element() {
  return first_with([](const ElementInfo& info) { return info.reference; });
}

std::vector<double> Hex8::record(std::span<const Vec3d> corners, const Material& material, const std::string& what) {
  const Corners8 x = corners8(corners);
  OnePoint e(x, what);
  const std::vector<double> hourglass = hourglass_numbers(x, e.mean, e.volume, material);
  e.record.insert(e.record.end(), hourglass.begin(), hourglass.end());
  e.record.push_back(e.volume);
  return e.record;
}

std::vector<double> Hex8::cube_record(double edge, const Material& material, const std::string& what) {
  const Corners8 x = cube_corners(edge);
  OnePoint e(x, what);
  // gamma = h - (h . X) b: the products of two or three corner signs, made orthogonal to every linear field.
  for (const int mode : {3, 5, 6, 7}) {
    Eigen::Matrix<double, 8, 1> h;
    for (int a = 0; a < 8; ++a) h[a] = __builtin_popcount(~a & mode) % 2 ? -1 : 1;
    const Eigen::Matrix<double, 8, 1> gamma = h - e.mean * (x.transpose() * h);
    e.record.insert(e.record.end(), gamma.begin(), gamma.end());
  }
  e.record.push_back(e.volume);
  e.record.push_back(hourglass_stiffness(material, e.volume));
  return e.record;
}

double Hex8::frequency(std::span<const double> record, const Material& m) {
  const Corners8 b = Eigen::Map<const Eigen::Matrix<double, 8, 3, Eigen::RowMajor>>(record.data());
  const Eigen::Matrix<double, 4, 8> gamma = hourglass_vectors(record);
  const double volume = hex8_volume(record), hourglass = pliant::hourglass_bound(record, Displacements8::Zero());
  // The two parts act on orthogonal modes of a parallelepiped, where the larger counts; in general their sum is safe.
  const double cross = (gamma * b).cwiseAbs().maxCoeff() * std::cbrt(volume);
  const double strain = volume * modulus_bound(b, m);
  const double total = cross < 1e-9 ? std::max(strain, hourglass) : strain + hourglass;
  return std::sqrt(total / (m.density * volume / 8));
}

std::vector<double> Hex8Full::record(std::span<const Vec3d> corners, const Material&, const std::string& what) {
  return full_record(corners8(corners), what);
}

std::vector<double> Hex8Full::cube_record(double edge, const Material&, const std::string& what) {
  return full_record(cube_corners(edge), what);
}

double Hex8Full::frequency(std::span<const double> record, const Material& m) {
  double stiffness = 0, volume = 0;
  for_each_point(record, [&](const Corners8& b, double weight) {
    stiffness += weight * modulus_bound(b, m);
    volume += weight;
  });
  return std::sqrt(stiffness / (m.density * volume / 8));
}

}  // namespace pliant
