// VTK legacy files: what POINT_DATA and CELL_DATA say. Only numbers of cells are kept; the rest is passed over, which takes
// knowing how long it is.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <type_traits>
#include <utility>

#include "mesh_io/read_volume_parts.h"

namespace pliant::volume_file {
namespace {

std::int64_t components_of(const std::string& attribute) {
  if (attribute == "vectors" || attribute == "normals") return 3;
  return attribute == "tensors" ? 9 : attribute == "tensors6" ? 6 : 0;
}

/// Writers that follow VTK's own put %20 for a blank, and so on.
std::string decoded(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto hex = [&](std::size_t k) { return k < name.size() && std::isxdigit(static_cast<unsigned char>(name[k])) != 0; };
    if (name[i] == '%' && hex(i + 1) && hex(i + 2)) {
      out += static_cast<char>(std::stoi(std::string(name.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      out += name[i];
    }
  }
  return out;
}

class Attributes {
 public:
  Attributes(Cursor& at, bool binary, bool cells, RawMesh& mesh) : at_(at), binary_(binary), cells_(cells), mesh_(mesh) {}
  void read();

 private:
  std::int64_t size(const char* what);
  void attribute(const std::string& key);
  void scalars();
  void field();
  void table();
  void values(const std::string& name, const std::string& type, std::int64_t components, std::int64_t tuples);
  template <class T>
  void keep(const std::string& name, const std::string& type, std::int64_t n);

  Cursor& at_;
  bool binary_, cells_;
  RawMesh& mesh_;
  std::int64_t tuples_ = 0;
};

/// Not negative; that values fit in the file is checked where they are read.
std::int64_t Attributes::size(const char* what) {
  const std::int64_t n = at_.integer(what);
  if (n < 0) at_.fail(fmt::format("{} is {}; it cannot be negative", what, n));
  return n;
}

template <class T>
void Attributes::keep(const std::string& name, const std::string& type, std::int64_t n) {
  const std::size_t size = vtk_type_size(type);
  const bool is_unsigned = type.find("unsigned") == 0 || type.find("uint") != std::string::npos;
  const auto binary_value = [&]() -> T {
    if (type == "float") return static_cast<T>(at_.raw<float>("a value"));
    if (type == "double") return static_cast<T>(at_.raw<double>("a value"));
    switch (size) {
      case 1:
        return is_unsigned ? static_cast<T>(at_.raw<std::uint8_t>("a value")) : static_cast<T>(at_.raw<std::int8_t>("a value"));
      case 2:
        return is_unsigned ? static_cast<T>(at_.raw<std::uint16_t>("a value"))
                           : static_cast<T>(at_.raw<std::int16_t>("a value"));
      case 4:
        return is_unsigned ? static_cast<T>(at_.raw<std::uint32_t>("a value"))
                           : static_cast<T>(at_.raw<std::int32_t>("a value"));
      default:
        return static_cast<T>(at_.raw<std::int64_t>("a value"));
    }
  };
  std::vector<T> out(static_cast<std::size_t>(n));
  for (T& v : out) {
    if (binary_) {
      v = binary_value();
    } else if constexpr (std::is_same_v<T, double>) {
      v = at_.real("a value");
    } else {
      v = at_.integer("a value");
    }
  }
  add_cell_values(mesh_, name, 0, std::span<const T>(out));
}

void Attributes::values(const std::string& name, const std::string& type, std::int64_t components, std::int64_t tuples) {
  const std::size_t size = vtk_type_size(type);
  if (size == 0 && type != "bit") at_.fail(fmt::format("an array of type '{}' cannot be read", shown(type)));
  if (components > 0 && static_cast<std::uint64_t>(tuples) > 8 * at_.remaining() / static_cast<std::uint64_t>(components))
    at_.fail(fmt::format("an array of {} times {} values cannot fit in the file", components, tuples));
  const std::int64_t n = components * tuples;
  at_.section("CELL_DATA");
  if (binary_) {
    at_.line();
    at_.binary(true);
  }
  if (type != "bit") at_.check_count(n, "the number of values", binary_ ? size : 1);
  if (cells_ && components == 1 && tuples == mesh_.cells && type != "bit") {
    type == "float" || type == "double" ? keep<double>(name, type, n) : keep<std::int64_t>(name, type, n);
  } else if (binary_) {
    at_.skip(type == "bit" ? static_cast<std::size_t>(n + 7) / 8 : static_cast<std::size_t>(n) * size, "a value");
  } else {
    for (std::int64_t i = 0; i < n; ++i) at_.token("a value");
  }
  at_.binary(false);
}

void Attributes::scalars() {
  const std::string name = decoded(at_.token("an array's name"));
  const std::string type = lower_word(at_.token("an array's type"));
  // The number of components may follow; what gives colours is an attribute of its own, or missing.
  const std::string_view rest = at_.line();
  const std::size_t digit = rest.find_first_not_of(" \t\r");
  std::int64_t components = 1;
  if (digit != std::string_view::npos) {
    const auto number = parse_integer(rest.substr(digit, rest.find_last_not_of(" \t\r") + 1 - digit));
    if (!number || *number < 1 || *number > 1000)
      at_.fail(fmt::format("'{}' is not a number of components", shown(rest.substr(digit))));
    components = *number;
  }
  const std::size_t before = at_.position();
  if (!at_.at_end() && lower_word(at_.token("LOOKUP_TABLE")) == "lookup_table") {
    at_.token("a table's name");
  } else {
    at_.seek(before);
  }
  // values() skips the rest of a line; without a table there is none left.
  if (binary_ && at_.position() == before) at_.seek(before - 1);
  values(name, type, components, tuples_);
}

void Attributes::field() {
  at_.token("a field's name");
  for (std::int64_t arrays = at_.count("the number of arrays", 1); arrays > 0; --arrays) {
    std::string_view name = at_.token("an array's name");
    while (lower_word(name) == "metadata") {  // of the array before; it ends with an empty line
      at_.line();
      while (at_.remaining() > 0 && !at_.line().empty()) continue;
      name = at_.token("an array's name");
    }
    const std::string known = decoded(name);
    const std::int64_t components = size("the number of components");
    const std::int64_t tuples = size("the number of tuples");
    values(known, lower_word(at_.token("an array's type")), components, tuples);
  }
}

/// Colours: four bytes each, or four numbers.
void Attributes::table() {
  at_.token("a table's name");
  const std::int64_t n = at_.count("the number of colours", 1);
  const bool kept = std::exchange(cells_, false);
  values("", binary_ ? "unsigned_char" : "float", 4, n);
  cells_ = kept;
}

void Attributes::attribute(const std::string& key) {
  if (key == "scalars") return scalars();
  if (key == "field") return field();
  if (key == "lookup_table") return table();
  const std::string name = decoded(at_.token("an array's name"));
  if (key == "color_scalars") {
    const std::int64_t components = at_.count("the number of components", 1);
    return values("", binary_ ? "unsigned_char" : "float", components, tuples_);
  }
  if (key == "global_ids" || key == "pedigree_ids") return values(name, lower_word(at_.token("a type")), 1, tuples_);
  if (key == "texture_coordinates") {
    const std::int64_t components = at_.count("the number of components", 1);
    return values(name, lower_word(at_.token("a type")), components, tuples_);
  }
  const std::int64_t components = components_of(key);
  if (components == 0) at_.fail(fmt::format("'{}' is no attribute of POINT_DATA or CELL_DATA", shown(key)));
  values(name, lower_word(at_.token("a type")), components, tuples_);
}

void Attributes::read() {
  tuples_ = size("the number of tuples");
  while (!at_.at_end()) {
    const std::string key = lower_word(at_.token("an attribute"));
    if (key == "point_data" || key == "cell_data") {
      cells_ = key == "cell_data";
      tuples_ = size("the number of tuples");
    } else if (key == "metadata") {
      at_.line();
      while (at_.remaining() > 0 && !at_.line().empty()) continue;
    } else {
      attribute(key);
    }
  }
}

}  // namespace

std::string lower_word(std::string_view word) {
  std::string out(word.substr(0, 40));
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::size_t vtk_type_size(const std::string& type) {
  if (type == "char" || type == "unsigned_char" || type == "vtktypeint8" || type == "vtktypeuint8") return 1;
  if (type == "short" || type == "unsigned_short" || type == "vtktypeint16" || type == "vtktypeuint16") return 2;
  if (type == "int" || type == "unsigned_int" || type == "float" || type == "vtkidtype") return 4;
  if (type == "vtktypeint32" || type == "vtktypeuint32") return 4;
  if (type == "long" || type == "unsigned_long" || type == "double" || type == "vtktypeint64" || type == "vtktypeuint64")
    return 8;
  return 0;
}

void read_vtk_attributes(Cursor& at, bool binary, bool cells, RawMesh& mesh) { Attributes(at, binary, cells, mesh).read(); }

}  // namespace pliant::volume_file
