#include "cli/frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/option_word.h"
#include "cutting/topology/cut_topology.h"
#include "io/obj.h"
#include "io/png.h"
#include "model/elements/each_element.h"
#include "model/pieces.h"
#include "model/surface_texture.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

void append(std::vector<float>& values, const Vec3d& v) {
  for (const double c : v) values.push_back(static_cast<float>(c));
}

/// Fill fraction of every element, body by body.
std::vector<std::vector<float>> fills(const Model& model) {
  std::vector<std::vector<float>> fill;
  for (const ModelBody& b : model.bodies) fill.emplace_back(static_cast<std::size_t>(b.elements()), 1.0F);
  for_each_element(model, [&](const ElementView& e) {
    fill[static_cast<std::size_t>(e.body)][static_cast<std::size_t>(e.id)] = static_cast<float>(e.share / e.modulus);
  });
  return fill;
}

/// Young's modulus of the elements, tetrahedra of all bodies first, as the cells of a file come; nothing without a field of it.
std::vector<float> moduli(const Scene& scene, const Model& model) {
  const auto varied = [](const ModelBody& b) { return !b.materials.modulus.empty(); };
  if (std::none_of(model.bodies.begin(), model.bodies.end(), varied)) return {};
  std::array<std::vector<float>, 2> of_kind;  // tetrahedra, hexahedra
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    for (std::size_t e = 0; e < static_cast<std::size_t>(body.elements()); ++e) {
      const double young = material_of(scene.bodies[b], body.materials.index[e]).moduli.young();
      of_kind[body.tets.empty() ? 1 : 0].push_back(static_cast<float>(young * body.materials.modulus_of(e)));
    }
  }
  of_kind[0].insert(of_kind[0].end(), of_kind[1].begin(), of_kind[1].end());
  return std::move(of_kind[0]);
}

/// A series has the same arrays in all its files.
bool shows_cuts(const Simulation& simulation) {
  return !simulation.scene().blades.empty() || simulation.topology_version() > 0;
}

/// What a blade did to every element: whether it is a copy of a divided cell, and the number of its piece.
struct ElementCuts {
  std::vector<float> cut, piece;
};

ElementCuts element_cuts(const Simulation& simulation, std::size_t body) {
  const ModelBody& b = simulation.model().bodies[body];
  ElementCuts out{std::vector<float>(static_cast<std::size_t>(b.elements())),
                  std::vector<float>(static_cast<std::size_t>(b.elements()))};
  std::vector<std::int32_t> piece;
  static_cast<void>(pieces_of(b, &piece));
  for (std::size_t e = 0; e < piece.size(); ++e) out.piece[e] = static_cast<float>(piece[e]);
  const CutTopology* topology = simulation.cut_topology(body);
  if (topology == nullptr) return out;
  const CutElements& elements = topology->elements();
  // A cell of a lattice may stand for six tetrahedra.
  const std::size_t parts = std::max<std::size_t>(1, out.cut.size() / elements.nodes.size());
  for (std::size_t e = 0; e < out.cut.size(); ++e) {
    const auto cell = topology->cells().find(elements.cell[e / parts]);
    out.cut[e] = cell != topology->cells().end() && cell->second.components > 1 ? 1.0F : 0.0F;
  }
  return out;
}

}  // namespace

const Words<OutputFormat>& format_words() {
  static const Words<OutputFormat> words{{"vtu", OutputFormat::vtu, "volume and surface, for ParaView"},
                                         {"obj", OutputFormat::obj, "the surface"},
                                         {"png", OutputFormat::png, "ray-traced pictures"},
                                         {"gltf", OutputFormat::gltf, "one animation of the surface"}};
  return words;
}

Words<OutputFormat> available_formats() {
  Words<OutputFormat> words = format_words();
  if (!render::Renderer::available()) {
    std::erase_if(words, [](const Word<OutputFormat>& w) { return w.value == OutputFormat::png; });
  }
  return words;
}

std::set<OutputFormat> parse_formats(const std::vector<std::string>& formats) {
  std::set<OutputFormat> chosen;
  for (const std::string& format : formats) {
    const OutputFormat value = value_of("--format", format, format_words());
    if (value == OutputFormat::png && !render::Renderer::available()) {
      throw Error(ErrorCode::bad_input, fmt::format("--format: png is not available: {}; allowed are {}",
                                                    render::Renderer::missing(), listed(words_only(available_formats()))));
    }
    chosen.insert(value);
  }
  return chosen;
}

