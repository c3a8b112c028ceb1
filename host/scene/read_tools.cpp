// The key "tools" of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {
namespace {

using PoseRow = std::array<double, 8>;

PoseRow read_pose(const Reader& row, const std::vector<PoseRow>& before) {
  const char* const expected =
      "a row [time, x, y, z] or [time, x, y, z, qx, qy, qz, qw] in seconds and metres with a unit quaternion";
  const std::vector<Reader> parts = row.items(expected);
  if (parts.size() != 4 && parts.size() != 8) row.fail(expected);
  PoseRow out{0, 0, 0, 0, 0, 0, 0, 1};
  for (std::size_t i = 0; i < parts.size(); ++i) out[i] = parts[i].number();
  if (!before.empty() && !(out[0] > before.back()[0]))
    parts[0].fail(fmt::format("a time after the previous row's {}", before.back()[0]));
  const double norm = std::sqrt(out[4] * out[4] + out[5] * out[5] + out[6] * out[6] + out[7] * out[7]);
  if (!(std::abs(norm - 1) <= 1e-3))
    row.fail(fmt::format("a quaternion of length {:.6g}", norm), "a unit quaternion qx, qy, qz, qw (within 1e-3)");
  for (std::size_t i = 4; i < 8; ++i) out[i] /= norm;
  return out;
}

void read_capsule(const Reader& capsule, ContactTool& tool) {
  const char* const expected = "[[x, y, z], [x, y, z], radius] in metres, two different ends";
  const std::vector<Reader> parts = capsule.items(expected);
  if (parts.size() != 3) capsule.fail(expected);
  tool.first = parts[0].vec3();
  tool.second = parts[1].vec3();
  if (tool.first == tool.second) capsule.fail(expected);
  tool.radius = parts[2].positive();
}

void read_half_space(const Reader& half_space, ContactTool& tool) {
  const char* const expected = "[[x, y, z], [nx, ny, nz]]: a point in metres and the outward normal, not zero";
  const std::vector<Reader> parts = half_space.items(expected);
  if (parts.size() != 2) half_space.fail(expected);
  tool.first = parts[0].vec3();
  tool.second = parts[1].vec3();
  if (!(vec::norm(tool.second) >= 1e-30)) half_space.fail(expected);
}

void read_shape(const Reader& shape, ContactTool& tool) {
  shape.expect_object("shape");
  if (shape.json().size() != 1) shape.fail("one of the keys " + alternatives(scene_keys().at("shape")));
  for (const Word<ToolShape>& word : tool_shape_words()) {
    if (!shape.has(word.word)) continue;
    const Reader value = shape.at(word.word);
    tool.shape = word.value;
    switch (word.value) {
      case ToolShape::sphere:
        tool.radius = value.positive();
        break;
      case ToolShape::capsule:
        read_capsule(value, tool);
        break;
      case ToolShape::box:
        tool.size = value.vec3("three edges [x, y, z] in metres, each > 0");
        for (const double edge : tool.size) {
          if (!(edge >= 1e-30)) value.fail("three edges [x, y, z] in metres, each > 0");
        }
        break;
      case ToolShape::half_space:
        read_half_space(value, tool);
        break;
      case ToolShape::mesh:
        tool.mesh = value.text("the file of a closed surface");
        break;
      case ToolShape::sequence:
        tool.mesh = value.text("a folder with a closed surface per frame");
        break;
      case ToolShape::blade_face:  // no word of a file
        break;
    }
  }
}

void refuse_key(const Reader& object, const char* key, bool refused, const char* beside) {
  if (refused && object.has(key)) object.at(key).fail(fmt::format("this key only with {}", beside));
}

void read_contact(const Reader& contact, ContactTool& tool) {
  contact.expect_object("contact");
  describe_contact_law(ReadKeys{contact}, tool);
  for (const char* key : {"exponent", "alpha"}) {
    refuse_key(contact, key, tool.stiffness == 0, "a stiffness that is a number");
  }
}

GripSpec read_grip(const Reader& grip) {
  grip.expect_object("grip");
  GripSpec out;
  describe_grip(ReadKeys{grip}, out);
  if (!grip.has("times")) return out;
  const char* expected = "a list of rows [from, to] in seconds, ascending";
  out.times = read_rows<2>(grip.at("times", expected), expected, "a row [from, to] in seconds, from < to");
  double before = -1e300;
  for (std::size_t i = 0; i < out.times.size(); ++i) {
    const auto& [from, to] = out.times[i];
    if (!(before <= from && from < to))
      grip.at("times").items(expected)[i].fail("from < to, and not before the row above ends");
    before = to;
  }
  return out;
}

}  // namespace

