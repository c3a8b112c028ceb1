#include "mesh_io/read_ply.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "mesh_io/mesh_io.h"
#include "support/temp_folder.h"
#include "surfaces.h"

namespace pliant {
namespace {

class ReadPly : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& bytes) { return folder_.write("t.ply", bytes); }
  static TriangleMesh read(const std::string& bytes) { return read_ply("t.ply", bytes); }
  static std::string error(const std::string& bytes) {
    return test::error_of([&] { read(bytes); });
  }
  static void expect_error(const std::string& bytes, const std::string& words) {
    const std::string message = error(bytes);
    EXPECT_NE(message.find(words), std::string::npos) << "expected: " << words << "\nreceived: " << message;
    EXPECT_NE(message.find("t.ply"), std::string::npos) << message;
  }
  test::TempFolder folder_;
};

enum class Encoding { text, little, big };
constexpr Encoding kEncodings[] = {Encoding::text, Encoding::little, Encoding::big};

/// Writes the numbers of a file in one of the encodings.
class Writer {
 public:
  explicit Writer(Encoding encoding) : encoding_(encoding) {}
  void header(const std::string& elements) {
    const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    bytes_ += std::string("ply\nformat ") + names[static_cast<int>(encoding_)] + " 1.0\n" + elements + "end_header\n";
  }
  template <class T>
  void put(T value) {
    if (encoding_ == Encoding::text) {
      char text[40];
      std::snprintf(text, sizeof text, std::is_integral_v<T> ? "%.0f " : "%.17g ", static_cast<double>(value));
      bytes_ += text;
      return;
    }
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    const bool swap = (encoding_ == Encoding::little) != (std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_ += raw[swap ? sizeof(T) - 1 - i : i];
  }
  void end_row() {
    if (encoding_ == Encoding::text) bytes_.back() = '\n';
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  Encoding encoding_;
  std::string bytes_;
};

template <class Real, class Length, class Index>
std::string file_of(const TriangleMesh& mesh, Encoding encoding, const std::string& real, const std::string& list) {
  Writer out(encoding);
  out.header("element vertex " + std::to_string(mesh.vertices.size()) + "\nproperty " + real + " x\nproperty " + real +
             " y\nproperty " + real + " z\nelement face " + std::to_string(mesh.triangles.size()) + "\nproperty list " + list +
             "\n");
  for (const Vec3d& v : mesh.vertices) {
    for (const double x : v) out.put(static_cast<Real>(x));
    out.end_row();
  }
  for (const auto& t : mesh.triangles) {
    out.put(Length{3});
    for (const std::int32_t i : t) out.put(static_cast<Index>(i));
    out.end_row();
  }
  return out.bytes();
}

/// A tetrahedron as text, with a part of it exchanged.
std::string tetra(const std::string& what = "", const std::string& with = "") {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  if (!what.empty()) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), with);
  }
  return text;
}

