// Small scenes in code, and a backend that is lost when told.
#pragma once
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "api/world_impl.h"
#include "backends/choice/backends.h"
#include "pliant/world.h"
#include "support/forwarding_backend.h"

namespace pliant::test {

/// A soft block of 10 x 8 x 6 cm that stands on its lower face, under gravity; `push` [N] presses its top aside.
inline SceneSpec block(double push = 0.5) {
  SceneSpec scene;
  scene.gravity = {0, -9.81, 0};
  BodySpec body;
  body.name = "block";
  body.surface = box_surface({0, 0, 0}, {0.1, 0.08, 0.06});
  body.lattice_spacing = 0.02;
  body.material.young = 3000;
  body.material.damping = 5;
  body.fixed.push_back({RegionSpec::plane({0, 0.001, 0}, {0, -1, 0})});
  if (push != 0) body.forces.push_back({RegionSpec::plane({0, 0.07, 0}, {0, 1, 0}), {push, 0, 0}, {"smooth", 0, 0.1, {}}});
  scene.bodies.push_back(body);
  return scene;
}

inline WorldOptions on(const std::string& backend, bool interactive = false) {
  WorldOptions options;
  options.backend = backend;
  options.interactive = interactive;
  return options;
}

/// The twins, and the first OpenCL device where there is one: their bits are the same.
inline std::vector<std::string> float_backends() {
  std::vector<std::string> names{"cpu"};
  for (const std::string& name : backend_names()) {
    if (names.size() == 1 && name.starts_with("opencl")) names.push_back(name);
  }
  return names;
}

/// A step 3 times too long: it diverges after some steps.
inline SceneSpec unstable() {
  SceneSpec scene = block(3);
  World probe(scene, on("cpu"));
  scene.dt = 3 * probe.stable_dt();
  return scene;
}

template <class Call>
ErrorCode code_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_STRNE(error.what(), "");
    return error.code();
  }
  ADD_FAILURE() << "no Error";
  return ErrorCode::internal;
}

template <class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline std::vector<Vec4f> positions(World& world) {
  const FramePtr frame = world.frame();
  return {frame->positions.begin(), frame->positions.end()};
}

/// Works until `left` runs are used up, and then fails like a device that is gone.
class FaultyBackend final : public ForwardingBackend {
 public:
  FaultyBackend(std::unique_ptr<Backend> inner, std::shared_ptr<std::atomic<int>> left)
      : ForwardingBackend(std::move(inner)), left_(std::move(left)) {}
  void run(const std::vector<Pass>& passes, std::int32_t first, std::int32_t count, std::int64_t origin) override {
    use();
    ForwardingBackend::run(passes, first, count, origin);
  }
  void run(const Pass& pass, std::int32_t step) override {
    use();
    ForwardingBackend::run(pass, step);
  }
  std::vector<double> read_reals(BufferId id) override { return alive(), ForwardingBackend::read_reals(id); }
  std::vector<std::int32_t> read_ints(BufferId id) override { return alive(), ForwardingBackend::read_ints(id); }
  std::vector<std::uint8_t> read_bytes(BufferId id) override { return alive(), ForwardingBackend::read_bytes(id); }
  void read_into(BufferId id, void* out) override {
    alive();
    ForwardingBackend::read_into(id, out);
  }

 private:
  void alive() const {
    if (*left_ <= 0) throw Error(ErrorCode::internal, "CL_DEVICE_NOT_AVAILABLE (-2)");
  }
  void use() {
    alive();
    --*left_;
  }
  std::shared_ptr<std::atomic<int>> left_;
};

}  // namespace pliant::test
