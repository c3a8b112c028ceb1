// pliant.HapticLoop and its devices. The loop's thread never needs Python: no class of Python can be a device of it, but
// ManualDevice takes poses from Python and tells the force.
#include "haptics.h"

#include <pliant/haptics.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>
#include <string>

#include "rows.h"

namespace py = pybind11;
using pliant::HapticDevice;
using pliant::HapticLoop;
using pliant::HapticOptions;
using pliant::ManualDevice;

namespace {

using FreeOfLock = py::call_guard<py::gil_scoped_release>;

/// A keyword of HapticLoop(). `set` throws py::cast_error for a value of another type.
struct LoopOption {
  const char* name;
  const char* type;
  void (*set)(HapticOptions& options, const py::handle& value);
};

template <auto Member>
void put(HapticOptions& options, const py::handle& value) {
  options.*Member = value.cast<std::remove_reference_t<decltype(options.*Member)>>();
}

const LoopOption kLoopOptions[] = {
    {"rate", "float", put<&HapticOptions::rate>},
    {"model", "str", put<&HapticOptions::model>},
    {"rings", "int", put<&HapticOptions::rings>},
    {"share", "float", put<&HapticOptions::share>},
    {"predict", "float", put<&HapticOptions::predict>},
    {"lead", "float", put<&HapticOptions::lead>},
    {"stiffness", "float", put<&HapticOptions::stiffness>},
    {"damping", "float", put<&HapticOptions::damping>},
    {"turn_stiffness", "float", put<&HapticOptions::turn_stiffness>},
    {"turn_damping", "float", put<&HapticOptions::turn_damping>},
    {"passive", "bool", put<&HapticOptions::passive>},
    {"device_damping", "float", put<&HapticOptions::device_damping>},
    {"stale_after", "float", put<&HapticOptions::stale_after>},
    {"ramp", "float", put<&HapticOptions::ramp>},
    {"greatest_force", "float", put<&HapticOptions::greatest_force>},
    {"greatest_torque", "float", put<&HapticOptions::greatest_torque>},
    {"align", "bool", put<&HapticOptions::align>},
    {"motion_scale", "float", put<&HapticOptions::motion_scale>},
    {"force_scale", "float", put<&HapticOptions::force_scale>},
    {"grip_button", "int", put<&HapticOptions::grip_button>},
    {"realtime", "bool", put<&HapticOptions::realtime>},
    {"log_samples", "int", put<&HapticOptions::log_samples>},
};

std::string type_of(const py::handle& value) { return py::type::of(value).attr("__name__").cast<std::string>(); }

HapticOptions loop_options(const py::kwargs& given) {
  HapticOptions options;
  for (const auto& [key, value] : given) {
    const auto word = key.cast<std::string>();
    const LoopOption* found = nullptr;
    std::string allowed;
    for (const LoopOption& option : kLoopOptions) {
      allowed += (allowed.empty() ? "'" : ", '") + std::string(option.name) + "'";
      if (word == option.name) found = &option;
    }
    if (found == nullptr) throw py::type_error("HapticLoop() has no argument '" + word + "'; allowed are: " + allowed);
    try {
      found->set(options, value);
    } catch (const py::cast_error&) {
      throw py::type_error("HapticLoop() takes " + word + ": " + found->type + ", got " + type_of(value));
    }
  }
  return options;
}

std::shared_ptr<HapticDevice> loop_device(const py::object& given) {
  if (py::isinstance<py::str>(given)) {
    const auto text = given.cast<std::string>();
    const py::gil_scoped_release release;
    return pliant::open_haptic_device(text);
  }
  if (py::isinstance<HapticDevice>(given)) return given.cast<std::shared_ptr<HapticDevice>>();
  throw py::type_error("HapticLoop() takes device: str or pliant.HapticDevice, got " + type_of(given));
}

/// The end of a loop waits for its thread.
struct DeleteFreeOfLock {
  void operator()(HapticLoop* loop) const {
    const py::gil_scoped_release release;
    delete loop;
  }
};
using LoopHolder = std::unique_ptr<HapticLoop, DeleteFreeOfLock>;

LoopHolder make_loop(pliant::World& world, const std::string& tool, const py::object& device, const py::kwargs& given) {
  const HapticOptions options = loop_options(given);
  auto opened = loop_device(device);
  const py::gil_scoped_release release;
  return LoopHolder(new HapticLoop(world, tool, std::move(opened), options));
}

/// An array of the fields of HapticSample.
py::array loop_samples(HapticLoop& loop) {
  std::vector<pliant::HapticSample> samples;
  {
    const py::gil_scoped_release release;
    samples = loop.samples();
  }
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(samples.size())}, strides{sizeof(pliant::HapticSample)};
  const Held<pliant::HapticSample> all = held(std::move(samples));
  return py::array(py::dtype::of<pliant::HapticSample>(), shape, strides, all.data, all.owner);
}

