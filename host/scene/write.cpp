// A scene, or the struct of the public API that describes one, as the JSON of a scene file. Words of the latter stand as they
// are: the reader refuses those that it does not know.
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/blade_face.h"
#include "scene/closed_surface.h"
#include "scene/described_keys.h"
#include "scene/keys.h"
#include "scene/link_json.h"
#include "scene/parts.h"
#include "scene/probe.h"

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

fs::path surface_of(const Selection& s) { return s.surface->file(); }
fs::path surface_of(const RegionSpec& r) { return r.surface_file; }
RegionName region_of(const Selection& s) { return s.region->name(); }
RegionName region_of(const RegionSpec& r) { return {r.region_name, r.region_number, r.region_data, r.region_dimension}; }

template <class Where>
OrderedJson selection_json(const Where& s, const fs::path& scene_file) {
  using Kind = typename Where::Kind;
  switch (s.kind) {
    case Kind::all:
      return {{"all", true}};
    case Kind::box:
      return {{"box", OrderedJson::array({s.a, s.b})}};
    case Kind::sphere:
      return {{"sphere", OrderedJson::array({s.a, s.radius})}};
    case Kind::plane:
      return {{"plane", OrderedJson::array({s.a, s.b})}};
    case Kind::nodes:
      return {{"nodes", s.nodes}};
    case Kind::surface:
      return {{"surface", path_json(surface_of(s), scene_file)}};
    case Kind::region: {
      const RegionName name = region_of(s);
      OrderedJson entry{{"region", name.name.empty() ? OrderedJson(name.number) : OrderedJson(name.name)}};
      if (!name.data.empty()) entry["data"] = name.data;
      if (name.dimension != 0) entry["dimension"] = name.dimension;
      return entry;
    }
  }
  return OrderedJson::object();
}

template <class C>
void add_curve(OrderedJson& entry, const C& curve) {
  const std::string& kind = text_of(curve_words(), curve.kind);
  entry["curve"] = kind;
  if (kind == "table") {
    entry["table"] = curve.table;
    return;
  }
  entry["start"] = curve.start;
  if (kind != "constant") entry["duration"] = curve.duration;
}

template <class S>
OrderedJson gravity_json(const S& scene) {
  if (text_of(curve_words(), scene.gravity_curve.kind) == "constant" && scene.gravity_curve.start == 0) return scene.gravity;
  OrderedJson gravity;
  describe_gravity(WriteKeys{gravity}, scene);
  add_curve(gravity, scene.gravity_curve);
  return gravity;
}

OrderedJson elastic_json(const Material& m) {
  const LawInfo& law = law_info(m.law);
  OrderedJson material{{"law", law.word}};
  if (!law.takes_moduli) {
    for (std::size_t i = 0; i < law.parameters.size(); ++i) material[law.parameters[i].name] = m.parameters.at(i);
    return material;
  }
  if (m.young_field != nullptr) {
    material["young"] = {{"field", m.young_field->name}};
    material["poisson"] = m.young_field->poisson;
    return material;
  }
  const Moduli& e = m.moduli;
  material["mu"] = e.mu;
  // The pair from which the loader computes the same three moduli to the last bit.
  if (e.lambda + 2 * e.mu / 3 == e.kappa) {
    material["lambda"] = e.lambda;
  } else {
    material["kappa"] = e.kappa;
  }
  return material;
}

OrderedJson elastic_json(const MaterialSpec& m) {
  OrderedJson material{{"law", m.law}};
  if (m.parameters.empty()) {
    const OrderedJson young = m.young_field.empty() ? OrderedJson(m.young) : OrderedJson{{"field", m.young_field}};
    material.update({{"young", young}, {"poisson", m.poisson}});
  }
  material.update(m.parameters);
  return material;
}

template <class M>
OrderedJson material_json(const M& m) {
  OrderedJson material = elastic_json(m);
  describe_material(WriteKeys{material}, m);
  return material;
}

