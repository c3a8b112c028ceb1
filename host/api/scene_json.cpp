#include "api/scene_json.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "geometry/mesh.h"
#include "pliant/error.h"

namespace pliant {

SurfaceSpec box_surface(const Vec3d& lower, const Vec3d& upper) {
  SurfaceSpec box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.push_back(
        {i & 1 ? upper[0] : lower[0], (i >> 1) & 1 ? upper[1] : lower[1], (i >> 2) & 1 ? upper[2] : lower[2]});
  }
  box.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return box;
}

namespace api {
namespace {

using Json = nlohmann::ordered_json;
const std::string kMemory = "memory:";

Json region(const RegionSpec& r) {
  switch (r.kind) {
    case RegionSpec::Kind::box:
      return {{"box", Json::array({r.a, r.b})}};
    case RegionSpec::Kind::sphere:
      return {{"sphere", Json::array({r.a, r.radius})}};
    case RegionSpec::Kind::plane:
      return {{"plane", Json::array({r.a, r.b})}};
    case RegionSpec::Kind::nodes:
      return {{"nodes", r.nodes}};
    case RegionSpec::Kind::all:
      break;
  }
  return {{"all", true}};
}

void add_curve(Json& entry, const CurveSpec& curve) {
  entry["curve"] = curve.kind;
  if (curve.kind == "table") {
    entry["table"] = curve.table;
    return;
  }
  entry["start"] = curve.start;
  if (curve.kind != "constant") entry["duration"] = curve.duration;
}

Json material(const MaterialSpec& m) {
  return {{"law", m.law}, {"young", m.young}, {"poisson", m.poisson}, {"density", m.density}, {"damping", m.damping}};
}

Json model(const ModelSpec& m) {
  Json json{{"type", m.type}};
  if (m.type == "tled") return json;
  if (m.type == "hybrid") {
    json["ratio"] = m.ratio;
    if (m.seed) json["seed"] = *m.seed;
    if (m.follow_tool) json["follow"] = "tool";
    if (m.beta) json["beta"] = *m.beta;
    json["substeps"] = m.substeps;
  }
  json["width"] = m.width;
  if (m.young) {
    json["stiffness"] = {{"young", *m.young}};
  } else {
    json["alpha"] = m.alpha;
  }
  json["damping"] = m.damping;
  return json;
}

/// One list per kind of entry: `fill` adds what is its own.
template <class Entries, class Fill>
void add_list(Json& body, const char* key, const Entries& entries, Fill&& fill) {
  for (const auto& e : entries) {
    Json entry = region(e.where);
    fill(entry, e);
    body[key].push_back(entry);
  }
}

void add_entries(Json& body, const BodySpec& b) {
  add_list(body, "inclusions", b.inclusions, [](Json& j, const InclusionSpec& e) { j["material"] = material(e.material); });
  add_list(body, "fixed", b.fixed, [](Json& j, const FixedSpec& e) { j["axes"] = e.axes; });
  add_list(body, "prescribed", b.prescribed, [](Json& j, const PrescribedSpec& e) {
    for (const auto& d : e.displacement) j["displacement"].push_back(d ? Json(*d) : Json(nullptr));
    add_curve(j, e.curve);
  });
  add_list(body, "forces", b.forces, [](Json& j, const ForceSpec& e) {
    j["force"] = e.force;
    add_curve(j, e.curve);
  });
  add_list(body, "pressures", b.pressures, [](Json& j, const PressureSpec& e) {
    j["pressure"] = e.pressure;
    add_curve(j, e.curve);
  });
}

Json body(const BodySpec& b, std::vector<SurfaceSpec>& surfaces) {
  const bool in_memory = !b.surface.vertices.empty() || !b.surface.triangles.empty();
  if (int{in_memory} + int{!b.surface_file.empty()} + int{!b.volume_file.empty()} != 1) {
    throw Error(ErrorCode::bad_input,
                fmt::format("body \"{}\": exactly one of surface, surface_file and volume_file must be set", b.name));
  }
  Json json{{"name", b.name}};
  if (!b.volume_file.empty()) {
    json["mesh"] = b.volume_file;
  } else {
    json["surface"] = in_memory ? kMemory + std::to_string(surfaces.size()) : b.surface_file;
    json["lattice"] = b.lattice_spacing != 0 ? Json{{"spacing", b.lattice_spacing}} : Json{{"nodes", b.lattice_nodes}};
  }
  if (in_memory) surfaces.push_back(b.surface);
  json["scale"] = b.scale;
  json["translate"] = b.translate;
  json["element"] = b.element;
  json["material"] = material(b.material);
  if (b.model.type != "tled") json["model"] = model(b.model);
  add_entries(json, b);
  json["velocity"] = b.velocity;
  json["angular_velocity"] = b.angular_velocity;
  return json;
}

}  // namespace

std::string scene_text(const SceneSpec& spec, std::vector<SurfaceSpec>& surfaces) {
  Json top{{"format", "pliant-scene/1"}, {"name", spec.name}, {"gravity", spec.gravity}};
  top["dt"] = spec.dt != 0 ? Json(spec.dt) : Json("auto");
  top["safety"] = spec.safety;
  if (!spec.tool_path.empty()) top["tool"] = {{"path", spec.tool_path}};
  top["bodies"] = Json::array();
  for (const BodySpec& b : spec.bodies) top["bodies"].push_back(body(b, surfaces));
  return top.dump(1, ' ', false, Json::error_handler_t::replace);
}

Scene read_scene(const std::string& text, const std::string& file, const std::vector<SurfaceSpec>& surfaces) {
  Scene scene = parse_scene(text, file);
  for (Body& b : scene.bodies) {
    const std::string name = b.surface.filename().string();
    if (name.rfind(kMemory, 0) != 0) continue;
    std::size_t number = surfaces.size();
    std::from_chars(name.data() + kMemory.size(), name.data() + name.size(), number);
    if (number >= surfaces.size()) {
      throw Error(ErrorCode::bad_input, fmt::format("{}/surface: got \"{}\", but {} surfaces were given in memory", b.pointer,
                                                    name, surfaces.size()));
    }
    b.surface = name;
    b.surface_in_memory =
        std::make_shared<const TriangleMesh>(TriangleMesh{surfaces[number].vertices, surfaces[number].triangles});
  }
  return scene;
}

}  // namespace api
}  // namespace pliant
