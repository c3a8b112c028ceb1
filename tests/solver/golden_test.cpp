// Golden hashes: the bits of whole runs, the same for every compiler, flag, backend and machine. A change that is meant to
// alter results writes tests/golden/hashes.json anew (PLIANT_WRITE_GOLDEN=1) and says in its message why.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "program/hash.h"
#include "solver/scenes.h"
#include "support/source_dir.h"

namespace pliant::golden_test {
namespace {

constexpr std::int64_t kSteps = 200;
const std::string kFile = test::source_dir() + "/tests/golden/hashes.json";

std::string run(const std::string& scene, const std::string& backend) {
  Simulation simulation(load_scene(test::source_dir() + "/scenes/" + scene + ".json"), open_backend(backend));
  simulation.advance(kSteps);
  return hash_text(simulation.hash());
}

class Golden : public ::testing::TestWithParam<const char*> {};

TEST_P(Golden, ScenesGiveTheRecordedBits) {
  const std::string backend = GetParam();
  if (backend == "opencl:0" && !testing::has_opencl()) GTEST_SKIP() << "there is no OpenCL device";
  const bool write = std::getenv("PLIANT_WRITE_GOLDEN") != nullptr;
  nlohmann::ordered_json golden;
  if (!write) golden = nlohmann::ordered_json::parse(std::ifstream(kFile));
  for (const char* scene : {"beam", "beam_tet", "beam_anp", "cube", "liver", "kidney", "inclusion", "two_bodies", "twist"}) {
    const std::string hash = run(scene, backend);
    if (write) {
      golden[scene] = hash;
    } else {
      EXPECT_EQ(hash, golden.at(scene).get<std::string>())
          << "scenes/" << scene << ".json after " << kSteps << " steps on " << backend;
    }
  }
  if (write) std::ofstream(kFile) << golden.dump(2) << '\n';
}

std::string label(const ::testing::TestParamInfo<const char*>& backend) {
  return std::string(backend.param) == "cpu" ? "cpu" : "opencl";
}
INSTANTIATE_TEST_SUITE_P(On, Golden, ::testing::Values("cpu", "opencl:0"), label);

}  // namespace
}  // namespace pliant::golden_test
