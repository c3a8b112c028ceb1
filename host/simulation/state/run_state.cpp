// Serialization of RunState and RunReports: for each member its name, then its value. Numbers take eight bytes; lists begin
// with their length.
#include "simulation/state/run_state.h"

#include <fmt/format.h>

#include <bit>
#include <concepts>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "pliant/error.h"
#include "simulation/state/run_report.h"

namespace pliant {
namespace {

class StateWriter {
 public:
  template <class T>
  void operator()(const char* name, const T& value) {
    put(std::string(name));
    put(value);
  }
  template <class T>
  void last(const char* name, const T& value) {
    if (!value.empty()) (*this)(name, value);
  }
  template <class T>
  void last(const char* name, const std::optional<T>& value) {
    if (value) (*this)(name, value);
  }
  void last(const char* name, bool value) {
    if (value) (*this)(name, value);
  }
  std::string bytes;

 private:
  void word(std::uint64_t value) {
    for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  }
  void put(std::integral auto value) { word(static_cast<std::uint64_t>(static_cast<std::int64_t>(value))); }
  void put(double value) { word(std::bit_cast<std::uint64_t>(value)); }
  void put(ToolShape shape) { word(static_cast<std::uint64_t>(shape)); }
  void put(const std::filesystem::path& path) { put(path.string()); }
  void put(const std::string& text) {
    put(text.size());
    bytes += text;
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& values) {
    for (const T& value : values) put(value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(values.size());
    for (const T& value : values) put(value);
  }
  template <class K, class T>
  void put(const std::map<K, T>& values) {
    put(values.size());
    for (const auto& [key, value] : values) {
      put(key);
      put(value);
    }
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class T>
  void put(const T& value) requires std::is_class_v<T> {
    visit(*this, const_cast<T&>(value));  // this visitor only reads
  }
};

class StateReader {
 public:
  StateReader(const char* what, const std::string& bytes) : what_(what), bytes_(bytes) {}
  template <class T>
  void operator()(const char* name, T& value) {
    const std::size_t start = at_;
    std::string found;
    get(found);
    if (found != name) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("the {} is damaged: byte {} should begin its member \"{}\"", what_, start, name));
    }
    name_ = name;
    get(value);
  }
  template <class T>
  void last(const char* name, T& value) {
    value = {};
    const std::size_t start = at_;
    if (start == bytes_.size()) return;
    std::string found;
    get(found);
    at_ = start;
    if (found == name) (*this)(name, value);
  }
  void end() const {
    if (at_ != bytes_.size()) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("the {} is damaged: {} bytes too many at its end", what_, bytes_.size() - at_));
    }
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw Error(ErrorCode::bad_input, fmt::format("the {} is damaged: its member \"{}\" {} at byte {} of {}", what_, name_,
                                                  what, at_, bytes_.size()));
  }
  std::uint64_t word() {
    if (bytes_.size() - at_ < 8) fail("is cut off");
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes_[at_ + i])} << (8 * i);
    at_ += 8;
    return value;
  }
  /// Reads a number of items, each at least `least` bytes long.
  std::size_t count(std::size_t least) {
    const std::uint64_t n = word();
    if (n > (bytes_.size() - at_) / least) fail("holds more items than there are bytes");
    return static_cast<std::size_t>(n);
  }
  template <std::integral T>
  void get(T& value) {
    const auto wide = static_cast<std::int64_t>(word());
    if (!std::in_range<T>(wide)) fail("is out of range");
    value = static_cast<T>(wide);
  }
  void get(bool& value) {
    const std::uint64_t wide = word();
    if (wide > 1) fail("is neither true nor false");
    value = wide == 1;
  }
  void get(double& value) { value = std::bit_cast<double>(word()); }
  void get(ToolShape& shape) {
    const std::uint64_t wide = word();
    if (wide > static_cast<std::uint64_t>(ToolShape::sequence)) fail("is no shape");
    shape = static_cast<ToolShape>(wide);
  }
  void get(std::filesystem::path& path) {
    std::string text;
    get(text);
    path = text;
  }
  void get(std::string& text) {
    const std::size_t size = count(1);
    text = bytes_.substr(at_, size);
    at_ += size;
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& values) {
    for (T& value : values) get(value);
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(count(8));
    for (T& value : values) get(value);
  }
  template <class K, class T>
  void get(std::map<K, T>& values) {
    values.clear();
    for (std::size_t n = count(16); n > 0; --n) {
      K key{};
      get(key);
      if (!values.empty() && !(values.rbegin()->first < key)) fail("is not in order");
      get(values[key]);
    }
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool has = false;
    get(has);
    value.reset();
    if (has) get(value.emplace());
  }
  template <class T>
  void get(T& value) requires std::is_class_v<T> {
    visit(*this, value);
  }

  const char* what_;
  const std::string& bytes_;
  std::size_t at_ = 0;
  std::string name_;
};

template <class T>
std::string write(const T& all) {
  StateWriter writer;
  visit(writer, const_cast<T&>(all));  // this visitor only reads
  return std::move(writer.bytes);
}

template <class T>
T read(const char* what, const std::string& bytes) {
  T all;
  StateReader reader(what, bytes);
  visit(reader, all);
  reader.end();
  return all;
}

}  // namespace

std::string write_state(const RunState& state) { return write(state); }
std::string write_report(const RunReports& reports) { return write(reports); }
RunState read_state(const std::string& bytes) { return read<RunState>("run state", bytes); }
RunReports read_report(const std::string& bytes) { return read<RunReports>("report", bytes); }

}  // namespace pliant
