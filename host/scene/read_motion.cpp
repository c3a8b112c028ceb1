// Prescribed motion, and motion at the start.
#include <fmt/format.h>

#include <algorithm>

#include "scene/described_keys.h"
#include "scene/parts.h"

namespace pliant {

namespace {

Rotation read_rotation(const Reader& rotation) {
  rotation.expect_object("rotation");
  Rotation r;
  describe_rotation(ReadKeys{rotation}, r);
  const auto& [x, y, z] = r.axis;
  const double largest = std::max({x, y, z, -x, -y, -z});
  if (!(largest >= 1e-15 && largest <= 1e15))
    rotation.at("axis").fail("a direction that is not zero, of a length from 1e-15 to 1e15");
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

AffineField read_field(const Reader& field) {
  AffineField out;
  if (field.json().is_array()) {
    out.offset = field.vec3();
    return out;
  }
  if (!field.json().is_object()) field.fail("three numbers [x, y, z], or an object with linear, about, offset");
  field.expect_object("field");
  describe_field(ReadKeys{field}, out);
  return out;
}

double volume_ratio(const std::array<Vec3d, 3>& h) {
  const double a = 1 + h[0][0], e = 1 + h[1][1], i = 1 + h[2][2];
  return a * (e * i - h[1][2] * h[2][1]) - h[0][1] * (h[1][0] * i - h[1][2] * h[2][0]) +
         h[0][2] * (h[1][0] * h[2][1] - e * h[2][0]);
}

}  // namespace

void read_prescribed(const Reader& entry, Prescribed& prescribed) {
  prescribed.curve = read_curve(entry);
  if (entry.has("rotate") == entry.has("displacement")) {
    entry.fail(entry.has("rotate") ? "both \"displacement\" and \"rotate\"" : "neither \"displacement\" nor \"rotate\"",
               "exactly one of them");
  }
  if (entry.has("rotate")) {
    prescribed.rotate = read_rotation(entry.at("rotate"));
    describe_axes(ReadKeys{entry}, prescribed);
    return;
  }
  if (entry.has("axes")) entry.at("axes").fail("no axes with a displacement (null leaves a component of it free)");
  read_displacement(entry.at("displacement"), prescribed);
}

void read_initial(const Reader& entry, Initial& initial) {
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
}

}  // namespace pliant