TriangleMesh random_mesh() {
  TriangleMesh mesh;
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) mesh.vertices.push_back(test::random_point(random, {-3, 0, 1e-6}, {2, 1e5, 2e-6}));
  for (int i = 0; i < 80; ++i) {
    const auto corner = [&] { return static_cast<std::int32_t>(random() % 50); };
    const std::int32_t a = corner(), b = corner(), c = corner();
    mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

TEST_F(ReadPly, DoublesSurviveEveryEncoding) {
  const TriangleMesh mesh = random_mesh();
  for (const Encoding e : kEncodings) {
    const TriangleMesh back = read(file_of<double, std::uint8_t, std::int32_t>(mesh, e, "double", "uchar int vertex_indices"));
    EXPECT_EQ(back.vertices, mesh.vertices) << static_cast<int>(e);
    EXPECT_EQ(back.triangles, mesh.triangles) << static_cast<int>(e);
  }
}

TEST_F(ReadPly, FloatsAreTheSameInEveryEncoding) {
  const TriangleMesh mesh = random_mesh();
  TriangleMesh rounded = mesh;
  for (Vec3d& v : rounded.vertices) {
    for (double& x : v) {
      const volatile float nearest = static_cast<float>(x);  // g++ 12 -O3 leaves the end of a vectorised round trip unrounded
      x = static_cast<double>(nearest);
    }
  }
  for (const Encoding e : kEncodings) {
    const TriangleMesh back =
        read(file_of<float, std::uint16_t, std::uint32_t>(mesh, e, "float32", "uint16 uint32 vertex_index"));
    EXPECT_EQ(back.vertices, rounded.vertices) << static_cast<int>(e);
    EXPECT_EQ(back.triangles, mesh.triangles) << static_cast<int>(e);
  }
  // Text with more digits than the type holds.
  EXPECT_EQ(read(tetra("\n1 0 0", "\n0.1 0 0")).vertices[1][0], static_cast<double>(0.1F));
}

TEST_F(ReadPly, IntegersOfEveryTypeAreCoordinates) {
  const TriangleMesh mesh{{{0, 0, 0}, {100, 0, 1}, {0, 127, 0}, {3, 5, 64}}, {{0, 2, 1}, {1, 2, 3}}};
  const auto check = [&]<class T>(T, const std::string& name) {
    for (const Encoding e : kEncodings) {
      const TriangleMesh back = read(file_of<T, T, T>(mesh, e, name, name + " " + name + " vertex_indices"));
      EXPECT_EQ(back.vertices, mesh.vertices) << name;
      EXPECT_EQ(back.triangles, mesh.triangles) << name;
    }
  };
  check(std::int8_t{}, "char");
  check(std::uint8_t{}, "uint8");
  check(std::int16_t{}, "short");
  check(std::uint16_t{}, "ushort");
  check(std::int32_t{}, "int32");
  check(std::uint32_t{}, "uint");
}

/// Faces before vertices, axes out of order, unknown elements and properties, lists among them, polygons, comments.
std::string crowded(Encoding encoding) {
  Writer out(encoding);
  out.header(
      "comment made by hand\nobj_info element vertex 99\nelement note 2\nproperty list uchar double text\nproperty char c\n"
      "element face 4\nproperty uchar red\nproperty list char short vertex_index\nproperty list uint float uv\n"
      "element vertex 5\nproperty double nx\nproperty float z\nproperty list ushort uchar tags\nproperty float x\n"
      "property float y\nelement nothing 12345678901234\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n");
  out.put(std::uint8_t{2}), out.put(1.5), out.put(2.5), out.put(std::int8_t{-1}), out.end_row();
  out.put(std::uint8_t{0}), out.put(std::int8_t{7}), out.end_row();
  const std::vector<std::vector<std::int16_t>> faces{{0, 1, 2, 3}, {4, 3, 2}, {0, 1}, {4, 3, 2, 1, 0}};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    out.put(std::uint8_t{200}), out.put(static_cast<std::int8_t>(faces[f].size()));
    for (const std::int16_t i : faces[f]) out.put(i);
    out.put(static_cast<std::uint32_t>(f));
    for (std::size_t k = 0; k < f; ++k) out.put(0.25F);
    out.end_row();
  }
  for (int v = 0; v < 5; ++v) {
    out.put(0.0), out.put(static_cast<float>(v + 0.5)), out.put(static_cast<std::uint16_t>(v));
    for (int k = 0; k < v; ++k) out.put(std::uint8_t{9});
    out.put(static_cast<float>(-v)), out.put(static_cast<float>(v * v)), out.end_row();
  }
  out.put(std::int32_t{0}), out.put(std::int32_t{1}), out.end_row();
  return out.bytes();
}

TEST_F(ReadPly, UnknownElementsAndPropertiesAreSkippedAndPolygonsBecomeFans) {
  for (const Encoding e : kEncodings) {
    const TriangleMesh mesh = read(crowded(e));
    ASSERT_EQ(mesh.vertices.size(), 5U);
    for (int v = 0; v < 5; ++v) {
      EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)], (Vec3d{-1.0 * v, 1.0 * v * v, v + 0.5}));
    }
    const std::vector<std::array<std::int32_t, 3>> expected{{0, 1, 2}, {0, 2, 3}, {4, 3, 2}, {4, 3, 2}, {4, 2, 1}, {4, 1, 0}};
    EXPECT_EQ(mesh.triangles, expected);
  }
}

