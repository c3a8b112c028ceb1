#include "render/trace.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "render/color.h"
#include "render/film.h"
#include "render/lighting.h"
#include "render/link_surface.h"
#include "render/sampling.h"
#include "render/tool_surface.h"

namespace pliant::render {
namespace {

/// work(row) for all rows, in any order and on any thread.
template <class Work>
void for_rows(int rows, int threads, const Work& work) {
  const int wanted = threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::atomic<int> next{0};
  const auto loop = [&] {
    for (int y = next++; y < rows; y = next++) work(y);
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < std::min(wanted, rows); ++t) pool.emplace_back(loop);
  loop();
  for (std::thread& t : pool) t.join();
}

/// Albedo of bodies, one after another; the first is the red-brown of liver.
Vec3f tint(std::int32_t body) {
  constexpr std::array<Vec3f, 5> kTints{Vec3f{0.62F, 0.25F, 0.21F}, Vec3f{0.83F, 0.62F, 0.45F}, Vec3f{0.55F, 0.60F, 0.68F},
                                        Vec3f{0.76F, 0.52F, 0.55F}, Vec3f{0.60F, 0.64F, 0.48F}};
  return linear_of(kTints[static_cast<std::size_t>(std::max(body, 0)) % kTints.size()]);
}

constexpr float kSeam = 0.8F;  ///< of the line along a cut on either side [pixels]

class Tracer {
 public:
  Tracer(const RayScene& scene, const Camera& camera, const RenderOptions& options)
      : scene_(scene),
        camera_(camera),
        o_(options),
        light_(camera),
        aspect_(static_cast<float>(o_.width) / static_cast<float>(o_.height)) {
    float lowest = HUGE_VALF;
    const std::size_t vertices = scene.vertices();
    for (std::size_t i = 0; i < vertices; ++i) {
      lowest = std::min(lowest, dot(scene.vertex(static_cast<std::int32_t>(i)), camera.up));
    }
    floor_ = o_.ground_height.value_or(vertices == 0 ? 0 : lowest);
    has_floor_ = o_.ground && dot(camera.eye, camera.up) > floor_;
    const Vec3f up = camera.up;
    open_floor_ = irradiance_without_body(up);
  }

  [[nodiscard]] Pixel pixel(int x, int y) const {
    PixelSum sum;
    const std::uint32_t first = place_in_tile(x, y) * static_cast<std::uint32_t>(o_.samples);
    int wanted = o_.samples;
    for (int i = 0; i < wanted; ++i) {
      const Sample2 inside = r2_sample(static_cast<std::uint32_t>(i), 0);
      const float px = 2 * (static_cast<float>(x) + inside.u) / static_cast<float>(o_.width) - 1;
      const float py = 1 - 2 * (static_cast<float>(y) + inside.v) / static_cast<float>(o_.height);
      sum.add(sample(px, py, first + static_cast<std::uint32_t>(i)));
      // No filter helps where edges meet: more samples do.
      if (i + 1 == o_.samples && sum.average().shows == Shows::mixed) wanted = 4 * o_.samples;
    }
    return sum.average();
  }

 private:
  [[nodiscard]] Radiance sample(float px, float py, std::uint32_t index) const {
    const Vec3f d = camera_.direction(px, py, aspect_);
    const Hit hit = scene_.nearest(camera_.eye, d);
    const float fall = dot(d, camera_.up);
    const float to_floor = has_floor_ && fall < 0 ? (floor_ - dot(camera_.eye, camera_.up)) / fall : HUGE_VALF;
    if (hit.triangle >= 0 && hit.distance < to_floor) return on_surface(d, hit, index);
    Radiance r = background(py);
    if (to_floor < HUGE_VALF) on_floor(d, to_floor, index, r);
    return r;
  }

  /// A studio: light grey, a little darker towards the top.
  [[nodiscard]] static Radiance background(float py) {
    Radiance r;
    r.albedo = mix(Vec3f{0.80F, 0.81F, 0.83F}, Vec3f{0.60F, 0.63F, 0.68F}, smoothstep(-1, 1.2F, py));
    r.light = {1, 1, 1};
    r.key = 1;
    return r;
  }

  [[nodiscard]] Vec3f irradiance_without_body(Vec3f n) const {
    const Basis around = basis_around(n);
    Vec3f sum;
    constexpr std::uint32_t kCount = 1024;
    for (std::uint32_t i = 0; i < kCount; ++i) sum += light_.sky(around.world(cosine_direction(r2_sample(i, 1))));
    return sum * (1.0F / kCount);
  }

