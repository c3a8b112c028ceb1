// Reading and writing of described keys (described.h).
#pragma once
#include <concepts>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/described.h"
#include "scene/described_entries.h"
#include "scene/described_parts.h"
#include "scene/described_tools.h"
#include "scene/reader.h"

namespace pliant {

/// Whether a number is one that the file may have.
bool within(double x, const Range& range);
/// "0 <= least_fill <= 1", "> 0", ">= 0", "> 1", empty for any; whole numbers: "from 1 to 64".
std::string range_text(const Key& key, bool whole);
/// Text of the expected value, for messages.
std::string expected_text(const Key& key, bool whole);
/// The number of the file. Throws Error.
double read_number(const Reader& field, const Key& key, bool whole);

/// Reads the keys that an object has.
struct ReadKeys {
  const Reader& object;

  template <class Member>
  void operator()(Member& member, const Key& key) const {
    if (key.required || object.has(key.name)) read(object.at(key.name, missing(key)), key, member);
  }
  template <class Enum>
  void operator()(Enum& member, const Words<Enum>& words, const Key& key) const {
    if (key.required || object.has(key.name)) member = object.at(key.name, "one of " + listed(words_only(words))).word(words);
  }

 private:
  static std::string missing(const Key& key);
  static void read(const Reader& field, const Key& key, std::string& member);
  static void read(const Reader& field, const Key& /*key*/, bool& member) { member = field.boolean(); }
  static void read(const Reader& field, const Key& /*key*/, Vec3d& member) { member = field.vec3(); }
  static void read(const Reader& field, const Key& /*key*/, std::array<Vec3d, 3>& member);
  static void read(const Reader& field, const Key& /*key*/, std::array<bool, 3>& axes);
  static void read(const Reader& field, const Key& key, PerElement& member);
  template <class Number>
  static void read(const Reader& field, const Key& key, Number& member) {
    member = static_cast<Number>(read_number(field, key, std::integral<Number>));
  }
  template <class T>
  static void read(const Reader& field, const Key& key, std::optional<T>& member) {
    read(field, key, member.emplace());
  }
};

/// Returns the word of an enumerator; words are returned as they are.
template <class Enum>
const std::string& text_of(const Words<Enum>& words, const Enum& value) {
  return word_of(words, value);
}
template <class Enum>
const std::string& text_of(const Words<Enum>& /*words*/, const std::string& text) {
  return text;
}

/// Axes as a file writes them: "xz".
std::string axes_text(const std::array<bool, 3>& axes);

/// Writes all present keys; values that stand for a word are written as that word.
struct WriteKeys {
  nlohmann::ordered_json& object;

  template <class Member>
  void operator()(const Member& member, const Key& key) const {
    if constexpr (std::is_arithmetic_v<Member>) {
      const auto number = static_cast<double>(member);
      if (key.range.absent && number == *key.range.absent) return;
      if (key.range.word != nullptr && number == *key.range.also) {
        object[key.name] = key.range.word;
        return;
      }
    }
    if constexpr (std::same_as<Member, std::string>) {
      if (!member.empty() || !key.range.absent) object[key.name] = member;
    } else if constexpr (std::same_as<Member, std::array<bool, 3>>) {
      object[key.name] = axes_text(member);
    } else {
      object[key.name] = member;
    }
  }
  template <class T>
  void operator()(const std::optional<T>& member, const Key& key) const {
    if (member) (*this)(*member, key);
  }
  template <class Enum, class Member>
  void operator()(const Member& member, const Words<Enum>& words, const Key& key) const {
    if constexpr (std::same_as<Member, bool>) {
      if (key.range.absent && member == (*key.range.absent != 0)) return;
    }
    object[key.name] = text_of(words, member);
  }
};

/// Names.
struct ListKeys {
  std::vector<std::string>& names;
  void operator()(const auto& /*member*/, const Key& key) const { names.emplace_back(key.name); }
  void operator()(const auto& /*member*/, const auto& /*words*/, const Key& key) const { names.emplace_back(key.name); }
};

}  // namespace pliant
