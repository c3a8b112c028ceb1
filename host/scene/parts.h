// The parts of a scene file below the top level. Internal to the scene room.
#pragma once
#include <fmt/format.h>

#include <filesystem>

#include "pliant/scene.h"
#include "scene/mesh_region.h"
#include "scene/probe.h"
#include "scene/reader.h"
#include "scene/tool_entry.h"

namespace pliant {

/// A whole scene. Throws Error as parse_scene does.
Scene read_document(const nlohmann::json& document, const std::filesystem::path& file);
/// The document of a scene in code. Of a body with a surface in memory it names no file that exists (write.cpp).
nlohmann::ordered_json document_of(const SceneSpec& spec);
nlohmann::ordered_json document_of(const Scene& scene);
/// The entry of a change, without its time.
nlohmann::ordered_json change_json(const ChangeSpec& change);
inline bool in_memory(const BodySpec& body) { return !body.surface.vertices.empty() || !body.surface.triangles.empty(); }
/// What paths and surfaces of a selection are relative to, and the mesh that its regions are parts of; null: a lattice's.
struct SelectionFrame {
  std::filesystem::path folder{};
  double scale = 1;
  Vec3d translate{};
  std::shared_ptr<const TaggedMesh> mesh{};
};
SelectionFrame frame_of(const Body& body, const std::filesystem::path& folder);
/// Only of nodes there may be lists: neither elements nor triangles have numbers that a scene could know.
Selection read_selection(const Reader& entry, Selected of, const SelectionFrame& frame);
/// Parts of `prescribed` and `initial` entries other than their selection.
void read_prescribed(const Reader& entry, Prescribed& prescribed);
void read_initial(const Reader& entry, Initial& initial);
Curve read_curve(const Reader& entry);
/// `mesh`: that of the body, for fields; null: a lattice.
Material read_material(const Reader& material, const TaggedMesh* mesh);
/// `lattice`: whether the body is a surface filled with a lattice, which shape matching needs.
DeformationModel read_model(const Reader& model, bool lattice);
Focus read_focus(const Reader& focus);
Vessel read_vessel(const Reader& entry);
nlohmann::ordered_json grip_json(const GripSpec& grip);
Spring read_spring(const Reader& spring);
/// `folder`: what its file is relative to.
SpringList read_spring_list(const Reader& entry, const std::filesystem::path& folder);
/// After the bodies.
std::vector<Join> read_joins(const Reader& joins, const Scene& scene);
/// Springs against the integrator and the solver.
void check_springs(const Reader& top, const Scene& scene);
/// The last entry of a list has a name of its own.
template <class Named>
void check_last_name(const Reader& entry, const std::vector<Named>& all, const char* kind) {
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].name != all.back().name) continue;
    entry.fail(fmt::format("the name \"{}\", which {} has already", all[i].name, all[i].pointer),
               fmt::format("a different name for every {}", kind));
  }
}
/// A name of 1 to 100 characters without control characters and those that are `refused`, which messages call `what`.
std::string read_name(const Reader& field, const std::string& what = "", const char* refused = "");
/// Rows of N numbers, the first of which is the time and ascends; at least `least` rows.
template <std::size_t N>
std::vector<std::array<double, N>> read_rows(const Reader& list, const char* expected, const char* row_expected,
                                             std::size_t least = 1) {
  std::vector<std::array<double, N>> rows;
  for (const Reader& row : list.items(expected, least)) {
    const std::vector<Reader> parts = row.items(row_expected);
    if (parts.size() != N) row.fail(row_expected);
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i) out[i] = parts[i].number();
    if (!rows.empty() && !(out[0] > rows.back()[0]))
      parts[0].fail(fmt::format("a time after the previous row's {}", rows.back()[0]));
    rows.push_back(out);
  }
  return rows;
}
/// After everything else of the scene has been read and checked.
std::vector<SceneChange> read_changes(const Reader& changes, const Scene& scene);
std::vector<Blade> read_blades(const Reader& blades);
SceneView read_view(const Reader& view);
std::optional<TissueContact> read_tissue_contact(const Reader& contact);
/// Reads an entry of `tools`; `name`: the default name.
ContactTool read_contact_tool(const Reader& entry, const std::string& name, const std::filesystem::path& folder);
/// The reverse, with paths relative to the scene's folder (write.cpp).
nlohmann::ordered_json tool_json(const ContactTool& tool, const std::filesystem::path& scene_file);
nlohmann::ordered_json tool_json(const ToolSpec& tool, const std::filesystem::path& scene_file);
std::vector<ContactTool> read_tools(const Reader& tools, const std::filesystem::path& folder);
void check_tools(const Reader& top, const Scene& scene);
/// After the bodies. Null without probes.
std::shared_ptr<const SceneProbes> read_probes(const Reader& top, const Scene& scene);
/// Fails at the key "integrator" unless the scene's has a property, `because` of what else the scene holds.
void require_integrator(const Reader& top, const Scene& scene, bool IntegratorInfo::*property, const std::string& because);
/// Models against the keys of the scene: its integrator, its relaxation and its tool.
void check_models(const Reader& top, const Scene& scene);
/// Materials with a viscosity against the integrator and the models.
void check_viscous(const Reader& top, const Scene& scene);
void check_blades(const Reader& top, const Scene& scene);
/// Adds the faces of blades to the tools, which have been checked.
void add_faces(const Reader& top, Scene& scene);
/// Materials with a toughness against the rest of the scene.
void check_tearing(const Reader& top, const Scene& scene);
/// `folder` is what relative mesh paths are relative to; `index` numbers a body without a name.
Body read_body(const Reader& body, const std::filesystem::path& folder, std::size_t index);

}  // namespace pliant
