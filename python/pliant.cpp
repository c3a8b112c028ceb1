// The compiled part of the Python package, pliant._core: pliant::World with NumPy views of its frames.
#include <pliant/world.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <regex>
#include <set>
#include <string>

#include "haptics.h"
#include "rows.h"

namespace py = pybind11;
using pliant::Vec3d;

namespace {

/// A read-only array over memory that `owner` keeps alive: shape [size][columns], `stride` bytes from row to row.
template <class T>
py::array view(const T* data, std::size_t size, std::size_t columns, std::size_t stride, const py::object& owner) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(size)}, strides{static_cast<py::ssize_t>(stride)};
  if (columns > 0) {
    shape.push_back(static_cast<py::ssize_t>(columns));
    strides.push_back(sizeof(T));
  }
  py::array array(py::dtype::of<T>(), shape, strides, data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array texels(pliant::View<pliant::Vec4f> v, const py::object& owner) {
  return view(v.empty() ? nullptr : v.data()->data(), v.size(), 3, sizeof(pliant::Vec4f), owner);
}

py::array_t<double> copy(const std::vector<Vec3d>& v) {
  py::array_t<double> array({static_cast<py::ssize_t>(v.size()), py::ssize_t{3}});
  std::copy_n(v.empty() ? nullptr : v.data()->data(), 3 * v.size(), array.mutable_data());
  return array;
}

py::tuple range(const pliant::IndexRange& r) { return py::make_tuple(r.first, r.count); }

py::list ranges(pliant::View<pliant::IndexRange> all) {
  py::list list;
  for (const pliant::IndexRange& r : all) list.append(range(r));
  return list;
}

using Vertices = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::int32_t vertex_number(std::int64_t v) {
  if (v >= 0 && v <= std::numeric_limits<std::int32_t>::max()) return static_cast<std::int32_t>(v);
  throw pliant::Error(pliant::ErrorCode::usage, "a triangle of a surface names the vertex " + std::to_string(v));
}

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

pliant::WorldOptions options(const std::string& backend, double dt, bool normals, bool interactive, bool cutting) {
  pliant::WorldOptions o;
  o.backend = backend;
  o.dt = dt;
  o.normals = normals;
  o.interactive = interactive;
  o.cutting = cutting;
  return o;
}

/// A scene is the name of a file, or a dict with the keys of a scene file.
std::unique_ptr<pliant::World> make_world(const py::object& scene, const std::vector<std::pair<Vertices, py::object>>& surfaces,
                                          const std::string& folder, const std::string& backend, double dt, bool normals,
                                          bool interactive, bool cutting) {
  const pliant::WorldOptions o = options(backend, dt, normals, interactive, cutting);
  std::vector<pliant::SurfaceSpec> meshes;
  for (const auto& [vertices, triangles] : surfaces) meshes.push_back(surface(vertices, triangles));
  if (py::isinstance<py::dict>(scene)) {
    const auto text = py::module_::import("json").attr("dumps")(scene).cast<std::string>();
    const py::gil_scoped_release release;
    return std::make_unique<pliant::World>(pliant::World::parse(text, folder, o, meshes));
  }
  const auto file = py::module_::import("os").attr("fspath")(scene).cast<std::string>();
  const py::gil_scoped_release release;
  return std::make_unique<pliant::World>(pliant::World::open(file, o));
}

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

void bind_frame(py::module_& m) {
  using pliant::Frame;
  py::class_<Frame, std::shared_ptr<Frame>>(m, "Frame", "The surface at one step. Arrays are views: they keep the frame alive.")
      .def_readonly("step", &Frame::step, "steps since the start")
      .def_readonly("time", &Frame::time, "[s]")
      .def_readonly("topology_version", &Frame::topology_version, "changes when vertices or triangles are others than before")
      .def_property_readonly(
          "positions", [](const py::object& self) { return texels(self.cast<const Frame&>().positions, self); },
          "[m], float32, shape [vertices, 3]")
      .def_property_readonly(
          "normals", [](const py::object& self) { return texels(self.cast<const Frame&>().normals, self); },
          "unit length, float32, shape [vertices, 3]")
      .def_property_readonly(
          "rest", [](const py::object& self) { return texels(self.cast<const Frame&>().rest, self); },
          "positions at rest [m], float32, shape [vertices, 3]")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            const auto& t = self.cast<const Frame&>().triangles;
            return view(t.empty() ? nullptr : t.data()->data(), t.size(), 3, sizeof(pliant::Triangle), self);
          },
          "vertex numbers, int32, shape [triangles, 3]")
      .def_property_readonly(
          "cut_faces",
          [](const py::object& self) {
            const auto& faces = self.cast<const Frame&>().cut_faces;
            return view(faces.data(), faces.size(), 0, 1, self);
          },
          "1: the triangle lies on a cut, uint8, shape [triangles]; empty: none does")
      .def_property_readonly(
          "body_vertices", [](const Frame& f) { return ranges(f.body_vertices); }, "(first, count) of each body's part")
      .def_property_readonly(
          "body_triangles", [](const Frame& f) { return ranges(f.body_triangles); }, "likewise")
      .def_property_readonly(
          "dirty_vertices", [](const Frame& f) { return range(f.dirty_vertices); },
          "(first, count) of what may have moved since the frame before")
      .def_property_readonly(
          "dirty_triangles", [](const Frame& f) { return range(f.dirty_triangles); },
          "(first, count) of what may be another triangle; the count is 0 unless the topology changed");
}

