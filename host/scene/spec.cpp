#include "scene/spec.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/mesh.h"
#include "pliant/error.h"
#include "scene/closed_surface.h"
#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

namespace {

const std::string kName = "scene";  // in messages, where a file would stand

template <class Enum>
Enum word(const Words<Enum>& words, const std::string& text, const std::string& pointer) {
  const nlohmann::json value = text;
  return Reader(value, kName, pointer).word(words);
}

/// `body`: whose scale and translate a surface shares, and whose mesh has the regions; null: there is none.
Selection selection(const RegionSpec& r, const std::string& pointer, const BodySpec* body,
                    const std::shared_ptr<const TaggedMesh>& mesh = nullptr, Selected of = Selected::nodes) {
  Selection s;
  switch (r.kind) {
    case RegionSpec::Kind::all:
      break;
    case RegionSpec::Kind::box:
      s = {Selection::Kind::box, r.a, r.b, 0, {}, ""};
      break;
    case RegionSpec::Kind::sphere:
      s = {Selection::Kind::sphere, r.a, {}, r.radius, {}, ""};
      break;
    case RegionSpec::Kind::plane:
      s = {Selection::Kind::plane, r.a, r.b, 0, {}, ""};
      break;
    case RegionSpec::Kind::nodes:
      s = {Selection::Kind::nodes, {}, {}, 0, r.nodes, ""};
      std::sort(s.nodes.begin(), s.nodes.end());
      break;
    case RegionSpec::Kind::surface:
      s.kind = Selection::Kind::surface;
      s.surface = std::make_shared<const ClosedSurface>(r.surface_file, body != nullptr ? body->scale : 1,
                                                        body != nullptr ? body->translate : Vec3d{}, pointer + "/surface");
      break;
    case RegionSpec::Kind::region:
      s.kind = Selection::Kind::region;
      s.region = std::make_shared<const MeshRegion>(
          mesh, RegionName{r.region_name, r.region_number, r.region_data, r.region_dimension}, of, pointer + "/region");
      break;
  }
  s.pointer = pointer;
  return s;
}

Curve curve(const CurveSpec& c, const std::string& pointer) {
  Curve out;
  out.kind = word(curve_words(), c.kind, pointer + "/curve");
  if (out.kind == Curve::Kind::table) {
    out.table = c.table;
  } else {
    out.start = c.start;
    if (out.kind != Curve::Kind::constant) out.duration = c.duration;
  }
  return out;
}

/// Elastic constants become moduli and parameters here, so what is wrong with them is found here, by the reader's own rules.
Material material(const MaterialSpec& m, const std::string& pointer) {
  nlohmann::json keys(m.parameters);
  if (m.parameters.empty()) keys = {{"young", m.young}, {"poisson", m.poisson}};
  keys["law"] = m.law;
  keys["density"] = m.density;
  keys["damping"] = m.damping;
  keys["hourglass"] = m.hourglass;
  if (m.toughness) keys["toughness"] = *m.toughness;
  if (m.integrity) keys["integrity"] = *m.integrity;
  return read_material(Reader(keys, kName, pointer));
}

DeformationModel model(const ModelSpec& m, const std::string& pointer) {
  DeformationModel out;
  out.pointer = pointer;
  out.type = word(model_words(), m.type, pointer + "/type");
  out.ratio = m.ratio;
  out.seed = m.seed;
  if (m.region) out.region = selection(*m.region, pointer + "/region", nullptr);
  out.follow = m.follow_tool;
  out.beta = m.beta.value_or(0);
  out.width = m.width;
  out.alpha = m.alpha.value_or(out.alpha);
  out.young = m.young.value_or(0);
  out.matched = out.type == ModelType::hybrid && !m.alpha && !m.young;
  out.damping = m.damping;
  out.substeps = m.substeps;
  out.extrapolate = word(goals_words(), m.goals, pointer + "/goals");
  out.conservative = word(coupling_words(), m.coupling, pointer + "/coupling");
  out.cut = m.cut;
  return out;
}

std::array<bool, 3> axes(const std::string& letters, const std::string& pointer) {
  std::array<bool, 3> out{false, false, false};
  for (const char c : letters.empty() ? std::string("?") : letters) {
    if (c < 'x' || c > 'z' || out[c - 'x']) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: {}: got \"{}\", expected one to three different letters of xyz", kName, pointer, letters));
    }
    out[c - 'x'] = true;
  }
  return out;
}

