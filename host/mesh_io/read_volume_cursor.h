// Bounds-checked reading of text and binary data from a file held in memory, with messages that say where.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace pliant::volume_file {

/// The bytes of a file; throws Error when it is absent, empty, no regular file or cannot be read.
std::string load(const std::filesystem::path& file);

/// Returns the part of a file's text that a message may quote: at most `most` characters, all of them printable.
std::string shown(std::string_view word, std::size_t most = 40);

/// A decimal integer, if that is all that the word is.
std::optional<std::int64_t> parse_integer(std::string_view word);

class Cursor {
 public:
  Cursor(std::filesystem::path file, std::string_view data) : file_(std::move(file)), data_(data) {}

  /// Named in messages about binary data.
  void section(std::string name) { section_ = std::move(name); }
  /// In binary mode messages give the section and byte instead of the line.
  void binary(bool on) { where_ = on ? Where::byte : Where::line; }
  /// Messages give the section alone (data that were decoded from the file).
  void section_only() { where_ = Where::section; }
  /// Byte order of the file differs from the machine's.
  void swap(bool on) { swap_ = on; }
  /// Text from this character to the end of a line is skipped.
  void comment(char c) { comment_ = c; }

  [[nodiscard]] std::size_t position() const { return at_; }
  void seek(std::size_t at) { at_ = last_ = at; }
  [[nodiscard]] std::size_t remaining() const { return data_.size() - at_; }
  [[nodiscard]] std::string_view rest() const { return data_.substr(at_); }

  /// True when only white space is left.
  bool at_end();
  /// The next word; throws at the end of the file. `what`: the expected item, for the message.
  std::string_view token(const char* what);
  /// The rest of the current line, without its end.
  std::string_view line();
  std::int64_t integer(const char* what);
  double real(const char* what);
  /// A number of items of which each takes at least `bytes` bytes of the rest of the file.
  std::int64_t count(const char* what, std::size_t bytes) { return check_count(integer(what), what, bytes); }
  std::int64_t check_count(std::int64_t n, const char* what, std::size_t bytes);
  /// Throws unless `bytes` more are there.
  void need(std::size_t bytes, const char* what);
  void skip(std::size_t bytes, const char* what) {
    need(bytes, what);
    at_ += bytes;
  }

  template <class T>
  T raw(const char* what) {
    static_assert(std::is_trivially_copyable_v<T>);
    need(sizeof(T), what);
    char bytes[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes[swap_ ? sizeof(T) - 1 - i : i] = data_[at_ + i];
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }

  /// Throws Error "FILE:LINE: what", "FILE, section, byte N: what" or "FILE, section: what".
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::filesystem::path file_;
  std::string_view data_;
  std::size_t at_ = 0;
  std::size_t last_ = 0;  ///< start of the last item read
  std::string section_;
  enum class Where { line, byte, section } where_ = Where::line;
  bool swap_ = false;
  char comment_ = 0;
};

}  // namespace pliant::volume_file
