// Random scenes: bodies that ship with Pliant, held somewhere, and loaded as hard as anybody would.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "bench/common/dice.h"
#include "bench/survival/random_grip.h"
#include "bench/survival/random_method.h"
#include "bench/survival/random_plates.h"
#include "bench/survival/random_springs.h"
#include "bench/survival/random_vessels.h"
#include "bench/survival/survival.h"
#include "geometry/mesh.h"
#include "geometry/vec.h"
#include "material/material.h"
#include "mesh_io/mesh_io.h"

namespace pliant::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Shape {
  const char* file;
  bool tets;
};
constexpr Shape kShapes[] = {{"apple.obj", false},          {"beam.obj", false},    {"cube.obj", false},
                             {"cylinder.obj", false},       {"kidney.obj", false},  {"liver.obj", false},
                             {"liver.obj", false},          {"beam_tet.msh", true}, {"cube_tet.vtu", true},
                             {"gallbladder_tet.msh", true}, {"sheet_tet.msh", true}};

vec::Box box_of(const std::filesystem::path& file, bool tets) {
  vec::Box box;
  for (const Vec3d& x : tets ? read_volume(file).vertices : read_surface(file).vertices) box.extend(x);
  return box;
}

class RandomScene {
 public:
  RandomScene(std::int64_t number, const std::filesystem::path& scenes)
      : dice_(number), late_(~number), touch_(number ^ 0x5bd1e995), number_(number) {
    Dice varied(number ^ 0x2545f491);
    shape_ = kShapes[dice_.below(std::size(kShapes))];
    // Half of the cubes of tetrahedra become a block with a modulus per element.
    varied_ = std::string_view(shape_.file) == "cube_tet.vtu" && varied.chance(0.5);
    if (varied_) shape_.file = "nodule_tet.vtu";
    Dice thin(number ^ 0x6a09e667);
    if (thin.chance(0.08)) {
      shape_ = {"cloth.obj", true};
      thickness_ = thin.uniform(0.0015, 0.006);
      varied_ = false;
    }
    file_ = std::filesystem::absolute(scenes / "meshes" / shape_.file);
    box_ = box_of(file_, shape_.tets && thickness_ == 0);
    if (thickness_ > 0) box_.lower[2] = -thickness_ / 2, box_.upper[2] = thickness_ / 2;  // it lies in the plane z = 0
    size_ = vec::sub(box_.upper, box_.lower);
    for (std::size_t c = 1; c < 3; ++c) {
      if (size_[c] > size_[axis_]) axis_ = c;
    }
    extent_ = size_[axis_];
  }

  Json operator()() {
    Json body{{"name", std::filesystem::path(shape_.file).stem().string()}};
    body[shape_.tets && thickness_ == 0 ? "mesh" : "surface"] = file_.string();
    if (thickness_ > 0) body["thickness"] = thickness_;
    method(body);
    const bool tears = shape_.tets && body["element"] == "tet4" && dice_.chance(0.35);
    material(body, tears);
    Dice skin(number_ ^ 0x7a3d71b9);
    if (skin.chance(0.15)) {
      body["membrane"] = membrane(skin);
      for (const char* key : {"substeps", "goals"}) body["model"].erase(key);  // refused
    }
    Dice tubes(number_ ^ 0x3c6ef372a54);
    if (thickness_ == 0 && (shape_.tets || has_no_hollows(shape_.file)) && tubes.chance(0.15)) {
      body["vessels"] = random_vessels(tubes, shape_.tets ? file_ : "", box_, young_);
      for (const char* key : {"substeps", "goals"}) body["model"].erase(key);  // refused
    }
    if (shape_.tets && thickness_ == 0) add_random_springs(Dice(number_ ^ 0x2545f491), file_, young_, extent_, body);
    Json scene{{"format", "pliant-scene/1"}, {"name", fmt::format("survival {}", number_)}, {"duration", 2.0}};
    hold(body);
    const bool weight = dice_.chance(0.75);
    if (weight) scene["gravity"] = vec::mul(dice_.chance(0.6) ? Vec3d{0, -1, 0} : dice_.direction(), 9.81);
    const std::size_t load = dice_.below(weight ? 4 : 3);
    if (load < 2) move(body);
    if (load < 2 && late_.chance(0.3)) twist(body);
    if (load == 2) push(body);
    const bool cuts = !tears && body["model"]["type"] != "flsm" && dice_.chance(0.5);
    if (cuts) scene["blades"] = blades();
    Dice along_faces(number_ ^ 0x3e11ad5);
    const bool parts = shape_.tets && along_faces.chance(0.4);
    if (parts && tears && along_faces.chance(0.5)) scene["blades"] = blades();  // one scene with both
    if (cuts && body["model"]["type"] == "hybrid" && late_.chance(0.5)) body["model"]["follow"] = "blade0";
    if (cuts) press(scene["blades"], body);
    if (parts && scene.contains("blades")) give_random_method(number_, body, tears, scene["blades"]);
    const bool has_tools = touch_.chance(0.5), touches = touch_.chance(0.4);
    if (has_tools || touches) {
      for (const char* key : {"substeps", "goals"}) body["model"].erase(key);  // refused
    }
    scene["bodies"] = Json::array({body});
    if (touches) touch(scene);
    if (has_tools) scene["tools"] = tools();
    Dice later(number_ ^ 0x1b873593);
    if (later.chance(0.3)) scene["changes"] = changes(later, body);
    return scene;
  }

