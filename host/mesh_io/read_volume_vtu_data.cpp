#include "mesh_io/read_volume_vtu_data.h"

#include <fmt/format.h>
#ifdef PLIANT_HAVE_ZLIB
#include <zlib.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

namespace pliant::volume_file {
namespace {

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

bool vtu_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// The first bytes of a source that is raw or base64. Groups of four are decoded one by one, so that a header which was encoded
/// on its own, with padding, and the data behind it read as one stream.
std::string first_bytes(std::string_view source, bool raw, std::uint64_t wanted, const Cursor& at) {
  if (wanted > source.size()) at.fail(fmt::format("{} bytes are announced, at most {} are there", wanted, source.size()));
  if (raw) return std::string(source.substr(0, static_cast<std::size_t>(wanted)));
  std::string out;
  out.reserve(static_cast<std::size_t>(wanted) + 3);
  std::size_t i = 0;
  while (out.size() < wanted) {
    std::uint32_t group = 0;
    int digits = 0;
    int padding = 0;
    while (i < source.size() && digits + padding < 4) {
      const char c = source[i++];
      if (vtu_blank(c)) continue;
      const int value = base64_value(c);
      if (c == '=' && digits >= 2) {
        ++padding;
        group <<= 6;
      } else if (value >= 0 && padding == 0) {
        ++digits;
        group = group << 6 | static_cast<std::uint32_t>(value);
      } else {
        at.fail("the data are not valid base64");
      }
    }
    if (digits + padding < 4) at.fail(fmt::format("the data end after {} of {} bytes", out.size(), wanted));
    for (int k = 0; k < digits - 1; ++k) out.push_back(static_cast<char>(group >> (16 - 8 * k) & 0xff));
  }
  out.resize(static_cast<std::size_t>(wanted));
  return out;
}

template <class T>
T number(std::string_view bytes, std::size_t at, bool swap) {
  std::array<char, sizeof(T)> b;
  std::memcpy(b.data(), bytes.data() + at, sizeof(T));
  if (swap) std::reverse(b.begin(), b.end());
  return std::bit_cast<T>(b);
}

std::uint64_t word(std::string_view bytes, std::size_t index, const VtuEncoding& e) {
  return e.wide ? number<std::uint64_t>(bytes, 8 * index, e.swap) : number<std::uint32_t>(bytes, 4 * index, e.swap);
}

/// Header: number of blocks, bytes of a block, bytes of the last block if it is shorter (else 0), compressed bytes of each
/// block.
std::string inflate(std::string_view source, bool raw, const VtuEncoding& e, const Cursor& at) {
#ifdef PLIANT_HAVE_ZLIB
  const std::size_t width = e.wide ? 8 : 4;
  const std::uint64_t blocks = word(first_bytes(source, raw, width, at), 0, e);
  if (blocks == 0) return {};
  if (blocks > source.size() / width)
    at.fail(fmt::format("{} compressed blocks cannot fit in {} bytes", blocks, source.size()));
  const std::string head = first_bytes(source, raw, (3 + blocks) * width, at);
  const std::uint64_t size = word(head, 1, e);
  const std::uint64_t last = word(head, 2, e);
  std::uint64_t packed = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t bytes = word(head, 3 + static_cast<std::size_t>(b), e);
    if (bytes > source.size() - std::min<std::uint64_t>(packed, source.size()))
      at.fail("the compressed blocks are longer than the data");
    packed += bytes;
  }
  // zlib compresses at most about 1032 to 1: a header with a higher ratio is wrong, whatever size it claims.
  const std::uint64_t limit = 1100 * packed + 1024;
  if (size > limit || last > size || (blocks - 1) > limit / std::max<std::uint64_t>(size, 1))
    at.fail("the compressed blocks have impossible sizes");
  std::string out;
  // A padded header occupies whole groups of four characters: skip them, then decode the blocks.
  const std::size_t head_text = raw ? head.size() : (head.size() + 2) / 3 * 4;
  if (!raw) {
    // White space around the data would shift the groups.
    while (!source.empty() && vtu_blank(source.front())) source.remove_prefix(1);
  }
  if (head_text > source.size()) at.fail("the data end in the block header");
  const std::string data = first_bytes(source.substr(head_text), raw, packed, at);
  std::size_t from = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t bytes = word(head, 3 + static_cast<std::size_t>(b), e);
    const std::uint64_t want = b + 1 == blocks && last != 0 ? last : size;
    uLongf got = static_cast<uLongf>(want);
    const std::size_t to = out.size();
    out.resize(to + static_cast<std::size_t>(want));
    const int code = uncompress(reinterpret_cast<Bytef*>(out.data() + to), &got,
                                reinterpret_cast<const Bytef*>(data.data() + from), static_cast<uLong>(bytes));
    if (code != Z_OK || got != want) at.fail(fmt::format("compressed block {} of {} is damaged", b + 1, blocks));
    from += static_cast<std::size_t>(bytes);
  }
  return out;
#else
  (void)source, (void)raw, (void)e;
  at.fail("the data are compressed and this build has no zlib; write the file without compression");
#endif
}

