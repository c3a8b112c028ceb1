#include "mesh_io/read_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh_io/read_volume_cursor.h"

namespace pliant {
namespace {

using volume_file::Cursor;
using volume_file::shown;

enum class Type { none, int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::pair<std::string_view, Type> kTypes[] = {
    {"char", Type::int8},   {"uchar", Type::uint8},   {"short", Type::int16},     {"ushort", Type::uint16},
    {"int", Type::int32},   {"uint", Type::uint32},   {"float", Type::float32},   {"double", Type::float64},
    {"int8", Type::int8},   {"uint8", Type::uint8},   {"int16", Type::int16},     {"uint16", Type::uint16},
    {"int32", Type::int32}, {"uint32", Type::uint32}, {"float32", Type::float32}, {"float64", Type::float64}};

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::float64:
      return 8;
    default:
      return 4;
  }
}

bool is_integer(Type type) { return type != Type::float32 && type != Type::float64; }

struct Property {
  std::string name;
  Type type = Type::none;
  Type length = Type::none;  ///< of a list: the type of its length; none for a single number
  [[nodiscard]] bool list() const { return length != Type::none; }
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::string_view data) : at_(file, data) {}

  TriangleMesh read() {
    read_header();
    check_header();
    for (const Element& element : elements_) read_element(element);
    if (at_.at_end()) return std::move(mesh_);
    at_.seek(at_.position());
    at_.fail(fmt::format("{} bytes follow the last element that the header declares", at_.remaining()));
  }

 private:
  // --- header: always text ---
  std::vector<std::string_view> header_line() {
    at_.seek(at_.position());  // what a message names
    if (at_.remaining() == 0) at_.fail("the file ends inside its header; the line 'end_header' is missing");
    return words_of(at_.line());
  }

