// The values of one DataArray of a VTK XML file: text, base64 or raw, in line or appended, possibly compressed with zlib.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh_io/read_volume_cursor.h"

namespace pliant::volume_file {

/// Attributes of the VTKFile element for all arrays, and where the appended data are.
struct VtuEncoding {
  bool swap = false;       ///< byte order differs from the machine's
  bool wide = false;       ///< 64-bit block headers
  std::string compressor;  ///< empty, or VTK's class name; text arrays ignore it
  bool appended_raw = true;
  std::string_view appended;  ///< behind the underscore
};

struct VtuArrayText {
  std::string_view type;     ///< "Float64", "Int32", ...
  std::string_view format;   ///< "ascii", "binary", "appended"
  std::string_view text;     ///< content, for ascii and binary
  std::uint64_t offset = 0;  ///< for appended
};

/// Decode as numbers; throws through `at`, whose section names the array. T is double or std::int64_t.
template <class T>
std::vector<T> vtu_values(const VtuArrayText& array, const VtuEncoding& encoding, const Cursor& at);

}  // namespace pliant::volume_file
