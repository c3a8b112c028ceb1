#include "io/checkpoint.h"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <string_view>

#include "io/atomic_file.h"
#include "pliant/error.h"
#include "program/hash.h"

// Layout: "PLIANTCK", u32 version, u32 zero, u64 length of the whole file, then u64 parts {string, u64 hash}, string name,
// string real type, string run state (run_state.h), string report (run_report.h), u64 buffers {string, u64 n, n bytes}, u64
// hash of all before (XXH3). A string is a u64 length and its bytes.
namespace pliant {
namespace {

constexpr std::string_view kMagic = "PLIANTCK";
constexpr std::uint32_t kVersion = 10;
constexpr std::size_t kHead = 24;
constexpr std::size_t kTail = 8;

void put(std::string& out, std::uint64_t value, int bytes = 8) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

void put(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint64_t>(text.size()));
  out += text;
}

std::uint64_t get(std::string_view data, std::size_t at, int bytes = 8) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i)
    value |= std::uint64_t{static_cast<unsigned char>(data[at + static_cast<std::size_t>(i)])} << (8 * i);
  return value;
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::string_view data) : file_(file), data_(data) {}

  std::uint64_t number(const char* what) {
    need(8, what);
    const std::uint64_t value = get(data_, at_);
    at_ += 8;
    return value;
  }
  /// A number of items that need at least `size` bytes each.
  std::size_t count(std::size_t size, const char* what) {
    const std::uint64_t n = number(what);
    if (n > (data_.size() - at_) / size) {
      throw Error(ErrorCode::bad_input, fmt::format("'{}' is damaged: {} {} at byte {}, but only {} bytes follow",
                                                    file_.string(), n, what, at_ - 8, data_.size() - at_));
    }
    return static_cast<std::size_t>(n);
  }
  std::string_view bytes(const char* what) {
    const std::size_t n = count(1, what);
    at_ += n;
    return data_.substr(at_ - n, n);
  }
  void end() const {
    if (at_ != data_.size())
      throw Error(ErrorCode::bad_input,
                  fmt::format("'{}' is damaged: {} unexpected bytes at its end", file_.string(), data_.size() - at_));
  }

 private:
  void need(std::size_t n, const char* what) const {
    if (data_.size() - at_ < n)
      throw Error(ErrorCode::bad_input, fmt::format("'{}' is damaged: no room for {} at byte {}", file_.string(), what, at_));
  }
  const std::filesystem::path& file_;
  std::string_view data_;
  std::size_t at_ = kHead;
};

std::string load(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code))
    throw Error(ErrorCode::bad_input, fmt::format("cannot read checkpoint '{}': no such file", file.string()));
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  std::ifstream in(file, std::ios::binary);
  if (code || !in)
    throw Error(ErrorCode::bad_input, fmt::format("cannot read checkpoint '{}': it cannot be opened", file.string()));
  std::string data(static_cast<std::size_t>(size), '\0');
  in.read(data.data(), static_cast<std::streamsize>(data.size()));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) {
    throw Error(ErrorCode::bad_input,
                fmt::format("cannot read checkpoint '{}': {} of {} bytes could be read", file.string(), in.gcount(), size));
  }
  return data;
}

/// Magic, version, length and hash; afterwards the content is what was written.
void check_frame(const std::filesystem::path& file, std::string_view data) {
  if (data.substr(0, kMagic.size()) != kMagic.substr(0, data.size()) || data.empty()) {
    throw Error(ErrorCode::bad_input, fmt::format("'{}' is not a Pliant checkpoint", file.string()));
  }
  if (data.size() < kHead + kTail) {
    throw Error(ErrorCode::bad_input, fmt::format("'{}' is truncated: expected at least {} bytes, found {}", file.string(),
                                                  kHead + kTail, data.size()));
  }
  const auto version = static_cast<std::uint32_t>(get(data, 8, 4));
  if (version != kVersion) {
    throw Error(ErrorCode::bad_input, fmt::format("'{}' is a checkpoint of version {}; this program reads version {}",
                                                  file.string(), version, kVersion));
  }
  const std::uint64_t length = get(data, 16);
  if (length > data.size()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' is truncated: expected {} bytes, found {}", file.string(), length, data.size()));
  }
  if (length < data.size()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' is damaged: expected {} bytes, found {}", file.string(), length, data.size()));
  }
  const std::uint64_t stored = get(data, data.size() - kTail);
  const std::uint64_t actual = hash_bytes(data.data(), data.size() - kTail);
  if (stored != actual) {
    throw Error(ErrorCode::bad_input, fmt::format("'{}' is damaged: its content has hash {}, stored is {}", file.string(),
                                                  hash_text(actual), hash_text(stored)));
  }
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  const Snapshot& s = checkpoint.snapshot;
  if (s.real_type != "float" && s.real_type != "double") {
    throw Error(ErrorCode::internal,
                fmt::format("checkpoint '{}': real type '{}' is neither float nor double", file.string(), s.real_type));
  }
  std::string out(kMagic);
  put(out, kVersion, 4);
  put(out, 0, 4);
  put(out, 0);
  put(out, static_cast<std::uint64_t>(s.made_of.size()));
  for (const ModelPart& part : s.made_of) {
    put(out, part.name);
    put(out, part.hash);
  }
  put(out, checkpoint.scene_name);
  put(out, s.real_type);
  put(out, write_state(s.state));
  put(out, write_report(s.reports));
  put(out, static_cast<std::uint64_t>(s.buffers.size()));
  for (const NamedBytes& b : s.buffers) {
    put(out, b.name);
    put(out, std::string_view(reinterpret_cast<const char*>(b.bytes.data()), b.bytes.size()));
  }
  std::string length;
  put(length, static_cast<std::uint64_t>(out.size() + kTail));
  out.replace(16, 8, length);
  put(out, hash_bytes(out));
  write_file(file, out);
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  const std::string data = load(file);
  check_frame(file, data);
  Reader in(file, std::string_view(data).substr(0, data.size() - kTail));
  Checkpoint c;
  Snapshot& s = c.snapshot;
  for (std::size_t parts = in.count(16, "parts of the model"); parts > 0; --parts) {
    const std::string name(in.bytes("bytes of a part's name"));
    s.made_of.push_back({name, in.number("the hash of a part")});
  }
  c.scene_name = in.bytes("bytes of scene name");
  s.real_type = in.bytes("bytes of real type");
  if (s.real_type != "float" && s.real_type != "double") {
    throw Error(ErrorCode::bad_input,
                fmt::format("'{}' is damaged: real type '{}' is neither float nor double", file.string(), s.real_type));
  }
  try {
    s.state = read_state(std::string(in.bytes("bytes of the run state")));
    s.reports = read_report(std::string(in.bytes("bytes of the report")));
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("'{}' is damaged: {}", file.string(), error.what()));
  }
  for (std::size_t buffers = in.count(16, "buffers"); buffers > 0; --buffers) {
    NamedBytes b;
    b.name = in.bytes("bytes of a buffer's name");
    const std::string_view bytes = in.bytes("bytes of a buffer");
    b.bytes.assign(bytes.begin(), bytes.end());
    s.buffers.push_back(std::move(b));
  }
  in.end();
  return c;
}

}  // namespace pliant
