// pliant bench NAME: measurements of the engine itself. Every benchmark prints {"machine": {...}, "rows": [...]}.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "bench/accuracy/accuracy.h"
#include "bench/contact/contact.h"
#include "bench/cutting/cutting.h"
#include "bench/deformation/deformation.h"
#include "bench/haptics/haptics.h"
#include "bench/kernels/kernels.h"
#include "bench/stability/stability.h"
#include "bench/survival/survival.h"
#include "bench/trainer/trainer.h"
#include "cli/cli.h"
#include "io/atomic_file.h"
#include "io/png.h"
#include "pliant/error.h"
#include "render/picture.h"
#include "scene/keys.h"

namespace pliant::cli {
namespace {

struct BenchArguments {
  Common common;
  bench::KernelsOptions kernels;
  bench::DeformationOptions deformation;
  bench::StabilityOptions stability;
  bench::AccuracyOptions accuracy;
  bench::CuttingOptions cutting;
  bench::SurvivalOptions survival;
  bench::ContactOptions contact;
  bench::TrainerOptions trainer;
  bench::HapticsOptions haptics;
  std::filesystem::path out;
};

/// Made before the work, so that a folder that cannot be made is known at once.
void make_folder(const std::filesystem::path& out) {
  std::error_code failed;
  std::filesystem::create_directories(out, failed);
  if (failed)
    throw Error(ErrorCode::bad_input, fmt::format("--out: folder \"{}\" cannot be made: {}", out.string(), failed.message()));
}

void write_folder(const std::filesystem::path& out, const std::string& stem, const nlohmann::json& result) {
  write_file(out / (stem + ".json"), result.dump(1) + "\n");
  write_file(out / (stem + ".csv"), bench::rows_csv(result["rows"]));
}

/// What every benchmark does around its measurements.
template <class Wanted>
int measure(BenchArguments& options, const std::string& stem, Wanted& wanted, nlohmann::json (*bench)(const Wanted&),
            std::string (*table)(const nlohmann::json&)) {
  if (!options.out.empty()) make_folder(options.out);
  Progress progress(!options.common.quiet);
  wanted.progress = [&](double done, const std::string& what) {
    progress.show(static_cast<std::int64_t>(1000 * done), 1000, what);
  };
  const nlohmann::json result = bench(wanted);
  progress.clear();
  options.common.print(table(result));
  if (!options.out.empty()) {
    write_folder(options.out, stem, result);
    const std::string out = options.out.string();
    options.common.note(
        fmt::format("wrote {1}.json and {1}.csv to {0}; python3 bench/report/report.py {0} draws the charts", out, stem));
  }
  options.common.write(nlohmann::ordered_json(result));
  return 0;
}

int kernels(BenchArguments& options) {
  options.common.check();
  for (const std::int64_t size : options.kernels.sizes) {
    if (size < 1 || size > 100'000'000)
      throw Error(ErrorCode::bad_input, fmt::format("--sizes: got {}, expected 1 to 100000000 elements", size));
  }
  return measure(options, "kernels", options.kernels, bench::bench_kernels, bench::kernels_table);
}

int deformation(BenchArguments& options) {
  options.common.check();
  return measure(options, "deformation", options.deformation, bench::bench_deformation, bench::deformation_table);
}

int stability(BenchArguments& options) {
  options.common.check();
  // Sweeps that an earlier call finished are taken from the folder.
  if (!options.out.empty()) options.stability.keep = options.out / "stability-sweeps";
  return measure(options, "stability", options.stability, bench::bench_stability, bench::stability_table);
}

void add_stability(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub = app.add_subcommand("stability", "Sweeps to the failure of every method: the limit predicted and measured");
  bench::StabilityOptions& s = options->stability;
  options->common.add_to(*sub);
  sub->add_option("--sweeps", s.sweeps, "some of the sweeps only; a wrong name lists them")->delimiter(',');
  sub->add_flag("--quick", s.quick, "few points and short runs: under a minute");
  sub->add_option("--out", options->out,
                  "folder for stability.json and stability.csv; finished sweeps kept there are not repeated");
}

int accuracy(BenchArguments& options) {
  options.common.check();
  options.accuracy.out = options.out;  // finished points are kept there
  options.accuracy.note = [&](const std::string& text) { options.common.note(text); };
  return measure(options, "accuracy", options.accuracy, bench::bench_accuracy, bench::accuracy_table);
}

void add_accuracy(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub =
      app.add_subcommand("accuracy", "Speed against error of every method, on exact answers and converged references");
  bench::AccuracyOptions& a = options->accuracy;
  options->common.add_to(*sub);
  sub->add_option("--scenes", a.scenes, "folder of the shipped scenes");
  sub->add_option("--problems", a.problems, "some of the problems only; a wrong name lists them")->delimiter(',');
  sub->add_option("--methods", a.methods, "some of the methods only; a wrong name lists them")->delimiter(',');
  sub->add_option("--backends", a.backends, "default: auto,cpu:double; the first one serves every point")->delimiter(',');
  sub->add_flag("--quick", a.quick, "coarse bodies and references, fewer methods: under a minute");
  sub->add_flag("--noisy", a.noisy, "measure finished points again whose times spread by more than 15 %");
  sub->add_flag("--again", a.again, "measure finished points of the folder again");
  sub->add_option("--out", options->out,
                  "folder for accuracy.json and accuracy.csv; finished points kept there are not measured again");
}

void add_deformation(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub = app.add_subcommand(
      "deformation", "Hybrid bodies beside finite elements and shape matching alone, the published times, growth and error");
  bench::DeformationOptions& d = options->deformation;
  options->common.add_to(*sub);
  sub->add_option("--scenes", d.scenes, "folder of the shipped scenes");
  sub->add_option("--only", d.only, "bunny, apple, liver, kidney")->delimiter(',');
  sub->add_option("--parts", d.parts, "scenes, scaling, accuracy")->delimiter(',');
  sub->add_option("--backends", d.backends, "default: auto,cpu; the first one serves scaling and accuracy")->delimiter(',');
  sub->add_option("--sizes", d.sizes, "nodes of the liver in part scaling, default: 10000,100000")->delimiter(',');
  sub->add_option("--ratios", d.ratios, "operational shares in part accuracy, default: 0.1 to 0.9")->delimiter(',');
  sub->add_flag("--full", d.full, "scaling to 1000000 nodes");
  sub->add_flag("--quick", d.quick, "a few steps of everything; the times mean nothing");
  sub->add_option("--out", options->out, "folder for deformation.json and deformation.csv");
}

int cutting(BenchArguments& options) {
  options.common.check();
  if (!options.out.empty() && render::Renderer::available()) {
    options.cutting.picture = [&](const std::string& name, Simulation& simulation) {
      render::PictureOptions picture;
      picture.width = 640;
      picture.height = 400;
      write_png(options.out / ("cutting_" + name + ".png"), render::Pictures(picture).draw(simulation));
    };
  }
  return measure(options, "cutting", options.cutting, bench::bench_cutting, bench::cutting_table);
}

void add_cutting(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub = app.add_subcommand(
      "cutting", "What a cut costs and leaves behind: virtual nodes beside removal, decomposition, separation");
  bench::CuttingOptions& c = options->cutting;
  options->common.add_to(*sub);
  sub->add_option("--scenes", c.scenes, "folder of the shipped scenes");
  sub->add_option("--parts", c.parts, "scenes, methods, live, steps, strokes")->delimiter(',');
  sub->add_option("--backend", c.backend, "of all parts but steps and strokes, default: auto");
  sub->add_option("--cuts", c.cuts, "random cuts of part steps, default: 10000, and of strokes, default: 1000")
      ->check(CLI::Range(1, 10'000'000));
  sub->add_option("--trial", c.trial, "part strokes: only the trial of this number")->check(CLI::Range(0, 10'000'000));
  sub->add_flag("--quick", c.quick, "small bodies, 200 random cuts, 20 strokes; the times mean nothing");
  sub->add_option("--out", options->out, "folder for cutting.json, cutting.csv and the pictures");
}

int survival(BenchArguments& options) {
  options.common.check();
  options.survival.out = options.out;  // finished scenes are kept there
  return measure(options, "survival", options.survival, bench::bench_survival, bench::survival_table);
}

void add_survival(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub =
      app.add_subcommand("survival", "Random scenes of the kind that strangers write: pulled, pushed, cut, torn, to their end");
  bench::SurvivalOptions& s = options->survival;
  options->common.add_to(*sub);
  sub->add_option("--scenes", s.scenes, "folder of the shipped scenes");
  sub->add_option("--backend", s.backend, "default: cpu");
  sub->add_option("--first", s.first, "number of the first scene, default: 0");
  sub->add_option("--count", s.count, "default: 1000");
  sub->add_option("--having", s.having, "only scenes with one of these keys or words, such as joins,membrane,mass-spring")
      ->delimiter(',');
  sub->add_flag("--quick", s.quick, "50 scenes for a quarter of the time");
  sub->add_option("--out", options->out,
                  "folder for survival.json and survival.csv, and the scenes that end badly or take short steps; finished ones "
                  "are not run again");
}

int contact(BenchArguments& options) {
  options.common.check();
  return measure(options, "contact", options.contact, bench::bench_contact, bench::contact_table);
}

void add_contact(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub = app.add_subcommand("contact", "Whether contact rests, feels, keeps what is to be kept, and what it costs");
  bench::ContactOptions& c = options->contact;
  options->common.add_to(*sub);
  sub->add_option("--parts", c.parts, "rest, tissue, strokes, figures, costs")->delimiter(',');
  sub->add_option("--backend", c.backend, "of all parts but costs, default: cpu");
  sub->add_option("--backends", c.backends, "of part costs, default: cpu and the first OpenCL device")->delimiter(',');
  sub->add_option("--sizes", c.sizes, "nodes in part costs, default: 3000,30000,300000")->delimiter(',');
  sub->add_option("--tools", c.tools, "tools in part rest, default: 200");
  sub->add_option("--strokes", c.strokes, "strokes of part strokes, default: 10000");
  sub->add_flag("--quick", c.quick, "few of everything, small bodies: below 20 s");
  sub->add_option("--out", options->out, "folder for contact.json and contact.csv");
}

int trainer(BenchArguments& options) {
  options.common.check();
  return measure(options, "trainer", options.trainer, bench::bench_trainer, bench::trainer_table);
}

void add_trainer(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub = app.add_subcommand(
      "trainer", "A trainer at 60 Hz: probe, scalpel, hand, save, load, reset; real time, pictures without news, worst calls");
  bench::TrainerOptions& t = options->trainer;
  options->common.add_to(*sub);
  sub->add_option("--organs", t.organs, "liver_hybrid, liver, two_livers, bunny, liver_10k; default: all")->delimiter(',');
  sub->add_option("--scenes", t.scenes, "folder of the shipped scenes");
  sub->add_option("--backend", t.backend, "default: auto");
  sub->add_option("--seconds", t.seconds, "length of a session, default: 20");
  sub->add_option("--busy", t.busy, "threads that compute all the time beside it, default: 0");
  sub->add_option("--ahead", t.ahead, "frames that the World may be ahead of the pictures, default: 1");
  sub->add_flag("--quick", t.quick, "3 s of the first organ");
  sub->add_option("--out", options->out, "folder for trainer.json and trainer.csv");
}

int haptics(BenchArguments& options) {
  options.common.check();
  return measure(options, "haptics", options.haptics, bench::bench_haptics, bench::haptics_table);
}

void add_haptics(CLI::App& app, const std::shared_ptr<BenchArguments>& options) {
  CLI::App* sub =
      app.add_subcommand("haptics", "What a hand feels: buffer model against the full one, passivity, ticks in time");
  bench::HapticsOptions& h = options->haptics;
  options->common.add_to(*sub);
  sub->add_option("--parts", h.parts, "strokes, others, edits, passivity, times")->delimiter(',');
  sub->add_option("--scenes", h.scenes, "folder of the shipped scenes");
  sub->add_option("--seconds", h.seconds, "length of each measurement in wall time, default: 20");
  sub->add_flag("--quick", h.quick, "one body, two sizes of buffer, 2 s");
  sub->add_option("--out", options->out, "folder for haptics.json and haptics.csv");
}

}  // namespace

std::function<int()> setup_bench(CLI::App& app) {
  auto options = std::make_shared<BenchArguments>();
  app.require_subcommand(1);
  CLI::App* sub =
      app.add_subcommand("kernels", "Every pass of a step: ns, bytes and flops per element, share of the machine's limit");
  options->common.add_to(*sub);
  sub->add_option("--elements", options->kernels.elements,
                  explained(element_words()) + ", springs (a network), membrane (its triangles on a sheet)")
      ->delimiter(',');
  sub->add_option("--sizes", options->kernels.sizes, "numbers of elements")->delimiter(',');
  sub->add_option("--backends", options->kernels.backends, "default: the first OpenCL device, cpu, cpu:double")->delimiter(',');
  sub->add_option("--law", options->kernels.law, alternatives(words_only(law_words())));
  sub->add_option("--out", options->out, "folder for kernels.json and kernels.csv");
  add_deformation(app, options);
  add_stability(app, options);
  add_accuracy(app, options);
  add_cutting(app, options);
  add_survival(app, options);
  add_contact(app, options);
  add_trainer(app, options);
  add_haptics(app, options);
  return [options, &app] {
    if (app.got_subcommand("kernels")) return kernels(*options);
    if (app.got_subcommand("accuracy")) return accuracy(*options);
    if (app.got_subcommand("survival")) return survival(*options);
    if (app.got_subcommand("cutting")) return cutting(*options);
    if (app.got_subcommand("contact")) return contact(*options);
    if (app.got_subcommand("trainer")) return trainer(*options);
    if (app.got_subcommand("haptics")) return haptics(*options);
    return app.got_subcommand("stability") ? stability(*options) : deformation(*options);
  };
}

}  // namespace pliant::cli
