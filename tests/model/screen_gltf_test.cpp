#include "mesh_io/screen_gltf.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "mesh_io/mesh_io.h"
#include "support/temp_folder.h"
#include "surfaces.h"

namespace pliant {
namespace {

using nlohmann::json;

class ScreenGltf : public ::testing::Test {
 protected:
  std::string error_of_bytes(const std::string& name, const std::string& bytes) {
    const auto file = folder_.write(name, bytes);
    return test::error_of([&] { read_surface(file); });
  }
  /// The change is a merge patch.
  void expect(const json& change, const std::string& words) {
    json root = triangle();
    root.merge_patch(change);
    const std::string message = error_of_bytes("t.gltf", root.dump());
    EXPECT_NE(message.find(words), std::string::npos) << "expected: " << words << "\nreceived: " << message;
  }
  /// The change holds at a JSON pointer.
  void expect_at(const std::string& pointer, const json& value, const std::string& words) {
    json root = triangle();
    root[json::json_pointer(pointer)] = value;
    const std::string message = error_of_bytes("t.gltf", root.dump());
    EXPECT_NE(message.find(words), std::string::npos) << "expected: " << words << "\nreceived: " << message;
  }
  /// Three corners at 0, x, y as floats, then the indices 0 1 2 as shorts.
  static json triangle() {
    return json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
      "buffers":[{"byteLength":44,"uri":
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA="}]})");
  }
  test::TempFolder folder_;
};

std::string word(std::uint32_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i));
  return bytes;
}

TEST_F(ScreenGltf, TheTriangleItselfIsRead) { EXPECT_EQ(error_of_bytes("t.gltf", triangle().dump()), ""); }

TEST_F(ScreenGltf, VersionAndText) {
  expect({{"asset", {{"version", "1.0"}}}}, "/asset/version: version '1.0'; only 2.x can be read");
  expect({{"asset", nullptr}}, "/asset/version");
  EXPECT_NE(error_of_bytes("t.gltf", "{\"asset\":").find("parse error"), std::string::npos);
  EXPECT_NE(error_of_bytes("t.gltf", std::string(100000, '[')).find("byte 256 of its JSON: more than 256 levels"),
            std::string::npos);
  expect({{"nodes", 7}}, "/nodes: an array is needed");
}

TEST_F(ScreenGltf, ViewsAndAccessorsStayInsideTheirBytes) {
  expect_at("/bufferViews/0/byteOffset", 9, "/bufferViews/0: bytes 9 to 45 of a buffer that has 44");
  expect_at("/bufferViews/0/byteOffset", 18446744073709551600U, "/bufferViews/0/byteOffset: is 18446744073709551600");
  expect_at("/bufferViews/0/byteLength", -1, "/bufferViews/0/byteLength: is -1");
  expect_at("/bufferViews/0/byteStride", 8, "/bufferViews/0/byteStride: is 8, but /accessors/0 holds items of 12 bytes");
  expect_at("/bufferViews/0/byteStride", 13, "/accessors/0: 3 items of 12 bytes, 13 apart, from byte 0 reach beyond the 36");
  expect_at("/bufferViews/1/buffer", 1, "/bufferViews/1/buffer: names number 1 of 'buffers', which has 1");
  expect_at("/accessors/0/count", 4, "/accessors/0: 4 items");
  expect_at("/accessors/0/count", 9007199254740992, "reach beyond the 36 bytes");
  expect_at("/accessors/0/byteOffset", 18446744073709551600U, "/accessors/0/byteOffset");
  expect_at("/accessors/1/byteOffset", 2, "/accessors/1: 3 items of 2 bytes");
  expect_at("/accessors/1/componentType", 5124, "/accessors/1/componentType: is 5124");
  expect_at("/accessors/1/type", "VEC5", "/accessors/1/type: has to be");
  expect_at("/accessors/0/sparse", json::object(), "/accessors/0: is sparse");
  expect_at("/accessors/0/bufferView", 2, "names number 2 of 'bufferViews', which has 2");
  json one = triangle();
  one["accessors"][0].update({{"count", 1}, {"byteOffset", 28}});
  EXPECT_NE(error_of_bytes("t.gltf", one.dump()).find("/accessors/0: 1 items of 12 bytes"), std::string::npos);
  json compressed = triangle();
  compressed["accessors"][0].erase("bufferView");
  EXPECT_NE(error_of_bytes("t.gltf", compressed.dump()).find("compressed meshes cannot be read"), std::string::npos);
}

TEST_F(ScreenGltf, NodesFormATree) {
  expect_at("/nodes", json::parse(R"([{"mesh":0,"children":[0]}])"), "/nodes/0: lies in a circle");
  expect_at("/nodes", json::parse(R"([{"mesh":0,"children":[1]},{"children":[0]}])"), "lies in a circle");
  expect_at("/nodes", json::parse(R"([{"children":[1,1]},{"mesh":0}])"), "node 1 has another parent already (node 0)");
  expect_at("/nodes", json::parse(R"([{"mesh":0,"children":[5]}])"), "names number 5 of 'nodes', which has 1");
  json chain = json::array();
  for (int i = 0; i < 256; ++i) chain.push_back({{"children", {i + 1}}});
  chain.push_back({{"mesh", 0}});
  expect_at("/nodes", chain, "/nodes/256: lies in a circle or below more than 256 others");
}

TEST_F(ScreenGltf, ChunksOfABinaryFile) {
  json root = triangle();
  root["buffers"][0].erase("uri");
  std::string text = root.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string corners(44, '\0');
  corners[14] = corners[30] = '\x80', corners[15] = corners[31] = '\x3F', corners[38] = 1, corners[40] = 2;
  const std::string bin = word(44) + std::string("BIN\0", 4) + corners;
  const auto size = static_cast<std::uint32_t>(text.size());
  const std::uint32_t all = size + 72;
  const auto whole = [&](std::uint32_t version, std::uint32_t total, std::uint32_t length) {
    return "glTF" + word(version) + word(total) + word(length) + "JSON" + text + bin;
  };
  EXPECT_EQ(error_of_bytes("t.glb", whole(2, all, size)), "");
  const auto expect_binary = [&](const std::string& bytes, const std::string& words) {
    const std::string message = error_of_bytes("t.glb", bytes);
    EXPECT_NE(message.find(words), std::string::npos) << words << "\n" << message;
  };
  expect_binary(whole(3, all, size), "container version 3");
  expect_binary(whole(2, all + 1, size), "the file is said to have " + std::to_string(all + 1));
  expect_binary(whole(2, all, 0xFFFFFFFF), "a chunk of 4294967295 bytes; " + std::to_string(all - 20) + " follow");
  expect_binary(whole(2, all, size + 4), "glTF chunk");
  for (std::size_t n = 1; n < all; ++n) ASSERT_NE(error_of_bytes("t.glb", whole(2, all, size).substr(0, n)), "");
}

TEST_F(ScreenGltf, NoFurtherFileThatIsAPipe) {
  // Opened as the material file of an OBJ, it would block until somebody wrote to it: without the check this test times out.
  ASSERT_EQ(mkfifo((folder_.path() / "t.mtl").c_str(), 0600), 0);
  EXPECT_EQ(error_of_bytes("t.obj", "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "");
  EXPECT_NE(test::error_of([&] { read_surface(folder_.path() / "t.mtl"); }).find("is no regular file"), std::string::npos);
}

}  // namespace
}  // namespace pliant
