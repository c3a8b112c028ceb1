// Runs the trainer without a window and says what it was like: trainer [ORGAN.obj [hybrid | elements [SECONDS]]].
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "trainer.h"

int main(int argc, char** argv) try {
  trainer::Organ organ;
  organ.mesh = argc > 1 ? argv[1] : "scenes/meshes/liver.obj";
  organ.hybrid = argc > 2 && std::string(argv[2]) == "hybrid";
  const double seconds = argc > 3 ? std::atof(argv[3]) : 20;
  const std::string file = (std::filesystem::temp_directory_path() / "trainer.pck").string();
  trainer::Session session(trainer::scene_of(organ), "auto", file);
  std::size_t drawn = 0;
  const trainer::Report report =
      session.run(seconds, 60, 1, [&](const pliant::Frame& frame) { drawn += frame.positions.size(); });
  std::filesystem::remove(file);

  std::printf("real time %.3f of %.1f s; %.1f %% of %lld pictures stale\n", report.real_time(), report.wall,
              100 * report.stale_share(), static_cast<long long>(report.frames));
  std::printf("backend %s\n", report.backend.c_str());
  std::printf("load %.2f, late %lld, dropped %lld, lost %.2f s\n", report.live.load, static_cast<long long>(report.live.late),
              static_cast<long long>(report.live.dropped), report.live.lost);
  std::printf("%lld forces on the probe, at most %.2f N; grab: at most %.2f N, %.1f mm from the hand at the end\n",
              static_cast<long long>(report.forces), report.probe_force, report.grab_force, 1000 * report.grab_gap);
  for (const auto& [call, worst] : report.worst) std::printf("%-12s at most %.3f ms\n", call.c_str(), 1000 * worst);
  for (const pliant::Event& e : report.events) {
    std::printf("t = %.2f s: %s %s %s\n", e.time, e.kind.c_str(), e.subject.c_str(), e.text.c_str());
  }
} catch (const pliant::Error& error) {
  std::fprintf(stderr, "trainer: %s\n", error.what());
  return static_cast<int>(error.code());
}