/// make(entry, pointer) for each entry of a list.
template <class Out, class In, class Make>
void convert(std::vector<Out>& out, const std::vector<In>& in, const std::string& pointer, Make make) {
  for (const In& entry : in) out.push_back(make(entry, fmt::format("{}/{}", pointer, out.size())));
}

AffineField field(const std::optional<FieldSpec>& f) {
  if (!f) return {};
  return {f->offset, f->linear, f->about};
}

void add_conditions(const BodySpec& spec, Body& b) {
  const std::shared_ptr<const TaggedMesh> mesh = frame_of(b, {}).mesh;
  const auto selected = [&](const RegionSpec& where, const std::string& at, Selected of = Selected::nodes) {
    return selection(where, at, &spec, mesh, of);
  };
  convert(b.inclusions, spec.inclusions, b.pointer + "/inclusions", [&selected](const InclusionSpec& s, const std::string& at) {
    return Inclusion{selected(s.where, at, Selected::elements), material(s.material, at + "/material")};
  });
  convert(b.fixed, spec.fixed, b.pointer + "/fixed", [&selected](const FixedSpec& s, const std::string& at) {
    return Fixed{selected(s.where, at), axes(s.axes, at + "/axes")};
  });
  convert(b.prescribed, spec.prescribed, b.pointer + "/prescribed",
          [&selected](const PrescribedSpec& s, const std::string& at) {
            Prescribed out{selected(s.where, at), s.displacement, curve(s.curve, at)};
            if (s.rotate) out.rotate = Rotation{s.rotate->axis, s.rotate->about, s.rotate->angle};
            if (s.rotate) out.axes = axes(s.axes, at + "/axes");
            return out;
          });
  convert(b.initial, spec.initial, b.pointer + "/initial", [&selected](const InitialSpec& s, const std::string& at) {
    return Initial{selected(s.where, at), field(s.velocity), field(s.displacement)};
  });
  convert(b.forces, spec.forces, b.pointer + "/forces", [&selected](const ForceSpec& s, const std::string& at) {
    return Force{selected(s.where, at), s.force, curve(s.curve, at)};
  });
  convert(b.pressures, spec.pressures, b.pointer + "/pressures", [&selected](const PressureSpec& s, const std::string& at) {
    return Pressure{selected(s.where, at, Selected::triangles), s.pressure, curve(s.curve, at)};
  });
}

/// `surfaces`: surfaces in memory so far.
Body body(const BodySpec& spec, const std::string& pointer, std::size_t& surfaces) {
  const bool in_memory = !spec.surface.vertices.empty() || !spec.surface.triangles.empty();
  if (int{in_memory} + int{!spec.surface_file.empty()} + int{!spec.volume_file.empty()} != 1) {
    throw Error(ErrorCode::bad_input,
                fmt::format("body \"{}\": exactly one of surface, surface_file and volume_file must be set", spec.name));
  }
  Body b;
  b.pointer = pointer;
  b.name = spec.name;
  b.mesh = spec.volume_file;
  b.surface = spec.surface_file;
  if (in_memory) {
    b.surface = fmt::format("memory:{}", surfaces++);
    b.surface_in_memory = std::make_shared<const TriangleMesh>(TriangleMesh{spec.surface.vertices, spec.surface.triangles});
  }
  b.scale = spec.scale;
  b.translate = spec.translate;
  if (b.mesh.empty()) {
    b.lattice.spacing = spec.lattice_spacing;
    if (spec.lattice_spacing == 0) b.lattice.nodes = spec.lattice_nodes;
  }
  b.element = word(element_words(), spec.element, pointer + "/element");
  b.material = material(spec.material, pointer + "/material");
  if (spec.model.type != to_string(ModelType::tled)) b.model = model(spec.model, pointer + "/model");
  b.model.pointer = pointer + "/model";
  if (b.model.matched) b.model.young = b.material.moduli.young();
  add_conditions(spec, b);
  b.velocity = spec.velocity;
  b.angular_velocity = spec.angular_velocity;
  return b;
}