TEST_F(ReadPly, EveryTruncationIsAnError) {
  for (const Encoding e : kEncodings) {
    const std::string whole = crowded(e);
    ASSERT_EQ(error(whole), "");
    // A text may lack its last line end; its last number has one digit.
    const std::size_t end = e == Encoding::text ? whole.size() - 1 : whole.size();
    for (std::size_t n = 0; n < end; ++n) {
      ASSERT_NE(error(whole.substr(0, n)), "")
          << "encoding " << static_cast<int>(e) << ", " << n << " of " << whole.size() << " bytes";
    }
    ASSERT_NE(error(whole + "\x01"), "");
  }
}

TEST_F(ReadPly, DamagedBytesGiveAMeshOrAnError) {
  std::mt19937 random(11);
  for (const Encoding e : kEncodings) {
    const std::string whole = crowded(e);
    for (int trial = 0; trial < 2000; ++trial) {
      std::string bytes = whole;
      for (unsigned k = 0; k <= random() % 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
      TriangleMesh mesh;
      if (!test::error_of([&] { mesh = read(bytes); }).empty()) continue;
      for (const Vec3d& v : mesh.vertices) ASSERT_TRUE(vec::finite(v));
      for (const auto& t : mesh.triangles) {
        for (const std::int32_t i : t) ASSERT_TRUE(i >= 0 && static_cast<std::size_t>(i) < mesh.vertices.size());
      }
    }
  }
}

TEST_F(ReadPly, LineEndsOfOtherSystems) {
  std::string text;
  for (const char c : tetra()) text += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(read(text).triangles, read(tetra()).triangles);
  EXPECT_EQ(read(tetra("0 1 0\n", "0\n1\t0  \n\n")).vertices, read(tetra()).vertices);  // a row over several lines
}

TEST_F(ReadPly, HeaderErrors) {
  expect_error(tetra("ply\n", "plx\n"), "t.ply:1: is no PLY file");
  expect_error(tetra("end_header\n", ""), "t.ply:9: '0' in the header");
  expect_error("ply\nformat ascii 1.0\n", "t.ply:3: the file ends inside its header; the line 'end_header' is missing");
  expect_error(tetra("ascii 1.0", "ascii 2.0"), "t.ply:2: format version '2.0'; only 1.0 can be read");
  expect_error(tetra("ascii", "binary"), "encoding 'binary'; allowed are ascii, binary_little_endian and binary_big_endian");
  expect_error(tetra("format ascii 1.0\n", ""), "no line 'format'");
  expect_error(tetra("format", "format ascii 1.0\nformat"), "t.ply:3: a second line 'format'");
  expect_error(tetra("element vertex 4\n", ""), "t.ply:3: a property before the first element");
  expect_error(tetra("vertex 4", "vertex -4"), "t.ply:3: '-4' elements 'vertex'; 0 or more are needed");
  expect_error(tetra("vertex 4", "vertex 4x"), "'4x' elements 'vertex'");
  expect_error(tetra("element vertex 4", "element vertex"), "an element needs a name and a number");
  expect_error(tetra("element face 4", "element vertex 4"), "t.ply:7: a second element 'vertex'");
  expect_error(tetra("float x", "half x"), "t.ply:4: property type 'half'; allowed are char, uchar");
  expect_error(tetra("float y", "float x"), "a second property 'x' of 'vertex'");
  expect_error(tetra("property float y\n", ""), "element 'vertex' has no property 'y'");
  expect_error(tetra("float y", "list uchar float y"), "property 'y' of 'vertex' is a list");
  expect_error(tetra("vertex_indices", "corners"), "element 'face' has 0 lists of integers named");
  expect_error(tetra("uchar int", "uchar float"), "element 'face' has 0 lists of integers named");
  expect_error(tetra("uchar int", "float int"), "a list whose length is a 'float'");
  expect_error(tetra("element vertex", "element point"), "declares no element 'vertex'");
}

TEST_F(ReadPly, CountsThatTheFileCannotHold) {
  expect_error(tetra("vertex 4", "vertex 2000000000"), "2000000000 elements 'vertex' of at least 6 bytes each cannot fit");
  expect_error(tetra("vertex 4", "vertex 3000000000"), "at most 2147483647");
  expect_error(tetra("face 4", "face 9223372036854775807"), "9223372036854775807 elements 'face'");
  expect_error(tetra("face 4", "face 9223372036854775808"), "'9223372036854775808' elements 'face'; 0 or more");
  expect_error(tetra("3 1 2 3", "2000000000 1 2 3"), "t.ply:17: the length of a list is 2000000000, which cannot fit");
  expect_error(tetra("3 1 2 3", "-1 1 2 3"), "the length of a list is -1");
  expect_error(tetra("vertex 4", "vertex 3"), "face 0");  // its row begins with the fourth vertex
}

TEST_F(ReadPly, DataErrors) {
  expect_error(tetra("3 0 1 3", "3 0 1 4"), "t.ply:15: face 1 names vertex 4; there are 4, counted from 0");
  expect_error(tetra("3 0 1 3", "3 0 -1 3"), "t.ply:15: face 1 names vertex -1");
  expect_error(tetra("3 0 1 3", "3 0 1.5 3"), "t.ply:15: expected the index of a vertex, found '1.5'");
  expect_error(tetra("\n1 0 0", "\n1 nan 0"), "t.ply:11: vertex 1: y is nan; a finite number is needed");
  expect_error(tetra("\n1 0 0", "\n1 0 -inf"), "t.ply:11: vertex 1: z is -inf");
  expect_error(tetra("\n1 0 0", "\n1e39 0 0"), "t.ply:11: vertex 1: x is inf");
  expect_error(tetra("\n1 0 0", "\n1e999 0 0"), "t.ply:11: expected a coordinate, found '1e999' (out of range)");
  expect_error(tetra("\n1 0 0", "\none 0 0"), "t.ply:11: expected a coordinate, found 'one'");
  expect_error(tetra("\n1 0 0", "\n1 0 0 7"), "vertex 1 is complete, but its line goes on with '7'");
  expect_error(tetra("3 1 2 3\n", "3 1 2 3\n3 1 2 3\n"), "t.ply:18: 8 bytes follow the last element");
  expect_error(tetra("face 4", "face 5"), "the file ends where the length of a list is expected");
}

TEST_F(ReadPly, BinaryErrorsNameElementAndByte) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}};
  const auto bytes = [&](Encoding e) {
    return file_of<float, std::uint8_t, std::int32_t>(mesh, e, "float", "uchar int vertex_index");
  };
  for (const Encoding e : {Encoding::little, Encoding::big}) {
    mesh.triangles[0][2] = 3;
    expect_error(bytes(e), "face 0 names vertex 3; there are 3");
    expect_error(bytes(e), "element 'face', byte");
    mesh.triangles[0][2] = 2;
    EXPECT_EQ(error(bytes(e)), "");
    expect_error(bytes(e).substr(0, bytes(e).size() - 3),
                 "the length of a list is 3, which cannot fit in the 9 bytes that follow");
    mesh.vertices[1][2] = HUGE_VAL;
    expect_error(bytes(e), "vertex 1: z is inf");
    mesh.vertices[1][2] = 0;
  }
}

