#include "model/unit_remarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"

namespace pliant {
namespace {

constexpr double kLargest = 10;      ///< body [m]; a whale has 30
constexpr double kSoftest = 50;      ///< Young's modulus [Pa]; mucus and brain have some hundreds
constexpr double kLightest = 100;    ///< density [kg/m^3]; an inflated lung has 200 to 300
constexpr double kHeaviest = 25000;  ///< density [kg/m^3]; osmium has 22600
constexpr double kCrushed = 10;      ///< weight of a column as high as the body, over the modulus
constexpr double kFarthest = 5;      ///< displacement, in sizes of the body
constexpr const char* kAllSi = "all units are SI";

void add_material(const std::string& where, const Material& material, std::vector<std::string>& remarks) {
  const double young = material.moduli.young(), density = material.density;
  if (young < kSoftest) {
    remarks.push_back(
        fmt::format("{}: its Young's modulus is {:.4g} Pa, and the softest tissues have some hundreds; {}: 5 kPa are 5000",
                    where, young, kAllSi));
  }
  if (density < kLightest || density > kHeaviest) {
    remarks.push_back(fmt::format("{}: its density is {:.4g} kg/m^3, and that of tissue is near 1000; {}: 1 g/cm^3 is 1000",
                                  where, density, kAllSi));
  }
}

void add_weight(const std::string& where, const Body& body, const Scene& scene, const vec::Box& box,
                std::vector<std::string>& remarks) {
  double column = 0;
  for (int a = 0; a < 3; ++a) column += std::abs(scene.gravity[a]) * (box.upper[a] - box.lower[a]);
  const double share = body.material.density * scene.gravity_curve.largest() * column / body.material.moduli.young();
  if (body.material.moduli.young() < kSoftest || share <= kCrushed) return;  // already reported, or plausible
  remarks.push_back(
      fmt::format("{}: the weight of a column as high as it is {:.3g} times its Young's modulus, which would crush it; check "
                  "\"scale\", \"density\", \"young\" and \"gravity\" ({})",
                  where, share, kAllSi));
}

}  // namespace

std::vector<std::string> unit_remarks(const Model& model, const Scene& scene) {
  std::vector<std::string> remarks;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    const std::string where = "body '" + model.bodies[b].name + "'";
    vec::Box box;
    for (const Vec3d& x : model.bodies[b].rest) box.extend(x);
    const Vec3d size = vec::sub(box.upper, box.lower);
    const double largest = std::max({size[0], size[1], size[2]});
    if (largest > kLargest) {
      remarks.push_back(fmt::format("{} is {:.4g} x {:.4g} x {:.4g} m large; {}: \"scale\": 0.001 reads a file in millimetres",
                                    where, size[0], size[1], size[2], kAllSi));
    }
    add_material(where, body.material, remarks);
    for (std::size_t i = 0; i < body.inclusions.size(); ++i) {
      add_material(fmt::format("{}, entry {} of \"inclusions\"", where, i), body.inclusions[i].material, remarks);
    }
    add_weight(where, body, scene, box, remarks);
    for (std::size_t i = 0; i < body.prescribed.size(); ++i) {
      double farthest = 0;
      for (const auto& component : body.prescribed[i].displacement)
        farthest = std::max(farthest, std::abs(component.value_or(0)));
      farthest *= body.prescribed[i].curve.largest();
      if (!(farthest > kFarthest * largest)) continue;
      remarks.push_back(fmt::format(
          "{}, entry {} of \"prescribed\": it moves nodes by {:.4g} m, {:.3g} times the body's size of {:.4g} m; {}", where, i,
          farthest, farthest / largest, largest, kAllSi));
    }
  }
  return remarks;
}

std::vector<std::string> model_remarks(const std::vector<SurfaceCheck>& checks, const Model& model, const Scene& scene) {
  std::vector<std::string> remarks = unit_remarks(model, scene);
  for (const SurfaceCheck& check : checks) {
    for (const std::string& warning : check.warnings) remarks.push_back("body '" + check.body + "': " + warning);
  }
  return remarks;
}

}  // namespace pliant