void bind_devices(py::module_& m) {
  using pliant::DeviceCounts;
  using pliant::DeviceLimits;
  using pliant::DeviceWrench;
  py::class_<DeviceCounts>(m, "DeviceCounts", "What a device has received so far.")
      .def_readonly("received", &DeviceCounts::received, "samples")
      .def_readonly("refused", &DeviceCounts::refused, "messages that gave none")
      .def_readonly("last_refusal", &DeviceCounts::last_refusal, "why the last one of them was refused; empty: none was");
  py::class_<DeviceLimits>(m, "DeviceLimits", "What a device can exert.")
      .def_readonly("force", &DeviceLimits::force, "greatest force [N]")
      .def_readonly("torque", &DeviceLimits::torque, "greatest torque [N m]; 0: it exerts none");
  py::class_<DeviceWrench>(m, "DeviceWrench", "Force and torque on the hand that holds a device.")
      .def_property_readonly(
          "force", [](const DeviceWrench& w) { return row(w.force); }, "[N]")
      .def_property_readonly(
          "torque", [](const DeviceWrench& w) { return row(w.torque); }, "about the tip [N m]")
      .def_readonly("time", &DeviceWrench::time, "of the sample that it answers, on the device's own clock [s]")
      .def_readonly("number", &DeviceWrench::number, "number of this sample");
  py::class_<HapticDevice, std::shared_ptr<HapticDevice>>(m, "HapticDevice", "A device that a hand holds.")
      .def("counts", &HapticDevice::counts, FreeOfLock(), "what it has received and refused so far: DeviceCounts")
      .def("limits", &HapticDevice::limits, FreeOfLock(), "what it can exert: DeviceLimits")
      .def("port", &HapticDevice::port, FreeOfLock(), "the port of UDP or TCP that it listens on; 0: none");
  constexpr double kNone = std::numeric_limits<double>::infinity();
  py::class_<ManualDevice, HapticDevice, std::shared_ptr<ManualDevice>>(
      m, "ManualDevice", "A device without hardware: a program moves it and asks what its hand would feel, from any thread.")
      .def(py::init([](double force, double torque) {
             return std::make_shared<ManualDevice>(pliant::DeviceLimits{force, torque});
           }),
           py::arg("force") = kNone, py::arg("torque") = kNone, "its limits [N], [N m]")
      .def("set_pose", &ManualDevice::set_pose, py::arg("position"), py::arg("turn") = std::array<double, 4>{0, 0, 0, 1},
           py::arg("buttons") = 0U, FreeOfLock(), "moves it [m]; turn: unit quaternion x, y, z, w; buttons: a bit per button")
      .def("wrench", &ManualDevice::wrench, FreeOfLock(), "what it exerts now: DeviceWrench");
  m.def("open_haptic_device", &pliant::open_haptic_device, py::arg("text"), FreeOfLock(),
        "a device by its text, such as \"udp:5000\": docs/haptic_devices.md");
}

