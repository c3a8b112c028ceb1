// Contact points on surfaces, of all bodies and in an order that keeps neighbours together.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "geometry/vec.h"
#include "model/contact/contact.h"
#include "model/contact/contact_samples.h"
#include "model/model.h"

namespace pliant {
namespace {

/// Depth of a soft shell, as a fraction of a cell.
constexpr double kShell = 0.25;

/// Morton code of a point in a box of 1024^3.
std::uint64_t morton(const Vec3d& x, const vec::Box& box) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, box.upper[a] - box.lower[a]);
  std::uint64_t code = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto cell = static_cast<std::uint64_t>(longest > 0 ? (x[a] - box.lower[a]) / longest * 1023 : 0);
    for (std::size_t bit = 0; bit < 10; ++bit) code |= (cell >> bit & 1) << (3 * bit + a);
  }
  return code;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const std::size_t i : order) sorted.push_back(values[i]);
  values = std::move(sorted);
}

}  // namespace

int side_of(const Vec3d& normal) {
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c) {
    if (std::abs(normal[c]) > std::abs(normal[axis])) axis = c;
  }
  return static_cast<int>(2 * axis) + (normal[axis] < 0 ? 1 : 0);
}

ContactPoints contact_points(const Model& model, bool patches) {
  ContactPoints points;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const auto body = static_cast<std::int32_t>(b);
    double spacing = model.bodies[b].spacing;
    if (spacing > 0) {
      sample_lattice(model, body, patches, points);
    } else {
      spacing = sample_faces(model, body, patches, points);
    }
    points.spacing = std::max(points.spacing, spacing);
  }
  vec::Box box;
  for (const Vec3d& x : points.rest) box.extend(x);
  std::vector<std::uint64_t> code(points.size());
  for (std::size_t i = 0; i < code.size(); ++i) code[i] = morton(points.rest[i], box);
  // Points of a tile have the same orientation, so that the two faces of a cut are in different tiles.
  std::vector<int> side(points.size());
  for (std::size_t i = 0; i < side.size(); ++i) side[i] = side_of(points.normal[i]);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
    return std::tie(points.body[i], side[i], code[i]) < std::tie(points.body[k], side[k], code[k]);
  });
  reorder(points.rest, order);
  reorder(points.nodes, order);
  reorder(points.weights, order);
  reorder(points.area, order);
  reorder(points.body, order);
  reorder(points.normal, order);
  reorder(points.apart, order);
  if (patches) reorder(points.sides, order);
  const auto is_face = [](const ToolForm& form) { return form.shape == ToolShape::blade_face; };
  if (patches) points.joined.assign(points.size(), 0);
  if (patches && std::any_of(model.tools->begin(), model.tools->end(), is_face)) points.joined = joined_points(points);
  return points;
}

void add_contact(const Scene& scene, Model& model) {
  if (scene.tools.empty() && !scene.contact) return;
  if (model.tools == nullptr) {
    auto forms = std::make_shared<ToolForms>();
    for (const ContactTool& tool : scene.tools) forms->push_back(tool_form(tool));
    model.tools = forms;
  }
  model.contact_laws.clear();
  for (const ContactTool& tool : scene.tools)
    model.contact_laws.push_back({tool.stiffness, tool.exponent, tool.alpha, tool.friction, 0});
  model.tissue_contact = scene.contact;
  const bool patches = std::any_of(scene.tools.begin(), scene.tools.end(), [](const ContactTool& t) { return t.edges; });
  if (model.contact == nullptr || (patches && model.contact->sides.empty()))
    model.contact = std::make_shared<const ContactPoints>(contact_points(model, patches));
  // A soft shell extends to a quarter of a cell; "auto" contact is rigid at once.
  for (ContactLaw& law : model.contact_laws) law.core = law.stiffness > 0 ? kShell * model.contact->spacing : 0;
}

}  // namespace pliant
