// Triangle surfaces: PLY by our own reader (assimp freezes or aborts on damaged files), the rest through assimp. The output
// of assimp is checked here: it may throw, and it may return garbage numbers.
#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <system_error>
#include <unordered_map>
#include <unordered_set>

#include "geometry/orient.h"
#include "geometry/vec.h"
#include "mesh_io/lacking.h"
#include "mesh_io/mesh_io.h"
#include "mesh_io/obj_points.h"
#include "mesh_io/read_ply.h"
#include "mesh_io/screen_gltf.h"
#include "mesh_io/surface_report.h"
#include "pliant/error.h"

namespace pliant {
namespace {

// A triangle whose height is below this share of its longest edge has no direction worth keeping.
constexpr double kFlatArea = 1e-10;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorCode::bad_input, fmt::format("surface mesh '{}': {}", file.string(), what));
}

void check_file(const std::filesystem::path& file) {
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status)) fail(file, "no such file");
  if (std::filesystem::is_directory(status)) fail(file, "is a folder; a mesh file (OBJ, STL, PLY, 3DS, glTF) is needed");
  if (!std::filesystem::is_regular_file(status)) fail(file, "is no regular file");
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(file, "cannot be opened for reading");
  if (in.peek() == std::ifstream::traits_type::eof()) fail(file, "is empty");
}

using Matrix = std::array<double, 12>;  // rows of the affine part

constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Matrix multiply(const Matrix& a, const aiMatrix4x4& b) {
  Matrix out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      for (int k = 0; k < 3; ++k) out[4 * r + c] += a[4 * r + k] * static_cast<double>(b[k][c]);
    }
    out[4 * r + 3] += a[4 * r + 3];
  }
  return out;
}

struct Hash {
  std::size_t operator()(const Vec3d& p) const {
    std::size_t h = 0;
    for (const double x : p) h = (h ^ std::hash<double>{}(x)) * 0x9E3779B97F4A7C15ULL;
    return h;
  }
};

struct Welder {
  TriangleMesh mesh;
  std::vector<TextureCorners> texture;  ///< parallel to the triangles
  std::unordered_map<Vec3d, std::int32_t, Hash> ids;
  std::int64_t degenerate = 0;
  Vec3d degenerate_at{};

  std::int32_t vertex(const Vec3d& p) {
    const auto [at, added] = ids.try_emplace(p, static_cast<std::int32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(p);
    return at->second;
  }
  void triangle(const std::array<Vec3d, 3>& p, const TextureCorners& at = {}) {
    const Vec3d a = vec::sub(p[1], p[0]), b = vec::sub(p[2], p[0]), c = vec::sub(p[2], p[1]);
    const double longest2 = std::max({vec::dot(a, a), vec::dot(b, b), vec::dot(c, c)});
    if (!(vec::norm(vec::cross(a, b)) > kFlatArea * longest2)) {
      if (degenerate++ == 0) degenerate_at = p[0];
      return;
    }
    mesh.triangles.push_back({vertex(p[0]), vertex(p[1]), vertex(p[2])});
    texture.push_back(at);
  }
};

struct FormatReader {
  const std::filesystem::path& file;
  double scale;
  Vec3d translate;
  const aiScene* scene = nullptr;
  Welder welder{};
  std::int64_t vertices = 0;  // read so far, for messages
  SurfaceReport report{};
  bool textured = false;  // whether the file has texture coordinates

  Vec3d place(const Matrix& m, const Vec3d& local, std::int64_t index) const {
    Vec3d out{};
    for (int r = 0; r < 3; ++r) {
      out[r] = scale * (m[4 * r] * local[0] + m[4 * r + 1] * local[1] + m[4 * r + 2] * local[2] + m[4 * r + 3]) + translate[r];
      out[r] += 0.0;  // -0 becomes 0, so that both weld
    }
    if (!vec::finite(out)) {
      fail(file, fmt::format("vertex {} is ({}, {}, {}); finite coordinates are needed", index, local[0], local[1], local[2]));
    }
    return out;
  }

  /// Counts those points of the file that stand where another stands.
  void count_merged(const std::vector<Vec3d>& points) {
    std::unordered_set<Vec3d, Hash> places;
    for (const Vec3d& p : points) {
      if (places.insert(p).second) continue;
      if (report.merged++ == 0) report.merged_at = p;
    }
  }

