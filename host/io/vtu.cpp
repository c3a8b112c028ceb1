#include "io/vtu.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>

#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Little-endian values through a small block, so that no second copy of a large array is made.
template <class T>
class Stream {
 public:
  explicit Stream(AtomicFile& out) : out_(out) {}
  ~Stream() = default;
  void put(T value) {
    if constexpr (std::endian::native == std::endian::big) {
      auto* bytes = reinterpret_cast<unsigned char*>(&value);
      std::reverse(bytes, bytes + sizeof(T));
    }
    block_[used_++] = value;
    if (used_ == block_.size()) flush();
  }
  void flush() {
    out_.write(block_.data(), used_ * sizeof(T));
    used_ = 0;
  }

 private:
  AtomicFile& out_;
  std::array<T, 1024> block_;
  std::size_t used_ = 0;
};

/// The XML head; every data array reserves its place in the appended section.
class Head {
 public:
  void text(const std::string& line) { text_ += line; }
  void array(const char* type, const std::string& name, int components, std::uint64_t bytes) {
    text_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
                         type, escaped(name), components, offset_);
    offset_ += 8 + bytes;
  }
  [[nodiscard]] const std::string& str() const { return text_; }

 private:
  std::string text_;
  std::uint64_t offset_ = 0;
};

std::size_t cell_count(const VtuMesh& m) {
  return m.tets.size() + m.quadratic_tets.size() + m.hexes.size() + m.triangles.size();
}
std::size_t corner_count(const VtuMesh& m) {
  return 4 * m.tets.size() + 10 * m.quadratic_tets.size() + 8 * m.hexes.size() + 3 * m.triangles.size();
}

void check_arrays(const std::vector<VtuArray>& arrays, std::size_t count, const char* what, const std::filesystem::path& file) {
  for (const VtuArray& a : arrays) {
    if ((a.components != 1 && a.components != 3 && a.components != 6) ||
        a.values.size() != count * static_cast<std::size_t>(a.components)) {
      throw Error(ErrorCode::internal, fmt::format("cannot write '{}': array '{}' has {} values of {} components for {} {}",
                                                   file.string(), a.name, a.values.size(), a.components, count, what));
    }
  }
}

template <std::size_t N>
void check_cells(const std::vector<std::array<std::int32_t, N>>& cells, std::size_t points, const std::filesystem::path& file) {
  for (const auto& cell : cells) {
    for (const std::int32_t i : cell) {
      if (i < 0 || static_cast<std::size_t>(i) >= points) {
        throw Error(ErrorCode::internal,
                    fmt::format("cannot write '{}': a cell names point {} of {}", file.string(), i, points));
      }
    }
  }
}

void check(const VtuMesh& mesh, const std::filesystem::path& file) {
  check_arrays(mesh.point_arrays, mesh.points.size(), "points", file);
  check_arrays(mesh.cell_arrays, cell_count(mesh), "cells", file);
  check_cells(mesh.tets, mesh.points.size(), file);
  check_cells(mesh.quadratic_tets, mesh.points.size(), file);
  check_cells(mesh.hexes, mesh.points.size(), file);
  check_cells(mesh.triangles, mesh.points.size(), file);
  if (corner_count(mesh) > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw Error(ErrorCode::bad_input, fmt::format("cannot write '{}': {} cell corners, at most 2147483647 are possible",
                                                  file.string(), corner_count(mesh)));
  }
}

void describe_arrays(Head& head, const char* tag, const std::vector<VtuArray>& arrays) {
  if (arrays.empty()) return;
  head.text(fmt::format("<{}>\n", tag));
  for (const VtuArray& a : arrays) head.array("Float32", a.name, a.components, sizeof(float) * a.values.size());
  head.text(fmt::format("</{}>\n", tag));
}

/// Must list the arrays in the order in which write_vtu sends them.
std::string head_of(const VtuMesh& mesh) {
  Head head;
  head.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n");
  head.text(
      fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n", mesh.points.size(), cell_count(mesh)));
  head.array("Float32", "Points", 3, 12 * mesh.points.size());
  head.text("</Points>\n<Cells>\n");
  head.array("Int32", "connectivity", 1, 4 * corner_count(mesh));
  head.array("Int32", "offsets", 1, 4 * cell_count(mesh));
  head.array("UInt8", "types", 1, cell_count(mesh));
  head.text("</Cells>\n");
  describe_arrays(head, "PointData", mesh.point_arrays);
  describe_arrays(head, "CellData", mesh.cell_arrays);
  head.text("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  return head.str();
}

void send_size(AtomicFile& out, std::uint64_t bytes) {
  Stream<std::uint64_t> stream(out);
  stream.put(bytes);
  stream.flush();
}

template <std::size_t N>
void send_corners(Stream<std::int32_t>& out, const std::vector<std::array<std::int32_t, N>>& cells) {
  for (const auto& cell : cells) {
    for (const std::int32_t i : cell) out.put(i);
  }
}

void send_cells(AtomicFile& out, const VtuMesh& mesh) {
  Stream<std::int32_t> ints(out);
  send_size(out, 4 * corner_count(mesh));
  send_corners(ints, mesh.tets);
  send_corners(ints, mesh.quadratic_tets);
  send_corners(ints, mesh.hexes);
  send_corners(ints, mesh.triangles);
  ints.flush();

  struct Kind {
    std::size_t count;
    std::int32_t corners;
    std::uint8_t type;
  };
  const std::array<Kind, 4> kinds{{{mesh.tets.size(), 4, 10},
                                   {mesh.quadratic_tets.size(), 10, 24},
                                   {mesh.hexes.size(), 8, 12},
                                   {mesh.triangles.size(), 3, 5}}};
  send_size(out, 4 * cell_count(mesh));
  std::int32_t end = 0;
  for (const Kind& kind : kinds) {
    for (std::size_t i = 0; i < kind.count; ++i) ints.put(end += kind.corners);
  }
  ints.flush();

  Stream<std::uint8_t> types(out);
  send_size(out, cell_count(mesh));
  for (const Kind& kind : kinds) {
    for (std::size_t i = 0; i < kind.count; ++i) types.put(kind.type);
  }
  types.flush();
}

void send_arrays(AtomicFile& out, const std::vector<VtuArray>& arrays) {
  for (const VtuArray& a : arrays) {
    send_size(out, sizeof(float) * a.values.size());
    Stream<float> floats(out);
    for (const float v : a.values) floats.put(v);
    floats.flush();
  }
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const VtuMesh& mesh) {
  check(mesh, file);
  AtomicFile out(file);
  out.write(head_of(mesh));
  send_size(out, 12 * mesh.points.size());
  Stream<float> floats(out);
  for (const Vec3d& p : mesh.points) {
    for (const double x : p) floats.put(static_cast<float>(x));
  }
  floats.flush();
  send_cells(out, mesh);
  send_arrays(out, mesh.point_arrays);
  send_arrays(out, mesh.cell_arrays);
  out.write("\n</AppendedData>\n</VTKFile>\n");
  out.commit();
}

void PvdSeries::append(double time, const std::filesystem::path& frame) {
  const std::filesystem::path folder = file_.parent_path();
  std::filesystem::path relative = frame.lexically_proximate(folder.empty() ? std::filesystem::path(".") : folder);
  if (relative.empty()) relative = frame;
  frames_.emplace_back(time, relative.generic_string());
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto& [when, name] : frames_) {
    text += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", when, escaped(name));
  }
  text += "</Collection>\n</VTKFile>\n";
  write_file(file_, text);
}

}  // namespace pliant