void bind_report(py::module_& m) {
  using pliant::StepReport;
  py::class_<StepReport>(m, "StepReport", "What a call of step did.")
      .def_readonly("done", &StepReport::done)
      .def_readonly("step", &StepReport::step)
      .def_readonly("time", &StepReport::time, "[s]")
      .def_readonly("dt", &StepReport::dt, "[s]")
      .def_readonly("diverged", &StepReport::diverged)
      .def_readonly("at_equilibrium", &StepReport::at_equilibrium)
      .def_readonly("message", &StepReport::message);
}

py::dict info(const pliant::World& world) {
  const pliant::WorldInfo& i = world.info();
  py::list bodies;
  for (const auto& b : i.bodies) {
    py::dict body;
    body["name"] = b.name;
    body["nodes"] = b.nodes;
    body["elements"] = b.elements;
    body["mass"] = b.mass;
    body["vertices"] = range(b.vertices);
    body["triangles"] = range(b.triangles);
    bodies.append(body);
  }
  py::dict d;
  d["backend"] = i.backend;
  d["device"] = i.device;
  d["reason"] = i.reason;
  d["bit_exact"] = i.bit_exact;
  d["nodes"] = i.nodes;
  d["elements"] = i.elements;
  d["vertices"] = i.vertices;
  d["triangles"] = i.triangles;
  d["bodies"] = bodies;
  d["remarks"] = i.remarks;
  return d;
}

py::dict result(const pliant::CutResult& r) {
  py::dict d;
  d["pending"] = r.pending;
  d["changed"] = r.changed;
  d["edges"] = r.edges;
  d["seconds"] = r.seconds;
  d["in_part"] = r.in_part;
  return d;
}

py::dict picked(const pliant::PickedPoint& p) {
  py::dict d;
  d["body"] = p.body;
  d["triangle"] = p.triangle;
  d["vertex"] = p.vertex;
  d["weights"] = row(p.weights);
  d["point"] = row(p.point);
  d["normal"] = row(p.normal);
  d["distance"] = p.distance;
  return d;
}

/// Where a ray first meets the surface, or None.
py::object pick(const pliant::World& w, const Vec3d& origin, const Vec3d& direction) {
  const auto found = w.pick(origin, direction);
  return found ? py::object(picked(*found)) : py::none();
}

py::dict cut(pliant::World& w, const Vertices& triangles) {
  if (triangles.ndim() != 3 || triangles.shape(1) != 3 || triangles.shape(2) != 3) {
    throw pliant::Error(pliant::ErrorCode::usage, "the triangles of a cut are an array of the shape [triangles, 3, 3]");
  }
  std::vector<std::array<Vec3d, 3>> list(static_cast<std::size_t>(triangles.shape(0)));
  if (!list.empty()) std::copy_n(triangles.data(), 9 * list.size(), list[0][0].data());
  return result(w.cut(list));
}

py::tuple frame_since(pliant::World& w, const std::shared_ptr<pliant::Frame>& seen) {
  pliant::FrameChange change;
  {
    const py::gil_scoped_release release;
    change = w.frame_since(seen);
  }
  return py::make_tuple(std::const_pointer_cast<pliant::Frame>(change.frame), range(change.dirty_vertices),
                        range(change.dirty_triangles));
}

