// pliant run: simulate a scene and write what comes out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "backends/choice/backends.h"
#include "cli/attempt_report.h"
#include "cli/checked_model.h"
#include "cli/cli.h"
#include "cli/energy_report.h"
#include "cli/frame_grid.h"
#include "cli/frames.h"
#include "cli/live_run.h"
#include "cli/picture_words.h"
#include "cli/probes.h"
#include "cli/run_events.h"
#include "cli/run_loop.h"
#include "cli/run_progress.h"
#include "cli/run_report.h"
#include "cli/run_static.h"
#include "cli/tool_report.h"
#include "geometry/stopwatch.h"
#include "io/atomic_file.h"
#include "io/save.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  Common common;
  std::string scene, backend = "auto", out, checkpoint, resume, motion;
  std::vector<std::string> formats{"vtu"}, fields, probes;
  PictureWords picture;
  LiveArguments live;
  std::optional<std::int64_t> steps;
  std::optional<std::string> every;
  std::optional<double> seconds, dt, checkpoint_every;
  bool hash = false, deep_hash = false, profile = false;
};

void check(const RunArguments& o) {
  if (o.steps) check_steps("--steps", *o.steps);
  if (o.seconds && !(*o.seconds >= 0 && std::isfinite(*o.seconds))) {
    throw Error(ErrorCode::bad_input, fmt::format("--seconds is {}; expected 0 or more", *o.seconds));
  }
  if (o.dt && !(*o.dt > 0 && std::isfinite(*o.dt)))
    throw Error(ErrorCode::bad_input, fmt::format("--dt is {} s; expected more than 0", *o.dt));
  for (const std::string& probe : o.probes) (void)parse_probe(probe);
  if (o.every) (void)FrameGrid::parse(*o.every);
  if (o.every && o.out.empty())
    throw Error(ErrorCode::bad_input, "--every says how often to write into a folder; it needs --out DIR");
  if (o.checkpoint_every && !(*o.checkpoint_every > 0 && std::isfinite(*o.checkpoint_every))) {
    throw Error(ErrorCode::bad_input,
                fmt::format("--checkpoint-every is {} s; expected more than 0 s of wall time", *o.checkpoint_every));
  }
  if (o.checkpoint_every && o.checkpoint.empty())
    throw Error(ErrorCode::bad_input, "--checkpoint-every says how often to save; it needs --checkpoint FILE");
  const std::set<OutputFormat> formats = parse_formats(o.formats);
  if (!parse_fields(o.fields).empty()) {
    if (o.out.empty())
      throw Error(ErrorCode::bad_input, "--fields selects the contents of the files of frames; it needs --out DIR");
    if (formats.count(OutputFormat::vtu) + formats.count(OutputFormat::gltf) == 0)
      throw Error(ErrorCode::bad_input, "--fields are values in VTU and glTF files; it needs --format vtu or gltf");
  }
  if (!o.picture.given().empty() && formats.count(OutputFormat::png) == 0) {
    throw Error(ErrorCode::bad_input, fmt::format("{} is for pictures; it needs --format png", o.picture.given()));
  }
  o.live.check();
  (void)o.picture.options();  // throws for invalid words
  o.common.check(o.hash);
  for (const std::string& file : {o.checkpoint, o.motion}) {
    if (!file.empty()) check_writable(file);
  }
}

class Run {
 public:
  explicit Run(const RunArguments& options) : o_(options), stem_(scene_stem(options.scene)) {}

