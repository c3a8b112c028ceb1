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
#include "live.h"
#include "rows.h"
#include "state.h"
#include "surfaces.h"
#include "tools.h"

namespace py = pybind11;
using pliant::Vec3d;

namespace {

/// A read-only array over memory that `owner` keeps alive: shape [size][columns], `stride` bytes from row to row. Its class
/// exports it by DLPack, too.
template <class T>
py::array view(const T* data, std::size_t size, std::size_t columns, std::size_t stride, const py::object& owner) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(size)}, strides{static_cast<py::ssize_t>(stride)};
  if (columns > 0) {
    shape.push_back(static_cast<py::ssize_t>(columns));
    strides.push_back(sizeof(T));
  }
  py::array array(py::dtype::of<T>(), shape, strides, data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array.attr("view")(py::module_::import("pliant._arrays").attr("FrameArray"));
}

py::array texels(pliant::View<pliant::Vec4f> v, const py::object& owner) {
  return view(v.empty() ? nullptr : v.data()->data(), v.size(), 3, sizeof(pliant::Vec4f), owner);
}

py::tuple range(const pliant::IndexRange& r) { return py::make_tuple(r.first, r.count); }

py::list ranges(pliant::View<pliant::IndexRange> all) {
  py::list list;
  for (const pliant::IndexRange& r : all) list.append(range(r));
  return list;
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
  d["elements"] = r.elements;
  d["mass_lost"] = r.mass_lost;
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
      .def("probes", &probes, "a dict of the scene's probes: of each a dict of its quantities, arrays of numbers")
      .def("remarks", &World::remarks, Free(), "a list of sentences: WorldInfo's, and what has happened since the start")
      .def("hash", &World::hash)
      .def("cut", &cut, py::arg("triangles"), "triangles: shape [triangles, 3, 3] [m]; a dict with the fields of CutResult")
      .def(
          "move_blade",
          [](World& w, const std::string& blade, const Vec3d& a, const Vec3d& b) { return result(w.move_blade(blade, a, b)); },
          py::arg("blade"), py::arg("a"), py::arg("b"))
      .def("lift_blade", &World::lift_blade, py::arg("blade"), Free())
      .def("drive_blade", &World::drive_blade, py::arg("blade"), py::arg("a"), py::arg("b"), py::arg("seconds") = 1.0 / 60,
           Free())
      .def("blade_forces", &blade_forces,
           "a dict of the blades that cut by force: of each a dict of its place and what it feels")
      .def("cut_attempts", &cut_attempts,
           "a list of dicts with the fields of CutAttempt: from which vertex to which these blades went since the last call")
      .def("pieces", &World::pieces, py::arg("body") = 0, Free())
      .def("save", &World::save, py::arg("file"), Free())
      .def("load", &World::load, py::arg("file"), Free())
      .def("reset", &World::reset, Free());
  bind_tools(world);
  bind_live(world);
  bind_state(world);
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
