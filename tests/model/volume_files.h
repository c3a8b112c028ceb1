// The same small mesh (one hexahedron, two tetrahedra, one triangle, one unused vertex) in every format that read_volume reads.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace pliant::testing {

inline const std::vector<Vec3d> kPoints{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0},    {0, 0, 1}, {1, 0, 1},
                                        {1, 1, 1}, {0, 1, 1}, {3, 0, 0}, {4.5, 0, 0}, {3, 1.25, 0}, {3, 0, 2}, {5, 2, 3}};
struct TestCell {
  int vtk;
  int gmsh;
  std::vector<int> nodes;
  int tag;  ///< of a material
  int entity;
};
inline const std::vector<TestCell> kCells{{12, 5, {1, 2, 3, 4, 5, 6, 7, 8}, 3, 1},
                                          {5, 2, {9, 10, 11}, 7, 1},
                                          {10, 4, {9, 10, 11, 12}, 5, 2},
                                          {10, 4, {10, 13, 11, 12}, 5, 2}};

/// Appends values in either byte order.
class Bytes {
 public:
  explicit Bytes(bool big = false) : swap_(big != (std::endian::native == std::endian::big)) {}
  Bytes& text(const std::string& s) {
    out_ += s;
    return *this;
  }
  template <class T>
  Bytes& put(T value) {
    std::array<char, sizeof(T)> b;
    std::memcpy(b.data(), &value, sizeof(T));
    if (swap_) std::reverse(b.begin(), b.end());
    out_.append(b.data(), b.size());
    return *this;
  }
  [[nodiscard]] const std::string& str() const { return out_; }

 private:
  std::string out_;
  bool swap_;
};

/// $ElementData of version 2 and 4: a vector, "a" = 1.5 + i / 4 of each cell i, and the same at a later time.
inline std::string gmsh_values(bool binary, bool big = false) {
  Bytes b(big);
  for (int data = 0; data < 3; ++data) {
    const int components = data == 0 ? 3 : 1;
    b.text(std::string("$ElementData\n1\n") + (data == 0 ? "\"v\"" : "\"a\"") + "\n1\n0.0\n3\n" + (data == 2 ? "1" : "0") +
           "\n" + std::to_string(components) + "\n" + std::to_string(kCells.size()) + "\n");
    for (std::size_t i = 0; i < kCells.size(); ++i) {
      const double value = (data == 2 ? 9 : 1.5) + 0.25 * static_cast<double>(i);
      if (binary) {
        b.put(static_cast<std::int32_t>(i + 1));
        for (int c = 0; c < components; ++c) b.put(value);
      } else {
        b.text(std::to_string(i + 1));
        for (int c = 0; c < components; ++c) b.text(" " + std::to_string(value));
        b.text("\n");
      }
    }
    b.text(binary ? "\n$EndElementData\n" : "$EndElementData\n");
  }
  return b.str();
}

inline std::string gmsh1() {
  std::ostringstream s;
  s << "$NOD\n" << kPoints.size() << "\n";
  for (std::size_t i = 0; i < kPoints.size(); ++i)
    s << 10 * i + 7 << " " << kPoints[i][0] << " " << kPoints[i][1] << " " << kPoints[i][2] << "\n";
  s << "$ENDNOD\n$ELM\n" << kCells.size() << "\n";
  for (std::size_t i = 0; i < kCells.size(); ++i) {
    s << i + 1 << " " << kCells[i].gmsh << " " << kCells[i].tag << " " << kCells[i].entity << " " << kCells[i].nodes.size();
    for (const int n : kCells[i].nodes) s << " " << 10 * n + 7;
    s << "\n";
  }
  s << "$ENDELM\n";
  return s.str();
}

inline std::string gmsh2_text() {
  std::ostringstream s;
  s << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 5 \"a tumour\"\n2 7 \"skin\"\n$EndPhysicalNames\n$Nodes\n"
    << kPoints.size() << "\n";
  for (std::size_t i = 0; i < kPoints.size(); ++i)
    s << i + 1 << " " << kPoints[i][0] << " " << kPoints[i][1] << " " << kPoints[i][2] << "\n";
  s << "$EndNodes\n$Elements\n" << kCells.size() << "\n";
  for (std::size_t i = 0; i < kCells.size(); ++i) {
    s << i + 1 << " " << kCells[i].gmsh << " 2 " << kCells[i].tag << " " << kCells[i].entity;
    for (const int n : kCells[i].nodes) s << " " << n + 1;
    s << "\n";
  }
  s << "$EndElements\n" << gmsh_values(false);
  return s.str();
}