// Which of the two chooses alpha; of a matched model neither.
void add_matching(OrderedJson& model, const DeformationModel& m) {
  if (m.matched) return;
  if (m.young != 0) {
    describe_stiffness(WriteKeys{model["stiffness"]}, m);
  } else {
    describe_alpha(WriteKeys{model}, m);
  }
}
void add_matching(OrderedJson& model, const ModelSpec& m) {
  describe_alpha(WriteKeys{model}, m);
  if (m.young) describe_stiffness(WriteKeys{model["stiffness"]}, m);
}

template <class M>
OrderedJson model_json(const M& m) {
  OrderedJson model;
  describe_type(WriteKeys{model}, m);
  if (model["type"] == to_string(ModelType::mass_spring)) {
    model["spring"] = spring_json(m.spring);
    describe_network(WriteKeys{model}, m);
    return model;
  }
  if (model["type"] == to_string(ModelType::hybrid)) {
    if (m.region) {
      model["region"] = selection_json(*m.region, {});
      if (!m.follow.empty()) model["follow"] = m.follow;  // refused
    } else {
      describe_growth(WriteKeys{model}, m);
    }
    describe_interface(WriteKeys{model}, m);
    if (m.substeps == 0) model.erase("goals");  // chosen with the substeps
  }
  describe_regions(WriteKeys{model}, m);
  add_matching(model, m);
  return model;
}

template <class F>
OrderedJson field_json(const F& field) {
  if (field.linear == std::array<Vec3d, 3>{} && field.about == Vec3d{}) return field.offset;
  OrderedJson entry;
  describe_field(WriteKeys{entry}, field);
  return entry;
}
template <class F>
OrderedJson field_json(const std::optional<F>& field) {
  return field_json(field.value_or(F{}));
}

template <class P>
void add_motion(OrderedJson& entry, const P& prescribed) {
  if (prescribed.rotate) {
    describe_rotation(WriteKeys{entry["rotate"]}, *prescribed.rotate);
    describe_axes(WriteKeys{entry}, prescribed);
  } else {
    for (const std::optional<double>& d : prescribed.displacement)
      entry["displacement"].push_back(d ? OrderedJson(*d) : OrderedJson(nullptr));
  }
  add_curve(entry, prescribed.curve);
}

/// The entries of a list, each with its selection and what `add` adds.
template <class Entry, class Add>
void add_entries(OrderedJson& body, const char* key, const std::vector<Entry>& list, const fs::path& file, const Add& add) {
  for (const Entry& e : list) {
    OrderedJson entry = selection_json(e.where, file);
    add(entry, e);
    body[key].push_back(entry);
  }
}

template <class B>
void add_conditions(OrderedJson& body, const B& b, const fs::path& file) {
  add_entries(body, "inclusions", b.inclusions, file,
              [](OrderedJson& entry, const auto& e) { entry["material"] = material_json(e.material); });
  add_entries(body, "fixed", b.fixed, file, [](OrderedJson& entry, const auto& e) { describe_axes(WriteKeys{entry}, e); });
  add_entries(body, "prescribed", b.prescribed, file, [](OrderedJson& entry, const auto& e) { add_motion(entry, e); });
  add_entries(body, "initial", b.initial, file, [](OrderedJson& entry, const auto& e) {
    entry["velocity"] = field_json(e.velocity);
    entry["displacement"] = field_json(e.displacement);
  });
  add_entries(body, "forces", b.forces, file, [](OrderedJson& entry, const auto& e) {
    describe_force(WriteKeys{entry}, e);
    add_curve(entry, e.curve);
  });
  add_entries(body, "pressures", b.pressures, file, [](OrderedJson& entry, const auto& e) {
    describe_pressure(WriteKeys{entry}, e);
    add_curve(entry, e.curve);
  });
}

