#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>

#include "pliant/error.h"
#include "scene/described_keys.h"
#include "scene/json_text.h"
#include "scene/parts.h"

namespace pliant {

namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw Error(ErrorCode::bad_input, fmt::format("{}: no such file, expected a scene file", name));
  if (fs::is_directory(file, ignored))
    throw Error(ErrorCode::bad_input, fmt::format("{}: got a folder, expected a scene file", name));
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text(max_scene_bytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad() || (stream.gcount() == 0 && !stream.eof())) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: cannot be read ({}), expected a scene file", name, std::strerror(errno)));
  }
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

/// In messages.
std::string name_of(const fs::path& file) { return file.empty() ? "scene" : file.string(); }

void read_format(const Reader& top) {
  const Reader format = top.at("format", "\"format\": \"pliant-scene/1\"");
  if (format.json() != "pliant-scene/1") format.fail("\"pliant-scene/1\"");
}

void read_gravity(const Reader& top, Scene& scene) {
  if (!top.has("gravity")) return;
  const Reader field = top.at("gravity");
  if (field.json().is_array()) {
    scene.gravity = field.vec3();
    return;
  }
  if (!field.json().is_object()) field.fail("three numbers [x, y, z], or an object with acceleration and a curve");
  field.expect_object("gravity");
  describe_gravity(ReadKeys{field}, scene);
  scene.gravity_curve = read_curve(field);
}

void read_relaxation(const Reader& top, Relaxation& relaxation) {
  if (!top.has("relaxation")) return;
  const Reader field = top.at("relaxation");
  if (field.json().is_boolean()) {
    relaxation.enabled = field.boolean();
    return;
  }
  if (!field.json().is_object()) field.fail("true, false or an object with the keys tolerance, max_steps");
  field.expect_object("relaxation");
  relaxation.enabled = true;
  describe_relaxation(ReadKeys{field}, relaxation);
}

void read_solver(const Reader& top, Scene& scene) {
  if (!top.has("solver")) return;
  const Reader field = top.at("solver");
  field.expect_object("solver");
  StaticSolver& solver = scene.solver;
  describe_solver(ReadKeys{field}, solver);
  for (const auto& [key, value] : field.json().items()) {
    if (!solver.enabled && key != "type") field.at(key).fail("this key only with \"type\": \"static\"");
  }
}

void read_bodies(const Reader& top, const fs::path& folder, Scene& scene) {
  const char* const expected = "a list of at least one body";
  std::map<std::string, std::string> names;
  for (const Reader& body : top.at("bodies", expected).items(expected, 1)) {
    scene.bodies.push_back(read_body(body, folder, scene.bodies.size()));
    const Body& b = scene.bodies.back();
    const auto [first, inserted] = names.emplace(b.name, b.pointer);
    if (!inserted) {
      body.fail(fmt::format("the name \"{}\", which {} has already", b.name, first->second), "a different name for every body");
    }
  }
}

/// Equilibrium has no start.
void check_initial(const Reader& top, const Scene& scene) {
  if (!scene.solver.enabled) return;
  for (const Reader& body : top.at("bodies").items("bodies")) {
    if (body.has("initial") && !body.at("initial").json().empty())
      body.at("initial").fail("none with \"solver\": {\"type\": \"static\"}, which finds the equilibrium whatever the start");
  }
}

}  // namespace

void require_integrator(const Reader& top, const Scene& scene, bool IntegratorInfo::*property, const std::string& because) {
  if (integrator_info(scene.integrator).*property) return;
  top.at("integrator").fail(integrators_with(property) + ", because " + because);
}

Scene read_document(const nlohmann::json& document, const fs::path& file) {
  const std::string shown = name_of(file);
  const Reader top(document, shown, "");
  top.expect_object("scene");
  read_format(top);

  Scene scene;
  scene.file = file;
  scene.name = top.has("name") ? top.at("name").text("a text that is not empty") : file.stem().string();
  read_gravity(top, scene);
  describe_scene(ReadKeys{top}, scene);
  describe_run(ReadKeys{top}, scene);
  read_relaxation(top, scene.relaxation);
  if (scene.relaxation.enabled) require_integrator(top, scene, &IntegratorInfo::relaxation, "the scene has relaxation");
  read_solver(top, scene);
  if (top.has("focus")) scene.focus = read_focus(top.at("focus"));
  if (top.has("tools")) scene.tools = read_tools(top.at("tools"), file.parent_path());
  if (top.has("contact")) scene.contact = read_tissue_contact(top.at("contact"));
  if (top.has("blades")) scene.blades = read_blades(top.at("blades"));
  if (top.has("view")) scene.view = read_view(top.at("view"));
  read_bodies(top, file.parent_path(), scene);
  if (top.has("joins")) scene.joins = read_joins(top.at("joins"), scene);
  scene.probes = read_probes(top, scene);
  check_initial(top, scene);
  check_models(top, scene);
  check_viscous(top, scene);
  check_springs(top, scene);
  check_blades(top, scene);
  for (Body& body : scene.bodies) body.plain = blade_method(scene) != BladeMethod::virtual_nodes;
  check_tools(top, scene);
  add_faces(top, scene);
  check_tearing(top, scene);
  if (top.has("changes")) scene.changes = read_changes(top.at("changes"), scene);
  return scene;
}

Scene parse_scene(const std::string& text, const fs::path& file) {
  return read_document(parse_json(text, name_of(file)), file);
}

Scene load_scene(const fs::path& file) { return parse_scene(read_file(file), file); }

}  // namespace pliant