  /// Light that arrives from direction d: sky, the lit ground, or the body itself with the colour of `near`.
  [[nodiscard]] Vec3f arriving(Vec3f from, Vec3f d, Vec3f near, bool& open) const {
    open = !scene_.blocked(from, d);
    if (!open) return near * 0.36F;
    const float fall = dot(d, camera_.up);
    if (!has_floor_ || fall >= 0) return light_.sky(d);
    // Ground in the body's own shadow is darker the closer the point is to it.
    const float height = std::max(0.0F, dot(from, camera_.up) - floor_) / scene_.size();
    return Vec3f{0.50F, 0.49F, 0.48F} * (0.35F + 0.65F * smoothstep(0, 0.35F, height / std::max(-fall, 0.05F)));
  }

  void on_floor(Vec3f d, float distance, std::uint32_t index, Radiance& r) const {
    const Vec3f up = camera_.up;
    const Vec3f p = camera_.eye + d * distance + up * scene_.step();
    bool open = false;
    const Vec3f sky =
        arriving(p, basis_around(up).world(cosine_direction(r2_sample(index, 1))),
                 scene_.surface().values.empty() && scene_.surface().kinds.empty() ? tint(0) : Vec3f{0.3F, 0.3F, 0.3F}, open);
    const Vec3f key = light_.key_direction(cone_direction(r2_sample(index, 2), Lighting::kCosKey));
    const bool lit = !scene_.blocked(p, key);
    const Vec3f key_light = light_.key_color() * (0.5F * dot(up, light_.key_axis()));  // a shadow that does not dominate
    const Vec3f whole = open_floor_ + key_light;
    const Vec3f share{1 / whole.x, 1 / whole.y, 1 / whole.z};
    r.shows = Shows::ground;
    r.light = sky * share;
    r.key_light = key_light * share;
    r.key = lit ? 1 : 0;
    r.normal = up;
    r.depth = distance;
  }

  [[nodiscard]] Material material_of(const Hit& hit, bool is_cut) const {
    const Surface& s = scene_.surface();
    const std::size_t corner = 3 * static_cast<std::size_t>(hit.triangle);
    const std::array<float, 3> w{1 - hit.u - hit.v, hit.u, hit.v};
    Material m;
    m.albedo = tint(s.body.empty() ? 0 : s.body[static_cast<std::size_t>(hit.triangle)]);
    if (const std::int32_t body = s.body.empty() ? 0 : s.body[static_cast<std::size_t>(hit.triangle)]; body < 0) {
      const bool steel = body == kToolBody;
      m.albedo = linear_of(steel                 ? Vec3f{0.60F, 0.64F, 0.70F}
                           : body == kSpringBody ? Vec3f{0.93F, 0.90F, 0.80F}
                                                 : Vec3f{0.45F, 0.10F, 0.16F});
      m.roughness = steel ? 0.25F : 0.4F;
      return m;
    }
    if (is_cut) {
      // Flesh inside is lighter and wetter than the skin outside.
      m.albedo = mix(m.albedo, linear_of({0.93F, 0.66F, 0.60F}), 0.75F);
      m.roughness = 0.28F;
      if (!o_.color_cuts) return m;
    }
    if (!s.values.empty()) {
      float value = 0;
      for (std::size_t i = 0; i < 3; ++i) value += w[i] * s.values[static_cast<std::size_t>(s.triangles[corner + i])];
      m.albedo = map_color((value - o_.low) / std::max(o_.high - o_.low, 1e-30F));
      m.gloss = 0.5F;
      m.roughness = 0.45F;
    } else if (!s.kinds.empty()) {
      std::array<float, 3> share{};
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
          share[k] += w[i] * s.kinds[3 * static_cast<std::size_t>(s.triangles[corner + i]) + k];
      }
      m.albedo = kind_color(static_cast<int>(std::max_element(share.begin(), share.end()) - share.begin()));
      m.gloss = 0.7F;
    }
    return m;
  }