fs::path surface_of(const Body& b) { return b.surface; }
fs::path surface_of(const BodySpec& b) { return in_memory(b) ? "memory" : b.surface_file; }
fs::path mesh_of(const Body& b) { return b.mesh; }
fs::path mesh_of(const BodySpec& b) { return b.volume_file; }
LatticeSpec lattice_of(const Body& b) { return b.lattice; }
LatticeSpec lattice_of(const BodySpec& b) { return {b.lattice_spacing, b.lattice_spacing == 0 ? b.lattice_nodes : 0}; }

template <class B>
OrderedJson body_json(const B& b, const fs::path& file) {
  OrderedJson body{{"name", b.name}};
  if (const fs::path mesh = mesh_of(b); !mesh.empty()) {
    body["mesh"] = path_json(mesh, file);
  } else {
    body["surface"] = path_json(surface_of(b), file);
    if (b.thickness == 0) {
      body["lattice"] = OrderedJson::object();
      describe_lattice(WriteKeys{body["lattice"]}, lattice_of(b));
    }
  }
  describe_body(WriteKeys{body}, b);
  // In code the default is that of lattices.
  if (b.thickness > 0 && body["element"] == to_string(usual_element(8))) body.erase("element");
  body["material"] = material_json(b.material);
  if (b.membrane) describe_membrane(WriteKeys{body["membrane"]}, *b.membrane);
  for (const auto& vessel : b.vessels) body["vessels"].push_back(vessel_json(vessel));
  for (const auto& list : b.springs) body["springs"].push_back(spring_list_json(list));
  if (text_of(model_words(), b.model.type) != to_string(ModelType::tled)) body["model"] = model_json(b.model);
  add_conditions(body, b, file);
  return body;
}

template <class T>
OrderedJson shape_json(ToolShape shape, const T& t, const fs::path& file) {
  switch (shape) {
    case ToolShape::sphere:
      return t.radius;
    case ToolShape::capsule:
      return OrderedJson::array({t.first, t.second, t.radius});
    case ToolShape::box:
      return t.size;
    case ToolShape::half_space:
      return OrderedJson::array({t.first, t.second});
    case ToolShape::mesh:
    case ToolShape::sequence:
    case ToolShape::blade_face:
      break;
  }
  return path_json(t.mesh, file);
}

template <class T>
OrderedJson any_tool_json(const T& t, const fs::path& file) {
  OrderedJson tool = OrderedJson::object();
  if (!t.name.empty()) tool["name"] = t.name;
  const std::string& shape = text_of(tool_shape_words(), t.shape);
  tool["shape"] = shape;  // refused, unless it is one of these words
  for (const Word<ToolShape>& w : tool_shape_words()) {
    if (w.word == shape) tool["shape"] = {{shape, shape_json(w.value, t, file)}};
  }
  if (!t.path.empty()) tool["path"] = t.path;
  describe_tool(WriteKeys{tool}, t);
  describe_contact_law(WriteKeys{tool["contact"]}, t);
  if (tool["contact"].empty()) tool.erase("contact");
  if (t.grip) tool["grip"] = grip_json(*t.grip);
  return tool;
}

template <class B>
OrderedJson blade_json(const B& b) {
  OrderedJson blade = OrderedJson::object();
  if (!b.name.empty()) blade["name"] = b.name;
  blade["path"] = b.path;
  describe_blade(WriteKeys{blade}, b);
  return blade;
}

template <class P>
OrderedJson probe_json(const P& p, const fs::path& file) {
  const bool selects = !p.point && p.between.empty();
  OrderedJson probe = selects ? selection_json(p.where, file) : OrderedJson::object();
  describe_place(WriteKeys{probe}, p);
  if (selects && !p.body.empty()) probe["body"] = p.body;
  if (!p.between.empty()) probe["between"] = p.between;
  probe["name"] = p.name;
  for (const auto& q : p.quantities) probe["quantities"].push_back(text_of(quantity_words(), q));
  return probe;
}

const std::vector<std::array<double, 4>>& focus_path(const Scene& scene) { return scene.focus.path; }
const std::vector<std::array<double, 4>>& focus_path(const SceneSpec& scene) { return scene.focus_path; }

