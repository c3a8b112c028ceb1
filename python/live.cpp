#include "live.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "rows.h"

namespace py = pybind11;

namespace {

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
  std::vector<pliant::ForceSample> trace = py::isinstance<py::str>(of) ? w.force_trace(of.cast<std::string>(), after)
                                                                       : w.force_trace(of.cast<pliant::GrabId>(), after);
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(trace.size())}, strides{sizeof(pliant::ForceSample)};
  const Held<pliant::ForceSample> all = held(std::move(trace));
  return py::array(dtype_of_force_sample(), shape, strides, all.data, all.owner);
}

}  // namespace

void bind_live(py::class_<pliant::World>& world) {
  using pliant::World;
  using Free = py::call_guard<py::gil_scoped_release>;
  world
      .def(
          "run_live",
          [](World& w, double rate, double speed, int ahead) {
            w.run_live({rate, speed, ahead});
          },
          py::arg("rate") = 60.0, py::arg("speed") = 1.0, py::arg("ahead") = 0, Free(),
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
