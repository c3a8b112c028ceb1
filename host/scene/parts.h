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
/// The entries of `prescribed` and `initial`.
Prescribed read_prescribed(const Reader& entry, const SelectionFrame& frame);
Initial read_initial(const Reader& entry, const SelectionFrame& frame);
std::array<bool, 3> read_axes(const Reader& field);
Curve read_curve(const Reader& entry);
Material read_material(const Reader& material);
/// `lattice`: whether the body is a surface filled with a lattice, which shape matching needs.
DeformationModel read_model(const Reader& model, bool lattice);
Tool read_tool(const Reader& tool);
/// The last entry of a list has a name of its own.
template <class Named>
void check_last_name(const Reader& entry, const std::vector<Named>& all, const char* kind) {
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].name != all.back().name) continue;
    entry.fail(fmt::format("the name \"{}\", which {} has already", all[i].name, all[i].pointer),
               fmt::format("a different name for every {}", kind));
  }
}
/// A name that stands in tables and messages: of a tool or a blade.
std::string read_plain_name(const Reader& field);
std::vector<Blade> read_blades(const Reader& blades);
SceneView read_view(const Reader& view);
std::optional<TissueContact> read_tissue_contact(const Reader& contact);
/// An entry of `tools`; `name`: what it is called if it does not say so.
ContactTool read_contact_tool(const Reader& entry, const std::string& name, const std::filesystem::path& folder);
/// The reverse, with paths relative to the scene's folder (write.cpp).
nlohmann::ordered_json tool_json(const ContactTool& tool, const std::filesystem::path& scene_file);
nlohmann::ordered_json tool_json(const ToolSpec& tool, const std::filesystem::path& scene_file);
std::vector<ContactTool> read_tools(const Reader& tools, const std::filesystem::path& folder);
void check_tools(const Reader& top, const Scene& scene);
/// After the bodies. Null without probes.
std::shared_ptr<const SceneProbes> read_probes(const Reader& top, const Scene& scene);
/// Models against the keys of the scene: its integrator, its relaxation and its tool.
void check_models(const Reader& top, const Scene& scene);
void check_blades(const Reader& top, const Scene& scene);
/// Materials with a toughness against the rest of the scene.
void check_tearing(const Reader& top, const Scene& scene);
/// `folder` is what relative mesh paths are relative to; `index` numbers a body without a name.
Body read_body(const Reader& body, const std::filesystem::path& folder, std::size_t index);

}  // namespace pliant
