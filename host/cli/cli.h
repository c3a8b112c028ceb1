// Shared by the commands: registration, --json and --quiet, progress, interruption.
#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace CLI {  // its header is long: only what uses it includes it
class App;
class ParseError;
}  // namespace CLI

namespace pliant::cli {

/// Adds a command's options (or subcommands of its own) to `app` and returns the function that runs it; its result is the exit
/// code.
using Setup = std::function<int()> (*)(CLI::App& app);

/// A row of the table in main.cpp. A new command is one file, one declaration here and one row there.
struct Command {
  const char* name;
  const char* about;
  Setup setup;
};

std::function<int()> setup_devices(CLI::App& app);
std::function<int()> setup_info(CLI::App& app);
std::function<int()> setup_run(CLI::App& app);
std::function<int()> setup_compare(CLI::App& app);
std::function<int()> setup_bench(CLI::App& app);
std::function<int()> setup_plan(CLI::App& app);

inline constexpr int kInterrupted = 130;  ///< exit code after SIGINT (as shells expect), SIGTERM or SIGHUP

/// The options of every command.
struct Common {
  std::string json;  ///< file, "-" for standard output, or empty
  bool quiet = false;
  std::shared_ptr<std::vector<std::string>> remarks = std::make_shared<std::vector<std::string>>();  ///< so far

  void add_to(CLI::App& app);
  /// Refuses a JSON file that cannot be written, and a closed standard output that something goes to, before the work.
  /// `prints`: something goes there even with --quiet.
  void check(bool prints = false) const;
  /// Text for people: standard output, or standard error where that carries JSON; nowhere with --quiet.
  void print(const std::string& text) const;
  /// Remarks that are no result: standard error, nowhere with --quiet.
  void note(const std::string& text) const;
  /// A note that belongs to the result: `remarks` of the JSON object has it too.
  void remark(const std::string& text) const;
  /// One object, to where --json says; nothing without it.
  void write(const nlohmann::ordered_json& object) const;
};

/// Descriptors 0 to 2 that the caller has closed would be given to the first files that are opened: put what takes nothing
/// there.
void reserve_standard_streams();

/// "pliant: TEXT" on standard error. One that is closed, full or gone ends nothing.
void tell(const std::string& text);

/// Throws Error if `file` could not be written now. Leaves nothing behind.
void check_writable(const std::filesystem::path& file);

/// Throws Error unless `steps` is 0 to 10^15; `option` is for the message.
void check_steps(const char* option, std::int64_t steps);

/// "; did you mean WORD?" or nothing.
std::string did_you_mean(const std::string& text, const std::vector<std::string>& words);

/// What of the command line was not understood, and the option that was probably meant.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

/// The scene's file without folder and extension: the stem of everything a run writes.
std::string scene_stem(const std::filesystem::path& scene);

/// One line on standard error that is drawn again and again on a terminal, and elsewhere a line every quarter of a minute.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void show(std::int64_t done, std::int64_t total, const std::string& text = "");
  /// The same for a share of the whole, 0 to 1.
  void show(double share, const std::string& text);
  void clear();

 private:
  bool on_ = false, terminal_ = false;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

/// From here on SIGINT, SIGTERM and SIGHUP only set a flag; a second SIGINT ends the process at once. A SIGHUP that is ignored
/// (nohup) stays so.
void watch_interrupt();
bool interrupted();

}  // namespace pliant::cli