inline std::string gmsh2_binary(bool big) {
  Bytes b(big);
  b.text("$MeshFormat\n2.2 1 8\n")
      .put<std::int32_t>(1)
      .text("\n$EndMeshFormat\n$Nodes\n" + std::to_string(kPoints.size()) + "\n");
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    b.put(static_cast<std::int32_t>(i + 1));
    for (const double x : kPoints[i]) b.put(x);
  }
  b.text("\n$EndNodes\n$Elements\n" + std::to_string(kCells.size()) + "\n");
  for (std::size_t i = 0; i < kCells.size(); ++i) {
    // The last two cells are of one kind and share a block.
    if (i != 3) b.put<std::int32_t>(kCells[i].gmsh).put<std::int32_t>(i == 2 ? 2 : 1).put<std::int32_t>(2);
    b.put(static_cast<std::int32_t>(i + 1)).put<std::int32_t>(kCells[i].tag).put<std::int32_t>(kCells[i].entity);
    for (const int n : kCells[i].nodes) b.put<std::int32_t>(n + 1);
  }
  b.text("\n$EndElements\n" + gmsh_values(true, big));
  return b.str();
}

/// A point, a curve, a face and two volumes with their groups; -7: the group has the face turned round.
inline std::string gmsh4_entities(bool v41) {
  const std::string box = " 0 0 0 1 1 1 ";
  return "$Entities\n1 1 1 2\n1" + (v41 ? std::string(" 0 0 0 ") : box) + "1 4\n1" + box + "1 9 1 1\n1" + box + "1 -7 1 1\n1" +
         box + "1 3 1 1\n2" + box + "1 5 0\n$EndEntities\n";
}

inline std::string gmsh4_text(bool v41) {
  std::ostringstream s;
  const std::size_t n = kPoints.size();
  s << "$MeshFormat\n"
    << (v41 ? "4.1" : "4") << " 0 8\n$EndMeshFormat\n"
    << "$PhysicalNames\n2\n3 5 \"a tumour\"\n2 7 \"skin\"\n$EndPhysicalNames\n"
    << gmsh4_entities(v41) << "$Nodes\n2 " << n;
  s << (v41 ? " 1 " + std::to_string(n) : "") << "\n";
  // The first block lies on a surface and carries two parametric coordinates.
  for (int block = 0; block < 2; ++block) {
    const std::size_t from = block == 0 ? 0 : 3;
    const std::size_t to = block == 0 ? 3 : n;
    s << (v41 ? (block == 0 ? "2 1 1 " : "3 1 0 ") : (block == 0 ? "1 2 1 " : "1 3 0 ")) << to - from << "\n";
    for (std::size_t i = from; v41 && i < to; ++i) s << i + 1 << "\n";
    for (std::size_t i = from; i < to; ++i) {
      if (!v41) s << i + 1 << " ";
      s << kPoints[i][0] << " " << kPoints[i][1] << " " << kPoints[i][2] << (block == 0 ? " 0.5 0.25" : "") << "\n";
    }
  }
  s << "$EndNodes\n$Elements\n3 " << kCells.size() << (v41 ? " 1 " + std::to_string(kCells.size()) : "") << "\n";
  for (std::size_t i = 0; i < kCells.size(); ++i) {
    const int dim = kCells[i].gmsh == 2 ? 2 : 3;
    if (i != 3)
      s << (v41 ? dim : kCells[i].entity) << " " << (v41 ? kCells[i].entity : dim) << " " << kCells[i].gmsh << " "
        << (i == 2 ? 2 : 1) << "\n";
    s << i + 1;
    for (const int k : kCells[i].nodes) s << " " << k + 1;
    s << "\n";
  }
  s << "$EndElements\n" << gmsh_values(false);
  return s.str();
}

