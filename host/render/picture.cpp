#include "render/picture.h"

#include <algorithm>

#include "geometry/vec.h"
#include "pliant/error.h"
#include "render/color.h"
#include "render/link_surface.h"

namespace pliant::render {
namespace {

bool has_values(ColorBy color) { return color_info(color).title[0] != 0; }

void append(std::vector<float>& list, const Vec3d& v) {
  for (const double c : v) list.push_back(static_cast<float>(c));
}

/// What a bar must reach for most of the surface to lie inside it: corners of a fixed set have stresses without bound.
double nearly_largest(std::vector<float> values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Values that rounding alone makes: a bar does not begin below them.
double least_of(const Simulation& simulation, ColorBy color) {
  double young = 0, size = 0;
  for (const Body& body : simulation.scene().bodies) young = std::max(young, body.material.moduli.young());
  for (const ModelBody& body : simulation.model().bodies) {
    vec::Box box;
    for (const Vec3d& x : body.rest) box.extend(x);
    size = std::max(size, vec::norm(vec::sub(box.upper, box.lower)));
  }
  constexpr double kStrain = 1e-4;
  switch (color) {
    case ColorBy::displacement:
      return kStrain * size;
    case ColorBy::energy:
      return young * kStrain * kStrain;
    case ColorBy::green_strain:
    case ColorBy::almansi_strain:
      return kStrain;
    default:
      return young * kStrain;
  }
}

Vec3f vertical(const Scene& scene) {
  const Vec3d& g = scene.gravity;
  if (vec::norm(g) == 0) return {0, 1, 0};
  return unit(-Vec3f{static_cast<float>(g[0]), static_cast<float>(g[1]), static_cast<float>(g[2])});
}

}  // namespace

Pictures::Pictures(const PictureOptions& options) : o_(options), renderer_(options.threads) {}

void Pictures::aim(Simulation& simulation, const std::vector<float>& positions) {
  const SceneView& view = simulation.scene().view;
  const Vec3f up = vertical(simulation.scene());
  const auto fit = [&](const std::vector<float>& points) {
    Framing framing;
    framing.aspect = aspect();
    if (o_.bar && has_values(o_.color)) framing.right = kBarShare;
    camera_ = fit_camera(view, points, up, framing);
  };
  if (!camera_) {
    // What is held or moved is known beforehand; the rest stays near.
    const Model& model = simulation.model();
    for (const Constraint& c : model.constraints)
      append(held_, vec::add(model.rest[static_cast<std::size_t>(c.slot)], c.target));
    std::vector<float> points = positions;
    points.insert(points.end(), held_.begin(), held_.end());
    for (std::size_t i = 0; i + 2 < points.size(); i += 3) start_.extend(Vec3d{points[i], points[i + 1], points[i + 2]});
    fit(points);
    ground_ = HUGE_VALF;
  } else if (!view.eye) {
    const std::vector<float> near = surroundings(positions);
    const std::vector<float>& seen = near.empty() ? positions : near;
    if (!in_picture(seen)) {
      std::vector<float> points = seen;
      if (!near.empty()) points.insert(points.end(), held_.begin(), held_.end());
      fit(points);
    }
  }
  const bool first = ground_ == HUGE_VALF;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    ground_ = std::min(ground_, dot(camera_->up, {positions[i], positions[i + 1], positions[i + 2]}));
  }
  if (first) first_ground_ = ground_;
  has_ground_ = view.ground && first_ground_ - ground_ <= static_cast<float>(vec::norm(vec::sub(start_.upper, start_.lower)));
}

float Pictures::aspect() const { return static_cast<float>(o_.width) / static_cast<float>(o_.height); }

/// Returns the vertices near the first picture's bodies: a piece in free fall would make all others small.
std::vector<float> Pictures::surroundings(const std::vector<float>& positions) const {
  const double size = vec::norm(vec::sub(start_.upper, start_.lower));
  std::vector<float> near;
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    if (start_.distance2({positions[i], positions[i + 1], positions[i + 2]}) > size * size) continue;
    near.insert(near.end(), positions.begin() + static_cast<std::ptrdiff_t>(i),
                positions.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  }
  return near;
}

bool Pictures::in_picture(const std::vector<float>& points) const {
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    if (!camera_->sees({points[i], points[i + 1], points[i + 2]}, aspect())) return false;
  }
  return true;
}

