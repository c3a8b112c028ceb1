#include "backends/choice/backends.h"

#include <fmt/format.h>

#include <charconv>
#include <exception>

#include "backends/choice/tiered_backend.h"
#include "backends/opencl/opencl_backend.h"
#include "backends/twins/check_backend.h"
#include "backends/twins/ref_backend.h"
#include "pliant/error.h"

namespace pliant {
namespace {

std::unique_ptr<Backend> open_cpu(bool double_precision) {
  RefOptions options;
  options.double_precision = double_precision;
  return make_ref_backend(options);
}

/// The N of "opencl:N"; throws Error if it is not a number.
int opencl_index(const std::string& spec) {
  if (spec == "opencl") return 0;
  int index = -1;
  const char* first = spec.data() + std::string("opencl:").size();
  const char* last = spec.data() + spec.size();
  const auto [end, error] = std::from_chars(first, last, index);
  if (error != std::errc{} || end != last || index < 0) {
    throw Error(ErrorCode::bad_input,
                fmt::format("backend \"{}\": N of opencl:N must be a number, 0 for the first device", spec));
  }
  return index;
}

struct Candidate {
  std::unique_ptr<Backend> backend;
  std::string skipped;  ///< why others were passed over
};

/// The first bit-exact device among those with (or without) this kind.
Candidate first_bit_exact(const std::vector<BackendInfo>& devices, const std::string& kind, bool wanted) {
  Candidate candidate;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if ((devices[i].kind == kind) != wanted) continue;
    std::string reason;
    try {
      candidate.backend = make_opencl_backend(static_cast<int>(i));
      if (candidate.backend->info().bit_exact) return candidate;
      reason = "not bit-exact: " + candidate.backend->info().tolerance_reason;
    } catch (const std::exception& error) {
      reason = error.what();
    }
    candidate.backend.reset();
    candidate.skipped += fmt::format("; {} ({}) passed over: {}", devices[i].name, devices[i].device, reason);
  }
  return candidate;
}

/// Below this one thread of PoCL 3.1 is about as fast as two, and loses less where others compute: two busy processes beside
/// a trainer of 10,000 nodes leave it 0.25 of real time on one thread, 0.09 to 0.23 on two.
constexpr std::int64_t kFewNodes = 12000;
/// Below this one run of a scene computes on the twins.
constexpr std::int64_t kNoKernels = 6000;

/// The twins: PoCL takes 0.4 s to start with its kernels compiled and 3 to 40 s without, more than its faster steps win back in
/// one run of a small scene. nullptr where this processor cannot run them.
std::unique_ptr<Backend> open_without_compiling() {
  try {
    return open_cpu(false);
  } catch (const Error&) {
    return nullptr;
  }
}

/// For `live`: an OpenCL processor that begins with the twins.
std::unique_ptr<Backend> begun_by_twins(std::unique_ptr<Backend> opencl, BackendUse use, std::string& why) {
  if (use != BackendUse::live || opencl->info().kind != "cpu") return opencl;
  auto cpu = open_without_compiling();
  if (cpu == nullptr || !cpu->info().bit_exact) return opencl;
  why += "; cpu computes until its kernels are compiled";
  const int device = opencl_index(opencl->info().name);
  return make_tiered_backend(std::move(cpu), std::move(opencl), device);
}

std::unique_ptr<Backend> open_auto(std::string& why, std::int64_t nodes, BackendUse use) {
  const std::vector<BackendInfo> devices = list_opencl_devices(false);
  Candidate gpu = first_bit_exact(devices, "gpu", true);
  if (gpu.backend != nullptr) {
    why = fmt::format("{} ({}): a bit-exact GPU{}", gpu.backend->info().name, gpu.backend->info().device, gpu.skipped);
    return std::move(gpu.backend);
  }
  const bool few = nodes > 0 && nodes < kFewNodes;
  if (few && nodes < kNoKernels && use == BackendUse::once) {
    if (auto cpu = open_without_compiling()) {
      why = fmt::format("cpu ({}): nothing to compile for one run of a small scene, and there is no bit-exact GPU{}",
                        cpu->info().device, gpu.skipped);
      return cpu;
    }
  }
  for (std::size_t i = 0; i < devices.size() && few; ++i) {
    if (!devices[i].single_thread) continue;
    auto single = make_opencl_backend(static_cast<int>(i));
    if (!single->info().bit_exact) continue;
    why = fmt::format("{} ({}): bit-exact, one thread for a small scene, and there is no bit-exact GPU{}", single->info().name,
                      single->info().device, gpu.skipped);
    return begun_by_twins(std::move(single), use, why);
  }
  Candidate other = first_bit_exact(devices, "gpu", false);
  const std::string skipped = gpu.skipped + other.skipped;
  if (other.backend != nullptr) {
    why = fmt::format("{} ({}): bit-exact, and there is no bit-exact GPU{}", other.backend->info().name,
                      other.backend->info().device, skipped);
    return begun_by_twins(std::move(other.backend), use, why);
  }
  auto cpu = open_cpu(false);
  const char* const reason = !devices.empty()       ? "no OpenCL device is bit-exact"
                             : opencl_is_built_in() ? "there is no OpenCL device"
                                                    : "this build has no OpenCL";
  why = fmt::format("cpu ({}): {}{}", cpu->info().device, reason, skipped);
  return cpu;
}

}  // namespace

std::vector<BackendInfo> list_backends() {
  std::vector<BackendInfo> result;
  for (const bool double_precision : {false, true}) {
    try {
      result.push_back(open_cpu(double_precision)->info());
    } catch (const std::exception& error) {
      BackendInfo info;
      info.name = double_precision ? "cpu:double" : "cpu";
      info.kind = "reference";
      info.tolerance_reason = error.what();
      result.push_back(info);
    }
  }
  const std::vector<BackendInfo> devices = list_opencl_devices(true);
  result.insert(result.end(), devices.begin(), devices.end());
  return result;
}

std::unique_ptr<Backend> open_backend(const std::string& spec, std::string* why, std::int64_t nodes, BackendUse use) {
  std::string reason;
  std::unique_ptr<Backend> backend;
  if (spec == "auto") {
    backend = open_auto(reason, nodes, use);
  } else if (spec == "cpu" || spec == "cpu:double") {
    backend = open_cpu(spec == "cpu:double");
  } else if (spec == "cpu:check") {
    backend = make_check_backend();
  } else if (spec == "opencl" || spec.rfind("opencl:", 0) == 0) {
    backend = make_opencl_backend(opencl_index(spec));
  } else {
    throw Error(ErrorCode::bad_input,
                fmt::format("unknown backend \"{}\"; allowed are auto, cpu, cpu:double, cpu:check, opencl and opencl:N", spec));
  }
  if (spec != "auto") reason = fmt::format("{} ({}): requested", backend->info().name, backend->info().device);
  const bool asks_for_opencl = spec.rfind("cpu", 0) != 0, is_gpu = backend->info().kind == "gpu";
  const std::string remark = asks_for_opencl && !is_gpu ? opencl_remark() : "";
  if (why != nullptr) *why = remark.empty() ? reason : fmt::format("{}; {}", reason, remark);
  return backend;
}

}  // namespace pliant