VtuMesh volume_frame(const Simulation& simulation) {
  const Model& model = simulation.model();
  VtuMesh mesh;
  VtuArray displacement{"displacement", 3, {}}, velocity{"velocity", 3, {}};
  std::vector<float> tet_body, tet_fill, tet_cut, tet_piece, hex_body, hex_fill, hex_cut, hex_piece;
  const auto fill = fills(model);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    const auto u = simulation.displacements(b), v = simulation.velocities(b);
    for (std::size_t n = 0; n < body.rest.size(); ++n) {
      const Vec3d& x = body.rest[n];
      mesh.points.push_back({x[0] + u[n][0], x[1] + u[n][1], x[2] + u[n][2]});
      append(displacement.values, u[n]);
      append(velocity.values, v[n]);
    }
    for (auto tet : body.tets) {
      for (auto& n : tet) n += first;
      mesh.tets.push_back(tet);
      tet_body.push_back(static_cast<float>(b));
    }
    for (auto hex : body.hexes) {
      for (auto& n : hex) n += first;
      mesh.hexes.push_back(hex);
      hex_body.push_back(static_cast<float>(b));
    }
    auto& of_kind = body.tets.empty() ? hex_fill : tet_fill;  // a body has elements of one kind
    of_kind.insert(of_kind.end(), fill[b].begin(), fill[b].end());
    if (!shows_cuts(simulation)) continue;
    const ElementCuts cuts = element_cuts(simulation, b);
    auto& cut = body.tets.empty() ? hex_cut : tet_cut;
    auto& piece = body.tets.empty() ? hex_piece : tet_piece;
    cut.insert(cut.end(), cuts.cut.begin(), cuts.cut.end());
    piece.insert(piece.end(), cuts.piece.begin(), cuts.piece.end());
  }
  tet_body.insert(tet_body.end(), hex_body.begin(), hex_body.end());
  tet_fill.insert(tet_fill.end(), hex_fill.begin(), hex_fill.end());
  mesh.point_arrays = {std::move(displacement), std::move(velocity)};
  mesh.cell_arrays = {{"body", 1, std::move(tet_body)}, {"fill", 1, std::move(tet_fill)}};
  if (auto young = moduli(simulation.scene(), model); !young.empty())
    mesh.cell_arrays.push_back({"young", 1, std::move(young)});
  if (shows_cuts(simulation)) {
    tet_cut.insert(tet_cut.end(), hex_cut.begin(), hex_cut.end());
    tet_piece.insert(tet_piece.end(), hex_piece.begin(), hex_piece.end());
    mesh.cell_arrays.push_back({"cut", 1, std::move(tet_cut)});
    mesh.cell_arrays.push_back({"piece", 1, std::move(tet_piece)});
  }
  return mesh;
}

VtuMesh surface_frame(Simulation& simulation) {
  const ModelSurface& surface = simulation.model().surface;
  VtuMesh mesh;
  mesh.points = simulation.surface_positions();
  mesh.triangles = surface.triangles;
  VtuArray displacement{"displacement", 3, {}}, body{"body", 1, {}};
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Vec3d &x = mesh.points[v], &rest = surface.rest[v];
    append(displacement.values, {x[0] - rest[0], x[1] - rest[1], x[2] - rest[2]});
  }
  for (const std::int32_t b : surface.triangle_body) body.values.push_back(static_cast<float>(b));
  mesh.point_arrays = {std::move(displacement)};
  mesh.cell_arrays = {std::move(body)};
  if (shows_cuts(simulation)) {
    VtuArray cut{"cut", 1, {surface.triangle_cut.begin(), surface.triangle_cut.end()}};
    cut.values.resize(mesh.triangles.size(), 0.0F);  // empty as long as nothing is cut
    mesh.cell_arrays.push_back(std::move(cut));
  }
  return mesh;
}

