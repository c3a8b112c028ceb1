// From text to a JSON document, rejecting constructs that a scene may not contain. Internal to the scene room and its tests.
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace pliant {

inline constexpr std::size_t max_scene_bytes = std::size_t{16} << 20;
inline constexpr std::size_t max_scene_depth = 64;

/// Parse strict JSON. Throws Error with `file` and line and column (syntax, numbers beyond double) or JSON pointer
/// (duplicate keys, nesting deeper than max_scene_depth).
nlohmann::json parse_json(const std::string& text, const std::string& file);

/// Appends a reference token to a JSON pointer, escaped according to RFC 6901.
std::string pointer_to(const std::string& pointer, const std::string& key);

/// `text` cut to a length that fits in a message.
std::string shortened(const std::string& text, std::size_t length = 80);

}  // namespace pliant