nlohmann::ordered_json grip_json(const GripSpec& grip) {
  auto out = nlohmann::ordered_json::object();
  describe_grip(WriteKeys{out}, grip);
  if (!grip.times.empty()) out["times"] = grip.times;
  return out;
}

ContactTool read_contact_tool(const Reader& entry, const std::string& name, const std::filesystem::path& folder) {
  entry.expect_object("contact_tool");
  ContactTool tool;
  tool.pointer = entry.pointer();
  tool.name = entry.has("name") ? read_name(entry.at("name")) : name;
  read_shape(entry.at("shape", "an object with one of the keys " + alternatives(scene_keys().at("shape"))), tool);
  refuse_key(entry, "scale", tool.mesh.empty(), "a shape that is a mesh or a sequence");
  refuse_key(entry, "frames_per_second", tool.shape != ToolShape::sequence, "a shape that is a sequence");
  if (!tool.mesh.empty() && tool.mesh.is_relative()) tool.mesh = folder / tool.mesh;
  if (entry.has("path")) {
    for (const Reader& row : entry.at("path").items("a list of at least one row [time, x, y, z, qx, qy, qz, qw]", 1))
      tool.path.push_back(read_pose(row, tool.path));
  }
  describe_tool(ReadKeys{entry}, tool);
  if (entry.has("contact")) read_contact(entry.at("contact"), tool);
  if (entry.has("grip")) tool.grip = read_grip(entry.at("grip"));
  refuse_key(entry, "edges", tool.edges && (tool.shape == ToolShape::half_space || tool.shape == ToolShape::sequence),
             "a shape that is a sphere, capsule, box or mesh");
  return tool;
}

std::optional<TissueContact> read_tissue_contact(const Reader& contact) {
  if (contact.json() == false) return {};
  TissueContact out;
  if (contact.json() == true) return out;
  contact.expect_object("tissue_contact");
  describe_friction(ReadKeys{contact}, out);
  return out;
}

std::vector<ContactTool> read_tools(const Reader& tools, const std::filesystem::path& folder) {
  std::vector<ContactTool> all;
  for (const Reader& entry : tools.items("a list of tools")) {
    if (all.size() == most_tools)
      tools.fail(fmt::format("{} tools", tools.json().size()), fmt::format("at most {}", most_tools));
    all.push_back(read_contact_tool(entry, fmt::format("tool{}", all.size()), folder));
    check_last_name(entry, all, "tool");
  }
  return all;
}

void check_tools(const Reader& top, const Scene& scene) {
  if (scene.tools.empty() && !scene.contact) return;
  const std::string has = scene.tools.empty() ? "contact" : "tools";
  require_integrator(top, scene, &IntegratorInfo::contact, "the scene has " + has);
  if (scene.solver.enabled)
    top.at("solver").fail("\"dynamic\", because the scene has " + has + " (contact is not solved statically)");
  const std::vector<Reader> bodies = top.at("bodies").items("a list of bodies");
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].model.substeps > 1)
      bodies[i]
          .at("model")
          .at("substeps")
          .fail("1, because the scene has " + has + ", which acts on shape matching in every step");
  }
}

}  // namespace pliant