void write_surface_obj(const std::filesystem::path& file, const Model& model, const std::vector<Vec3d>& positions) {
  const std::vector<TextureCorners> texture = texture_of(model);
  if (texture.empty()) return write_obj(file, {positions, model.surface.triangles});
  std::vector<float> packed;
  for (const Vec3d& x : positions) append(packed, x);
  std::vector<std::int32_t> triangles;
  for (const auto& t : model.surface.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  const std::vector<std::uint8_t> cut(model.surface.triangle_cut.begin(), model.surface.triangle_cut.end());
  render::Surface surface;
  surface.positions = packed;
  surface.triangles = triangles;
  surface.cut = cut;
  write_textured_obj(file, {positions, model.surface.triangles}, render::obj_corners(surface, texture));
}

namespace {

/// Files such as bunny_00000100.vtu and bunny_surface_00000100.obj.
std::size_t frames_in(const std::filesystem::path& folder, const std::string& stem, const std::set<OutputFormat>& formats) {
  std::size_t count = 0;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    std::string name = entry.path().stem().string();
    const std::string kind = entry.path().extension().string();
    if (name.rfind(stem + "_", 0) != 0) continue;
    name.erase(0, stem.size() + 1);
    if (name.rfind("surface_", 0) == 0) name.erase(0, 8);
    const bool number = name.size() >= 8 && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    const bool written =
        std::any_of(formats.begin(), formats.end(), [&](OutputFormat f) { return kind == "." + word_of(format_words(), f); });
    count += number && written ? 1 : 0;
  }
  return count;
}

}  // namespace

FrameWriter::FrameWriter(std::filesystem::path folder, std::string stem, std::set<OutputFormat> formats,
                         std::vector<FrameField> fields, const render::PictureOptions& pictures)
    : folder_(std::move(folder)),
      stem_(std::move(stem)),
      formats_(std::move(formats)),
      fields_(std::move(fields)),
      volume_(folder_ / (stem_ + ".pvd")),
      surface_(folder_ / (stem_ + "_surface.pvd")) {
  std::error_code code;
  std::filesystem::create_directories(folder_, code);
  if (code)
    throw Error(ErrorCode::bad_input, fmt::format("--out: the folder {} cannot be made: {}", folder_.string(), code.message()));
  if (!std::filesystem::is_directory(folder_))
    throw Error(ErrorCode::bad_input, fmt::format("--out: {} is a file, expected a folder", folder_.string()));
  check_writable(folder_ / (stem_ + ".pvd"));
  lock_.emplace(folder_);
  older_ = frames_in(folder_, stem_, formats_);
  if (formats_.count(OutputFormat::png) != 0) pictures_.emplace(pictures);
}

void FrameWriter::write(Simulation& simulation) {
  if (last_step_ == simulation.step()) return;
  last_step_ = simulation.step();
  const std::string number = fmt::format("_{:08}", simulation.step());
  const bool has_surface = !simulation.model().surface.triangles.empty();
  VtuMesh surface = has_surface ? surface_frame(simulation) : VtuMesh{};
  const std::vector<VtuArray> fields = has_surface ? vertex_fields(simulation, fields_) : std::vector<VtuArray>{};
  surface.point_arrays.insert(surface.point_arrays.end(), fields.begin(), fields.end());
  if (formats_.count(OutputFormat::vtu) != 0) {
    const auto file = folder_ / (stem_ + number + ".vtu");
    VtuMesh volume = volume_frame(simulation);
    for (VtuArray& array : element_fields(simulation, fields_)) volume.cell_arrays.push_back(std::move(array));
    write_vtu(file, volume);
    volume_.append(simulation.time(), file);
    if (has_surface) {
      const auto surface_file = folder_ / (stem_ + "_surface" + number + ".vtu");
      write_vtu(surface_file, surface);
      surface_.append(simulation.time(), surface_file);
    }
  }
  if (formats_.count(OutputFormat::obj) != 0 && has_surface) {
    write_surface_obj(folder_ / (stem_ + "_surface" + number + ".obj"), simulation.model(), surface.points);
  }
  if (pictures_ && has_surface) write_png(folder_ / (stem_ + number + ".png"), pictures_->draw(simulation));
  if (formats_.count(OutputFormat::gltf) != 0 && has_surface) {
    render::SurfaceCopy copy;
    copy.read(simulation);
    std::vector<VertexArray> values;
    for (const VtuArray& field : fields) values.push_back({field.name, field.components, field.values});
    animation_.add(splitter_.split(copy.view(), simulation.time(), values, texture_of(simulation.model())));
  }
  ++frames_;
}

void FrameWriter::finish() {
  if (animation_.empty()) return;
  write_glb(folder_ / (stem_ + ".glb"), animation_);
}

}  // namespace pliant::cli
