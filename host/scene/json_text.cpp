#include "scene/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "pliant/error.h"

namespace pliant {

namespace {

using Json = nlohmann::json;

/// Builds the document while it is read, because only here are duplicate keys, depth and positions still visible.
class Builder final : public nlohmann::json_sax<Json> {
 public:
  Builder(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  Json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    if (stack_.back()->contains(value)) {
      throw Error(ErrorCode::bad_input, fmt::format("{}: {}: got the key a second time, expected every key at most once", file_,
                                                    shortened(pointer_to(pointer(), value), 200)));
    }
    keys_.back() = std::move(value);
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    const std::size_t end = std::min(position > 0 ? position - 1 : 0, text_.size());
    const auto begin = text_.begin();
    const auto line = 1 + std::count(begin, begin + static_cast<std::ptrdiff_t>(end), '\n');
    const std::size_t newline = end == 0 ? std::string::npos : text_.rfind('\n', end - 1);
    const std::size_t column = newline == std::string::npos ? end + 1 : end - newline;
    throw Error(ErrorCode::bad_input, fmt::format("{}: line {}, column {}: {}", file_, line, column, reason(error.what())));
  }

 private:
  bool add(Json value) {
    place(std::move(value));
    return true;
  }

  bool open(Json value) {
    if (stack_.size() >= max_scene_depth) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: {}: got arrays or objects nested deeper than {}, expected a scene (which needs 7)", file_,
                              shortened(pointer(), 60), max_scene_depth));
    }
    Json* const child = place(std::move(value));
    stack_.push_back(child);
    keys_.emplace_back();
    return true;
  }

  bool close() {
    stack_.pop_back();
    keys_.pop_back();
    return true;
  }

  Json* place(Json value) {
    if (stack_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& parent = *stack_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    return &(parent[keys_.back()] = std::move(value));
  }

  std::string pointer() const {
    std::string path;
    for (std::size_t i = 0; i + 1 < stack_.size(); ++i) {
      path = pointer_to(path, stack_[i]->is_array() ? std::to_string(stack_[i]->size() - 1) : keys_[i]);
    }
    return path;
  }

  /// The library's sentence without its own numbering and position.
  static std::string reason(std::string what) {
    if (what.find("out_of_range.406") != std::string::npos) {
      const std::size_t quote = what.find('\'');
      return fmt::format("got {}, expected a number that a double can hold",
                         shortened(quote == std::string::npos ? what : what.substr(quote), 60));
    }
    const std::size_t column = what.find(", column ");
    const std::size_t colon = column == std::string::npos ? what.find("] ") : what.find(": ", column);
    if (colon != std::string::npos) what.erase(0, colon + 2);
    return "not valid JSON: " + shortened(what, 240);
  }

  const std::string& text_;
  const std::string& file_;
  Json root_;
  std::vector<Json*> stack_;       // open containers, outermost first; each is the last child of the one before
  std::vector<std::string> keys_;  // parallel to stack_: the key being filled, if that container is an object
};

}  // namespace

nlohmann::json parse_json(const std::string& text, const std::string& file) {
  if (text.size() > max_scene_bytes) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: got more than {} MiB, expected a scene file of at most that size", file,
                                                  max_scene_bytes >> 20));
  }
  // The library takes a NUL for the end of the text and would ignore what follows it.
  if (const std::size_t nul = text.find('\0'); nul != std::string::npos) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: got a NUL byte at offset {}, expected JSON text", file, nul));
  }
  Builder builder(text, file);
  nlohmann::json::sax_parse(text, &builder);
  return builder.take();
}

std::string pointer_to(const std::string& pointer, const std::string& key) {
  std::string path = pointer + "/";
  for (const char c : key) {
    if (c == '~') {
      path += "~0";
    } else if (c == '/') {
      path += "~1";
    } else {
      path += c;
    }
  }
  return path;
}

std::string shortened(const std::string& text, std::size_t length) {
  if (text.size() <= length) return text;
  std::size_t end = length;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a UTF-8 character
  return text.substr(0, end) + "...";
}

}  // namespace pliant