  void mesh(const TriangleMesh& ply) {
    std::vector<Vec3d> points;
    points.reserve(ply.vertices.size());
    for (const Vec3d& v : ply.vertices) points.push_back(place(kIdentity, v, vertices++));
    count_merged(points);
    for (const auto& t : ply.triangles) welder.triangle({points[t[0]], points[t[1]], points[t[2]]});
  }

  std::array<float, 2> texture_at(const aiMesh& part, unsigned vertex) {
    textured = true;
    const aiVector3D& at = part.mTextureCoords[0][vertex];
    if (std::isfinite(at.x) && std::isfinite(at.y)) return {static_cast<float>(at.x), static_cast<float>(at.y)};
    fail(file, fmt::format("texture coordinates ({}, {}) of vertex {}; finite ones are needed", at.x, at.y, vertex));
  }

  void mesh(const Matrix& m, const aiMesh& part) {
    std::vector<Vec3d> points;
    points.reserve(part.mNumVertices);
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      points.push_back(place(m, {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)}, vertices++));
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<Vec3d, 3> corners;
      TextureCorners at{};
      for (int c = 0; c < 3; ++c) {
        if (face.mIndices[c] >= part.mNumVertices) {
          fail(file, fmt::format("triangle {} names vertex {}, but there are {}", f, face.mIndices[c], part.mNumVertices));
        }
        corners[c] = points[face.mIndices[c]];
        if (part.HasTextureCoords(0)) at[c] = texture_at(part, face.mIndices[c]);
      }
      welder.triangle(corners, at);
    }
  }

  void node(const Matrix& parent, const aiNode& n) {
    const Matrix m = multiply(parent, n.mTransformation);
    for (unsigned i = 0; i < n.mNumMeshes; ++i) mesh(m, *scene->mMeshes[n.mMeshes[i]]);
    for (unsigned i = 0; i < n.mNumChildren; ++i) node(m, *n.mChildren[i]);
  }

  TriangleMesh finish() {
    TriangleMesh& mesh = welder.mesh;
    if (mesh.triangles.empty()) {
      if (welder.degenerate == 0) fail(file, fmt::format("holds {} vertices but no triangle", vertices));
      fail(file, fmt::format("all {} triangles have zero area", welder.degenerate));
    }
    drop_copies(mesh);
    const auto given = mesh.triangles;
    const OrientationReport orientation = orient_outward(mesh);
    for (std::size_t t = 0; t < given.size(); ++t) {  // a triangle is turned by exchanging its last two corners
      if (given[t] != mesh.triangles[t]) std::swap(welder.texture[t][1], welder.texture[t][2]);
    }
    describe(mesh, given, orientation);
    return std::move(mesh);
  }

  void drop_copies(TriangleMesh& mesh) {
    const Copies copies = copies_of(mesh);
    report.doubled = copies.found;
    report.doubled_dropped = copies.dropped;
    if (copies.found > 0) report.doubled_at = centroid_of(mesh, copies.first);
    if (copies.dropped == 0) return;
    mesh = without(mesh, copies.drop);
    std::vector<TextureCorners> kept;
    for (std::size_t t = 0; t < copies.drop.size(); ++t) {
      if (copies.drop[t] == 0) kept.push_back(welder.texture[t]);
    }
    welder.texture = std::move(kept);
  }

  void describe(const TriangleMesh& mesh, const std::vector<std::array<std::int32_t, 3>>& given,
                const OrientationReport& orientation) {
    report.name = file.string();
    report.degenerate = welder.degenerate;
    report.degenerate_at = welder.degenerate_at;
    report.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    report.flipped = orientation.flipped;
    report.shell = orientation.shell;
    report.volume = signed_volume(mesh);
    std::vector<char> sheets;
    if (!orientation.closed()) sheets = sheets_of(mesh, orientation);
    for (std::int64_t t = report.triangles; t-- > 0;) {
      const double area = area_of(mesh, t);
      report.area += area;
      if (given[t] != mesh.triangles[t]) report.flipped_at = centroid_of(mesh, t);
      if (sheets.empty() || sheets[t] == 0) continue;
      ++report.sheet_triangles;
      report.sheet_area += area;
      report.sheet_at = centroid_of(mesh, t);
    }
    if (orientation.closed() || report.sheet_triangles == report.triangles) return;
    TriangleMesh rest = without(mesh, sheets);
    orient_outward(rest);
    report.volume = signed_volume(rest);
    report.holes = holes_of(rest);
    for (const Hole& hole : report.holes) report.volume += hole.volume;
  }
};

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// A mesh may refer to further files (materials, buffers); opening a pipe among them would block forever.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* name) const override {
    std::error_code code;
    return std::filesystem::is_regular_file(name, code);  // assimp's own opens the file
  }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return Exists(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
  }
};

