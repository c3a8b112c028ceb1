// Prescribed motion, and motion at the start.
#include <fmt/format.h>

#include "scene/parts.h"

namespace pliant {

namespace {

Vec3d read_direction(const Reader& field) {
  const Vec3d v = field.vec3();
  const double largest = std::max({v[0], v[1], v[2], -v[0], -v[1], -v[2]});
  if (!(largest >= 1e-15 && largest <= 1e15)) field.fail("a direction that is not zero, of a length from 1e-15 to 1e15");
  return v;
}

Rotation read_rotation(const Reader& rotation) {
  rotation.expect_object("rotation");
  Rotation r;
  r.axis = read_direction(rotation.at("axis", "the direction of the axis [x, y, z]"));
  if (rotation.has("about")) r.about = rotation.at("about").vec3();
  r.angle = rotation.at("angle", "the angle at factor 1 in degrees").number();
  return r;
}

void read_displacement(const Reader& field, Prescribed& prescribed) {
  const char* const expected = "three numbers [x, y, z], null for a component that stays free";
  const std::vector<Reader> parts = field.items(expected);
  if (parts.size() != 3) field.fail(expected);
  for (int c = 0; c < 3; ++c) {
    if (!parts[c].json().is_null()) prescribed.displacement[c] = parts[c].number("a number or null");
  }
  const auto& d = prescribed.displacement;
  if (!d[0] && !d[1] && !d[2]) field.fail("at least one component that is not null");
}

std::array<Vec3d, 3> read_matrix(const Reader& field) {
  const char* const expected = "three rows of three numbers";
  const std::vector<Reader> rows = field.items(expected);
  if (rows.size() != 3) field.fail(expected);
  return {rows[0].vec3(expected), rows[1].vec3(expected), rows[2].vec3(expected)};
}

AffineField read_field(const Reader& field) {
  AffineField out;
  if (field.json().is_array()) {
    out.offset = field.vec3();
    return out;
  }
  if (!field.json().is_object()) field.fail("three numbers [x, y, z], or an object with linear, about, offset");
  field.expect_object("field");
  out.linear = read_matrix(field.at("linear", "the matrix of the field, three rows of three numbers"));
  if (field.has("about")) out.about = field.at("about").vec3();
  if (field.has("offset")) out.offset = field.at("offset").vec3();
  return out;
}

double volume_ratio(const std::array<Vec3d, 3>& h) {
  const double a = 1 + h[0][0], e = 1 + h[1][1], i = 1 + h[2][2];
  return a * (e * i - h[1][2] * h[2][1]) - h[0][1] * (h[1][0] * i - h[1][2] * h[2][0]) +
         h[0][2] * (h[1][0] * h[2][1] - e * h[2][0]);
}

}  // namespace

std::array<bool, 3> read_axes(const Reader& field) {
  const char* const expected = "one to three different letters of xyz, such as \"xz\"";
  std::array<bool, 3> axes{false, false, false};
  for (const char c : field.text(expected)) {
    if (c < 'x' || c > 'z' || axes[c - 'x']) field.fail(expected);
    axes[c - 'x'] = true;
  }
  return axes;
}

Prescribed read_prescribed(const Reader& entry, const SelectionFrame& frame) {
  Prescribed prescribed{read_selection(entry, Selected::nodes, frame), {}, read_curve(entry)};
  if (entry.has("rotate") == entry.has("displacement")) {
    entry.fail(entry.has("rotate") ? "both \"displacement\" and \"rotate\"" : "neither \"displacement\" nor \"rotate\"",
               "exactly one of them");
  }
  if (entry.has("rotate")) {
    prescribed.rotate = read_rotation(entry.at("rotate"));
    if (entry.has("axes")) prescribed.axes = read_axes(entry.at("axes"));
    return prescribed;
  }
  if (entry.has("axes")) entry.at("axes").fail("no axes beside a displacement (null leaves a component of it free)");
  read_displacement(entry.at("displacement"), prescribed);
  return prescribed;
}

Initial read_initial(const Reader& entry, const SelectionFrame& frame) {
  Initial initial{read_selection(entry, Selected::nodes, frame), {}, {}};
  if (!entry.has("velocity") && !entry.has("displacement"))
    entry.fail("neither \"velocity\" nor \"displacement\"", "one of them, or both");
  if (entry.has("velocity")) initial.velocity = read_field(entry.at("velocity"));
  if (entry.has("displacement")) {
    const Reader field = entry.at("displacement");
    initial.displacement = read_field(field);
    const double ratio = volume_ratio(initial.displacement.linear);
    if (!(ratio > 0)) {
      field.fail(fmt::format("a field with det(I + linear) = {:.6g}", ratio),
                 "one above 0: otherwise it turns the material inside out");
    }
  }
  return initial;
}

}  // namespace pliant