void bind_state(py::module_& m) {
  using pliant::HapticSample;
  using pliant::HapticState;
  PYBIND11_NUMPY_DTYPE(HapticSample, tick, time, device, position, tissue, force);
  py::class_<HapticSample>(m, "HapticSample", "One tick of a HapticLoop.")
      .def_readonly("tick", &HapticSample::tick, "number since the start, from 1")
      .def_readonly("time", &HapticSample::time, "wall time since the start [s]")
      .def_property_readonly(
          "device", [](const HapticSample& s) { return row(s.device); }, "position of the device, in scene coordinates [m]")
      .def_property_readonly(
          "position", [](const HapticSample& s) { return row(s.position); }, "of the tool's origin [m]")
      .def_property_readonly(
          "tissue", [](const HapticSample& s) { return row(s.tissue); }, "force of the tissue on the tool [N]")
      .def_property_readonly(
          "force", [](const HapticSample& s) { return row(s.force); }, "on the hand, in scene coordinates [N]");
  py::class_<HapticState>(m, "HapticState", "State of a HapticLoop; include/pliant/haptics.h describes its members.")
      .def_readonly("running", &HapticState::running)
      .def_readonly("realtime", &HapticState::realtime)
      .def_readonly("model", &HapticState::model)
      .def_readonly("ticks", &HapticState::ticks)
      .def_readonly("late", &HapticState::late)
      .def_readonly("work_mean", &HapticState::work_mean, "[s]")
      .def_readonly("work_most", &HapticState::work_most, "[s]")
      .def_readonly("work_p999", &HapticState::work_p999, "[s]")
      .def_readonly("delay_p999", &HapticState::delay_p999, "[s]")
      .def_readonly("delay_most", &HapticState::delay_most, "[s]")
      .def_readonly("frames", &HapticState::frames)
      .def_readonly("age", &HapticState::age, "[s]")
      .def_readonly("rings", &HapticState::rings)
      .def_readonly("elements", &HapticState::elements)
      .def_readonly("substeps", &HapticState::substeps)
      .def_readonly("buffers", &HapticState::buffers)
      .def_readonly("resets", &HapticState::resets)
      .def_readonly("contacts", &HapticState::contacts)
      .def_readonly("stale", &HapticState::stale)
      .def_readonly("limited", &HapticState::limited)
      .def_readonly("not_finite", &HapticState::not_finite)
      .def_readonly("corrections", &HapticState::corrections)
      .def_readonly("energy", &HapticState::energy, "[J]")
      .def_readonly("least_energy", &HapticState::least_energy, "[J]")
      .def_readonly("refused", &HapticState::refused)
      .def_readonly("last", &HapticState::last, "the newest tick: HapticSample");
}

}  // namespace

void bind_haptics(py::module_& m) {
  bind_devices(m);
  bind_state(m);
  py::class_<HapticLoop, LoopHolder>(
      m, "HapticLoop", "Couples a device with a tool of a World: see docs/embedding.md. It keeps both. Usable from any thread.")
      .def(py::init(&make_loop), py::arg("world"), py::arg("tool"), py::arg("device"), py::keep_alive<1, 2>(),
           "Starts the thread. device: a HapticDevice, or the text of one; keywords: the members of HapticOptions in "
           "include/pliant/haptics.h, such as rate=1000")
      .def("stop", &HapticLoop::stop, FreeOfLock(), "ends the thread; the device gets a zero force")
      .def("state", &HapticLoop::state, FreeOfLock(), "HapticState")
      .def("samples", &loop_samples,
           "a structured array of the ticks since the last call: tick, time [s], device [m], position [m], tissue [N], force "
           "[N]")
      .def("write_log", &HapticLoop::write_log, py::arg("file"), FreeOfLock(),
           "writes what the device said as a stroke, which \"file:\" plays; needs log_samples")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](HapticLoop& loop, const py::args&) {
        const py::gil_scoped_release release;
        loop.stop();
      });
}
