#include "tools.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "rows.h"
#include "surfaces.h"

namespace py = pybind11;
using pliant::Vec3d;

namespace {

void set_tool_mesh(pliant::World& w, const std::string& name, const Vertices& vertices, const py::object& triangles,
                   double time) {
  const pliant::SurfaceSpec mesh = surface(vertices, triangles);
  const py::gil_scoped_release release;
  w.set_tool_mesh(name, mesh, time);
}

/// The name that it got.
std::string add_tool(pliant::World& w, const py::dict& tool, const std::string& folder) {
  const auto text = py::module_::import("json").attr("dumps")(tool).cast<std::string>();
  const py::gil_scoped_release release;
  return w.parse_tool(text, folder);
}

/// An entry of "changes" by its keys.
void change(pliant::World& w, const py::kwargs& change) {
  const auto text = py::module_::import("json").attr("dumps")(change).cast<std::string>();
  const py::gil_scoped_release release;
  w.parse_change(text);
}

py::dict grab_state(const pliant::World& w, pliant::GrabId grab) {
  const pliant::GrabState state = w.grab_state(grab);
  return py::dict(py::arg("force") = row(state.force), py::arg("gap") = row(state.gap), py::arg("limited") = state.limited);
}

/// By name: where each tool is, and what it feels.
py::dict tool_forces(const pliant::World& w) {
  py::dict d;
  for (const pliant::ToolForce& f : w.tool_forces()) {
    py::dict tool;
    tool["position"] = row(f.position);
    tool["turn"] = row(f.turn);
    tool["force"] = row(f.force);
    tool["torque"] = row(f.torque);
    tool["area"] = f.area;
    tool["penetration"] = f.penetration;
    tool["parked"] = f.parked;
    d[py::str(f.name)] = tool;
  }
  return d;
}

/// The surface of a tool in its own frame: vertices [m] and triangles.
py::tuple tool_surface(const pliant::World& w, const std::string& name) {
  pliant::SurfaceSpec now = w.tool_surface(name);
  return py::make_tuple(hand_over(std::move(now.vertices)), hand_over(std::move(now.triangles)));
}

py::array vertex_values(const pliant::World& w, const std::string& field) {
  std::vector<float> values;
  {
    const py::gil_scoped_release release;
    values = w.vertex_values(field);
  }
  return hand_over(std::move(values));
}

/// What tools and bodies, and bodies and bodies, have in common.
py::list interpenetrations(const pliant::World& w) {
  std::vector<pliant::Interpenetration> now;
  {
    const py::gil_scoped_release release;
    now = w.interpenetrations();
  }
  py::list all;
  for (const pliant::Interpenetration& i : now) {
    py::dict found;
    found["first"] = i.first;
    found["second"] = i.second;
    found["tool"] = i.tool;
    found["volume"] = i.volume;
    found["centroid"] = row(i.centroid);
    found["area"] = row(i.area);
    found["depth"] = i.depth;
    found["deepest"] = row(i.deepest);
    all.append(found);
  }
  return all;
}

}  // namespace

py::dict blade_forces(const pliant::World& w) {
  py::dict d;
  for (const pliant::BladeForce& f : w.blade_forces()) {
    py::dict blade;
    blade["a"] = row(f.a);
    blade["b"] = row(f.b);
    blade["force"] = row(f.force);
    blade["torque"] = row(f.torque);
    blade["max_force"] = f.max_force;
    blade["work"] = f.work;
    blade["fracture"] = f.fracture;
    blade["gave_way"] = f.gave_way;
    blade["present"] = f.present;
    blade["pressing"] = f.pressing;
    blade["face_force"] = row(f.face_force);
    blade["face_normal"] = f.face_normal;
    blade["face_work"] = f.face_work;
    d[py::str(f.name)] = blade;
  }
  return d;
}

py::list cut_attempts(pliant::World& w) {
  py::list all;
  for (const pliant::CutAttempt& a : w.cut_attempts()) {
    py::dict attempt;
    attempt["blade"] = a.blade;
    attempt["body"] = a.body;
    attempt["stroke"] = a.stroke;
    attempt["from"] = a.from;
    attempt["to"] = a.to;
    attempt["time"] = a.time;
    attempt["position"] = row(a.position);
    attempt["rest"] = row(a.rest);
    attempt["gave_way"] = a.gave_way;
    all.append(attempt);
  }
  return all;
}

void bind_tools(py::class_<pliant::World>& world) {
  using pliant::World;
  using Free = py::call_guard<py::gil_scoped_release>;
  world
      .def(
          "grab",
          [](World& w, std::int32_t vertex, double radius, double stiffness, double max_force) {
            return w.grab(vertex, {radius, stiffness, max_force});
          },
          py::arg("vertex"), py::arg("radius") = 0.0, py::arg("stiffness") = 0.0, py::arg("max_force") = 0.0)
      .def("move_grab", &World::move_grab, py::arg("grab"), py::arg("target"))
      .def("grab_state", &grab_state, py::arg("grab"), "what a grab does: force [N], gap to its target [m], limited")
      .def("release", &World::release, py::arg("grab"))
      .def("push", &World::push, py::arg("vertex"), py::arg("force"))
      .def("push_node", &World::push_node, py::arg("body"), py::arg("node"), py::arg("force"))
      .def("clear_handles", &World::clear_handles)
      .def("move_focus", &World::move_focus, py::arg("position"))
      .def("change", &change,
           "Changes gravity, materials, models or what holds a body: the keys of an entry of `changes` of a scene file without "
           "its time, such as "
           "change(body=\"liver\", material={\"young\": 2000})")
      .def("add_tool", &add_tool, py::arg("tool"), py::arg("folder") = "",
           "tool: a dict with the keys of an entry of `tools` of a scene file; its name")
      .def("remove_tool", &World::remove_tool, py::arg("name"), Free())
      .def("park_tool", &World::park_tool, py::arg("name"), Free())
      .def("unpark_tool", &World::unpark_tool, py::arg("name"), Free())
      .def("grip_tool", &World::grip_tool, py::arg("name"), py::arg("on") = true, Free())
      .def("place_tool", &World::place_tool, py::arg("name"), py::arg("position"),
           py::arg("turn") = std::array<double, 4>{0, 0, 0, 1}, Free())
      .def("drive_tool", &World::drive_tool, py::arg("name"), py::arg("position"),
           py::arg("turn") = std::array<double, 4>{0, 0, 0, 1}, py::arg("seconds") = 1.0 / 60, Free())
      .def("set_tool_mesh", &set_tool_mesh, py::arg("name"), py::arg("vertices"), py::arg("triangles"), py::arg("time"),
           "changes the shape of a mesh tool: at `time` [s] of the simulation it has this closed surface, in its own frame [m]")
      .def("tool_forces", &tool_forces, "a dict of the tools: of each a dict of its pose and what it feels")
      .def("tool_surface", &tool_surface, py::arg("name"),
           "a tool's surface in its own frame, for drawing: vertices [m] and triangles, shapes [n, 3]")
      .def("vertex_values", &vertex_values, py::arg("field"),
           "a value per vertex at the current time: \"displacement\", \"energy\", \"mises\", \"green_strain\", "
           "\"almansi_strain\", "
           "\"pressure\" or \"finite_elements\"")
      .def("interpenetrations", &interpenetrations,
           "a list of dicts: what tools and bodies, and bodies and bodies, have in common");
}
