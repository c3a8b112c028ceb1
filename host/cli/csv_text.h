// Text in tables of comma-separated values.
#pragma once
#include <string>

namespace pliant::cli {

/// A field of a table: in quotation marks, its own doubled, where it would be more than one (RFC 4180).
inline std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

}  // namespace pliant::cli