void Pictures::color(Simulation& simulation, Surface& surface) {
  if (o_.color == ColorBy::none) return;
  const Model& model = simulation.model();
  if (o_.color == ColorBy::model) {
    kinds_ = vertex_kinds(model);
    surface.kinds = kinds_;
    const bool springs = model.network_bound > 0, elements = model.batches.size() + model.brick_batches.size() > 0;
    elements_ = !springs ? "finite elements" : elements ? "elements, springs" : "springs";
    return;
  }
  values_ = vertex_values(simulation, o_.color);
  surface.values = values_;
  largest_ = std::max(largest_, least_of(simulation, o_.color));
  largest_ = std::max(largest_, nearly_largest(values_, o_.color == ColorBy::displacement ? 1 : 0.99));
  const ScaledUnit unit = scaled_unit(color_info(o_.color).unit, o_.range ? o_.range->second : largest_);
  ticks_ = o_.range ? ticks_within(o_.range->first * unit.factor, o_.range->second * unit.factor)
                    : nice_ticks(0, std::max(largest_ * unit.factor, 1e-12));
}

void Pictures::annotate(Image& image) const {
  if (!o_.bar || o_.color == ColorBy::none) return;
  if (o_.color == ColorBy::model) {
    draw_key(image, {{srgb_of(kind_color(0)), elements_},
                     {srgb_of(kind_color(1)), "interface"},
                     {srgb_of(kind_color(2)), "shape matching"}});
    return;
  }
  const ColorInfo& q = color_info(o_.color);
  draw_color_bar(image, {q.title, scaled_unit(q.unit, o_.range ? o_.range->second : largest_).unit, ticks_});
}

void SurfaceCopy::read(Simulation& simulation) {
  const ModelSurface& model = simulation.model().surface;
  positions.clear();
  for (const Vec3d& x : simulation.surface_positions()) append(positions, x);
  triangles.clear();
  for (const auto& t : model.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  body = model.triangle_body;
  cut.assign(model.triangle_cut.begin(), model.triangle_cut.end());
  topology = static_cast<std::uint64_t>(simulation.topology_version());
}

Surface SurfaceCopy::view() const {
  Surface s;
  s.positions = positions;
  s.triangles = triangles;
  s.cut = cut;
  s.body = body;
  s.topology = topology;
  return s;
}

/// Appends the triangles of tools, springs and vessels. They have no values, and the camera ignores them.
void Pictures::add_others(Simulation& simulation, Surface& surface) {
  const std::size_t triangles = surface_.triangles.size() / 3;
  tools_.append(simulation, surface_.positions, surface_.triangles);
  surface_.body.resize(surface_.triangles.size() / 3, kToolBody);
  append_links(simulation, surface_.positions, surface_.triangles, surface_.body);
  const std::size_t all = surface_.triangles.size() / 3, vertices = surface_.positions.size() / 3;
  if (all == triangles) return;
  if (!surface_.cut.empty()) surface_.cut.resize(all, 0);
  if (!surface.values.empty()) values_.resize(vertices, 0);
  if (!surface.kinds.empty()) kinds_.resize(3 * vertices, 0);
  const bool valued = !surface.values.empty(), kinds = !surface.kinds.empty();
  surface = surface_.view();
  if (valued) surface.values = values_;
  if (kinds) surface.kinds = kinds_;
}

Image Pictures::draw(Simulation& simulation) {
  surface_.read(simulation);
  if (surface_.triangles.empty())
    throw Error(ErrorCode::bad_input, "a picture needs a surface, and the bodies of this scene have none");
  Surface surface = surface_.view();
  aim(simulation, surface_.positions);
  color(simulation, surface);
  add_others(simulation, surface);
  renderer_.update(surface);
  RenderOptions options;
  options.width = o_.width;
  options.height = o_.height;
  options.samples = o_.samples;
  options.ground = has_ground_;
  options.ground_height = ground_;
  if (!values_.empty()) {
    const double factor = scaled_unit(color_info(o_.color).unit, o_.range ? o_.range->second : largest_).factor;
    options.low = static_cast<float>(ticks_.low / factor);
    options.high = static_cast<float>(ticks_.high / factor);
  }
  Image image = renderer_.render(*camera_, options);
  annotate(image);
  return image;
}

}  // namespace pliant::render