inline std::string gmsh4_binary(bool v41) {
  Bytes b;
  const auto n = static_cast<std::uint64_t>(kPoints.size());
  b.text(v41 ? "$MeshFormat\n4.1 1 8\n" : "$MeshFormat\n4 1 8\n").put<std::int32_t>(1).text("\n$EndMeshFormat\n$Entities\n");
  for (const std::uint64_t count : {0, 0, 1, 2}) b.put(count);
  for (const auto& [entity, group] : {std::pair{1, -7}, {1, 3}, {2, 5}}) {
    b.put<std::int32_t>(entity);
    for (int k = 0; k < 6; ++k) b.put(0.5 * k);
    b.put<std::uint64_t>(1).put<std::int32_t>(group).put<std::uint64_t>(1).put<std::int32_t>(1);
  }
  b.text("\n$EndEntities\n$Nodes\n");
  b.put<std::uint64_t>(1).put(n);
  if (v41) b.put<std::uint64_t>(1).put(n);
  b.put<std::int32_t>(v41 ? 3 : 1).put<std::int32_t>(v41 ? 1 : 3).put<std::int32_t>(0).put(n);
  for (std::uint64_t i = 1; v41 && i <= n; ++i) b.put(i);
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    if (!v41) b.put(static_cast<std::int32_t>(i + 1));
    for (const double x : kPoints[i]) b.put(x);
  }
  b.text("\n$EndNodes\n$Elements\n").put<std::uint64_t>(3).put<std::uint64_t>(kCells.size());
  if (v41) b.put<std::uint64_t>(1).put<std::uint64_t>(kCells.size());
  const auto tag = [&](std::size_t v) { v41 ? b.put(static_cast<std::uint64_t>(v)) : b.put(static_cast<std::int32_t>(v)); };
  for (std::size_t i = 0; i < kCells.size(); ++i) {
    const int dim = kCells[i].gmsh == 2 ? 2 : 3;
    if (i != 3)
      b.put<std::int32_t>(v41 ? dim : kCells[i].entity)
          .put<std::int32_t>(v41 ? kCells[i].entity : dim)
          .put<std::int32_t>(kCells[i].gmsh)
          .put<std::uint64_t>(i == 2 ? 2 : 1);
    tag(i + 1);
    for (const int k : kCells[i].nodes) tag(static_cast<std::size_t>(k) + 1);
  }
  b.text("\n$EndElements\n" + gmsh_values(true));
  return b.str();
}

inline std::vector<std::int64_t> connectivity() {
  std::vector<std::int64_t> out;
  for (const auto& c : kCells) out.insert(out.end(), c.nodes.begin(), c.nodes.end());
  return out;
}

/// `first`: with the leading zero of the newer legacy form.
inline std::vector<std::int64_t> offsets(bool first) {
  std::vector<std::int64_t> out;
  std::int64_t end = 0;
  if (first) out.push_back(0);
  for (const auto& c : kCells) out.push_back(end += static_cast<std::int64_t>(c.nodes.size()));
  return out;
}

/// `tagged`: with attributes of every kind, of which "MaterialIds" are the tags.
inline std::string vtk_legacy(bool binary, bool newer, bool tagged = false) {
  Bytes b(true);
  const auto value = [&](auto v) {
    if (binary) {
      b.put(v);
    } else {
      std::ostringstream s;
      s << +v << " ";
      b.text(s.str());
    }
  };
  b.text(std::string("# vtk DataFile Version ") + (newer ? "5.1" : "3.0") + "\nsmall mesh\n" + (binary ? "BINARY" : "ASCII"));
  b.text("\nDATASET UNSTRUCTURED_GRID\nPOINTS " + std::to_string(kPoints.size()) + " float\n");
  for (const Vec3d& p : kPoints) {
    for (const double x : p) value(static_cast<float>(x));
  }
  b.text("\nMETADATA\nINFORMATION 0\n\n");
  const auto list = connectivity();
  if (newer) {
    b.text("CELLS " + std::to_string(kCells.size() + 1) + " " + std::to_string(list.size()) + "\nOFFSETS vtktypeint64\n");
    for (const auto v : offsets(true)) value(v);
    b.text("\nCONNECTIVITY vtktypeint64\n");
    for (const auto v : list) value(v);
  } else {
    b.text("CELLS " + std::to_string(kCells.size()) + " " + std::to_string(list.size() + kCells.size()) + "\n");
    for (const auto& c : kCells) {
      value(static_cast<std::int32_t>(c.nodes.size()));
      for (const int n : c.nodes) value(static_cast<std::int32_t>(n));
    }
  }
  b.text("\nCELL_TYPES " + std::to_string(kCells.size()) + "\n");
  for (const auto& c : kCells) value(static_cast<std::int32_t>(c.vtk));
  if (tagged) {
    b.text("\nPOINT_DATA " + std::to_string(kPoints.size()) + "\nVECTORS v double\n");
    for (std::size_t i = 0; i < 3 * kPoints.size(); ++i) value(0.5);
    b.text("\nSCALARS MaterialIds int\nLOOKUP_TABLE default\n");  // of points: no tags
    for (std::size_t i = 0; i < kPoints.size(); ++i) value(std::int32_t{9});
  }
  b.text("\nCELL_DATA 4\nSCALARS a float\nLOOKUP_TABLE default\n");
  for (int i = 0; i < 4; ++i) value(tagged ? 1.5f + 0.25f * static_cast<float>(i) : 1.0f);
  if (tagged) {
    b.text("\nTENSORS t float\n");
    for (int i = 0; i < 36; ++i) value(0.25f);
    b.text("\nSCALARS MaterialIds int 1\nLOOKUP_TABLE default\n");
    for (const auto& c : kCells) value(static_cast<std::int32_t>(c.tag));
    b.text("\nFIELD FieldData 3\npair 2 4 unsigned_char\n");
    for (int i = 0; i < 8; ++i) value(static_cast<std::uint8_t>(7));
    b.text("\npart%20of 1 4 double\n");
    for (const auto& c : kCells) value(static_cast<double>(c.entity));
    b.text("\nMETADATA\nINFORMATION 0\n\nid 1 4 vtktypeint64\n");
    for (int i = 0; i < 4; ++i) value(std::int64_t{100} + i);
  }
  b.text("\n");
  return b.str();
}