SceneProbe probe(const ProbeSpec& spec, const std::string& pointer, const SceneSpec& all, const std::vector<Body>& bodies) {
  SceneProbe out;
  out.name = spec.name;
  out.pointer = pointer;
  convert(out.quantities, spec.quantities, pointer + "/quantities",
          [](const std::string& text, const std::string& at) { return word(quantity_words(), text, at); });
  if (spec.quantities.empty()) out.quantities = {Quantity::position, Quantity::displacement, Quantity::velocity};
  out.point = spec.point;
  if (out.point) return out;
  out.body = spec.body.empty() && bodies.size() == 1 ? bodies[0].name : spec.body;
  // A name that no body has is refused by validate().
  std::size_t b = 0;
  while (b < bodies.size() && bodies[b].name != out.body) ++b;
  const bool known = b < bodies.size();
  out.where = selection(spec.where, pointer, known ? &all.bodies[b] : nullptr, known ? frame_of(bodies[b], {}).mesh : nullptr);
  return out;
}

}  // namespace

ContactTool contact_tool(const ToolSpec& spec, const std::string& shape_pointer, const std::string& name) {
  ContactTool t;
  t.name = spec.name.empty() ? name : spec.name;
  t.shape = word(tool_shape_words(), spec.shape, shape_pointer);
  t.radius = spec.radius;
  t.first = spec.first;
  t.second = spec.second;
  t.size = spec.size;
  t.mesh = spec.mesh;
  const CopyKeys copy{kName};
  describe_tool(copy, t, spec);
  describe_mesh_tool(copy, t, spec);
  describe_sequence_tool(copy, t, spec);
  t.path = spec.path;
  t.stiffness = spec.stiffness;
  t.exponent = spec.exponent;
  t.alpha = spec.alpha;
  return t;
}

Scene scene_of(const SceneSpec& spec) {
  Scene scene;
  scene.name = spec.name;
  scene.gravity = spec.gravity;
  scene.gravity_curve = curve(spec.gravity_curve, "/gravity");
  const CopyKeys copy{kName};
  describe_scene(copy, scene, spec);
  scene.relaxation.enabled = spec.relaxation.has_value();
  if (spec.relaxation) describe_relaxation(copy, scene.relaxation, *spec.relaxation);
  scene.tool.path = spec.tool_path;
  convert(scene.blades, spec.blades, "/blades", [&](const BladeSpec& s, const std::string& at) {
    Blade b;
    b.name = s.name.empty() ? fmt::format("blade{}", scene.blades.size()) : s.name;
    b.path = s.path;
    if (s.start) b.start = *s.start;
    if (s.end) b.end = *s.end;
    b.pointer = at;
    return b;
  });
  convert(scene.tools, spec.tools, "/tools", [&](const ToolSpec& s, const std::string& at) {
    ContactTool tool = contact_tool(s, at + "/shape", fmt::format("tool{}", scene.tools.size()));
    tool.pointer = at;
    return tool;
  });
  if (spec.contact) describe_friction(copy, scene.contact.emplace(), *spec.contact);
  std::size_t surfaces = 0;
  convert(scene.bodies, spec.bodies, "/bodies",
          [&](const BodySpec& s, const std::string& at) { return body(s, at, surfaces); });
  SceneProbes probes;
  convert(probes.list, spec.probes, "/probes",
          [&](const ProbeSpec& s, const std::string& at) { return probe(s, at, spec, scene.bodies); });
  if (!probes.list.empty()) scene.probes = std::make_shared<const SceneProbes>(std::move(probes));
  validate(scene);
  return scene;
}

}  // namespace pliant
