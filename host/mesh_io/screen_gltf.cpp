#include "mesh_io/screen_gltf.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh_io/read_volume_cursor.h"
#include "pliant/error.h"

namespace pliant {
namespace {

using Json = nlohmann::json;
using volume_file::Cursor;
using volume_file::shown;

constexpr int kLevels = 256;  // of nested JSON and of nodes: assimp recurses over both

class Screen {
 public:
  Screen(const std::filesystem::path& file, const Json& root) : file_(file), root_(root) {}

  void run() const {
    check_version();
    const auto count = [&](const char* name) { return array(name).size(); };
    for (std::size_t i = 0; i < count("bufferViews"); ++i) check_view(i);
    for (std::size_t i = 0; i < count("accessors"); ++i) check_accessor(i);
    check_nodes();
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw Error(ErrorCode::bad_input, fmt::format("surface mesh '{}', {}: {}", file_.string(), where, what));
  }

  void check_version() const {
    const Json* asset = member(root_, "asset", "");
    const Json* version = asset == nullptr ? nullptr : member(*asset, "version", "/asset");
    if (version == nullptr || !version->is_string()) fail("/asset/version", "a text such as \"2.0\" is needed");
    const auto& text = version->get_ref<const std::string&>();
    if (!text.starts_with("2.")) fail("/asset/version", fmt::format("version '{}'; only 2.x can be read", shown(text)));
  }

  const Json* member(const Json& object, const char* key, const std::string& where) const {
    if (!object.is_object()) fail(where.empty() ? "/" : where, "an object is needed");
    const auto at = object.find(key);
    return at == object.end() ? nullptr : &*at;
  }

  /// An array of the root; empty if absent.
  const Json& array(const char* name) const {
    static const Json none = Json::array();
    const Json* all = member(root_, name, "");
    if (all == nullptr) return none;
    if (!all->is_array()) fail(fmt::format("/{}", name), "an array is needed");
    return *all;
  }

  /// A whole number from 0 to 2^53 (what JSON carries exactly): sums of two cannot overflow.
  std::uint64_t whole(const Json& value, const std::string& where) const {
    constexpr std::uint64_t most = std::uint64_t{1} << 53;
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most) {
      fail(where, fmt::format("is {}; a whole number of at most 2^53 is needed",
                              shown(value.dump(-1, ' ', true, Json::error_handler_t::replace))));
    }
    return value.get<std::uint64_t>();
  }
  std::uint64_t whole(const Json& object, const char* key, const std::string& where,
                      std::optional<std::uint64_t> absent) const {
    const Json* value = member(object, key, where);
    if (value == nullptr && !absent) fail(where, fmt::format("'{}' is missing", key));
    return value == nullptr ? *absent : whole(*value, fmt::format("{}/{}", where, key));
  }

  const Json& element(const char* name, std::uint64_t index, const std::string& where) const {
    const Json& all = array(name);
    if (index >= all.size()) fail(where, fmt::format("names number {} of '{}', which has {}", index, name, all.size()));
    return all[static_cast<std::size_t>(index)];
  }

  void check_view(std::size_t i) const {
    const std::string where = fmt::format("/bufferViews/{}", i);
    const Json& view = array("bufferViews")[i];
    const std::uint64_t number = whole(view, "buffer", where, std::nullopt);
    const Json& buffer = element("buffers", number, where + "/buffer");
    const std::uint64_t size = whole(buffer, "byteLength", fmt::format("/buffers/{}", number), std::nullopt);
    const std::uint64_t offset = whole(view, "byteOffset", where, 0);
    const std::uint64_t length = whole(view, "byteLength", where, std::nullopt);
    if (offset + length > size) {
      fail(where, fmt::format("bytes {} to {} of a buffer that has {}", offset, offset + length, size));
    }
  }

  std::uint64_t component_bytes(const Json& accessor, const std::string& where) const {
    switch (const std::uint64_t type = whole(accessor, "componentType", where, std::nullopt)) {
      case 5120:
      case 5121:
        return 1;
      case 5122:
      case 5123:
        return 2;
      case 5125:
      case 5126:
        return 4;
      default:
        fail(where + "/componentType", fmt::format("is {}; allowed are 5120, 5121, 5122, 5123, 5125 and 5126", type));
    }
  }

