// A value of a scene document together with the file and JSON pointer that its messages need. Internal to the scene room.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/keys.h"
#include "scene/scene.h"

namespace pliant {

/// Every getter throws Error "<file>: <pointer>: got <value>, expected <...>" when the value does not fit.
class Reader {
 public:
  Reader(const nlohmann::json& value, const std::string& file, std::string pointer)
      : value_(value), file_(file), pointer_(std::move(pointer)) {}

  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  [[nodiscard]] const nlohmann::json& json() const { return value_; }

  [[noreturn]] void fail(const std::string& expected) const;
  [[noreturn]] void fail(const std::string& got, const std::string& expected) const;

  /// An object all of whose keys are in scene_keys().at(kind).
  void expect_object(const std::string& kind) const;
  [[nodiscard]] bool has(const std::string& key) const { return value_.contains(key); }
  /// The member `key`; `expected`: text of the expected value, for the message if it is missing.
  [[nodiscard]] Reader at(const std::string& key, const std::string& expected) const;
  [[nodiscard]] Reader at(const std::string& key) const { return at(key, "the key \"" + key + "\""); }
  /// The entries of an array; at least `least` of them.
  [[nodiscard]] std::vector<Reader> items(const std::string& expected, std::size_t least = 0) const;

  /// Numbers beyond +-1e30 are refused: kernels work in float, where products of larger ones overflow.
  [[nodiscard]] double number(const std::string& expected = "a number") const;
  /// At least 1e-30, for the same reason.
  [[nodiscard]] double positive() const;
  [[nodiscard]] double non_negative() const;
  [[nodiscard]] std::int64_t integer(std::int64_t least, std::int64_t most) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text(const std::string& expected) const;
  [[nodiscard]] Vec3d vec3(const std::string& expected = "three numbers [x, y, z]") const;

  template <class Enum>
  [[nodiscard]] Enum word(const Words<Enum>& words) const {
    std::vector<std::string> allowed;
    for (const Word<Enum>& w : words) {
      if (value_ == w.word) return w.value;
      allowed.push_back(w.word);
    }
    fail_word(allowed);
  }
  [[noreturn]] void fail_word(const std::vector<std::string>& allowed) const;

 private:
  const nlohmann::json& value_;
  const std::string& file_;
  std::string pointer_;
};

}  // namespace pliant
