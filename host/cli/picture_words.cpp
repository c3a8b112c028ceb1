#include "cli/picture_words.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "cli/cli.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

/// "A<sign>B" as two numbers; false when it is anything else.
template <class Number>
bool two_numbers(const std::string& text, char sign, Number& a, Number& b) {
  const char *const end = text.data() + text.size(), *middle = nullptr;
  const auto first = std::from_chars(text.data(), end, a);
  middle = first.ptr;
  if (first.ec != std::errc() || middle == end || *middle != sign) return false;
  const auto second = std::from_chars(middle + 1, end, b);
  return second.ec == std::errc() && second.ptr == end;
}

}  // namespace

void PictureWords::add_to(CLI::App& app) {
  app.add_option("--size", size, "Pictures: width and height in pixels; default: 1280x720")->type_name("WxH");
  app.add_option("--color", color,
                 "Pictures: none, displacement, energy, mises, green_strain, almansi_strain, pressure or model; default: none");
  app.add_option("--range", range, "Pictures: values at the ends of the colours in m, J/m^3 or Pa; default: from the values")
      ->type_name("A,B");
  app.add_option("--samples", samples, "Pictures: rays per pixel; default: 16");
}

std::string PictureWords::given() const {
  if (!size.empty()) return "--size";
  if (!color.empty()) return "--color";
  if (!range.empty()) return "--range";
  return samples != 0 ? "--samples" : "";
}

render::PictureOptions PictureWords::options() const {
  render::PictureOptions o;
  if (!size.empty() &&
      (!two_numbers(size, 'x', o.width, o.height) || o.width < 16 || o.height < 16 || o.width > 8192 || o.height > 8192)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("--size is \"{}\"; expected width x height with 16 to 8192 pixels each, such as 1280x720", size));
  }
  if (!color.empty()) {
    const auto by = color_by(color);
    if (!by) {
      std::vector<std::string> words;
      for (const ColorInfo& c : colors()) words.emplace_back(c.word);
      throw Error(ErrorCode::bad_input, fmt::format("--color is \"{}\"; allowed are {}{}", color, fmt::join(words, ", "),
                                                    did_you_mean(color, words)));
    }
    o.color = *by;
  }
  if (!range.empty()) {
    std::pair<double, double> ends;
    if (!two_numbers(range, ',', ends.first, ends.second) || !(ends.first < ends.second) ||
        !std::isfinite(ends.second - ends.first)) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("--range is \"{}\"; expected two ascending numbers, such as 0,0.02", range));
    }
    if (o.color == ColorBy::none || o.color == ColorBy::model) {
      throw Error(ErrorCode::bad_input,
                  "--range is for the colours of values; it needs --color displacement, energy, mises or a strain");
    }
    o.range = ends;
  }
  if (samples < 0 || samples > 4096)
    throw Error(ErrorCode::bad_input, fmt::format("--samples is {}; expected 1 to 4096", samples));
  if (samples > 0) o.samples = samples;
  return o;
}

}  // namespace pliant::cli