  std::uint64_t components(const Json& accessor, const std::string& where) const {
    constexpr std::pair<std::string_view, std::uint64_t> types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                                    {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const Json* type = member(accessor, "type", where);
    for (const auto& [name, n] : types) {
      if (type != nullptr && type->is_string() && type->get_ref<const std::string&>() == name) return n;
    }
    fail(where + "/type", "has to be SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
  }

  void check_accessor(std::size_t i) const {
    const std::string where = fmt::format("/accessors/{}", i);
    const Json& accessor = array("accessors")[i];
    if (member(accessor, "sparse", where) != nullptr) fail(where, "is sparse; export the mesh with plain accessors");
    if (member(accessor, "bufferView", where) == nullptr) {
      fail(where, "'bufferView' is missing; compressed meshes cannot be read");
    }
    const std::uint64_t number = whole(accessor, "bufferView", where, std::nullopt);
    const Json& view = element("bufferViews", number, where + "/bufferView");
    const std::string view_where = fmt::format("/bufferViews/{}", number);
    const std::uint64_t size = whole(view, "byteLength", view_where, std::nullopt);
    const std::uint64_t item = component_bytes(accessor, where) * components(accessor, where);
    std::uint64_t stride = whole(view, "byteStride", view_where, 0);
    if (stride == 0) stride = item;
    if (stride < item)
      fail(view_where + "/byteStride", fmt::format("is {}, but {} holds items of {} bytes", stride, where, item));
    const std::uint64_t offset = whole(accessor, "byteOffset", where, 0);
    const std::uint64_t count = whole(accessor, "count", where, std::nullopt);
    if (count == 0) return;
    if (offset + item > size || (count - 1) > (size - offset - item) / stride) {
      fail(where, fmt::format("{} items of {} bytes, {} apart, from byte {} reach beyond the {} bytes of {}", count, item,
                              stride, offset, size, view_where));
    }
  }

  void check_nodes() const {
    const Json& nodes = array("nodes");
    constexpr auto none = ~std::size_t{0};
    std::vector<std::size_t> parent(nodes.size(), none);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::string where = fmt::format("/nodes/{}", i);
      const Json* children = member(nodes[i], "children", where);
      if (children == nullptr) continue;
      if (!children->is_array()) fail(where + "/children", "an array is needed");
      for (const Json& child : *children) {
        const std::uint64_t c = whole(child, where + "/children");
        element("nodes", c, where + "/children");
        auto& of_child = parent[static_cast<std::size_t>(c)];
        if (of_child != none)
          fail(where + "/children", fmt::format("node {} has another parent already (node {})", c, of_child));
        of_child = i;
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      int levels = 0;
      for (std::size_t at = i; at != none; at = parent[at]) {
        if (++levels > kLevels)
          fail(fmt::format("/nodes/{}", i), fmt::format("lies in a circle or below more than {} others", kLevels));
      }
    }
  }

  const std::filesystem::path& file_;
  const Json& root_;
};

/// The JSON part of a binary file: 12 bytes of header, then chunks of length, type and content.
std::string_view json_of_binary(Cursor& at, std::string_view data) {
  at.section("glTF header");
  at.binary(true);
  at.skip(4, "'glTF'");
  if (const auto version = at.raw<std::uint32_t>("the version"); version != 2) {
    at.fail(fmt::format("container version {}; only 2 can be read", version));
  }
  if (const auto length = at.raw<std::uint32_t>("the length"); length != data.size()) {
    at.fail(fmt::format("the file is said to have {} bytes; it has {}", length, data.size()));
  }
  std::string_view json;
  for (int chunk = 0; at.remaining() > 0; ++chunk) {
    at.section(fmt::format("glTF chunk {}", chunk));
    const auto length = at.raw<std::uint32_t>("the length of a chunk");
    const auto type = at.raw<std::uint32_t>("the type of a chunk");
    if (chunk == 0 && type != 0x4E4F534A) at.fail("the first chunk has to be of type JSON");
    if (length > at.remaining()) at.fail(fmt::format("a chunk of {} bytes; {} follow", length, at.remaining()));
    if (chunk == 0) json = at.rest().substr(0, length);
    at.skip(length, "a chunk");
  }
  if (json.empty()) at.fail("the chunk of type JSON is missing or empty");
  return json;
}

/// Counts brackets outside of strings.
void check_levels(const std::filesystem::path& file, std::string_view text) {
  int levels = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted) {
      i += c == '\\' ? 1 : 0;
    } else if (c == '[' || c == '{') {
      if (++levels > kLevels) {
        throw Error(ErrorCode::bad_input,
                    fmt::format("surface mesh '{}', byte {} of its JSON: more than {} levels", file.string(), i, kLevels));
      }
    } else if (c == ']' || c == '}') {
      --levels;
    }
  }
}

}  // namespace

void screen_gltf(const std::filesystem::path& file) {
  const std::string data = volume_file::load(file);
  Cursor at(file, data);
  at.swap(std::endian::native == std::endian::big);
  const std::string_view text = data.starts_with("glTF") ? json_of_binary(at, data) : std::string_view(data);
  check_levels(file, text);
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::exception& e) {
    throw Error(ErrorCode::bad_input, fmt::format("surface mesh '{}': {}", file.string(), shown(e.what(), 200)));
  }
  Screen(file, root).run();
}

}  // namespace pliant