  int operator()() {
    check(o_);
    Scene scene = load_scene(o_.scene);
    if (scene.solver.enabled) return solve(scene);
    open(std::move(scene));
    watch_interrupt();
    std::vector<DueOutput> due = outputs();
    if (o_.profile) simulation_->backend().profile(true);
    if (!o_.live.given().empty()) live_.emplace(o_.live, o_.common, *simulation_, o_.steps || o_.seconds);
    RunLoop loop(*simulation_, end(), o_.profile, live_ ? &live_->guide() : nullptr);
    energy_.emplace(*simulation_, loop);
    RunProgress progress(o_.common, *simulation_, loop);
    const Stopwatch since_start;
    double saved = 0;
    result_ = loop.run(due, [&](const RunResult& done) {
      progress.show(done);
      energy_->look();
      if (!o_.checkpoint_every || since_start.seconds() - saved < *o_.checkpoint_every) return;
      if (!simulation_->settled()) return;  // frames before it may not be written yet
      save_on_the_way();
      saved = since_start.seconds();
    });
    if (live_) live_->finish();
    progress.missed(blades_without_contact(*simulation_, false));
    progress.clear();
    if (!result_.diverged.empty()) return diverged();
    if (frames_) {
      write_frame();
      write_scene_probes();
      frames_->finish();
    }
    if (!o_.checkpoint.empty()) write_checkpoint(o_.checkpoint, checkpoint());
    if (!o_.motion.empty()) write_motion();
    report();
    return result_.interrupted ? kInterrupted : 0;
  }

