// Triangle surfaces: PLY by our own reader (assimp hangs or aborts on damaged ones), the rest through assimp. What assimp hands
// over is checked here: it may throw, and it passes garbage numbers on.
#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <unordered_map>

#include "geometry/orient.h"
#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"
#include "mesh_io/read_ply.h"
#include "mesh_io/screen_gltf.h"
#include "pliant/error.h"

namespace pliant {
namespace {

// A triangle whose height is below this share of its longest edge has no direction worth keeping.
constexpr double kFlat = 1e-10;

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

// assimp hands over OBJ vertices in the order of the faces; the file's own numbering is what its author knows.
void check_obj_numbers(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line, word;
  for (std::int64_t number = 1, vertex = 0; std::getline(in, line); ++number) {
    if (line.size() < 2 || line[0] != 'v' || (line[1] != ' ' && line[1] != '\t')) continue;
    std::istringstream words(line.substr(2));
    for (int axis = 0; axis < 3; ++axis) {
      word.clear();
      words >> word;
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (word.empty() || *end != '\0' || !std::isfinite(value)) {
        fail(file,
             fmt::format("vertex {} (line {}): {} is '{}'; a finite number is needed", vertex, number, "xyz"[axis], word));
      }
    }
    ++vertex;
  }
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

struct Welder {
  struct Hash {
    std::size_t operator()(const Vec3d& p) const {
      std::size_t h = 0;
      for (const double x : p) h = (h ^ std::hash<double>{}(x)) * 0x9E3779B97F4A7C15ULL;
      return h;
    }
  };
  TriangleMesh mesh;
  std::unordered_map<Vec3d, std::int32_t, Hash> ids;
  std::int64_t degenerate = 0;

  std::int32_t vertex(const Vec3d& p) {
    const auto [at, added] = ids.try_emplace(p, static_cast<std::int32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(p);
    return at->second;
  }
  void triangle(const std::array<Vec3d, 3>& p) {
    const Vec3d a = vec::sub(p[1], p[0]), b = vec::sub(p[2], p[0]), c = vec::sub(p[2], p[1]);
    const double longest2 = std::max({vec::dot(a, a), vec::dot(b, b), vec::dot(c, c)});
    if (!(vec::norm(vec::cross(a, b)) > kFlat * longest2)) {
      ++degenerate;
      return;
    }
    mesh.triangles.push_back({vertex(p[0]), vertex(p[1]), vertex(p[2])});
  }
};

struct Reader {
  const std::filesystem::path& file;
  double scale;
  Vec3d translate;
  const aiScene* scene;
  Welder welder;
  std::int64_t vertices = 0;  // read so far, for messages

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

  void mesh(const TriangleMesh& ply) {
    std::vector<Vec3d> points;
    points.reserve(ply.vertices.size());
    for (const Vec3d& v : ply.vertices) points.push_back(place(kIdentity, v, vertices++));
    for (const auto& t : ply.triangles) welder.triangle({points[t[0]], points[t[1]], points[t[2]]});
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
      for (int c = 0; c < 3; ++c) {
        if (face.mIndices[c] >= part.mNumVertices) {
          fail(file, fmt::format("triangle {} names vertex {}, but there are {}", f, face.mIndices[c], part.mNumVertices));
        }
        corners[c] = points[face.mIndices[c]];
      }
      welder.triangle(corners);
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
    orient_outward(mesh);
    return std::move(mesh);
  }
};

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// A mesh may name further files (materials, buffers); to open a pipe among them would block for ever.
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
  if (scene == nullptr) fail(file, fmt::format("cannot be read: {}", importer.GetErrorString()));
  if (scene->mRootNode == nullptr || scene->mNumMeshes == 0) fail(file, "holds no mesh");
  return scene;
}

}  // namespace

TriangleMesh read_surface(const std::filesystem::path& file, double scale, const Vec3d& translate) {
  check_file(file);
  if (!std::isfinite(scale) || scale == 0)
    fail(file, fmt::format("scale is {}; a finite number other than 0 is needed", scale));
  const std::string extension = lower_extension(file);
  if (extension == ".obj") check_obj_numbers(file);
  if (is_gltf(extension)) screen_gltf(file);
  Reader reader{file, scale, translate, nullptr, {}};
  if (extension == ".ply") {
    reader.mesh(read_ply(file));
  } else {
    Assimp::Importer importer;
    reader.scene = import(file, importer);
    reader.node(kIdentity, *reader.scene->mRootNode);
  }
  return reader.finish();
}

TriangleMesh clean_surface(const TriangleMesh& surface, const std::string& name, double scale, const Vec3d& translate) {
  const std::filesystem::path shown = name;
  const auto count = static_cast<std::int64_t>(surface.vertices.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const std::int32_t v : surface.triangles[t]) {
      if (v < 0 || v >= count) fail(shown, fmt::format("triangle {} names vertex {}, but there are {}", t, v, count));
    }
  }
  Reader used{shown, scale, translate, nullptr, {}}, reader = used;
  used.mesh(surface);
  // Vertices keep their order, so those of a clean surface keep their numbers.
  for (const Vec3d& v : surface.vertices) {
    const Vec3d p = reader.place(kIdentity, v, 0);
    if (used.welder.ids.contains(p)) reader.welder.vertex(p);
  }
  reader.mesh(surface);
  return reader.finish();
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