  /// Within a line along the rim of a cut, so wide that it is seen at any distance: closed cuts are not seen otherwise.
  [[nodiscard]] bool on_seam(const Hit& hit) const {
    const std::size_t first = 3 * static_cast<std::size_t>(hit.triangle);
    const std::array<float, 3> w{1 - hit.u - hit.v, hit.u, hit.v};
    const float width = kSeam * hit.distance * 2 * camera_.half_height / static_cast<float>(o_.height);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!scene_.seam(first + i)) continue;
      const auto corner = [&](std::size_t k) { return scene_.vertex(scene_.surface().triangles[first + (i + k) % 3]); };
      const Vec3f along = corner(2) - corner(1);
      const float height = length(cross(along, corner(0) - corner(1))) / std::max(length(along), 1e-30F);
      if (w[i] * height < width) return true;
    }
    return false;
  }

  struct Place {
    Vec3f point, normal, face;
  };

  /// Where the hit is, with a normal towards the viewer. The point lies on the smooth surface that the normals pretend (Hanika
  /// 2021), or the facets would show along the edge of shadows.
  [[nodiscard]] Place place_of(Vec3f d, const Hit& hit) const {
    const std::size_t corner = 3 * static_cast<std::size_t>(hit.triangle);
    const std::array<float, 3> w{1 - hit.u - hit.v, hit.u, hit.v};
    std::array<Vec3f, 3> v, n;
    Place place;
    for (std::size_t i = 0; i < 3; ++i) {
      v[i] = scene_.vertex(scene_.surface().triangles[corner + i]);
      n[i] = scene_.normals()[static_cast<std::size_t>(scene_.smooth().corner()[corner + i])];
      place.point += v[i] * w[i];
      place.normal += n[i] * w[i];
    }
    place.face = unit(cross(v[1] - v[0], v[2] - v[0]), -d);
    place.normal = unit(place.normal, place.face);
    if (dot(place.face, d) > 0) {  // seen from inside
      place.face = -place.face;
      place.normal = -place.normal;
    } else {
      Vec3f shift;
      for (std::size_t i = 0; i < 3; ++i) shift += n[i] * (-w[i] * std::min(0.0F, dot(place.point - v[i], n[i])));
      place.point += shift;
    }
    const float away = dot(place.normal, d);
    if (away > -0.02F) place.normal = unit(place.normal - d * (away + 0.02F), place.face);
    place.point += place.face * scene_.step();
    return place;
  }

  [[nodiscard]] Radiance on_surface(Vec3f d, const Hit& hit, std::uint32_t index) const {
    const Surface& s = scene_.surface();
    const bool is_cut = !s.cut.empty() && s.cut[static_cast<std::size_t>(hit.triangle)] != 0;
    const Place at = place_of(d, hit);
    Material m = material_of(hit, is_cut);
    if (!is_cut && on_seam(hit)) m.albedo = linear_of({0.20F, 0.05F, 0.05F});
    Radiance r;
    r.shows = is_cut ? Shows::cut : Shows::outside;
    r.albedo = m.albedo;
    bool open = false;
    const Vec3f way = basis_around(at.normal).world(cosine_direction(r2_sample(index, 1)));
    r.light = dot(way, at.face) > 0 ? arriving(at.point, way, m.albedo, open) : m.albedo * 0.36F;
    r.open = open ? 1 : 0;
    const Vec3f to_key = light_.key_direction(cone_direction(r2_sample(index, 2), Lighting::kCosKey));
    const float facing = dot(at.normal, light_.key_axis());
    if (facing > 0 && dot(at.face, to_key) > 0) r.key = scene_.blocked(at.point, to_key) ? 0.0F : 1.0F;
    r.key_light = light_.key_color() * std::max(0.0F, facing);
    r.key_gloss = light_.key_color() * light_.key_highlight(at.normal, -d, m);
    const Vec3f mirrored = d - at.normal * (2 * dot(d, at.normal));
    r.sky_gloss = light_.reflected_sky(mirrored, m.roughness) * Lighting::sky_share(at.normal, -d, m);
    r.normal = at.normal;
    r.depth = hit.distance;
    return r;
  }

  const RayScene& scene_;
  const Camera& camera_;
  const RenderOptions& o_;
  Lighting light_;
  float aspect_;
  float floor_ = 0;
  bool has_floor_ = true;
  Vec3f open_floor_;
};

}  // namespace

Image trace(const RayScene& scene, const Camera& camera, const RenderOptions& options, int threads) {
  const Tracer tracer(scene, camera, options);
  Film film(options.width, options.height);
  for_rows(options.height, threads, [&](int y) {
    for (int x = 0; x < options.width; ++x) film.at(x, y) = tracer.pixel(x, y);
  });
  std::vector<Pixel::Noisy> a = film.noisy(), b(a.size());
  for_rows(options.height, threads, [&](int y) { film.filter_row(y, false, a, b); });
  for_rows(options.height, threads, [&](int y) { film.filter_row(y, true, b, a); });
  return film.develop(a);
}

}  // namespace pliant::render