 private:
  int solve(const Scene& scene) {
    for (const auto& [given, option] : {std::pair{o_.steps.has_value(), "--steps"},
                                        {o_.seconds.has_value(), "--seconds"},
                                        {o_.dt.has_value(), "--dt"},
                                        {o_.every.has_value(), "--every"},
                                        {!o_.probes.empty(), "--probe"},
                                        {!o_.checkpoint.empty(), "--checkpoint"},
                                        {o_.checkpoint_every.has_value(), "--checkpoint-every"},
                                        {!o_.resume.empty(), "--resume"},
                                        {!o_.motion.empty(), "--motion"},
                                        {!o_.live.live.empty(), "--live"},
                                        {!o_.live.replay.empty(), "--replay"},
                                        {o_.profile, "--profile"}}) {
      if (given)
        throw Error(ErrorCode::bad_input,
                    fmt::format("{} has no effect on {}, which uses the static solver: there are no steps", option, o_.scene));
    }
    if (o_.backend != "auto" && o_.backend != "cpu:double") {
      throw Error(ErrorCode::bad_input,
                  fmt::format("--backend is \"{}\"; {} uses the static solver, which runs in double on the processor alone",
                              o_.backend, o_.scene));
    }
    if (!o_.fields.empty()) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("--fields: {} uses the static solver, whose files hold displacements and reactions alone; the "
                              "fields are for steps in time (\"relaxation\" finds the same equilibrium)",
                              o_.scene));
    }
    return run_static(scene, {o_.common, stem_, o_.out, parse_formats(o_.formats), o_.hash});
  }

  void open(Scene scene) {
    if (o_.dt) scene.dt = *o_.dt;  // from here on the step is a fixed one, and part of what a checkpoint belongs to
    std::optional<Checkpoint> saved;
    if (!o_.resume.empty()) {
      saved = read_checkpoint(o_.resume);
      scene.interactive = has_part(saved->snapshot.made_of, kInteractive);  // as the host that saved it had it
      scene.cuttable = has_part(saved->snapshot.made_of, kCutting);
    }
    if (!o_.out.empty())
      frames_.emplace(o_.out, stem_, parse_formats(o_.formats), parse_fields(o_.fields), o_.picture.options());
    std::string reason;
    const auto model = std::make_shared<const Model>(checked_model(scene, o_.common, warnings_));
    std::vector<SceneProbe> points;
    for (const std::string& probe : o_.probes) points.push_back(parse_probe(probe));
    probes_ = Probes(points, *model);
    if (scene.probes != nullptr) scene_probes_ = Probes(scene.probes->list, *model);
    auto backend = open_backend(o_.backend, &reason, model->nodes(), BackendUse::once);
    o_.common.note("backend " + reason);
    if (!backend->info().bit_exact) o_.common.remark("tolerance mode: " + backend->info().tolerance_reason);
    simulation_.emplace(std::move(scene), model, std::move(backend));
    if (saved) resume(*saved);
    if (simulation_->stable_dt() > 0 && simulation_->dt() > simulation_->stable_dt()) {
      o_.common.remark(fmt::format("dt = {:.6g} s is {:.3g} times the stable step {:.6g} s: expect the simulation to diverge",
                                   simulation_->dt(), simulation_->dt() / simulation_->stable_dt(), simulation_->stable_dt()));
    }
    for (const std::string& remark : simulation_->remarks()) o_.common.remark(remark);
    if (frames_ && frames_->older() > 0 && !saved) {
      o_.common.remark(fmt::format(
          "--out: the folder {} holds {} files of an earlier run of {}; those of steps that this run does not write "
          "remain with the new ones",
          o_.out, frames_->older(), stem_));
    }
    first_time_ = simulation_->time();
  }

  void resume(const Checkpoint& saved) {
    restore_checkpoint(*simulation_, saved, o_.resume);
    o_.common.note(
        fmt::format("resumed at step {} (t = {:.6g} s) from {}", simulation_->step(), simulation_->time(), o_.resume));
    if (converged()) o_.common.remark("the checkpoint is at equilibrium: nothing is left to do");
  }

  [[nodiscard]] bool relaxes() const { return simulation_->scene().relaxation.enabled; }
  [[nodiscard]] bool converged() const { return simulation_->at_equilibrium(); }

  [[nodiscard]] RunEnd end() const {
    RunEnd end;
    if (o_.steps) end.step = simulation_->step() + *o_.steps;
    if (o_.seconds) end.time = first_time_ + *o_.seconds;
    if (o_.steps || o_.seconds) return end;
    if (relaxes()) {
      end.step = simulation_->scene().relaxation.max_steps;
    } else {  // a replay ends by itself, after the drives of its last step
      end.time = simulation_->scene().duration;
      if (live_) end.time = std::max(*end.time, live_->logged_end() + simulation_->dt());
    }
    return end;
  }

  /// Sets up the outputs and their times; the first are written at once.
  std::vector<DueOutput> outputs() {
    if (!frames_) return {};
    // Frames of a sixtieth of a second: a viewer then plays in real time.
    std::vector<DueOutput> due{
        {o_.every ? FrameGrid::parse(*o_.every) : FrameGrid::of_seconds(1.0 / 60), [&] { write_frame(); }}};
    if (const SceneProbes* probes = simulation_->scene().probes.get(); probes != nullptr && own_pace(*probes)) {
      due.push_back(
          {probes->every_steps > 0 ? FrameGrid::of_steps(probes->every_steps) : FrameGrid::of_seconds(probes->every_seconds),
           [&] { write_scene_probes(); }});
    }
    return due;
  }

  void write_frame() {
    frames_->write(*simulation_);
    probes_.write(*simulation_, frames_->folder() / (stem_ + "_probes.csv"));
    if (const SceneProbes* probes = simulation_->scene().probes.get(); probes != nullptr && !own_pace(*probes))
      write_scene_probes();
    write_tools();
  }

  static bool own_pace(const SceneProbes& probes) { return probes.every_steps > 0 || probes.every_seconds > 0; }
  void write_scene_probes() {
    scene_probes_.write_each(*simulation_, frames_->folder(), stem_);
    write_tools();
  }
  void write_tools() {
    tools_.write(*simulation_, frames_->folder() / (stem_ + "_tools.csv"));
    attempts_.write(*simulation_, frames_->folder() / (stem_ + "_attempts.csv"));
  }

  /// A disk that is full for a while does not end a run; the checkpoint before stays.
  void save_on_the_way() {
    try {
      write_checkpoint(o_.checkpoint, checkpoint());
    } catch (const Error& error) {
      tell(fmt::format("the run goes on without this checkpoint: {}", error.what()));
    }
  }

  void write_motion() const {
    const std::vector<std::uint8_t> bytes = simulation_->motion();
    write_file(o_.motion, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

  [[nodiscard]] Checkpoint checkpoint() const { return take_checkpoint(*simulation_); }

  /// Save the last good state, report, and leave with the divergence's exit code.
  int diverged() {
    const fs::path folder = o_.out.empty() ? fs::path(".") : fs::path(o_.out);
    const fs::path saved = folder / (stem_ + "-last-good.pckpt");
    write_checkpoint(saved, checkpoint());
    if (frames_) frames_->finish();
    if (frames_) write_vtu(folder / (stem_ + "-last-good.vtu"), volume_frame(*simulation_));
    report();
    throw Error(ErrorCode::diverged, fmt::format("{}; saved as {}", result_.diverged, saved.lexically_normal().string()));
  }

  void report() {
    report_run({o_.common, stem_, *simulation_, result_, probes_, scene_probes_, *energy_, warnings_,
                frames_ ? &*frames_ : nullptr, o_.checkpoint, first_time_, o_.hash, o_.deep_hash, o_.profile,
                live_ ? &*live_ : nullptr});
  }

  const RunArguments& o_;
  const std::string stem_;
  std::optional<Simulation> simulation_;
  std::optional<FrameWriter> frames_;
  Probes probes_, scene_probes_;
  ToolTable tools_;
  AttemptTable attempts_;
  std::optional<EnergyReport> energy_;
  std::optional<LiveRun> live_;
  RunResult result_;
  std::vector<std::string> warnings_;  // about surfaces
  double first_time_ = 0;
};

}  // namespace

