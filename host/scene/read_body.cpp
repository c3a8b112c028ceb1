#include <fmt/format.h>

#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

namespace {

namespace fs = std::filesystem;

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
    if (body.has("lattice")) body.at("lattice").fail("no lattice with a volume mesh (which has elements of its own)");
    if (body.has("thickness"))
      body.at("thickness").fail("no thickness with a volume mesh (that of a \"surface\" makes a sheet of it)");
    return;
  }
  if (body.has("thickness")) {
    if (body.has("lattice")) body.at("lattice").fail("no lattice with a \"thickness\", which makes the surface a sheet");
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
  if (!element_info(b.element).averaged || law_info(m.law).volumetric) return;
  material.fail(
      fmt::format("the law {} with the element {}", to_string(m.law), to_string(b.element)),
      laws_with(&LawInfo::volumetric) + ": the averaged nodal pressure needs a law whose volumetric part depends on J alone");
}

/// The entries of a list: a selection each, and what `read` reads.
template <class Entry, class Read>
void read_entries(const Reader& body, const char* key, const char* kind, Selected of, const SelectionFrame& frame,
                  std::vector<Entry>& list, const Read& read) {
  if (!body.has(key)) return;
  for (const Reader& entry : body.at(key).items("a list of objects")) {
    entry.expect_object(kind);
    list.emplace_back().where = read_selection(entry, of, frame);
    read(entry, list.back());
  }
}

void read_conditions(const Reader& body, Body& b, const SelectionFrame& frame) {
  const auto of_nodes = [&](const char* key, const char* kind, auto& list, const auto& read) {
    read_entries(body, key, kind, Selected::nodes, frame, list, read);
  };
  of_nodes("fixed", "fixed", b.fixed, [](const Reader& entry, Fixed& out) { describe_axes(ReadKeys{entry}, out); });
  of_nodes("prescribed", "prescribed", b.prescribed, read_prescribed);
  of_nodes("forces", "force", b.forces, [](const Reader& entry, Force& out) {
    describe_force(ReadKeys{entry}, out);
    out.curve = read_curve(entry);
  });
  read_entries(body, "pressures", "pressure", Selected::triangles, frame, b.pressures, [](const Reader& entry, Pressure& out) {
    describe_pressure(ReadKeys{entry}, out);
    out.curve = read_curve(entry);
  });
  of_nodes("initial", "initial", b.initial, read_initial);
}

}  // namespace

Body read_body(const Reader& body, const fs::path& folder, std::size_t index) {
  body.expect_object("body");
  Body b;
  b.pointer = body.pointer();
  // Output files and messages are named after bodies.
  b.name = body.has("name") ? read_name(body.at("name"), "slashes", "/\\") : fmt::format("body{}", index);
  if (b.name == "." || b.name == "..") body.at("name").fail("a name that is no folder");
  read_geometry(body, folder, b);
  // A volume mesh is of tetrahedra more often than not; one of hexahedra has to say so.
  b.element = usual_element(body.has("lattice") ? 8 : 4);
  describe_body(ReadKeys{body}, b);
  if (b.thickness > 0 && element_info(b.element).corners != 4) {
    body.at("element").fail(elements_with([](const ElementInfo& e) { return e.corners == 4; }) +
                            ": a sheet is a layer of tetrahedra");
  }
  if (body.has("model")) b.model = read_model(body.at("model"), b.has_lattice());

  const Reader material = body.at("material", "a material such as {\"young\": 3000, \"poisson\": 0.45, \"density\": 1060}");
  const SelectionFrame frame = frame_of(b, folder);
  b.material = read_material(material, frame.mesh.get());
  if (b.model.matched) b.model.young = b.material.moduli.young();
  check_pressure_law(material, b, b.material);
  if (body.has("membrane")) {
    const Reader membrane = body.at("membrane");
    membrane.expect_object("membrane");
    describe_membrane(ReadKeys{membrane}, b.membrane.emplace());
  }
  if (body.has("vessels")) {
    for (const Reader& entry : body.at("vessels").items("a list of objects")) b.vessels.push_back(read_vessel(entry));
  }
  if (body.has("springs")) {
    if (b.has_lattice())
      body.at("springs").fail(
          "no springs between nodes of a lattice, which have no numbers before it is made (\"vessels\" have places)");
    for (const Reader& entry : body.at("springs").items("a list of objects"))
      b.springs.push_back(read_spring_list(entry, folder));
  }
  if (!b.model.edge_springs && b.springs.empty())
    body.at("model").at("edge_springs").fail("true in a body without \"springs\"");
  read_entries(body, "inclusions", "inclusion", Selected::elements, frame, b.inclusions,
               [&](const Reader& entry, Inclusion& out) {
                 const Reader other = entry.at("material", "the material of the inclusion");
                 out.material = read_material(other, frame.mesh.get());
                 check_pressure_law(other, b, out.material);
               });
  read_conditions(body, b, frame);
  return b;
}

}  // namespace pliant
