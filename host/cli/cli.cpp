#include "cli/cli.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <nlohmann/json.hpp>

#include "io/atomic_file.h"
#include "pliant/error.h"
#include "scene/keys.h"

namespace pliant::cli {
namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

void on_interrupt(int signal) {
  interrupt_flag = 1;
  // A closing terminal sends SIGHUP more than once, and what stops services may add it to SIGTERM: neither is impatience.
  if (signal == SIGINT) std::signal(SIGINT, SIG_DFL);
}

bool takes_output(int descriptor) {
  const int flags = ::fcntl(descriptor, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

/// Write errors of a stream are checked when the command ends.
void put(std::FILE* stream, const std::string& line) { (void)std::fwrite(line.data(), 1, line.size(), stream); }

}  // namespace

void Common::add_to(CLI::App& app) {
  app.add_option("--json", json, "Write the result as one JSON object to this file, or to standard output with -")
      ->type_name("FILE|-");
  app.add_flag("--quiet", quiet, "Print only errors and requested output");
}

void Common::check(bool prints) const {
  if (!json.empty() && json != "-") check_writable(json);
  if ((!quiet || prints || json == "-") && !takes_output(STDOUT_FILENO)) {
    throw Error(
        ErrorCode::bad_input,
        "standard output is closed, and the result goes there; redirect it (> FILE), or leave it closed and give --quiet");
  }
}

void Common::print(const std::string& text) const {
  if (!quiet) put(json == "-" ? stderr : stdout, text + "\n");
}

void Common::note(const std::string& text) const {
  if (!quiet) tell(text);
}

void Common::remark(const std::string& text) const {
  remarks->push_back(text);
  note(text);
}

void Common::write(const nlohmann::ordered_json& object) const {
  if (json.empty()) return;
  // Names of files may hold any bytes; JSON may not.
  const std::string text = object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (json == "-") {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
      throw Error(ErrorCode::bad_input, "standard output: the JSON could not be written");
    }
  } else {
    write_file(json, text);
  }
}

void reserve_standard_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number is given. What is lost on standard error is no result; on standard output it must be noticed.
    if (::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY) != descriptor) return;
  }
}

void tell(const std::string& text) { put(stderr, fmt::format("pliant: {}\n", text)); }

void check_writable(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status))
    return;
  const AtomicFile probe(file);
}

void check_steps(const char* option, std::int64_t steps) {
  constexpr std::int64_t kMost = 1'000'000'000'000'000;
  if (steps < 0 || steps > kMost)
    throw Error(ErrorCode::bad_input, fmt::format("{} is {}; expected 0 to {}", option, steps, kMost));
}

std::string did_you_mean(const std::string& text, const std::vector<std::string>& words) {
  const std::string near = nearest(text, words);
  return near.empty() ? "" : fmt::format("; did you mean {}?", near);
}

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const CLI::App& used = chosen.empty() ? app : *chosen.front();
  std::string message = error.what();
  const auto extras = app.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !extras.empty()) {
    const auto option = std::find_if(extras.begin(), extras.end(), [](const auto& word) { return word.rfind('-', 0) == 0; });
    std::vector<std::string> known;
    for (const auto* candidate : used.get_options()) known.push_back(candidate->get_name());
    message = option == extras.end() ? fmt::format("unexpected argument \"{}\"", extras.back())
                                     : fmt::format("unknown option \"{}\"{}", *option, did_you_mean(*option, known));
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  return fmt::format("{} (pliant {}--help lists the options)", message, chosen.empty() ? "" : used.get_name() + " ");
}

std::string scene_stem(const std::filesystem::path& scene) {
  const std::string stem = scene.stem().string();
  return stem.empty() ? "scene" : stem;
}

constexpr std::chrono::seconds kSpoken{15};  ///< interval of progress lines without a terminal

Progress::Progress(bool wanted)
    : on_(wanted), terminal_(::isatty(STDERR_FILENO) == 1), last_(std::chrono::steady_clock::now()) {}

void Progress::show(std::int64_t done, std::int64_t total, const std::string& text) {
  const double share = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 0;
  show(share, fmt::format("step {} of {}  {}", done, total, text));
}

void Progress::show(double share, const std::string& text) {
  if (!on_) return;
  const auto now = std::chrono::steady_clock::now();
  share = std::clamp(share, 0.0, 1.0);
  if (!terminal_) {
    if (now - last_ < kSpoken) return;
    last_ = now;
    tell(fmt::format("{:.0f} %  {}", 100 * share, text));
    return;
  }
  if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(share * kWidth);
  put(stderr, fmt::format("\r[{}{}] {:3.0f} %  {}\033[K", std::string(static_cast<std::size_t>(filled), '#'),
                          std::string(static_cast<std::size_t>(kWidth - filled), '.'), 100 * share, text));
  std::fflush(stderr);
}

void Progress::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

void watch_interrupt() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool interrupted() { return interrupt_flag != 0; }

}  // namespace pliant::cli