TEST_F(ReadPly, SurfacesAreWeldedAndOrientedAsFromOtherFormats) {
  // A box, every triangle with vertices of its own, some turned, one without area.
  TriangleMesh solid = test::box({0, 0, 0}, {1, 2, 3}), soup;
  test::flip_some(solid, 0.4, 3);
  for (const auto& t : solid.triangles) {
    const auto n = static_cast<std::int32_t>(soup.vertices.size());
    for (const std::int32_t i : t) soup.vertices.push_back(solid.vertices[static_cast<std::size_t>(i)]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  soup.triangles.push_back({0, 0, 1});
  std::string obj;
  for (const Vec3d& v : soup.vertices)
    obj += "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
  for (const auto& t : soup.triangles) {
    obj += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  }
  const TriangleMesh expected = read_surface(folder_.write("t.obj", obj), 2, {1, 0, 0});
  for (const Encoding e : kEncodings) {
    const auto file = write(file_of<float, std::uint8_t, std::uint16_t>(soup, e, "float", "uchar ushort vertex_indices"));
    const TriangleMesh mesh = read_surface(file, 2, {1, 0, 0});
    EXPECT_EQ(mesh.vertices.size(), 8U);
    EXPECT_EQ(mesh.vertices, expected.vertices);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    EXPECT_NEAR(signed_volume(mesh), 48, 1e-9);
  }
  EXPECT_NE(test::error_of([&] {
              read_surface(write(tetra("face 4", "face 0").substr(0, tetra().find("3 0 2 1"))));
            }).find("no triangle"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
