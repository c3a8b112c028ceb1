// The pliant command: one row per command, and the one place where errors become exit codes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <exception>
#include <new>

#include "cli/cli.h"
#include "pliant/error.h"
#include "scene/keys.h"

namespace {

using pliant::Error;
using pliant::ErrorCode;

constexpr pliant::cli::Command kCommands[] = {
    {"devices", "List the backends of this machine and whether each gives the same bits", pliant::cli::setup_devices},
    {"info", "Contents of a scene: elements, mass, stable step, memory, passes", pliant::cli::setup_info},
    {"run", "Simulate a scene and write the results", pliant::cli::setup_run},
    {"compare", "Run a scene on two backends in lockstep and find the first bit that differs", pliant::cli::setup_compare},
    {"bench", "Measure the engine itself: pliant bench kernels", pliant::cli::setup_bench},
    {"plan", "The cheapest lattice, element and model of a scene for a tolerance and a frame budget", pliant::cli::setup_plan},
};

/// A first word that is neither command nor option gets an answer of its own.
void check_first_word(int argc, char** argv) {
  std::vector<std::string> names;
  for (const auto& command : kCommands) names.emplace_back(command.name);
  if (argc < 2)
    throw Error(ErrorCode::bad_input,
                fmt::format("no command given; allowed are {} (pliant --help says more)", pliant::listed(names)));
  const std::string word = argv[1];
  const std::vector<std::string> options{"--help", "-h", "--version"};
  const bool is_option = word.rfind('-', 0) == 0;
  const auto& allowed = is_option ? options : names;
  if (std::find(allowed.begin(), allowed.end(), word) != allowed.end()) return;
  throw Error(ErrorCode::bad_input, fmt::format("unknown {} \"{}\"; allowed here are {}{}", is_option ? "option" : "command",
                                                word, pliant::listed(allowed), pliant::cli::did_you_mean(word, allowed)));
}

int run(int argc, char** argv) {
  CLI::App app{"Pliant: soft-tissue deformation on OpenCL and on a bit-exact CPU reference"};
  app.name("pliant");
  app.set_version_flag("--version", "pliant " PLIANT_VERSION);
  app.require_subcommand(1);
  std::function<int()> chosen;
  for (const auto& command : kCommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.about);
    auto action = command.setup(*sub);
    sub->final_callback([&chosen, action] { chosen = action; });
  }
  try {
    check_first_word(argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    throw Error(ErrorCode::bad_input, pliant::cli::usage_message(app, error));
  }
  return chosen();
}

int fail(int code, const std::string& message) {
  pliant::cli::tell(message);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  pliant::cli::reserve_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit then fails a write, which names the file
  try {
    const int code = run(argc, argv);
    // After SIGHUP the terminal is gone, but requested files are still written.
    const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    return lost && code != pliant::cli::kInterrupted ? fail(2, "standard output could not be written") : code;
  } catch (const Error& error) {
    const int code = static_cast<int>(error.code());
    return fail(code > 4 ? 2 : code, error.what());  // the embedding API has finer codes than the command
  } catch (const std::bad_alloc&) {
    return fail(2, "out of memory: the scene needs more than this machine has (pliant info SCENE lists its memory)");
  } catch (const std::exception& error) {
    return fail(1, fmt::format("a defect of Pliant itself: {}", error.what()));
  }
}