std::string binary_bytes(const VtuArrayText& array, const VtuEncoding& e, const Cursor& at) {
  const bool appended = array.format == "appended";
  const bool raw = appended && e.appended_raw;
  std::string_view source = array.text;
  if (appended) {
    if (array.offset > e.appended.size())
      at.fail(fmt::format("offset {} lies outside the {} appended bytes", array.offset, e.appended.size()));
    source = e.appended.substr(static_cast<std::size_t>(array.offset));
  }
  if (!e.compressor.empty() && e.compressor != "vtkZLibDataCompressor") {
    at.fail(fmt::format("compressor '{}' cannot be read; allowed are none and vtkZLibDataCompressor", e.compressor));
  }
  if (!e.compressor.empty()) return inflate(source, raw, e, at);
  const std::size_t width = e.wide ? 8 : 4;
  const std::uint64_t size = word(first_bytes(source, raw, width, at), 0, e);
  if (size > source.size()) at.fail(fmt::format("{} bytes are announced, at most {} are there", size, source.size()));
  return first_bytes(source, raw, width + size, at).substr(width);
}

template <class Stored, class T>
void convert(std::string_view bytes, bool swap, std::vector<T>& out, const Cursor& at) {
  if (bytes.size() % sizeof(Stored) != 0)
    at.fail(fmt::format("{} bytes are not whole values of {} bytes", bytes.size(), sizeof(Stored)));
  out.reserve(bytes.size() / sizeof(Stored));
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(Stored)) out.push_back(static_cast<T>(number<Stored>(bytes, i, swap)));
}

template <class T>
std::vector<T> text_values(std::string_view text, const Cursor& at) {
  std::vector<T> out;
  const char* p = text.data();
  const char* const end = p + text.size();
  while (true) {
    while (p != end && vtu_blank(*p)) ++p;
    if (p == end) return out;
    T value{};
    const auto [next, code] = std::from_chars(*p == '+' ? p + 1 : p, end, value);
    if (code != std::errc{} || (next != end && !vtu_blank(*next))) at.fail(fmt::format("value {} is not a number", out.size()));
    out.push_back(value);
    p = next;
  }
}

}  // namespace

template <class T>
std::vector<T> vtu_values(const VtuArrayText& array, const VtuEncoding& e, const Cursor& at) {
  if (array.format == "ascii") return text_values<T>(array.text, at);
  if (array.format != "binary" && array.format != "appended") {
    at.fail(fmt::format("format '{}'; allowed are ascii, binary and appended", array.format));
  }
  const std::string bytes = binary_bytes(array, e, at);
  std::vector<T> out;
  const std::string_view type = array.type;
  constexpr bool real = std::is_floating_point_v<T>;
  if (real && type == "Float32") {
    convert<float>(bytes, e.swap, out, at);
  } else if (real && type == "Float64") {
    convert<double>(bytes, e.swap, out, at);
  } else if (!real && type == "Int8") {
    convert<std::int8_t>(bytes, e.swap, out, at);
  } else if (!real && type == "UInt8") {
    convert<std::uint8_t>(bytes, e.swap, out, at);
  } else if (!real && type == "Int16") {
    convert<std::int16_t>(bytes, e.swap, out, at);
  } else if (!real && type == "UInt16") {
    convert<std::uint16_t>(bytes, e.swap, out, at);
  } else if (!real && type == "Int32") {
    convert<std::int32_t>(bytes, e.swap, out, at);
  } else if (!real && type == "UInt32") {
    convert<std::uint32_t>(bytes, e.swap, out, at);
  } else if (!real && (type == "Int64" || type == "UInt64")) {
    convert<std::int64_t>(bytes, e.swap, out, at);
  } else {
    at.fail(fmt::format("type '{}' is not one of the {}", type, real ? "floating-point types" : "integer types"));
  }
  return out;
}

template std::vector<double> vtu_values<double>(const VtuArrayText&, const VtuEncoding&, const Cursor&);
template std::vector<std::int64_t> vtu_values<std::int64_t>(const VtuArrayText&, const VtuEncoding&, const Cursor&);

}  // namespace pliant::volume_file
