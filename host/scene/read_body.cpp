#include <fmt/format.h>

#include <algorithm>

#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

namespace {

namespace fs = std::filesystem;

std::string read_name(const Reader& body, std::size_t index) {
  if (!body.has("name")) return fmt::format("body{}", index);
  const Reader field = body.at("name");
  const char* const expected = "a name of 1 to 100 characters without slashes or control characters";
  const std::string name = field.text(expected);
  // Output files and messages are named after bodies.
  const bool fits = name.size() <= 100 && name != "." && name != ".." && std::none_of(name.begin(), name.end(), [](char c) {
                      const auto code = static_cast<unsigned char>(c);
                      return code < 32 || code == 127 || c == '/' || c == '\\';
                    });
  if (!fits) field.fail(expected);
  return name;
}

fs::path read_path(const Reader& field, const fs::path& folder) {
  const fs::path path = field.text("the path of a mesh file");
  return path.is_absolute() ? path : folder / path;
}

void read_geometry(const Reader& body, const fs::path& folder, Body& b) {
  const bool surface = body.has("surface");
  const bool mesh = body.has("mesh");
  if (surface == mesh) {
    body.fail(surface ? "both \"surface\" and \"mesh\"" : "neither \"surface\" nor \"mesh\"",
              "exactly one: a surface (to be filled with a lattice) or a volume mesh");
  }
  if (surface) b.surface = read_path(body.at("surface"), folder);
  if (mesh) b.mesh = read_path(body.at("mesh"), folder);
  if (mesh) {
    if (body.has("lattice")) body.at("lattice").fail("no lattice beside a volume mesh (which has elements of its own)");
    return;
  }
  const Reader lattice = body.at("lattice", "a lattice to fill the surface, such as {\"spacing\": 0.01}");
  lattice.expect_object("lattice");
  if (lattice.has("spacing") == lattice.has("nodes")) {
    lattice.fail(lattice.has("nodes") ? "both \"spacing\" and \"nodes\"" : "neither \"spacing\" nor \"nodes\"",
                 "exactly one of them");
  }
  describe_lattice(ReadKeys{lattice}, b.lattice);
}

/// The averaged nodal pressure replaces the volumetric part of the stress, so that part must depend on J alone.
void check_pressure_law(const Reader& material, const Body& b, const Material& m) {
  if (b.element != ElementKind::tet4anp || law_info(m.law).volumetric) return;
  material.fail(
      fmt::format("the law {} with the element tet4anp", to_string(m.law)),
      laws_with(&LawInfo::volumetric) + ": the averaged nodal pressure needs a law whose volumetric part depends on J alone");
}

template <class Entry, class Read>
void read_entries(const Reader& body, const char* key, const char* kind, std::vector<Entry>& list, Read read) {
  if (!body.has(key)) return;
  for (const Reader& entry : body.at(key).items("a list of objects")) {
    entry.expect_object(kind);
    list.push_back(read(entry));
  }
}

Fixed read_fixed(const Reader& entry, const SelectionFrame& frame) {
  Fixed fixed{read_selection(entry, Selected::nodes, frame)};
  if (entry.has("axes")) fixed.axes = read_axes(entry.at("axes"));
  return fixed;
}

Force read_force(const Reader& entry, const SelectionFrame& frame) {
  return {read_selection(entry, Selected::nodes, frame), entry.at("force", "the total force [x, y, z] in newton").vec3(),
          read_curve(entry)};
}

Pressure read_pressure(const Reader& entry, const SelectionFrame& frame) {
  return {read_selection(entry, Selected::triangles, frame), entry.at("pressure", "the pressure in pascal").number(),
          read_curve(entry)};
}

}  // namespace

Body read_body(const Reader& body, const fs::path& folder, std::size_t index) {
  body.expect_object("body");
  Body b;
  b.pointer = body.pointer();
  b.name = read_name(body, index);
  read_geometry(body, folder, b);
  // A volume mesh is of tetrahedra more often than not; one of hexahedra has to say so.
  b.element = b.mesh.empty() ? ElementKind::hex8 : ElementKind::tet4;
  describe_body(ReadKeys{body}, b);
  if (body.has("model")) b.model = read_model(body.at("model"), b.mesh.empty());

  const Reader material = body.at("material", "a material such as {\"young\": 3000, \"poisson\": 0.45, \"density\": 1060}");
  b.material = read_material(material);
  if (b.model.matched) b.model.young = b.material.moduli.young();
  check_pressure_law(material, b, b.material);
  const SelectionFrame frame = frame_of(b, folder);
  read_entries(body, "inclusions", "inclusion", b.inclusions, [&](const Reader& entry) {
    const Reader other = entry.at("material", "the material of the inclusion");
    Inclusion inclusion{read_selection(entry, Selected::elements, frame), read_material(other)};
    check_pressure_law(other, b, inclusion.material);
    return inclusion;
  });
  const auto in = [&frame](auto read) { return [&frame, read](const Reader& entry) { return read(entry, frame); }; };
  read_entries(body, "fixed", "fixed", b.fixed, in(read_fixed));
  read_entries(body, "prescribed", "prescribed", b.prescribed, in(read_prescribed));
  read_entries(body, "forces", "force", b.forces, in(read_force));
  read_entries(body, "pressures", "pressure", b.pressures, in(read_pressure));
  read_entries(body, "initial", "initial", b.initial, in(read_initial));
  return b;
}

}  // namespace pliant