/// By name: the numbers of each quantity.
py::dict probes(const pliant::World& w) {
  std::vector<pliant::ProbeValue> values;
  {
    const py::gil_scoped_release release;
    values = w.probes();
  }
  py::dict d;
  for (const pliant::ProbeValue& v : values) {
    const py::str name(v.probe);
    if (!d.contains(name)) d[name] = py::dict();
    d[name][py::str(v.quantity)] = row(v.numbers);
  }
  return d;
}

/// By name: where each tool is, and what it feels.
py::dict grab_state(const pliant::World& w, pliant::GrabId grab) {
  const pliant::GrabState state = w.grab_state(grab);
  return py::dict(py::arg("force") = row(state.force), py::arg("gap") = row(state.gap), py::arg("limited") = state.limited);
}

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

/// By name: where each blade that cuts by force is, and what it feels.
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
    d[py::str(f.name)] = blade;
  }
  return d;
}

/// The surface of a tool in its own frame: vertices [m] and triangles.
py::tuple tool_surface(const pliant::World& w, const std::string& name) {
  const pliant::SurfaceSpec now = w.tool_surface(name);
  const auto rows = [](const auto& list) { return std::array<py::ssize_t, 2>{static_cast<py::ssize_t>(list.size()), 3}; };
  py::array_t<double> vertices(rows(now.vertices));
  py::array_t<std::int32_t> triangles(rows(now.triangles));
  std::copy_n(now.vertices.data()->data(), vertices.size(), vertices.mutable_data());
  std::copy_n(now.triangles.data()->data(), triangles.size(), triangles.mutable_data());
  return py::make_tuple(vertices, triangles);
}

