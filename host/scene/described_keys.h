// What the loader and the writer do with described keys (described.h).
#pragma once
#include <fmt/format.h>

#include <concepts>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/described.h"
#include "scene/described_parts.h"
#include "scene/reader.h"

namespace pliant {

/// "0 <= least_fill <= 1", "> 0", ">= 0", "> 1", empty for any; whole numbers: "from 1 to 64".
std::string range_text(const Key& key, bool whole);
/// What a message expects.
std::string expected_text(const Key& key, bool whole);
/// The number of the file. Throws Error.
double read_number(const Reader& field, const Key& key, bool whole);

/// Reads the keys that an object has.
struct ReadKeys {
  const Reader& object;

  template <class Number>
  void operator()(const Key& key, Number& member) const {
    if (!object.has(key.name)) return;
    const Reader field = object.at(key.name);
    if constexpr (std::same_as<Number, bool>) {
      member = field.boolean();
    } else {
      member = static_cast<Number>(read_number(field, key, std::integral<Number>));
    }
  }
  template <class Enum>
  void operator()(const Key& key, const Words<Enum>& words, Enum& member) const {
    if (object.has(key.name)) member = object.at(key.name).word(words);
  }
};

/// Writes all keys; what stands for a word as that word.
struct WriteKeys {
  nlohmann::ordered_json& object;

  template <class Number>
  void operator()(const Key& key, const Number& member) const {
    if (key.optional && member == Number{}) return;
    const bool as_word = key.word != nullptr && static_cast<double>(member) == key.also;
    object[key.name] = as_word ? nlohmann::ordered_json(key.word) : nlohmann::ordered_json(member);
  }
  template <class Enum>
  void operator()(const Key& key, const Words<Enum>& words, const Enum& member) const {
    object[key.name] = word_of(words, member);
  }
};

/// From the struct of the public API, at the top level. Nothing is checked but words.
struct CopyKeys {
  const std::string& file;  ///< for messages

  template <class To, class From>
  void operator()(const Key& /*key*/, To& to, const From& from) const {
    to = from;
  }
  template <class Enum>
  void operator()(const Key& key, const Words<Enum>& words, Enum& to, const std::string& from) const {
    const nlohmann::json value = from;
    to = Reader(value, file, std::string("/") + key.name).word(words);
  }
};

/// Names.
struct ListKeys {
  std::vector<std::string>& names;
  template <class... Rest>
  void operator()(const Key& key, Rest&&... /*members*/) const {
    names.emplace_back(key.name);
  }
};

}  // namespace pliant