void forget(Assimp::Importer& importer, const char* extension) {
  while (Assimp::BaseImporter* loader = importer.GetImporter(extension)) {
    importer.UnregisterLoader(loader);
    delete loader;  // no longer the importer's
  }
}

bool is_gltf(const std::string& extension) { return extension == ".gltf" || extension == ".glb"; }

const aiScene* import(const std::filesystem::path& file, Assimp::Importer& importer) {
  const aiScene* scene = nullptr;
  importer.SetIOHandler(new RegularFiles);  // the importer owns it
  // Files of other extensions are recognised by their content: none may reach what only its own extension is checked for.
  forget(importer, "ply");
  if (!is_gltf(lower_extension(file))) forget(importer, "gltf");
  try {
    scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  } catch (const std::exception& e) {
    fail(file, fmt::format("cannot be read: {}", e.what()));
  }
  if (scene == nullptr) {
    fail(file, fmt::format("cannot be read: {}{}", importer.GetErrorString(), lacking("surface", file.extension().string())));
  }
  if (scene->mRootNode == nullptr || scene->mNumMeshes == 0) fail(file, "holds no mesh");
  return scene;
}

}  // namespace

TriangleMesh read_surface(const std::filesystem::path& file, double scale, const Vec3d& translate, SurfaceReport* report,
                          std::vector<TextureCorners>* texture) {
  check_file(file);
  if (!std::isfinite(scale) || scale == 0)
    fail(file, fmt::format("scale is {}; a finite number other than 0 is needed", scale));
  const std::string extension = lower_extension(file);
  if (is_gltf(extension)) screen_gltf(file);
  FormatReader reader{file, scale, translate};
  if (extension == ".obj") {
    std::vector<Vec3d> points = obj_points(file);
    for (Vec3d& p : points) p = reader.place(kIdentity, p, 0);
    reader.count_merged(points);
  }
  if (extension == ".ply") {
    reader.mesh(read_ply(file));
  } else {
    Assimp::Importer importer;
    reader.scene = import(file, importer);
    reader.node(kIdentity, *reader.scene->mRootNode);
  }
  TriangleMesh mesh = reader.finish();
  if (texture != nullptr) *texture = reader.textured ? std::move(reader.welder.texture) : std::vector<TextureCorners>{};
  if (report != nullptr) *report = std::move(reader.report);
  return mesh;
}

TriangleMesh clean_surface(const TriangleMesh& surface, const std::string& name, double scale, const Vec3d& translate,
                           SurfaceReport* report) {
  const std::filesystem::path shown = name;
  const auto count = static_cast<std::int64_t>(surface.vertices.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::int32_t v : surface.triangles[t]) {
      if (v < 0 || v >= count) fail(shown, fmt::format("triangle {} names vertex {}, but there are {}", t, v, count));
    }
  }
  FormatReader used{shown, scale, translate}, reader = used;
  used.mesh(surface);
  // Vertices keep their order, so those of a clean surface keep their numbers.
  for (const Vec3d& v : surface.vertices) {
    const Vec3d p = reader.place(kIdentity, v, 0);
    if (used.welder.ids.contains(p)) reader.welder.vertex(p);
  }
  reader.mesh(surface);
  TriangleMesh mesh = reader.finish();
  if (report != nullptr) *report = std::move(reader.report);
  return mesh;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3d& origin = mesh.vertices[0];  // close to the surface: keeps the sum free of cancellation far from (0, 0, 0)
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3d a = vec::sub(mesh.vertices[t[0]], origin), b = vec::sub(mesh.vertices[t[1]], origin);
    sum += vec::dot(a, vec::cross(b, vec::sub(mesh.vertices[t[2]], origin)));
  }
  return sum / 6;
}

}  // namespace pliant
