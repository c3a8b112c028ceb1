#include "backends/opencl/kernel_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "backends/interface/pass_table.h"
#include "backends/opencl/devices.h"
#include "backends/opencl/pocl_cache.h"

namespace pliant::opencl {
namespace {

/// The x of a line `#include "x"`, or nothing.
std::string included_file(const std::string& line) {
  const std::size_t hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return {};
  const std::size_t word = line.find_first_not_of(" \t", hash + 1);
  if (word == std::string::npos || line.compare(word, 7, "include") != 0) return {};
  const std::size_t open = line.find('"', word), close = line.find('"', open + 1);
  if (open == std::string::npos || close == std::string::npos) return {};
  return line.substr(open + 1, close - open - 1);
}

std::string guard_name(const std::string& file) {
  std::string name = "PLIANT_INCLUDED_";
  for (const char c : file) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

void append(const Files& files, const std::string& file, std::vector<std::string>& open, std::string& text) {
  const auto found = files.find(file);
  if (found == files.end()) {
    throw Error(ErrorCode::internal,
                open.empty() ? fmt::format("there is no kernel file \"{}\"", file)
                             : fmt::format("kernel file \"{}\" includes \"{}\", which does not exist", open.back(), file));
  }
  if (std::find(open.begin(), open.end(), file) != open.end()) return;  // it is being included already
  open.push_back(file);
  text += fmt::format("#ifndef {0}\n#define {0}\n#line 1 \"{1}\"\n", guard_name(file), file);
  std::istringstream lines(found->second);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string included = included_file(line);
    if (included.empty()) {
      text += line + '\n';
    } else {
      append(files, included, open, text);
      text += fmt::format("#line {} \"{}\"\n", number + 1, file);
    }
  }
  text += "#endif\n";
  open.pop_back();
}

}  // namespace

std::string resolve_includes(const Files& files, const std::string& file) {
  std::string text;
  std::vector<std::string> open;
  append(files, file, open, text);
  return text;
}

KernelCache::KernelCache(std::shared_ptr<SharedContext> context, cl::Device device, Files files, std::string device_name)
    : context_(std::move(context)),
      device_(std::move(device)),
      files_(std::move(files)),
      device_name_(std::move(device_name)),
      common_options_(build_options(device_)) {}

cl::Kernel KernelCache::make(const std::string& stem, const std::vector<std::pair<std::string, int>>& defines, int lanes) {
  const cl::Program built = program(stem, defines, lanes);
  return guarded(ErrorCode::internal, fmt::format("kernel \"{}\" of {}.cl on {}", stem, stem, device_name_),
                 [&] { return cl::Kernel(built, stem.c_str()); });
}

cl::Program KernelCache::program(const std::string& stem, const std::vector<std::pair<std::string, int>>& defines, int lanes) {
  auto sorted = defines;
  std::sort(sorted.begin(), sorted.end());
  std::string options = fmt::format("{} -D LANES={}", common_options_, lanes);
  for (const auto& [name, value] : sorted) options += fmt::format(" -D {}={}", name, value);
  const auto key = std::make_pair(stem, options);
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = programs_.find(key); found != programs_.end()) return found->second;
  }
  cl::Program built = build(stem, options);
  const std::lock_guard lock(mutex_);
  return programs_.emplace(key, std::move(built)).first->second;
}

cl::Program KernelCache::build(const std::string& stem, const std::string& options) const {
  const std::string source = resolve_includes(files_, stem + ".cl");
  try {
    return context_->program(source, options, [&] {
      cl::Program program(context_->context(), source);
      program.build({device_}, options.c_str());
      return program;
    });
  } catch (const cl::BuildError& error) {
    std::string log;
    for (const auto& [device, text] : error.getBuildLog()) log += text;
    throw Error(ErrorCode::bad_input,
                fmt::format("{} cannot build kernel \"{}\" (options {}): {}. {}The compiler's log:\n{}", device_name_, stem,
                            options, error_name(error.err()), pocl_cache_remark().empty() ? "" : pocl_cache_remark() + ". ",
                            log.empty() ? "(empty)" : log));
  } catch (const cl::Error& error) {
    throw translate(error, ErrorCode::bad_input,
                    fmt::format("building kernel \"{}\" (options {}) on {}", stem, options, device_name_));
  }
}

}  // namespace pliant::opencl