inline std::string base64(const std::string& in) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < in.size(); i += 3) {
    std::uint32_t g = 0;
    for (std::size_t k = 0; k < 3; ++k) g = g << 8 | (i + k < in.size() ? static_cast<unsigned char>(in[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) out += k <= in.size() - i ? digits[g >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

struct VtuVariant {
  enum class Where { ascii, inline64, raw, appended64 } where = Where::ascii;
  bool wide = false;
  bool compressed = false;
  bool big = false;
};

/// A zlib stream (RFC 1950, 1951) with one stored block, so that the tests need no compressor.
inline std::string zlib_stored(const std::string& data) {
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : data) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto n = static_cast<std::uint16_t>(data.size());
  const std::string body = Bytes().text("\x78\x01\x01").put(n).put(static_cast<std::uint16_t>(~n)).text(data).str();
  return body + Bytes(true).put(b << 16 | a).str();
}

/// One array as it stands in the file, header included.
inline std::string vtu_block(const std::string& data, const VtuVariant& v) {
  const auto number = [&](Bytes& b, std::size_t n) {
    v.wide ? b.put(static_cast<std::uint64_t>(n)) : b.put(static_cast<std::uint32_t>(n));
  };
  const bool raw = v.where == VtuVariant::Where::raw;
  Bytes head(v.big);
  if (!v.compressed) {
    number(head, data.size());
    return raw ? head.str() + data : base64(head.str() + data);
  }
  // Two or more blocks with a short last one, to exercise the block arithmetic.
  const std::size_t block = 40;
  const std::size_t blocks = (data.size() + block - 1) / block;
  std::string packed;
  std::vector<std::size_t> sizes;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::string part = data.substr(b * block, block);
    packed += zlib_stored(part);
    sizes.push_back(zlib_stored(part).size());
  }
  number(head, blocks);
  number(head, block);
  number(head, data.size() % block);
  for (const std::size_t s : sizes) number(head, s);
  return raw ? head.str() + packed : base64(head.str()) + base64(packed);
}

/// `tagged`: with data of cells, of which "MaterialIds" are the tags.
inline std::string vtu(const VtuVariant& v, bool tagged = false) {
  using Where = VtuVariant::Where;
  std::string appended;
  std::ostringstream s;
  const auto array = [&](const char* type, const char* name, const auto& values, auto stored) {
    using Stored = decltype(stored);
    s << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"";
    Bytes data(v.big);
    for (const auto x : values) data.put(static_cast<Stored>(x));
    if (v.where == Where::ascii) {
      s << "ascii\">\n";
      for (const auto x : values) s << x << " ";
      s << "\n</DataArray>\n";
    } else if (v.where == Where::inline64) {
      s << "binary\">\n  " << vtu_block(data.str(), v) << "\n</DataArray>\n";
    } else {
      s << "appended\" offset=\"" << appended.size() << "\"/>\n";
      appended += vtu_block(data.str(), v);
    }
  };
  s << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"" << (v.big ? "Big" : "Little")
    << "Endian\"";
  s << (v.wide ? " header_type=\"UInt64\"" : "") << (v.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") << ">\n";
  s << "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" << kPoints.size() << "\" NumberOfCells=\"" << kCells.size()
    << "\">\n<Points>\n";
  std::vector<double> xs;
  for (const Vec3d& p : kPoints) xs.insert(xs.end(), p.begin(), p.end());
  array("Float64", "Points", xs, double{});
  s << "</Points>\n<Cells>\n";
  array("Int64", "connectivity", connectivity(), std::int64_t{});
  array("Int32", "offsets", offsets(false), std::int32_t{});
  std::vector<int> types;
  for (const auto& c : kCells) types.push_back(c.vtk);
  array("UInt8", "types", types, std::uint8_t{});
  s << "</Cells>\n";
  if (tagged) {
    std::vector<int> tags, entities;
    for (const auto& c : kCells) tags.push_back(c.tag), entities.push_back(c.entity);
    s << "<CellData>\n";
    array("Float32", "a", std::vector<double>{1.5, 1.75, 2, 2.25}, float{});
    array("Int32", "MaterialIds", tags, std::int32_t{});
    array("Float64", "part of", entities, double{});
    s << "</CellData>\n";
  }
  s << "</Piece>\n</UnstructuredGrid>\n";
  if (!appended.empty())
    s << "<AppendedData encoding=\"" << (v.where == Where::raw ? "raw" : "base64") << "\">\n_" << appended
      << "\n</AppendedData>\n";
  s << "</VTKFile>\n";
  return s.str();
}

inline std::string tetgen_node(int base) {
  std::ostringstream s;
  s << "# a comment\n" << kPoints.size() << " 3 1 1\n";
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    s << i + static_cast<std::size_t>(base) << " " << kPoints[i][0] << " " << kPoints[i][1] << " " << kPoints[i][2]
      << " 0.5 1\n";
  }
  return s.str() + "# end\n";
}

inline std::string tetgen_ele(int base) {
  std::ostringstream s;
  s << "2 4 1\n";
  for (int i = 2; i < 4; ++i) {
    s << i - 2 + base;
    for (const int n : kCells[static_cast<std::size_t>(i)].nodes) s << " " << n + base;
    s << " 7\n";
  }
  return s.str() + "# end\n";
}

struct VolumeFile {
  std::string name;  ///< unique, usable as a test name
  std::string extension;
  std::string content;
};

/// Every format that holds its mesh in one file. `tagged`: with cell data in those of VTK; those of Gmsh always have tags.
inline std::vector<VolumeFile> volume_files(bool tagged = false) {
  using Where = VtuVariant::Where;
  std::vector<VolumeFile> out{{"gmsh1", ".msh", gmsh1()},
                              {"gmsh2_text", ".msh", gmsh2_text()},
                              {"gmsh2_little", ".msh", gmsh2_binary(false)},
                              {"gmsh2_big", ".msh", gmsh2_binary(true)},
                              {"gmsh40_text", ".msh", gmsh4_text(false)},
                              {"gmsh41_text", ".msh", gmsh4_text(true)},
                              {"gmsh40_binary", ".msh", gmsh4_binary(false)},
                              {"gmsh41_binary", ".msh", gmsh4_binary(true)},
                              {"vtk_text", ".vtk", vtk_legacy(false, false, tagged)},
                              {"vtk_binary", ".vtk", vtk_legacy(true, false, tagged)},
                              {"vtk5_text", ".vtk", vtk_legacy(false, true, tagged)},
                              {"vtk5_binary", ".vtk", vtk_legacy(true, true, tagged)},
                              {"vtu_ascii", ".vtu", vtu({}, tagged)}};
  const std::array<std::pair<const char*, Where>, 3> places{
      {{"inline", Where::inline64}, {"raw", Where::raw}, {"base64", Where::appended64}}};
  for (const auto& [name, where] : places) {
    for (int bits = 0; bits < 8; ++bits) {
      const VtuVariant v{where, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0};
      out.push_back(
          {std::string("vtu_") + name + (v.wide ? "_64" : "_32") + (v.compressed ? "_zlib" : "") + (v.big ? "_big" : ""),
           ".vtu", vtu(v, tagged)});
    }
  }
  return out;
}

}  // namespace pliant::testing
