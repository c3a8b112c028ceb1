#include "scene/closed_surface.h"

#include <fmt/format.h>

#include "geometry/distance.h"
#include "geometry/vec.h"
#include "mesh_io/mesh_io.h"
#include "pliant/error.h"

namespace pliant {

ClosedSurface::ClosedSurface(std::filesystem::path file, double scale, const Vec3d& translate, std::string pointer)
    : file_(std::move(file)), scale_(scale), translate_(translate), pointer_(std::move(pointer)) {}

ClosedSurface::~ClosedSurface() = default;

void ClosedSurface::read() const {
  auto distance = std::make_unique<const SurfaceDistance>(read_surface(file_, scale_, translate_));
  if (!distance->orientation().closed()) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: the surface {} has {} open edges, expected a closed one, which has an inside", pointer_,
                            file_.string(), distance->orientation().rim.size()));
  }
  const vec::Box& box = distance->tree().bounds();
  slack_ = 1e-9 * vec::norm(vec::sub(box.upper, box.lower));
  distance_ = std::move(distance);
}

bool ClosedSurface::contains(const Vec3d& x) const {
  std::call_once(once_, [this] { read(); });
  return distance_->inside(x) || distance_->closest(x).distance <= slack_;
}

double ClosedSurface::distance(const Vec3d& x) const {
  std::call_once(once_, [this] { read(); });
  return distance_->inside(x) ? 0 : distance_->closest(x).distance;
}

}  // namespace pliant