 private:
  /// A point of the body's box.
  [[nodiscard]] Vec3d at(const Vec3d& share) const {
    return {box_.lower[0] + share[0] * size_[0], box_.lower[1] + share[1] * size_[1], box_.lower[2] + share[2] * size_[2]};
  }

  void method(Json& body) {
    if (shape_.tets) {
      body["element"] = dice_.chance(0.5) ? "tet4" : "tet4anp";
      body["model"] = {{"type", "tled"}};
      Dice springs(number_ ^ 0x3c6ef372);
      if (springs.chance(0.2)) body["model"] = network(springs);
      return;
    }
    body["lattice"] = {{"spacing", std::cbrt(size_[0] * size_[1] * size_[2] / dice_.logarithmic(300, 1500))}};
    constexpr const char* elements[] = {"hex8", "hex8", "hex8full", "tet4", "tet4anp"};
    const std::size_t kind = dice_.below(10);
    body["element"] = kind < 5 ? elements[kind] : "hex8";
    if (kind < 7) {
      body["model"] = {{"type", "tled"}};
    } else if (kind < 9) {
      const Vec3d seed = at({dice_.uniform(0.2, 0.8), dice_.uniform(0.2, 0.8), dice_.uniform(0.2, 0.8)});
      body["model"] = {{"type", "hybrid"}, {"seed", seed}, {"ratio", dice_.uniform(0.2, 0.8)}};
      if (late_.chance(0.5)) subcycle(body["model"]);
    } else {
      body["model"] = {{"type", "flsm"}};
    }
  }

  /// A fifth of the meshes are networks of springs, some of them damped or slack.
  static Json network(Dice& dice) {
    Json spring = Json::object();
    if (dice.chance(0.5)) spring["damping"] = dice.logarithmic(1e-4, 1e-1);
    if (dice.chance(0.2)) spring["slack"] = true;
    return {{"type", "mass-spring"}, {"spring", spring}};
  }

  void subcycle(Json& model) {
    model["width"] = 1 + late_.below(3);
    model["substeps"] = 1 + late_.below(8);
    if (late_.chance(0.5)) model["goals"] = "extrapolated";
    if (Dice(number_ ^ 0x4cf5ad43).chance(0.4)) model.update({{"substeps", "auto"}, {"goals", "extrapolated"}});
  }