py::array_t<float> vertex_values(const pliant::World& w, const std::string& field) {
  std::vector<float> values;
  {
    const py::gil_scoped_release release;
    values = w.vertex_values(field);
  }
  return py::array_t<float>(static_cast<py::ssize_t>(values.size()), values.data());
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

py::dict live_state(const pliant::World& w) {
  const pliant::LiveState s = w.live_state();
  py::dict live;
  live["running"] = s.running;
  live["frames"] = s.frames;
  live["late"] = s.late;
  live["dropped"] = s.dropped;
  live["real_time"] = s.real_time;
  live["load"] = s.load;
  live["lost"] = s.lost;
  return live;
}

py::list events(pliant::World& w) {
  py::list all;
  for (const pliant::Event& e : w.events()) {
    py::dict event;
    event["kind"] = e.kind;
    event["subject"] = e.subject;
    event["step"] = e.step;
    event["time"] = e.time;
    event["position"] = e.placed ? py::cast(e.position) : py::object(py::none());
    event["amount"] = e.amount;
    event["text"] = e.text;
    all.append(event);
  }
  return all;
}

/// The members of ForceSample as fields of an array.
py::dtype dtype_of_force_sample() {
  const pliant::ForceSample sample;
  py::list names, formats, offsets;
  const auto add = [&](const char* name, const char* format, const void* member) {
    names.append(name);
    formats.append(format);
    offsets.append(static_cast<const char*>(member) - reinterpret_cast<const char*>(&sample));
  };
  add("step", "i8", &sample.step);
  add("time", "f8", &sample.time);
  add("force", "3f8", &sample.force);
  add("torque", "3f8", &sample.torque);
  return {names, formats, offsets, sizeof sample};
}

/// An array of the fields of ForceSample.
py::array force_trace(const pliant::World& w, const py::object& of, std::int64_t after) {
  const std::vector<pliant::ForceSample> trace = py::isinstance<py::str>(of) ? w.force_trace(of.cast<std::string>(), after)
                                                                             : w.force_trace(of.cast<pliant::GrabId>(), after);
  return py::array(dtype_of_force_sample(), {trace.size()}, {}, trace.data());
}

void bind_live(py::class_<pliant::World>& world) {
  using pliant::World;
  using Free = py::call_guard<py::gil_scoped_release>;
  world
      .def(
          "run_live",
          [](World& w, double rate, double speed) {
            w.run_live({rate, speed});
          },
          py::arg("rate") = 60.0, py::arg("speed") = 1.0, Free(),
          "the worker steps on its own, paced by the wall clock, and makes `rate` frames per second until stop_live()")
      .def("stop_live", &World::stop_live, Free(), "ends run_live() after the frame at work; a StepReport")
      .def("live_state", &live_state, "a dict with the fields of LiveState: what run_live() achieves")
      .def("events", &events, "a list of dicts with the fields of Event: what happened since the last call")
      .def(
          "force_trace", &force_trace, py::arg("of"), py::arg("after") = -1,
          "of: name of a tool, or a grab; a structured array with step, time [s], force [N] and torque [N m]: a tool's of each "
          "of the last 4096 steps after step `after`, a grab's of each update")
      .def("recover", &World::recover, Free(), "after a divergence, goes on from the last good state, at rest");
}

void bind_world(py::module_& m) {
  using pliant::World;
  using Free = py::call_guard<py::gil_scoped_release>;
  py::class_<World> world(m, "World", "A scene on a backend: see docs/embedding.md. One thread at a time.");
  world
      .def(py::init(&make_world), py::arg("scene"), py::arg("surfaces") = std::vector<std::pair<Vertices, py::object>>{},
           py::arg("folder") = "", py::arg("backend") = "auto", py::arg("dt") = 0.0, py::arg("normals") = true,
           py::arg("interactive") = false, py::arg("cutting") = false,
           "scene: a file, or a dict with the keys of a scene file whose \"surface\": \"memory:N\" takes surfaces[N] = "
           "(vertices, triangles)")
      .def_property_readonly("info", &info)
      .def_property_readonly("time", &World::time, "[s]")
      .def_property_readonly("step_number", &World::step_number)
      .def_property_readonly("dt", &World::dt, "[s]")
      .def_property_readonly("stable_dt", &World::stable_dt, "[s]")
      .def("step", &World::step, py::arg("steps") = 1, Free())
      .def("advance", &World::advance, py::arg("seconds"), Free())
      .def("step_async", &World::step_async, py::arg("steps"), Free())
      .def("advance_async", static_cast<bool (World::*)(double)>(&World::advance_async), py::arg("seconds"), Free())
      .def("busy", &World::busy)
      .def("poll", &World::poll)
      .def("wait", &World::wait, Free())
      .def(
          "frame", [](World& w) { return std::const_pointer_cast<pliant::Frame>(w.frame()); }, Free())
      .def("frame_since", &frame_since, py::arg("seen"),
           "seen: the frame that one of several consumers got last, or None; (frame, dirty_vertices, dirty_triangles)")
      .def("pick", &pick, py::arg("origin"), py::arg("direction"),
           "where the ray from origin [m] first meets the surface of the frame returned last: a dict with the fields of "
           "PickedPoint, whose vertex grab and push take; None: it misses, or there was no frame")
      .def(
          "displacements", [](const World& w, std::size_t body) { return copy(w.displacements(body)); }, py::arg("body") = 0)
      .def(
          "velocities", [](const World& w, std::size_t body) { return copy(w.velocities(body)); }, py::arg("body") = 0)
      .def(
          "rest_positions", [](const World& w, std::size_t body) { return copy(w.rest_positions(body)); }, py::arg("body") = 0)
      .def("probes", &probes, "a dict of the scene's probes: of each a dict of its quantities, arrays of numbers")
      .def("remarks", &World::remarks, Free(), "a list of sentences: WorldInfo's, and what has happened since the start")
      .def("hash", &World::hash)
      .def("cut", &cut, py::arg("triangles"), "triangles: shape [triangles, 3, 3] [m]; a dict with the fields of CutResult")
      .def(
          "move_blade",
          [](World& w, const std::string& blade, const Vec3d& a, const Vec3d& b) { return result(w.move_blade(blade, a, b)); },
          py::arg("blade"), py::arg("a"), py::arg("b"))
      .def("lift_blade", &World::lift_blade, py::arg("blade"))
      .def("drive_blade", &World::drive_blade, py::arg("blade"), py::arg("a"), py::arg("b"), py::arg("seconds") = 1.0 / 60)
      .def("blade_forces", &blade_forces,
           "a dict of the blades that cut by force: of each a dict of its place and what it feels")
      .def("pieces", &World::pieces, py::arg("body") = 0, Free())
      .def("save", &World::save, py::arg("file"), Free())
      .def("load", &World::load, py::arg("file"), Free())
      .def("reset", &World::reset, Free());
  bind_tools(world);
  bind_live(world);
}

/// Names and types of a function's parameters without `self`, as its text says them: "steps: int = 1, ...".
std::string parameters_of(const std::string& text) {
  const std::size_t open = text.find('('), close = text.find(") -> ");
  std::string all = text.substr(open + 1, close - open - 1);
  const std::size_t comma = all.find(", ");
  return comma == std::string::npos ? "" : all.substr(comma + 2);
}

[[noreturn]] void refuse(const std::string& call, const std::string& parameters, const py::args& args,
                         const py::kwargs& kwargs) {
  std::set<std::string> names;
  std::string allowed;
  const std::regex name("(\\w+): ");
  for (std::sregex_iterator at(parameters.begin(), parameters.end(), name), end; at != end; ++at) {
    names.insert((*at)[1]);
    allowed += (allowed.empty() ? "'" : ", '") + (*at)[1].str() + "'";
  }
  const bool any = parameters.find("**kwargs") != std::string::npos;
  for (const auto& [key, value] : kwargs) {
    const auto word = key.cast<std::string>();
    if (names.count(word) > 0 || any) continue;
    throw py::type_error(call + "() has no argument '" + word + "'; allowed are: " + (allowed.empty() ? "none" : allowed));
  }
  std::string given;
  const auto type = [](const py::handle& of) { return py::type::of(of).attr("__name__").cast<std::string>(); };
  for (std::size_t i = 1; i < args.size(); ++i) given += (given.empty() ? "" : ", ") + type(args[i]);
  for (const auto& [key, value] : kwargs) given += (given.empty() ? "" : ", ") + key.cast<std::string>() + ": " + type(value);
  throw py::type_error(call + "() takes (" + parameters + "), got (" + given + ")");
}

/// What pybind11 says about a wrong call is a list of C++ signatures. Each method gets a shell that says it like Python does,
/// from the text that pybind11 wrote about the method.
void in_pythons_words(const py::object& type) {
  const auto type_name = type.attr("__name__").cast<std::string>();
  const py::dict members(type.attr("__dict__"));
  for (const auto& [key, member] : members) {
    const auto name = key.cast<std::string>();
    if (!PyInstanceMethod_Check(member.ptr()) || member.attr("__doc__").is_none()) continue;
    const auto inner = py::reinterpret_borrow<py::object>(member);
    const auto text = inner.attr("__doc__").cast<std::string>();
    const bool init = name == "__init__";  // a name by which pybind11 would take the shell for a constructor of its own
    const std::string call = init ? type_name : type_name + "." + name;
    const auto shell = [inner, call, parameters = parameters_of(text)](const py::args& args, const py::kwargs& kwargs) {
      try {
        return py::object(inner(*args, **kwargs));
      } catch (py::error_already_set& error) {
        const bool of_pybind =
            std::string(error.what()).find("The following argument types are supported") != std::string::npos;
        if (!error.matches(PyExc_TypeError) || !of_pybind) throw;
      }
      refuse(call, parameters, args, kwargs);
    };
    py::options options;
    options.disable_function_signatures();
    type.attr(name.c_str()) =
        py::cpp_function(shell, py::name(init ? "init" : name.c_str()), py::is_method(type), py::doc(text.c_str()));
  }
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.attr("__module__") = "pliant";  // where users find what is defined here: pybind11 names it so in classes and signatures
  m.doc() = "Soft-tissue deformation. SI units.";
  m.attr("__version__") = pliant::version();
  static const py::handle error = py::exception<pliant::Error>(m, "Error").release();  // never freed: exceptions may come late
  error.attr("__module__") = "pliant";
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const pliant::Error& e) {
      const py::object instance = error(e.what());
      instance.attr("code") = static_cast<int>(e.code());
      PyErr_SetObject(error.ptr(), instance.ptr());
    }
  });
  // pybind11 looks NumPy up at the first use of an array, within the guard of a static. That import lets other threads run, and
  // one that needs an array would wait for the guard with the interpreter's lock in hand, for ever. Here there is one thread.
  py::dtype::of<double>();
  bind_frame(m);
  bind_report(m);
  bind_world(m);
  bind_haptics(m);
  for (const char* name : {"World", "HapticLoop", "HapticDevice", "ManualDevice"}) in_pythons_words(m.attr(name));
  m.def("backends", &pliant::backend_names, "names of the backends of this machine");
}