std::function<int()> setup_run(CLI::App& app) {
  auto o = std::make_shared<RunArguments>();
  app.add_option("scene", o->scene, "Scene file")->required();
  app.add_option("--backend", o->backend, "auto, cpu, cpu:double, cpu:check, opencl or opencl:N")->capture_default_str();
  auto* steps = app.add_option("--steps", o->steps, "Steps of this run; default: to the scene's duration, or to equilibrium");
  app.add_option("--seconds", o->seconds, "Simulated time of this run [s]")->excludes(steps);
  app.add_option("--dt", o->dt, "Step [s] instead of the scene's");
  app.add_option("--out", o->out, "Folder for frames; made where missing")->type_name("DIR");
  app.add_option("--every", o->every,
                 "Steps between two frames (100), or simulated time (16ms, 0.016s): a frame at the first step at or after each "
                 "multiple; default: every 1/60 s of simulated time")
      ->type_name("STEPS|TIME");
  app.add_option("--probe", o->probes,
                 "Follow the material at a point at rest [m], written with every frame and to the JSON; may be given again")
      ->type_name("NAME=x,y,z")
      ->allow_extra_args(false);
  app.add_option("--format", o->formats, explained(format_words()))->delimiter(',')->capture_default_str();
  app.add_option("--fields", o->fields, "Values in VTU and glTF files: " + explained(field_words()))->delimiter(',');
  o->picture.add_to(app);
  o->live.add_to(app);
  app.add_option("--checkpoint", o->checkpoint, "Save the last state")->type_name("FILE");
  app.add_option("--checkpoint-every", o->checkpoint_every,
                 "Save the state on the way, too, after so many seconds of wall time [s]");
  app.add_option("--resume", o->resume, "Go on from a saved state of the same scene")->type_name("FILE");
  app.add_option("--motion", o->motion, "Save the bytes that the hash is of: displacements and increments of the last state")
      ->type_name("FILE");
  app.add_flag("--deep-hash", o->deep_hash,
               "Also print the hash of all that later steps depend on: model, state buffers and run state");
  app.add_flag("--hash", o->hash, "Print the hash of the last state, with --quiet as the only output");
  app.add_flag("--profile", o->profile, "Time every pass on the device; this slows a run down");
  o->common.add_to(app);
  return [o] { return Run(*o)(); };
}

}  // namespace pliant::cli
