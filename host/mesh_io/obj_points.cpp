#include "mesh_io/obj_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

#include "pliant/error.h"

namespace pliant {
namespace {

constexpr std::string_view kSpace = " \t\r\v\f";

std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kSpace));
  text.remove_prefix(word.size());
  return word;
}

/// Not a number: the word is none, or not finite. Neither strtod nor a stream: both follow the host's locale.
double number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return NAN;
  if (code == std::errc::result_out_of_range) return word.find("e-") == word.npos && word.find("E-") == word.npos ? NAN : 0;
  return code == std::errc() && std::isfinite(value) ? value : NAN;
}

}  // namespace

std::vector<Vec3d> obj_points(const std::filesystem::path& file) {
  std::vector<Vec3d> points;
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (std::int64_t at = 1; std::getline(in, line); ++at) {
    if (line.size() < 2 || line[0] != 'v' || (line[1] != ' ' && line[1] != '\t')) continue;
    std::string_view rest = std::string_view(line).substr(2);
    Vec3d& point = points.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = take_word(rest);
      point[axis] = static_cast<double>(static_cast<float>(number(word)));
      const std::string_view digits = word.substr(word.starts_with('-') || word.starts_with('+') ? 1 : 0);
      if (digits.starts_with('.') && std::isfinite(point[axis])) {  // assimp takes such a vertex for none
        throw Error(ErrorCode::bad_input, fmt::format("surface mesh '{}': vertex {} (line {}): {} is '{}'; a digit before the "
                                                      "point is needed",
                                                      file.string(), points.size() - 1, at, "xyz"[axis], word));
      }
      if (std::isfinite(point[axis])) continue;
      throw Error(ErrorCode::bad_input,
                  fmt::format("surface mesh '{}': vertex {} (line {}): {} is '{}'; a finite number is needed", file.string(),
                              points.size() - 1, at, "xyz"[axis], word));
    }
  }
  return points;
}

}  // namespace pliant
