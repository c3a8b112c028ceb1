// A scene back into its file format.
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/closed_surface.h"
#include "scene/described_keys.h"
#include "scene/keys.h"
#include "scene/parts.h"
#include "scene/probe.h"
#include "scene/spec.h"

namespace pliant {

namespace {

using OrderedJson = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string path_json(const fs::path& path, const fs::path& scene_file) {
  const fs::path folder = scene_file.parent_path();
  if (path.is_absolute() || folder.empty()) return path.string();
  const fs::path relative = path.lexically_relative(folder);
  return relative.empty() ? fs::absolute(path).string() : relative.string();
}

OrderedJson selection_json(const Selection& s, const fs::path& scene_file) {
  switch (s.kind) {
    case Selection::Kind::all:
      return {{"all", true}};
    case Selection::Kind::box:
      return {{"box", OrderedJson::array({s.a, s.b})}};
    case Selection::Kind::sphere:
      return {{"sphere", OrderedJson::array({s.a, s.radius})}};
    case Selection::Kind::plane:
      return {{"plane", OrderedJson::array({s.a, s.b})}};
    case Selection::Kind::nodes:
      return {{"nodes", s.nodes}};
    case Selection::Kind::surface:
      return {{"surface", path_json(s.surface->file(), scene_file)}};
    case Selection::Kind::region: {
      const RegionName& name = s.region->name();
      OrderedJson entry{{"region", name.name.empty() ? OrderedJson(name.number) : OrderedJson(name.name)}};
      if (!name.data.empty()) entry["data"] = name.data;
      if (name.dimension != 0) entry["dimension"] = name.dimension;
      return entry;
    }
  }
  return OrderedJson::object();
}

void add_curve(OrderedJson& entry, const Curve& curve) {
  entry["curve"] = word_of(curve_words(), curve.kind);
  if (curve.kind == Curve::Kind::table) {
    entry["table"] = curve.table;
    return;
  }
  entry["start"] = curve.start;
  if (curve.kind != Curve::Kind::constant) entry["duration"] = curve.duration;
}

OrderedJson gravity_json(const Scene& scene) {
  if (scene.gravity_curve.kind == Curve::Kind::constant && scene.gravity_curve.start == 0) return scene.gravity;
  OrderedJson gravity{{"acceleration", scene.gravity}};
  add_curve(gravity, scene.gravity_curve);
  return gravity;
}

OrderedJson material_json(const Material& m) {
  const LawInfo& law = law_info(m.law);
  OrderedJson material{{"law", law.word}};
  if (!law.takes_moduli) {
    for (std::size_t i = 0; i < law.parameters.size(); ++i) material[law.parameters[i].name] = m.parameters.at(i);
  } else {
    const Moduli& e = m.moduli;
    material["mu"] = e.mu;
    // The pair from which the loader computes the same three moduli to the last bit.
    if (e.lambda + 2 * e.mu / 3 == e.kappa) {
      material["lambda"] = e.lambda;
    } else {
      material["kappa"] = e.kappa;
    }
  }
  describe_material(WriteKeys{material}, m);
  if (m.toughness != 0) describe_tearing(WriteKeys{material}, m);
  return material;
}

OrderedJson model_json(const DeformationModel& m) {
  OrderedJson model{{"type", to_string(m.type)}};
  if (m.type == ModelType::hybrid) {
    if (m.region) {
      model["region"] = selection_json(*m.region, {});
    } else {
      model["ratio"] = m.ratio;
      if (m.seed) model["seed"] = *m.seed;
      if (m.follow) model["follow"] = word_of(follow_words(), m.follow);
    }
    model["beta"] = m.beta != 0 ? OrderedJson(m.beta) : OrderedJson("auto");
    model["substeps"] = m.substeps;
    model["goals"] = word_of(goals_words(), m.extrapolate);
    model["coupling"] = word_of(coupling_words(), m.conservative);
  }
  model["width"] = m.width;
  if (m.matched) {
    // What a reader does without either.
  } else if (m.young != 0) {
    model["stiffness"] = {{"young", m.young}};
  } else {
    model["alpha"] = m.alpha;
  }
  model["damping"] = m.damping;
  model["cut"] = m.cut;
  return model;
}

std::string axes_text(const std::array<bool, 3>& axes) {
  std::string text;
  for (int c = 0; c < 3; ++c) {
    if (axes[c]) text += "xyz"[c];
  }
  return text;
}

OrderedJson field_json(const AffineField& field) {
  if (field.linear == std::array<Vec3d, 3>{} && field.about == Vec3d{}) return field.offset;
  return {{"linear", field.linear}, {"about", field.about}, {"offset", field.offset}};
}

void add_conditions(OrderedJson& body, const Body& b, const fs::path& file) {
  for (const Inclusion& inclusion : b.inclusions) {
    OrderedJson entry = selection_json(inclusion.where, file);
    entry["material"] = material_json(inclusion.material);
    body["inclusions"].push_back(entry);
  }
  for (const Fixed& fixed : b.fixed) {
    OrderedJson entry = selection_json(fixed.where, file);
    entry["axes"] = axes_text(fixed.axes);
    body["fixed"].push_back(entry);
  }
  for (const Prescribed& prescribed : b.prescribed) {
    OrderedJson entry = selection_json(prescribed.where, file);
    if (prescribed.rotate) {
      const Rotation& r = *prescribed.rotate;
      entry["rotate"] = {{"axis", r.axis}, {"about", r.about}, {"angle", r.angle}};
      entry["axes"] = axes_text(prescribed.axes);
    } else {
      for (const std::optional<double>& d : prescribed.displacement)
        entry["displacement"].push_back(d ? OrderedJson(*d) : OrderedJson(nullptr));
    }
    add_curve(entry, prescribed.curve);
    body["prescribed"].push_back(entry);
  }
  for (const Initial& initial : b.initial) {
    OrderedJson entry = selection_json(initial.where, file);
    entry["velocity"] = field_json(initial.velocity);
    entry["displacement"] = field_json(initial.displacement);
    body["initial"].push_back(entry);
  }
  for (const Force& force : b.forces) {
    OrderedJson entry = selection_json(force.where, file);
    entry["force"] = force.total;
    add_curve(entry, force.curve);
    body["forces"].push_back(entry);
  }
  for (const Pressure& pressure : b.pressures) {
    OrderedJson entry = selection_json(pressure.where, file);
    entry["pressure"] = pressure.pressure;
    add_curve(entry, pressure.curve);
    body["pressures"].push_back(entry);
  }
}

OrderedJson body_json(const Body& b, const fs::path& scene_file) {
  OrderedJson body{{"name", b.name}};
  if (b.mesh.empty()) {
    body["surface"] = path_json(b.surface, scene_file);
  } else {
    body["mesh"] = path_json(b.mesh, scene_file);
  }
  body["scale"] = b.scale;
  body["translate"] = b.translate;
  if (b.mesh.empty()) {
    body["lattice"] =
        b.lattice.spacing != 0 ? OrderedJson{{"spacing", b.lattice.spacing}} : OrderedJson{{"nodes", b.lattice.nodes}};
  }
  body["element"] = to_string(b.element);
  body["material"] = material_json(b.material);
  if (b.model.type != ModelType::tled) body["model"] = model_json(b.model);
  add_conditions(body, b, scene_file);
  body["velocity"] = b.velocity;
  body["angular_velocity"] = b.angular_velocity;
  return body;
}

OrderedJson blade_json(const Blade& b) {
  OrderedJson blade{{"name", b.name}, {"path", b.path}};
  if (std::isfinite(b.start)) blade["start"] = b.start;
  if (std::isfinite(b.end)) blade["end"] = b.end;
  return blade;
}

OrderedJson view_json(const SceneView& v) {
  OrderedJson view = OrderedJson::object();
  if (v.eye) view["eye"] = *v.eye;
  if (v.target) view["target"] = *v.target;
  if (v.up) view["up"] = *v.up;
  if (v.field_of_view != SceneView{}.field_of_view) view["field_of_view"] = v.field_of_view;
  if (!v.ground) view["ground"] = false;
  return view;
}

void add_probes(OrderedJson& top, const Scene& scene) {
  if (scene.probes == nullptr) return;
  top["probes"] = OrderedJson::array();
  for (const SceneProbe& p : scene.probes->list) {
    OrderedJson probe = p.point ? OrderedJson{{"point", *p.point}} : selection_json(p.where, scene.file);
    if (!p.point) probe["body"] = p.body;
    probe["name"] = p.name;
    for (const Quantity q : p.quantities) probe["quantities"].push_back(word_of(quantity_words(), q));
    top["probes"].push_back(probe);
  }
  if (scene.probes->every_steps > 0) top["probe_every"] = {{"steps", scene.probes->every_steps}};
  if (scene.probes->every_seconds > 0) top["probe_every"] = scene.probes->every_seconds;
}

// Nothing is left out because of its value, or validate() would not see it: 0 alone means "auto".
OrderedJson document_of(const Scene& scene) {
  OrderedJson top{{"format", "pliant-scene/1"}};
  if (!scene.name.empty()) top["name"] = scene.name;
  top["gravity"] = gravity_json(scene);
  describe_scene(WriteKeys{top}, scene);
  describe_run(WriteKeys{top}, scene);
  if (scene.relaxation.enabled) {
    describe_relaxation(WriteKeys{top["relaxation"]}, scene.relaxation);
  } else {
    top["relaxation"] = false;
  }
  if (scene.solver.enabled) {
    top["solver"] = {{"type", "static"}, {"order", scene.solver.quadratic ? 2 : 1}};
    describe_solver(WriteKeys{top["solver"]}, scene.solver);
  }
  if (!scene.tool.path.empty()) top["tool"] = {{"path", scene.tool.path}};
  for (const ContactTool& t : scene.tools) top["tools"].push_back(tool_json(t, scene.file));
  if (scene.contact) describe_friction(WriteKeys{top["contact"]}, *scene.contact);
  for (const Blade& b : scene.blades) top["blades"].push_back(blade_json(b));
  if (const OrderedJson view = view_json(scene.view); !view.empty()) top["view"] = view;
  add_probes(top, scene);
  top["bodies"] = OrderedJson::array();
  for (const Body& b : scene.bodies) top["bodies"].push_back(body_json(b, scene.file));
  return top;
}

}  // namespace

OrderedJson tool_json(const ContactTool& t, const std::filesystem::path& scene_file) {
  OrderedJson tool{{"name", t.name}};
  OrderedJson& shape = tool["shape"];
  const std::string& word = word_of(tool_shape_words(), t.shape);
  switch (t.shape) {
    case ToolShape::sphere:
      shape[word] = t.radius;
      break;
    case ToolShape::capsule:
      shape[word] = {t.first, t.second, t.radius};
      break;
    case ToolShape::box:
      shape[word] = t.size;
      break;
    case ToolShape::half_space:
      shape[word] = {t.first, t.second};
      break;
    case ToolShape::mesh:
    case ToolShape::sequence:
      shape[word] = path_json(t.mesh, scene_file);
      break;
  }
  if (!t.path.empty()) tool["path"] = t.path;
  describe_tool(WriteKeys{tool}, t);
  if (!t.mesh.empty() || t.scale != 1) describe_mesh_tool(WriteKeys{tool}, t);
  if (t.shape == ToolShape::sequence || t.frames_per_second != ContactTool{}.frames_per_second)
    describe_sequence_tool(WriteKeys{tool}, t);
  if (t.stiffness != 0) tool["contact"]["stiffness"] = t.stiffness;
  if (t.stiffness != 0 || t.exponent != 1) tool["contact"]["exponent"] = t.exponent;
  if (t.stiffness != 0 || t.alpha != 0) tool["contact"]["alpha"] = t.alpha;
  return tool;
}

std::string scene_to_json(const Scene& scene) {
  return document_of(scene).dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

void validate(const Scene& scene) { (void)read_document(document_of(scene), scene.file); }

}  // namespace pliant
