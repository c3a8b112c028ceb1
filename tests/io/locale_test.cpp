// A host may live in a locale with a decimal comma: readers and writers must not notice.
#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <locale>

#include "io/gltf.h"
#include "io/obj.h"
#include "io/vtu.h"
#include "mesh_io/mesh_io.h"
#include "scene/scene.h"
#include "support/error_of.h"
#include "support/temp_folder.h"

namespace pliant {
namespace {

using test::TempFolder;

struct Comma : std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

/// Both global locales as they were, at the end.
class KeepLocale {
 public:
  KeepLocale() : c_(std::setlocale(LC_ALL, nullptr)) {}
  ~KeepLocale() {
    std::locale::global(cpp_);
    std::setlocale(LC_ALL, c_.c_str());
  }
  KeepLocale(const KeepLocale&) = delete;
  KeepLocale& operator=(const KeepLocale&) = delete;

 private:
  std::locale cpp_;
  std::string c_;
};

const char* const kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n0.5 0 0\n1.25 0 0\n0 1.125 0\n0 0 1.75\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 "
    "1 2 3\n";
const char* const kStl =
    "solid t\nfacet normal 0.5 0 0\nouter loop\nvertex 0.5 0 0\nvertex 1.25 0 0\nvertex 0 1.125 0\nendloop\nendfacet\nendsolid "
    "t\n";
const char* const kMsh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0.5 0 0\n2 1.25 0 0\n3 0 1.125 0\n4 0 0 1.75\n$EndNodes\n"
    "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
const char* const kVtk =
    "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0.5 0 0\n1.25 0 0\n0 1.125 0\n0 0 1.75\n"
    "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";
const char* const kVtu =
    "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
    "NumberOfCells=\"1\"><Points>"
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0.5 0 0 1.25 0 0 0 1.125 0 0 0 "
    "1.75</DataArray></Points>"
    "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
// Three corners at 0, x, y; the node scales and shifts them.
const char* const kGltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0,"scale":[2.5,1.5,2],"translation":[0.25,0,5]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
    "buffers":[{"byteLength":44,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA="}]})";
const char* const kScene = R"({"format": "pliant-scene/1", "duration": 0.125, "dt": 1.5e-4, "gravity": [0, -9.81, 0],
    "bodies": [{"surface": "t.obj", "lattice": {"spacing": 0.0125}, "material": {"young": 3000.5, "poisson": 0.45}}]})";

std::string bits(const std::vector<double>& values) {
  std::string out;
  for (const double x : values) out += fmt::format("{:016x} ", std::bit_cast<std::uint64_t>(x));
  return out + "\n";
}

/// Everything that reads numbers as text, read, and everything that writes them, written, as one text.
std::string all_of_it() {
  const TempFolder folder;
  std::string out;
  const auto add = [&](const std::vector<Vec3d>& points) {
    for (const Vec3d& p : points) out += bits({p[0], p[1], p[2]});
  };
  const std::string obj = "v 0.5 0 0\nv 1.25 0 0\nv 0 1.125e0 0\nv 0 0 +1.75\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  for (const auto& [name, text] : {std::pair{"t.obj", obj.c_str()}, {"t.ply", kPly}, {"t.stl", kStl}, {"t.gltf", kGltf}}) {
    const TriangleMesh mesh = read_surface(folder.write(name, text), 1.5, {0.25, 0, 0});
    out += fmt::format("{}\n", name);
    add(mesh.vertices);
  }
  for (const auto& [name, text] : {std::pair{"t.msh", kMsh}, {"t.vtk", kVtk}, {"t.vtu", kVtu}}) {
    add(read_volume(folder.write(name, text)).vertices);
  }
  const Scene scene = parse_scene(kScene, folder.path() / "t.json");
  out += bits({scene.dt, scene.duration, scene.bodies[0].lattice.spacing, scene.gravity[1]});
  std::string written = scene_to_json(scene);
  for (std::size_t at; (at = written.find(folder.path().string())) != written.npos;) {
    written.erase(at, folder.path().string().size());
  }
  out += written;
  const TriangleMesh mesh = read_surface(folder.path() / "t.obj");
  write_obj(folder.path() / "out.obj", mesh, mesh.vertices);
  VtuMesh vtu;
  vtu.points = mesh.vertices;
  vtu.triangles = mesh.triangles;
  vtu.point_arrays = {{"x", 1, {0.5F, 1234.5F, 0.25F, 1e-7F}}};
  write_vtu(folder.path() / "out.vtu", vtu);
  PvdSeries(folder.path() / "out.pvd").append(1234.5, "out.vtu");
  SurfaceFrame frame;
  for (const Vec3d& v : mesh.vertices) {
    for (const double x : v) frame.positions.push_back(static_cast<float>(x));
    for (const float x : {0.F, 0.F, 1.F}) frame.normals.push_back(x);
  }
  for (const auto& t : mesh.triangles) frame.triangles.insert(frame.triangles.end(), t.begin(), t.end());
  SurfaceAnimation animation;
  animation.add(frame);
  write_glb(folder.path() / "out.glb", animation);
  for (const char* name : {"out.obj", "out.vtu", "out.pvd", "out.glb"}) out += test::bytes_of(folder.path() / name);
  return out;
}

TEST(Locale, AStreamFacetWithACommaChangesNothing) {
  const KeepLocale keep;
  const std::string plain = all_of_it();
  std::locale::global(std::locale(std::locale::classic(), new Comma));
  std::ostringstream shown;
  shown << 1234.5;
  ASSERT_EQ(shown.str(), "1.234,5");
  EXPECT_EQ(all_of_it(), plain);
}

TEST(Locale, GermanChangesNothing) {
  const KeepLocale keep;
  const std::string plain = all_of_it();
  const TempFolder folder;  // where none may be installed
  const std::string made = (folder.path() / "de_DE.UTF-8").string();
  const bool done = std::system(("localedef -c -i de_DE -f UTF-8 '" + made + "' 2>/dev/null").c_str()) == 0;
  if (done) ::setenv("LOCPATH", folder.path().c_str(), 1);
  const bool german = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  if (german) std::locale::global(std::locale("de_DE.UTF-8"));
  ::unsetenv("LOCPATH");
  if (!german) GTEST_SKIP() << "there is no German locale, and localedef cannot make one";
  ASSERT_EQ(std::strtod("0,5", nullptr), 0.5);
  EXPECT_EQ(all_of_it(), plain);
}

TEST(Locale, ACommaInAFileIsNoDecimalPoint) {
  const TempFolder folder;
  const auto file = folder.write("c.obj", "v 0,5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(test::error_of([&] { read_surface(file); }).find("vertex 0 (line 1): x is '0,5'"), std::string::npos);
}

}  // namespace
}  // namespace pliant