/// Faces of blades are written with their blade.
bool of_blade(const ContactTool& tool) { return is_face(tool); }
bool of_blade(const ToolSpec& /*tool*/) { return false; }

/// What both have but their probes.
template <class S>
OrderedJson top_json(const S& scene, const fs::path& file) {
  OrderedJson top{{"format", "pliant-scene/1"}};
  if (!scene.name.empty()) top["name"] = scene.name;
  top["gravity"] = gravity_json(scene);
  describe_scene(WriteKeys{top}, scene);
  if (!focus_path(scene).empty()) top["focus"] = {{"path", focus_path(scene)}};
  for (const auto& t : scene.tools) {
    if (!of_blade(t)) top["tools"].push_back(tool_json(t, file));
  }
  if (scene.contact) describe_friction(WriteKeys{top["contact"]}, *scene.contact);
  for (const auto& b : scene.blades) top["blades"].push_back(blade_json(b));
  top["bodies"] = OrderedJson::array();
  for (const auto& b : scene.bodies) top["bodies"].push_back(body_json(b, file));
  return top;
}

void add_change(OrderedJson& top, double time, const OrderedJson& change) {
  OrderedJson entry{{"time", time}};
  entry.update(change);
  top["changes"].push_back(entry);
}

}  // namespace

OrderedJson change_json(const ChangeSpec& change) {
  OrderedJson entry = OrderedJson::object();
  if (change.gravity) entry["gravity"] = *change.gravity;
  if (!change.body.empty()) entry["body"] = change.body;
  if (change.inclusion) entry["inclusion"] = *change.inclusion;
  if (change.material) entry["material"] = material_json(*change.material);
  if (change.damping) entry["material"]["damping"] = *change.damping;
  if (change.model) entry["model"] = model_json(*change.model);
  if (!change.fixed) return entry;
  entry["fixed"] = OrderedJson::array();
  add_entries(entry, "fixed", *change.fixed, {}, [](OrderedJson& one, const auto& e) { describe_axes(WriteKeys{one}, e); });
  return entry;
}

OrderedJson document_of(const Scene& scene) {
  OrderedJson top = top_json(scene, scene.file);
  describe_run(WriteKeys{top}, scene);
  add_joins(top, scene.joins);
  if (scene.relaxation.enabled) {
    describe_relaxation(WriteKeys{top["relaxation"]}, scene.relaxation);
  } else {
    top["relaxation"] = false;
  }
  if (scene.solver.enabled) describe_solver(WriteKeys{top["solver"]}, scene.solver);
  OrderedJson view = OrderedJson::object();
  describe_view(WriteKeys{view}, scene.view);
  if (!view.empty()) top["view"] = view;
  for (const SceneChange& c : scene.changes) add_change(top, c.time, OrderedJson::parse(c.text));
  if (scene.probes == nullptr) return top;
  top["probes"] = OrderedJson::array();
  for (const SceneProbe& p : scene.probes->list) top["probes"].push_back(probe_json(p, scene.file));
  if (scene.probes->every_steps > 0) describe_pace(WriteKeys{top["probe_every"]}, *scene.probes);
  if (scene.probes->every_seconds > 0) top["probe_every"] = scene.probes->every_seconds;
  return top;
}

OrderedJson document_of(const SceneSpec& spec) {
  OrderedJson top = top_json(spec, {});
  add_joins(top, spec.joins);
  if (spec.relaxation) describe_relaxation(WriteKeys{top["relaxation"]}, *spec.relaxation);
  for (const ProbeSpec& p : spec.probes) top["probes"].push_back(probe_json(p, {}));
  for (const ChangeSpec& c : spec.changes) add_change(top, c.time, change_json(c));
  return top;
}

OrderedJson tool_json(const ContactTool& tool, const fs::path& scene_file) { return any_tool_json(tool, scene_file); }
OrderedJson tool_json(const ToolSpec& tool, const fs::path& scene_file) { return any_tool_json(tool, scene_file); }

std::string scene_to_json(const Scene& scene) {
  return document_of(scene).dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace pliant