  void material(Json& body, bool tears) {
    young_ = dice_.logarithmic(1e3, 300e3);
    if (varied_) young_ = 4e3;  // of most of the block
    const double poisson = dice_.uniform(0.3, 0.49), damping = dice_.chance(0.3) ? 0 : dice_.logarithmic(0.5, 50);
    Law law = Law::neo_hookean;
    if (dice_.chance(0.5)) law = all_laws()[dice_.below(law_count)];
    if (body["element"] == "tet4anp" && !law_info(law).volumetric) law = Law::neo_hookean;  // refused
    const LawInfo& info = law_info(law);
    Json m{{"law", info.word}};
    if (info.takes_moduli) {
      m["young"] = varied_ ? Json{{"field", "E"}} : Json(young_);
      m["poisson"] = poisson;
    } else {
      const Material made = make_material(law, Moduli::from_young(young_, poisson));
      for (std::size_t i = 0; i < made.parameters.size(); ++i) m[info.parameters[i].name] = made.parameters[i];
    }
    m["density"] = dice_.uniform(900, 1100);
    m["damping"] = damping;
    // A sixth of the bodies of elements have a viscosity, of up to a tenth of a second; some have b K.
    Dice viscous(number_ ^ 0x632be59b), rayleigh(number_ ^ 0x2545f491);
    if (body["model"]["type"] == "tled" || body["model"]["type"] == "mass-spring")
      if (rayleigh.chance(0.1)) m["stiffness_damping"] = rayleigh.logarithmic(1e-5, 1e-2);
    if (body["model"]["type"] == "tled" && viscous.chance(1.0 / 6)) {
      m["viscosity"] = young_ * viscous.logarithmic(1e-5, 0.03);
      if (viscous.chance(0.5)) m["bulk_viscosity"] = young_ * viscous.logarithmic(1e-5, 0.1);
    }
    if (tears) m["toughness"] = young_ * dice_.uniform(0.1, 0.8);
    body["material"] = m;
  }

  /// From a hundredth to ten times as stiff as the tissue within a thirtieth of the body.
  [[nodiscard]] Json membrane(Dice& dice) const {
    const double thickness = extent_ * dice.logarithmic(1e-4, 1e-2);
    return {{"thickness", thickness},
            {"young", young_ * extent_ / 30 / thickness * dice.logarithmic(0.01, 10)},
            {"poisson", dice.uniform(0, 0.5)},
            {"density", dice.uniform(0, 1500)}};
  }

  /// Parameters that change on the way: stiffer or softer up to ten times, other damping, gravity, region, or nothing holds it.
  Json changes(Dice& dice, const Json& body) const {
    Json list = Json::array();
    double time = 0;
    for (std::size_t i = 0; i <= dice.below(3); ++i) {
      time += dice.uniform(0.05, 0.8);
      Json change{{"time", time}};
      const std::size_t kind = dice.below(4);
      if (kind == 0) change["gravity"] = vec::mul(dice.direction(), dice.uniform(0, 20));
      if (kind == 1) change["material"]["damping"] = dice.logarithmic(0.5, 50);
      if (kind == 1 && body["material"].contains("young") && !varied_)
        change["material"]["young"] = young_ * dice.logarithmic(0.1, 10);
      if (kind == 2 && body["model"]["type"] == "hybrid") change["model"]["ratio"] = dice.uniform(0.2, 0.8);
      if (kind == 2 && body["model"]["type"] == "flsm") change["model"]["alpha"] = dice.uniform(0.1, 1);
      if (kind == 3) change["fixed"] = dice.chance(0.5) ? Json::array() : body["fixed"];
      if (change.size() > 1 && kind > 0) change["body"] = body["name"];
      if (change.size() > 1) list.push_back(change);
    }
    return list;
  }

  /// All beyond a share of the longest axis: {"plane": [point, normal]}.
  [[nodiscard]] Json cap(double share, bool upper) const {
    Vec3d point = at({0.5, 0.5, 0.5}), normal{};
    point[axis_] = upper ? box_.upper[axis_] - share * extent_ : box_.lower[axis_] + share * extent_;
    normal[axis_] = upper ? 1 : -1;
    return Json::array({point, normal});
  }

  void hold(Json& body) {
    upper_ = dice_.chance(0.5);
    body["fixed"] = Json::array({{{"plane", cap(dice_.uniform(0.05, 0.2), upper_)}}});
  }

  /// The far end is moved along the axis or anywhere, by up to twice the body's length away and by up to half of it inwards.
  void move(Json& body) {
    Vec3d way = dice_.direction();
    if (dice_.chance(0.5)) {
      way = {};
      way[axis_] = upper_ ? -1 : 1;
    }
    const double outwards = (upper_ ? -1 : 1) * way[axis_];
    const double most = outwards < 0 ? 0.5 : 2;
    body["prescribed"] = Json::array({{{"plane", cap(dice_.uniform(0.05, 0.2), !upper_)},
                                       {"displacement", vec::mul(way, dice_.uniform(0.05, most) * extent_)},
                                       {"curve", dice_.chance(0.6) ? "smooth" : "ramp"},
                                       {"duration", dice_.uniform(0.3, 1.5)}}});
  }

