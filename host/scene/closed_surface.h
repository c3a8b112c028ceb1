// A selection by the inside of a surface from a file.
#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "geometry/vec3.h"

namespace pliant {

class SurfaceDistance;

/// Opened on first use, after which it is thread-safe.
class ClosedSurface {
 public:
  /// `scale`, `translate`: those of the body, whose coordinates the file shares. `pointer`: of the entry, for messages.
  ClosedSurface(std::filesystem::path file, double scale, const Vec3d& translate, std::string pointer);
  ~ClosedSurface();
  ClosedSurface(const ClosedSurface&) = delete;
  ClosedSurface& operator=(const ClosedSurface&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Returns whether a point [m] is inside or on the surface, to 1e-9 of its size. Throws Error for a surface that is not
  /// closed.
  [[nodiscard]] bool contains(const Vec3d& x) const;
  /// From a point to the inside, 0 in it [m]. Throws Error as `contains` does.
  [[nodiscard]] double distance(const Vec3d& x) const;

 private:
  void read() const;

  std::filesystem::path file_;
  double scale_;
  Vec3d translate_;
  std::string pointer_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const SurfaceDistance> distance_;
  mutable double slack_ = 0;  ///< [m]
};

}  // namespace pliant
