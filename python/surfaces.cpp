#include "surfaces.h"

#include <pliant/error.h>

#include <limits>
#include <string>

namespace py = pybind11;

namespace {

std::int32_t vertex_number(std::int64_t v) {
  if (v >= 0 && v <= std::numeric_limits<std::int32_t>::max()) return static_cast<std::int32_t>(v);
  throw pliant::Error(pliant::ErrorCode::usage, "a triangle of a surface names the vertex " + std::to_string(v));
}

}  // namespace

pliant::SurfaceSpec surface(const Vertices& vertices, const py::object& given) {
  const auto numbers = py::array::ensure(given);
  if (!numbers || (numbers.dtype().kind() != 'i' && numbers.dtype().kind() != 'u')) {
    throw pliant::Error(pliant::ErrorCode::usage, "the triangles of a surface are an array of integers");
  }
  const auto triangles = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(numbers);
  if (vertices.ndim() != 2 || vertices.shape(1) != 3 || triangles.ndim() != 2 || triangles.shape(1) != 3) {
    throw pliant::Error(pliant::ErrorCode::usage,
                        "a surface is a pair of arrays of the shapes [vertices, 3] and [triangles, 3]");
  }
  pliant::SurfaceSpec s;
  for (py::ssize_t v = 0; v < vertices.shape(0); ++v)
    s.vertices.push_back({vertices.at(v, 0), vertices.at(v, 1), vertices.at(v, 2)});
  for (py::ssize_t t = 0; t < triangles.shape(0); ++t) {
    s.triangles.push_back(
        {vertex_number(triangles.at(t, 0)), vertex_number(triangles.at(t, 1)), vertex_number(triangles.at(t, 2))});
  }
  return s;
}
