#include "state.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "rows.h"
#include "surfaces.h"

namespace py = pybind11;
using pliant::Vec3d;

namespace {

/// A list with a row of three numbers for each node of a body; None: an empty one.
std::vector<Vec3d> rows_of(const py::object& given, const char* what, std::size_t nodes) {
  if (given.is_none()) return {};
  const auto numbers = Vertices::ensure(given);
  if (!numbers) PyErr_Clear();
  if (!numbers || numbers.ndim() != 2 || numbers.shape(1) != 3 || numbers.shape(0) != static_cast<py::ssize_t>(nodes)) {
    std::string got = "something else";
    if (numbers) got = "the shape " + py::str(py::list(numbers.attr("shape"))).cast<std::string>();
    throw pliant::Error(pliant::ErrorCode::usage, std::string(what) + " of a state are numbers of the shape [" +
                                                      std::to_string(nodes) + ", 3], in the order of rest_positions(), not " +
                                                      got);
  }
  std::vector<Vec3d> rows(nodes);
  if (nodes > 0) std::copy_n(numbers.data(), 3 * nodes, rows.front().data());
  return rows;
}

void set_state(pliant::World& w, const py::object& positions, const py::object& velocities, const py::object& displacements,
               std::size_t body) {
  std::vector<Vec3d> rest;
  {
    const py::gil_scoped_release release;
    rest = w.rest_positions(body);
  }
  if (!positions.is_none() && !displacements.is_none())
    throw pliant::Error(pliant::ErrorCode::usage, "a state has positions or displacements, not both");
  std::vector<Vec3d> moved = rows_of(displacements, "displacements", rest.size());
  const std::vector<Vec3d> speeds = rows_of(velocities, "velocities", rest.size());
  if (!positions.is_none()) {
    moved = rows_of(positions, "positions", rest.size());
    for (std::size_t n = 0; n < moved.size(); ++n) {
      for (std::size_t c = 0; c < 3; ++c) moved[n][c] -= rest[n][c];
    }
  }
  const py::gil_scoped_release release;
  w.set_state(body, moved, speeds);
}

}  // namespace

void bind_state(py::class_<pliant::World>& world) {
  using pliant::World;
  world
      .def(
          "displacements", [](const World& w, std::size_t body) { return hand_over(w.displacements(body)); },
          py::arg("body") = 0)
      .def(
          "velocities", [](const World& w, std::size_t body) { return hand_over(w.velocities(body)); }, py::arg("body") = 0)
      .def(
          "rest_positions", [](const World& w, std::size_t body) { return hand_over(w.rest_positions(body)); },
          py::arg("body") = 0)
      .def("set_state", &set_state, py::arg("positions") = py::none(), py::arg("velocities") = py::none(),
           py::arg("displacements") = py::none(), py::arg("body") = 0,
           "sets positions [m] or displacements [m], and velocities [m/s], of a body's nodes now: shape [nodes, 3], in the "
           "order "
           "of rest_positions(); what is None stays, and so do components that the scene holds or moves");
}
