// The key "springs" of a body: springs between nodes, listed in the scene or in a file.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>

#include "pliant/error.h"
#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRow = "a row [from, to], [from, to, factor] or [from, to, factor, length]: two nodes, numbers > 0";
constexpr std::array<std::string_view, 4> kColumns{"from", "to", "factor", "length"};

/// Two to four numbers.
using SpringRow = std::array<double, 4>;

/// Why a row cannot be one; null: it can.
const char* check_spring_row(const SpringRow& row) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (!(row[k] >= 0 && row[k] <= 2147483647) || row[k] != std::floor(row[k])) return "two whole numbers >= 0 first";
  }
  if (row[0] == row[1]) return "two different nodes";
  if (!(row[2] > 0 && row[2] < 1e30)) return "a factor > 0";
  if (!(row[3] >= 0 && row[3] < 1e30)) return "a length > 0";
  return nullptr;
}

void add_row(const SpringRow& row, SpringList& list) {
  list.nodes.push_back({static_cast<std::int32_t>(row[0]), static_cast<std::int32_t>(row[1])});
  list.factor.push_back(row[2]);
  list.length.push_back(row[3]);
}

void read_spring_nodes(const Reader& nodes, SpringList& list) {
  for (const Reader& entry : nodes.items("a list of at least one row of nodes", 1)) {
    const std::vector<Reader> parts = entry.items(kRow);
    if (parts.size() < 2 || parts.size() > 4) entry.fail(kRow);
    SpringRow row{0, 0, 1, 0};
    for (std::size_t k = 0; k < parts.size(); ++k) row[k] = k < 2 ? parts[k].number() : parts[k].positive();
    if (const char* const expected = check_spring_row(row); expected != nullptr) entry.fail(expected);
    add_row(row, list);
  }
}

/// A line without its end, divided at commas.
std::vector<std::string_view> fields(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t end = std::min(line.find(',', from), line.size());
    std::string_view field = line.substr(from, end - from);
    while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
    while (!field.empty() && (field.back() == ' ' || field.back() == '\r')) field.remove_suffix(1);
    out.push_back(field);
    from = end + 1;
  }
  return out;
}

bool parse(std::string_view field, double& number) {
  const auto [after, error] = std::from_chars(field.data(), field.data() + field.size(), number);
  return error == std::errc() && after == field.data() + field.size();
}

/// Fails with what a line is instead.
[[noreturn]] void fail_line(const std::string& file, std::size_t number, std::string_view line, std::string_view expected) {
  throw Error(ErrorCode::bad_input, fmt::format("{}:{}: got \"{}\", expected {}", file, number, line, expected));
}

/// The columns that a first line names, at least the first two of kColumns and in their order.
std::size_t columns_of(std::string_view line, const std::string& file) {
  const std::vector<std::string_view> names = fields(line);
  bool right = names.size() >= 2 && names.size() <= kColumns.size();
  for (std::size_t k = 0; right && k < names.size(); ++k) right = names[k] == kColumns[k];
  if (!right) fail_line(file, 1, line, "the first line \"from,to\", \"from,to,factor\" or \"from,to,factor,length\"");
  return names.size();
}

void read_spring_file(const Reader& entry, const fs::path& folder, SpringList& list) {
  const fs::path path = folder / entry.text("the path of a CSV file");
  list.file = path.string();
  std::ifstream stream(path);
  std::string line;
  if (fs::is_directory(path) || !std::getline(stream, line)) entry.fail("a CSV file that can be read");
  const std::size_t columns = columns_of(line, list.file);
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \r") == std::string::npos && !std::getline(stream, line)) break;  // an empty last line
    const std::vector<std::string_view> parts = fields(line);
    SpringRow row{0, 0, 1, 0};
    bool right = parts.size() == columns;
    for (std::size_t k = 0; right && k < columns; ++k) right = parse(parts[k], row[k]);
    if (!right) fail_line(list.file, number, line, fmt::format("{} numbers separated by commas", columns));
    if (columns == 4 && row[3] == 0) fail_line(list.file, number, line, "a length > 0");
    if (const char* const expected = check_spring_row(row); expected != nullptr) fail_line(list.file, number, line, expected);
    add_row(row, list);
  }
  if (list.nodes.empty()) entry.fail("a CSV file with at least one spring after its first line");
}

}  // namespace

std::string SpringList::place(std::size_t s) const {
  return file.empty() ? fmt::format("{}/nodes/{}", pointer, s) : fmt::format("{}: {}:{}", pointer, file, s + 2);
}

SpringList read_spring_list(const Reader& entry, const fs::path& folder) {
  entry.expect_object("spring_list");
  SpringList list;
  list.pointer = entry.pointer();
  if (entry.has("nodes") == entry.has("file"))
    entry.fail(entry.has("nodes") ? "both \"nodes\" and \"file\"" : "neither \"nodes\" nor \"file\"", "exactly one of them");
  const Reader spring = entry.at("spring", "a spring such as {\"stiffness\": 40}");
  list.spring = read_spring(spring);
  if (list.spring.law == SpringLaw::linear && list.spring.stiffness == 0)
    spring.fail("a number \"stiffness\" > 0 [N/m]: only springs along edges can take it from the material");
  if (entry.has("nodes")) read_spring_nodes(entry.at("nodes"), list);
  if (entry.has("file")) read_spring_file(entry.at("file"), folder, list);
  return list;
}

}  // namespace pliant
