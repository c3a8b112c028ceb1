// The key "blades" of a scene.
#include <fmt/format.h>

#include <algorithm>

#include "scene/blade_face.h"
#include "scene/described_keys.h"
#include "scene/keys.h"
#include "scene/parts.h"
#include "scene/tool_entry.h"

namespace pliant {
namespace {

using Row = std::array<double, 7>;

void check_faces(const Reader& blade, const Blade& b) {
  for (const char* key : {"height", "back"}) {
    if (!b.has_faces() && blade.has(key)) blade.at(key).fail(fmt::format("no {} of a blade without a \"thickness\"", key));
  }
  if (!b.has_faces()) return;
  const std::string least =
      fmt::format("at least the thickness, {:g} m: how far the faces reach back from the edge", b.thickness);
  const Reader height = blade.at("height", least);
  if (b.height < b.thickness) height.fail(least);
  if (b.back_at_first() != Vec3d{}) return;
  const char* const across =
      "a direction [x, y, z] from the edge to the back of the blade, across its edge, which the path does not tell";
  blade.at("back", across).fail(across);
}

Blade read_blade(const Reader& blade, std::size_t index) {
  blade.expect_object("blade");
  Blade b;
  b.pointer = blade.pointer();
  b.name = blade.has("name") ? read_name(blade.at("name")) : fmt::format("blade{}", index);
  const char* const expected = "a list of rows [time, x, y, z, x, y, z]: at least two, or one of a blade that cuts by force";
  const Reader path = blade.at("path", expected);
  b.path = read_rows<7>(path, expected, "a row [time, x, y, z, x, y, z] in seconds and metres: both ends of the blade", 1);
  for (std::size_t i = 0; i < b.path.size(); ++i) {
    const Row& r = b.path[i];
    if (std::equal(r.begin() + 1, r.begin() + 4, r.begin() + 4))
      path.items(expected)[i].fail("two different ends (a blade has a length)");
  }
  describe_blade(ReadKeys{blade}, b);
  if (b.cuts == BladeCuts::always && b.path.size() < 2) path.fail(expected);
  if (!(b.end > b.start)) blade.at("end").fail(fmt::format("a time after the start {}", b.start));
  if (b.cuts == BladeCuts::by_force && b.edge == 0) {
    static_cast<void>(blade.at("edge", "the radius of the edge in metres, because the blade cuts by force"));
  }
  for (const char* key : {"sharpness", "edge", "friction", "thickness", "height", "back"}) {
    if (b.cuts == BladeCuts::always && blade.has(key))
      blade.at(key).fail(fmt::format("no {} of a blade that does not cut \"by-force\"", key));
  }
  check_faces(blade, b);
  return b;
}

bool has_toughness(const Body& b) {
  return b.material.toughness > 0 ||
         std::any_of(b.inclusions.begin(), b.inclusions.end(), [](const Inclusion& i) { return i.material.toughness > 0; });
}

}  // namespace

bool cuts_by_force(const Scene& scene) {
  return std::any_of(scene.blades.begin(), scene.blades.end(), [](const Blade& b) { return b.cuts == BladeCuts::by_force; });
}

BladeMethod blade_method(const Scene& scene) {
  const auto other = std::find_if(scene.blades.begin(), scene.blades.end(),
                                  [](const Blade& b) { return b.method != BladeMethod::virtual_nodes; });
  return other == scene.blades.end() ? BladeMethod::virtual_nodes : other->method;
}

bool parts_along_faces(const Scene& scene) { return blade_method(scene) == BladeMethod::separation; }

bool remakes_elements(const Scene& scene) {
  const BladeMethod method = blade_method(scene);
  return method == BladeMethod::decomposition || method == BladeMethod::removal;
}

std::vector<Blade> read_blades(const Reader& blades) {
  const char* const expected = "a list of blades";
  std::vector<Blade> all;
  for (const Reader& entry : blades.items(expected)) {
    all.push_back(read_blade(entry, all.size()));
    check_last_name(entry, all, "blade");
  }
  return all;
}

namespace {

/// What a scene must have whose blades have another method than virtual nodes: the same method everywhere, and bodies of
/// elements that it knows.
void check_method(const Reader& top, const Scene& scene) {
  const BladeMethod method = blade_method(scene);
  const std::string& word = word_of(blade_method_words(), method);
  const std::vector<Reader> blades = top.at("blades").items("a list of blades"), bodies = top.at("bodies").items("a list");
  for (std::size_t i = 0; i < blades.size(); ++i) {
    const Blade& blade = scene.blades[i];
    if (blade.method != method) {
      const std::string expected =
          fmt::format("\"{}\", the method of another blade: all blades of a scene have the same", word);
      blades[i].at("method", expected).fail(expected);
    }
    if (method == BladeMethod::removal && blade.cuts == BladeCuts::by_force)
      blades[i].at("cuts").fail("\"always\", because the blade removes what it touches: no tissue is left to press it back");
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& b = scene.bodies[i];
    if (b.model.matches()) {
      blades[0].at("method").fail(fmt::format(
          "\"virtual-nodes\", because shape matching moves nodes of body '{}': \"{}\" knows elements only", b.name, word));
    }
    if (method != BladeMethod::decomposition) continue;
    const std::string tets = elements_with([](const ElementInfo& e) { return e.corners == 4; });
    if (element_info(b.element).corners != 4) {
      const std::string expected = fmt::format(
          "{}, because blades with the method \"decomposition\" divide tetrahedra; hexahedra are cut by \"separation\", "
          "\"removal\" and, in a lattice, \"virtual-nodes\"",
          tets);
      bodies[i].at("element", expected).fail(expected);
    }
    if (b.model.type == ModelType::mass_spring)
      bodies[i].at("model").at("type").fail(
          "\"tled\", because blades divide its elements (\"decomposition\"): a network whose "
          "tetrahedra are divided is another network");
  }
}

}  // namespace

void check_blades(const Reader& top, const Scene& scene) {
  if (scene.blades.empty()) return;
  if (blade_method(scene) != BladeMethod::virtual_nodes) check_method(top, scene);
  require_integrator(top, scene, &IntegratorInfo::edits, "the scene has blades");
  if (scene.relaxation.enabled) top.at("relaxation").fail("false, because the scene has blades");
  const std::vector<Reader> bodies = top.at("bodies").items("a list of bodies");
  if (cuts_by_force(scene) && std::none_of(scene.bodies.begin(), scene.bodies.end(), has_toughness)) {
    const auto first =
        std::find_if(scene.blades.begin(), scene.blades.end(), [](const Blade& b) { return b.cuts == BladeCuts::by_force; });
    top.at("blades").items("a list of blades")[static_cast<std::size_t>(first - scene.blades.begin())].at("cuts").fail(
        "\"always\", or a material with a \"toughness\" [Pa] in at least one body: without one no force cuts");
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& b = scene.bodies[i];
    if (cuts_by_force(scene) && b.model.substeps > 1)
      bodies[i].at("model").at("substeps").fail("1, because the scene has a blade that cuts by force, in every step");
    const ElementInfo& info = element_info(b.element);
    if (b.has_lattice() || info.splits || blade_method(scene) != BladeMethod::virtual_nodes) continue;
    bodies[i].at("element").fail(fmt::format("{}, because the scene has blades (a mesh of {} cannot be cut)",
                                             elements_with([](const ElementInfo& e) { return e.splits; }), info.cells));
  }
}

void add_faces(const Reader& top, Scene& scene) {
  for (std::size_t i = 0; i < scene.blades.size(); ++i) {
    if (!scene.blades[i].has_faces()) continue;
    const Reader thickness = top.at("blades").items("a list of blades")[i].at("thickness");
    require_integrator(top, scene, &IntegratorInfo::contact, "a blade has faces");
    for (ContactTool& face : faces_of(scene.blades[i])) {
      if (scene.tools.size() == most_tools) {
        thickness.fail(fmt::format("faces beyond the {} tools of a scene (each face is one)", most_tools),
                       fmt::format("at most {} tools and faces", most_tools));
      }
      const auto same = [&](const ContactTool& t) { return t.name == face.name; };
      if (std::any_of(scene.tools.begin(), scene.tools.end(), same))
        thickness.fail(fmt::format("no tool \"{}\", which is the name of a face of the blade", face.name));
      scene.tools.push_back(std::move(face));
    }
  }
}

std::array<Vec3d, 2> Blade::at(double time) const {
  const auto after = std::upper_bound(path.begin(), path.end(), time, [](double t, const Row& row) { return t < row[0]; });
  const Row& left = after == path.begin() ? *after : *(after - 1);
  const Row& right = after == path.end() ? left : *after;
  const double span = right[0] - left[0], s = span > 0 ? (time - left[0]) / span : 0;
  Row row{};
  for (std::size_t i = 1; i < 7; ++i) row[i] = s == 0 ? left[i] : left[i] + s * (right[i] - left[i]);
  return {Vec3d{row[1], row[2], row[3]}, Vec3d{row[4], row[5], row[6]}};
}

}  // namespace pliant