  void read_header() {
    auto words = header_line();
    if (words.size() != 1 || words[0] != "ply") at_.fail("is no PLY file: its first line has to be 'ply'");
    for (bool formatted = false;;) {
      words = header_line();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") {
        if (!formatted) at_.fail("the header has no line 'format'");
        return;
      }
      if (words[0] == "format") {
        if (formatted) at_.fail("a second line 'format'");
        read_format(words);
        formatted = true;
      } else if (words[0] == "element") {
        read_element_line(words);
      } else if (words[0] == "property") {
        read_property_line(words);
      } else {
        at_.fail(fmt::format("'{}' in the header; allowed are format, comment, obj_info, element, property and end_header",
                             shown(words[0])));
      }
    }
  }

  void read_format(const std::vector<std::string_view>& words) {
    if (words.size() != 3) at_.fail("the line 'format' needs an encoding and a version, as in 'format ascii 1.0'");
    if (words[2] != "1.0") at_.fail(fmt::format("format version '{}'; only 1.0 can be read", shown(words[2])));
    text_ = words[1] == "ascii";
    const bool big = words[1] == "binary_big_endian";
    if (!text_ && !big && words[1] != "binary_little_endian") {
      at_.fail(fmt::format("encoding '{}'; allowed are ascii, binary_little_endian and binary_big_endian", shown(words[1])));
    }
    at_.swap(big == (std::endian::native == std::endian::little));
  }

  void read_element_line(const std::vector<std::string_view>& words) {
    if (words.size() != 3) at_.fail("an element needs a name and a number, as in 'element vertex 8'");
    for (const Element& e : elements_) {
      if (e.name == words[1]) at_.fail(fmt::format("a second element '{}'", shown(words[1])));
    }
    const std::int64_t count = volume_file::parse_integer(words[2]).value_or(-1);
    if (count < 0) at_.fail(fmt::format("'{}' elements '{}'; 0 or more are needed", shown(words[2]), shown(words[1])));
    elements_.push_back({std::string(words[1]), count, {}});
  }

  Type type_of(std::string_view word) const {
    for (const auto& [name, type] : kTypes) {
      if (name == word) return type;
    }
    at_.fail(
        fmt::format("property type '{}'; allowed are char, uchar, short, ushort, int, uint, float and double, "
                    "or int8 to float64",
                    shown(word)));
  }

  void read_property_line(const std::vector<std::string_view>& words) {
    if (elements_.empty()) at_.fail("a property before the first element");
    Property property;
    if (words.size() == 5 && words[1] == "list") {
      property = {std::string(words[4]), type_of(words[3]), type_of(words[2])};
      if (!is_integer(property.length)) at_.fail(fmt::format("a list whose length is a '{}'; an integer is needed", words[2]));
    } else if (words.size() == 3) {
      property = {std::string(words[2]), type_of(words[1])};
    } else {
      at_.fail("a property needs a type and a name, as in 'property float x' or 'property list uchar int vertex_indices'");
    }
    for (const Property& p : elements_.back().properties) {
      if (p.name == property.name)
        at_.fail(fmt::format("a second property '{}' of '{}'", shown(p.name), shown(elements_.back().name)));
    }
    elements_.back().properties.push_back(std::move(property));
  }

  // --- what the header promises ---
  void check_header() {
    at_.seek(at_.position());
    const Element* vertex = find("vertex");
    if (vertex == nullptr) at_.fail("the header declares no element 'vertex'");
    for (const char* axis : {"x", "y", "z"}) {
      const auto& all = vertex->properties;
      const auto p = std::find_if(all.begin(), all.end(), [&](const Property& q) { return q.name == axis; });
      if (p == all.end()) at_.fail(fmt::format("element 'vertex' has no property '{}'", axis));
      if (p->list()) at_.fail(fmt::format("property '{}' of 'vertex' is a list; a number is needed", axis));
    }
    if (vertex->count > std::numeric_limits<std::int32_t>::max()) {
      at_.fail(fmt::format("{} vertices; at most {} can be read", vertex->count, std::numeric_limits<std::int32_t>::max()));
    }
    vertices_ = vertex->count;
    if (const Element* face = find("face"); face != nullptr && face->count > 0) {
      const auto corners = std::count_if(face->properties.begin(), face->properties.end(), is_corners);
      if (corners != 1) {
        at_.fail(fmt::format("element 'face' has {} lists of integers named 'vertex_indices' or 'vertex_index'; one is needed",
                             corners));
      }
    }
  }

  const Element* find(std::string_view name) const {
    const auto e = std::find_if(elements_.begin(), elements_.end(), [&](const Element& q) { return q.name == name; });
    return e == elements_.end() ? nullptr : &*e;
  }

  static bool is_corners(const Property& p) {
    return p.list() && is_integer(p.type) && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  // --- data ---
  void read_element(const Element& element) {
    if (element.properties.empty() || element.count == 0) return;
    const std::string name = shown(element.name);
    if (!text_) at_.section(fmt::format("element '{}'", name));
    at_.binary(!text_);
    at_.seek(at_.position());
    // A number of a text takes a digit and a separator; the last one of the file may lack the latter.
    std::size_t bytes = 0;
    for (const Property& p : element.properties) bytes += text_ ? 2 : size_of(p.list() ? p.length : p.type);
    if (static_cast<std::uint64_t>(element.count) > (at_.remaining() + 1) / bytes) {
      at_.fail(fmt::format("{} elements '{}' of at least {} bytes each cannot fit in the {} bytes that follow the header",
                           element.count, name, bytes, at_.remaining()));
    }
    const bool vertex = element.name == "vertex";
    const bool face = element.name == "face";
    if (vertex) mesh_.vertices.reserve(static_cast<std::size_t>(element.count));
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (vertex) {
        read_vertex(element, i);
      } else {
        for (const Property& p : element.properties) face&& is_corners(p) ? read_corners(p, i) : skip(p);
      }
      if (text_) end_of_row(name, i);
    }
  }

  void read_vertex(const Element& element, std::int64_t i) {
    Vec3d point{};
    for (const Property& p : element.properties) {
      const int axis = p.name == "x" ? 0 : p.name == "y" ? 1 : p.name == "z" ? 2 : 3;
      if (axis == 3) {
        skip(p);
        continue;
      }
      point[axis] = number(p.type, "a coordinate");
      if (!std::isfinite(point[axis]))
        at_.fail(fmt::format("vertex {}: {} is {}; a finite number is needed", i, p.name, point[axis]));
    }
    mesh_.vertices.push_back(point);
  }

  void read_corners(const Property& p, std::int64_t i) {
    const std::int64_t n = length(p);
    std::int32_t first = 0, before = 0;
    for (std::int64_t k = 0; k < n; ++k) {
      const std::int64_t index = integer(p.type, "the index of a vertex");
      if (index < 0 || index >= vertices_) {
        at_.fail(fmt::format("face {} names vertex {}; there are {}, counted from 0", i, index, vertices_));
      }
      const auto corner = static_cast<std::int32_t>(index);
      if (k == 0) first = corner;
      if (k >= 2) mesh_.triangles.push_back({first, before, corner});
      before = corner;
    }
  }

  void skip(const Property& p) {
    const std::int64_t n = p.list() ? length(p) : 1;
    if (!text_) return at_.skip(static_cast<std::size_t>(n) * size_of(p.type), "a property");
    for (std::int64_t k = 0; k < n; ++k) at_.token("a property");
  }

  std::int64_t length(const Property& p) {
    return at_.check_count(integer(p.length, "the length of a list"), "the length of a list", text_ ? 1 : size_of(p.type));
  }

  /// A row that goes on holds other columns than the header says: every later number would be taken for another one.
  void end_of_row(const std::string& name, std::int64_t i) {
    const std::string_view rest = at_.rest();
    const std::size_t next = rest.find_first_not_of(" \t\r");
    if (next == std::string_view::npos || rest[next] == '\n') return;
    const auto more = words_of(rest.substr(0, std::min<std::size_t>(rest.find('\n'), 80)));
    at_.fail(fmt::format("{} {} is complete, but its line goes on with '{}'", name, i, shown(more.front())));
  }

  double number(Type type, const char* what) {
    if (text_) {
      // As the declared type, so that all encodings of a file agree.
      const double value = at_.real(what);
      return type == Type::float32 ? to_float(value) : value;
    }
    if (type == Type::float32) return static_cast<double>(at_.raw<float>(what));
    if (type == Type::float64) return at_.raw<double>(what);
    return static_cast<double>(integer(type, what));
  }

  static double to_float(double value) {
    constexpr double largest = std::numeric_limits<float>::max();
    if (std::abs(value) > largest) return std::copysign(HUGE_VAL, value);  // the cast would be undefined
    return static_cast<double>(static_cast<float>(value));
  }

  std::int64_t integer(Type type, const char* what) {
    if (text_) return at_.integer(what);
    switch (type) {
      case Type::int8:
        return at_.raw<std::int8_t>(what);
      case Type::uint8:
        return at_.raw<std::uint8_t>(what);
      case Type::int16:
        return at_.raw<std::int16_t>(what);
      case Type::uint16:
        return at_.raw<std::uint16_t>(what);
      case Type::int32:
        return at_.raw<std::int32_t>(what);
      default:
        return at_.raw<std::uint32_t>(what);
    }
  }

  Cursor at_;
  bool text_ = true;
  std::vector<Element> elements_;
  std::int64_t vertices_ = 0;  ///< that the header declares
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_ply(const std::filesystem::path& file, std::string_view data) { return Reader(file, data).read(); }

TriangleMesh read_ply(const std::filesystem::path& file) { return read_ply(file, volume_file::load(file)); }

}  // namespace pliant
