// The Python module: pliant::World with NumPy views of its frames.
#include <pliant/world.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>

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

pliant::WorldOptions options(const std::string& backend, double dt, bool normals, bool interactive) {
  pliant::WorldOptions o;
  o.backend = backend;
  o.dt = dt;
  o.normals = normals;
  o.interactive = interactive;
  return o;
}

/// A scene is the name of a file, or a dict with the keys of a scene file.
std::unique_ptr<pliant::World> make_world(const py::object& scene, const std::vector<std::pair<Vertices, py::object>>& surfaces,
                                          const std::string& folder, const std::string& backend, double dt, bool normals,
                                          bool interactive) {
  const pliant::WorldOptions o = options(backend, dt, normals, interactive);
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
          "dirty_vertices", [](const Frame& f) { return py::make_tuple(f.dirty_vertices.first, f.dirty_vertices.count); },
          "(first, count) of what may have moved since the frame before")
      .def_property_readonly(
          "dirty_triangles", [](const Frame& f) { return py::make_tuple(f.dirty_triangles.first, f.dirty_triangles.count); },
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
    bodies.append(body);
  }
  py::dict d;
  d["backend"] = i.backend;
  d["device"] = i.device;
  d["reason"] = i.reason;
  d["bit_exact"] = i.bit_exact;
  d["nodes"] = i.nodes;
  d["elements"] = i.elements;
  d["bodies"] = bodies;
  return d;
}

py::dict result(const pliant::CutResult& r) {
  py::dict d;
  d["pending"] = r.pending;
  d["changed"] = r.changed;
  d["edges"] = r.edges;
  d["seconds"] = r.seconds;
  return d;
}

py::dict cut(pliant::World& w, const Vertices& triangles) {
  if (triangles.ndim() != 3 || triangles.shape(1) != 3 || triangles.shape(2) != 3) {
    throw pliant::Error(pliant::ErrorCode::usage, "the triangles of a cut are an array of the shape [triangles, 3, 3]");
  }
  std::vector<std::array<Vec3d, 3>> list(static_cast<std::size_t>(triangles.shape(0)));
  if (!list.empty()) std::copy_n(triangles.data(), 9 * list.size(), list[0][0].data());
  return result(w.cut(list));
}

void bind_world(py::module_& m) {
  using pliant::World;
  using Free = py::call_guard<py::gil_scoped_release>;
  py::class_<World>(m, "World", "A scene on a backend: see docs/embedding.md. One thread at a time.")
      .def(py::init(&make_world), py::arg("scene"), py::arg("surfaces") = std::vector<std::pair<Vertices, py::object>>{},
           py::arg("folder") = "", py::arg("backend") = "auto", py::arg("dt") = 0.0, py::arg("normals") = true,
           py::arg("interactive") = false,
           "scene: a file, or a dict with the keys of a scene file whose \"surface\": \"memory:N\" takes surfaces[N] = "
           "(vertices, triangles)")
      .def_property_readonly("info", &info)
      .def_property_readonly("time", &World::time, "[s]")
      .def_property_readonly("step_number", &World::step_number)
      .def_property_readonly("dt", &World::dt, "[s]")
      .def_property_readonly("stable_dt", &World::stable_dt, "[s]")
      .def("step", &World::step, py::arg("steps") = 1, Free())
      .def("advance", &World::advance, py::arg("seconds"), Free())
      .def("advance_async", &World::advance_async, py::arg("steps"), Free())
      .def("busy", &World::busy)
      .def("poll", &World::poll)
      .def("wait", &World::wait, Free())
      .def(
          "frame", [](World& w) { return std::const_pointer_cast<pliant::Frame>(w.frame()); }, Free())
      .def(
          "displacements", [](const World& w, std::size_t body) { return copy(w.displacements(body)); }, py::arg("body") = 0)
      .def(
          "velocities", [](const World& w, std::size_t body) { return copy(w.velocities(body)); }, py::arg("body") = 0)
      .def(
          "rest_positions", [](const World& w, std::size_t body) { return copy(w.rest_positions(body)); }, py::arg("body") = 0)
      .def("hash", &World::hash)
      .def(
          "grab",
          [](World& w, std::int32_t vertex, double radius, double stiffness, double max_force) {
            return w.grab(vertex, {radius, stiffness, max_force});
          },
          py::arg("vertex"), py::arg("radius") = 0.0, py::arg("stiffness") = 0.0, py::arg("max_force") = 0.0)
      .def("move_grab", &World::move_grab, py::arg("grab"), py::arg("target"))
      .def("release", &World::release, py::arg("grab"))
      .def("push", &World::push, py::arg("vertex"), py::arg("force"))
      .def("clear_tools", &World::clear_tools)
      .def("move_tool", &World::move_tool, py::arg("position"))
      .def("cut", &cut, py::arg("triangles"), "triangles: shape [triangles, 3, 3] [m]; a dict with the fields of CutResult")
      .def(
          "move_blade",
          [](World& w, const std::string& blade, const Vec3d& a, const Vec3d& b) { return result(w.move_blade(blade, a, b)); },
          py::arg("blade"), py::arg("a"), py::arg("b"))
      .def("lift_blade", &World::lift_blade, py::arg("blade"))
      .def("pieces", &World::pieces, py::arg("body") = 0, Free())
      .def("save", &World::save, py::arg("file"), Free())
      .def("load", &World::load, py::arg("file"), Free())
      .def("reset", &World::reset, Free());
}

}  // namespace

PYBIND11_MODULE(pliant, m) {
  m.doc() = "Soft-tissue deformation. SI units.";
  m.attr("__version__") = pliant::version();
  static const py::handle error = py::exception<pliant::Error>(m, "Error").release();  // never freed: exceptions may come late
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const pliant::Error& e) {
      const py::object instance = error(e.what());
      instance.attr("code") = static_cast<int>(e.code());
      PyErr_SetObject(error.ptr(), instance.ptr());
    }
  });
  bind_frame(m);
  bind_report(m);
  bind_world(m);
  m.def("backends", &pliant::backend_names, "names of the backends of this machine");
}