  /// The far end is turned about the axis instead, by up to a whole turn.
  void twist(Json& body) {
    Vec3d axis{};
    axis[axis_] = late_.chance(0.5) ? 1 : -1;
    Json& far = body["prescribed"][0];
    far.erase("displacement");
    far["rotate"] = {{"axis", axis}, {"about", at({0.5, 0.5, 0.5})}, {"angle", late_.uniform(20, 360)}};
  }

  /// A force of up to what doubles the length of a bar of that size.
  void push(Json& body) {
    const double area = size_[0] * size_[1] * size_[2] / extent_;
    body["forces"] = Json::array({{{"plane", cap(0.25, !upper_)},
                                   {"force", vec::mul(dice_.direction(), dice_.uniform(0.05, 1) * young_ * area)},
                                   {"curve", dice_.chance(0.6) ? "smooth" : "ramp"},
                                   {"duration", dice_.uniform(0.1, 1)}}});
  }

  /// Blades that go through the body somewhere, at any angle, some deep and some not.
  Json blades() {
    Json list = Json::array();
    const std::size_t count = 1 + dice_.below(3);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d through = at({dice_.uniform(0.15, 0.85), dice_.uniform(0.15, 0.85), dice_.uniform(0.15, 0.85)});
      const Vec3d along = dice_.direction();
      Vec3d edge = vec::cross(along, dice_.direction());
      if (vec::norm(edge) < 0.1) edge = vec::cross(along, {along[1], -along[2], along[0] + 1});
      edge = vec::mul(edge, 1 / vec::norm(edge));
      const double half = extent_ * dice_.uniform(0.3, 1.2), reach = 1.3 * extent_, depth = extent_ * dice_.uniform(-0.2, 1.3);
      const double start = dice_.uniform(0.05, 1), end = start + dice_.uniform(0.2, 0.8);
      const auto row = [&](double time, const Vec3d& middle) {
        const Vec3d a = vec::sub(middle, vec::mul(edge, half)), b = vec::add(middle, vec::mul(edge, half));
        return Json::array({time, a[0], a[1], a[2], b[0], b[1], b[2]});
      };
      list.push_back({{"name", fmt::format("blade{}", i)},
                      {"path", Json::array({row(start, vec::sub(through, vec::mul(along, reach))),
                                            row(end, vec::add(through, vec::mul(along, depth)))})}});
    }
    return list;
  }

  /// Makes some of the blades press until tissue gives way, at forces that dent it little or much.
  void press(Json& blades, Json& body) {
    Dice sharp(number_ ^ 0x5ca1be1);
    if (!sharp.chance(0.3)) return;
    body["material"]["toughness"] = young_ * sharp.logarithmic(0.3, 100);
    for (const char* key : {"substeps", "goals"}) body["model"].erase(key);  // refused
    for (Json& blade : blades) {
      if (sharp.chance(0.2)) continue;
      blade["cuts"] = "by-force";
      blade["edge"] = extent_ * sharp.logarithmic(1e-3, 2e-2);
      blade["friction"] = sharp.chance(0.5) ? 0.0 : sharp.uniform(0, 1);
    }
    if (!blades[0].contains("cuts")) blades[0].update(Json{{"cuts", "by-force"}, {"edge", 0.005 * extent_}});
    give_random_plates(number_, extent_, blades);
  }

  /// Spheres, capsules, boxes and half spaces that stand beside the body or come towards it, up to two fifths of its size deep,
  /// and perhaps leave again.
  Json tools() {
    Json list = Json::array();
    const std::size_t count = 1 + touch_.below(3);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d way = touch_.direction();  // from the tool to the body
      double reach = 0;
      Json tool{{"name", fmt::format("tool{}", i)}, {"shape", shape(way, reach)}};
      const Vec3d target = at({touch_.uniform(0.3, 0.7), touch_.uniform(0.3, 0.7), touch_.uniform(0.3, 0.7)});
      // Where no point of the box is within reach.
      double behind = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3d x = at({double(corner & 1), double(corner >> 1 & 1), double(corner >> 2 & 1)});
        for (const Vec3d& y : {x, vec::add(x, second_)}) behind = std::max(behind, -vec::dot(vec::sub(y, target), way));
      }
      const Vec3d start = vec::sub(target, vec::mul(way, behind + reach + 1e-3 * extent_));
      const double begin = touch_.uniform(0, 0.5), end = begin + touch_.logarithmic(0.1, 1.5);
      const Vec3d deep = vec::add(start, vec::mul(way, touch_.uniform(0.05, 0.4) * extent_));
      const auto row = [](double time, const Vec3d& x) { return Json::array({time, x[0], x[1], x[2]}); };
      tool["path"] = Json::array({row(begin, start)});
      if (touch_.chance(0.75)) tool["path"].push_back(row(end, deep));
      if (tool["path"].size() > 1 && touch_.chance(0.4)) tool["path"].push_back(row(end + touch_.uniform(0.1, 0.5), start));
      if (touch_.chance(0.6)) tool["friction"] = touch_.uniform(0, 0.8);
      if (touch_.chance(0.2)) tool["contact"] = {{"stiffness", touch_.logarithmic(1e4, 1e7)}, {"alpha", touch_.uniform(0, 1)}};
      Dice hold(number_ ^ (0x51ed270b + i));
      if (hold.chance(0.25)) tool["grip"] = random_grip(hold, young_);
      if (hold.chance(0.3) && !tool["shape"].contains("half_space")) tool["edges"] = true;
      list.push_back(std::move(tool));
    }
    return list;
  }

  /// About its origin; `reach`: the farthest point along its way.
  Json shape(const Vec3d& way, double& reach) {
    const double size = touch_.logarithmic(0.02, 0.5) * extent_;
    switch (touch_.below(4)) {
      case 0:
        reach = size;
        return {{"sphere", size}};
      case 1: {
        const Vec3d half = vec::mul(touch_.direction(), touch_.uniform(0.2, 1) * extent_);
        reach = 0.5 * size + vec::norm(half);
        return {{"capsule", {vec::mul(half, -1), half, 0.5 * size}}};
      }
      case 2: {
        const Vec3d edges{size, touch_.uniform(0.05, 1) * extent_, touch_.uniform(0.05, 1) * extent_};
        reach = 0.5 * vec::norm(edges);
        return {{"box", edges}};
      }
      default:
        return {{"half_space", {Vec3d{}, way}}};
    }
  }

  /// Tissue touches tissue: itself, or another such body that falls or flies towards the first.
  void touch(Json& scene) {
    scene["contact"] = {{"friction", touch_.chance(0.5) ? 0 : touch_.uniform(0, 0.8)}};
    if (touch_.chance(0.4)) return;
    Json second = scene["bodies"][0];
    for (const char* key : {"fixed", "prescribed", "forces", "vessels"}) second.erase(key);
    second["name"] = second["name"].get<std::string>() + "2";
    Vec3d from = touch_.direction();
    if (scene.contains("gravity")) from = vec::mul(scene["gravity"].get<Vec3d>(), -1 / 9.81);
    std::size_t axis = 0;
    for (std::size_t c = 1; c < 3; ++c) {
      if (std::abs(from[c]) > std::abs(from[axis])) axis = c;
    }
    second_[axis] = std::copysign(1.01 * size_[axis], from[axis]);
    for (std::size_t c = 0; c < 3; ++c) {
      if (c != axis) second_[c] = touch_.uniform(-0.3, 0.3) * size_[c];
    }
    second["translate"] = second_;
    second["velocity"] = vec::mul(second_, -touch_.logarithmic(0.1, 2) / vec::norm(second_));
    scene["bodies"].push_back(std::move(second));
    add_random_joins(Dice(number_ ^ 0x41c64e6d), file_, second_, young_, extent_, scene);
  }

  Dice dice_;
  Dice late_, touch_;  ///< for what came later, so that the rest of a scene stays what it was
  std::int64_t number_;
  Shape shape_{};
  std::filesystem::path file_;
  vec::Box box_;
  Vec3d size_{};
  Vec3d second_{};  ///< from the first body to the second; 0: there is none
  std::size_t axis_ = 0;
  double extent_ = 0, young_ = 0;
  bool varied_ = false;   ///< a modulus per element
  double thickness_ = 0;  ///< of a sheet [m]
  bool upper_ = false;
};

}  // namespace

std::string survival_scene(std::int64_t number, const std::filesystem::path& scenes) {
  return RandomScene(number, scenes)().dump(1) + "\n";
}

}  // namespace pliant::bench
