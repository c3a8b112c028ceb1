// pliant devices: every backend of this machine.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "backends/choice/backends.h"
#include "backends/interface/pass_table.h"
#include "cli/cli.h"

namespace pliant::cli {
namespace {

/// The reference in double is an oracle for rounding errors: it answers to no probe.
std::string verdict(const BackendInfo& info) {
  if (info.bit_exact) return "bit-exact";
  return fmt::format("tolerance ({})", info.tolerance_reason.empty() ? "not probed" : info.tolerance_reason);
}

nlohmann::ordered_json device_json(const BackendInfo& info) {
  return {{"name", info.name},
          {"device", info.device},
          {"kind", info.kind},
          {"platform", info.platform},
          {"version", info.version},
          {"driver", info.driver},
          {"bit_exact", info.bit_exact},
          {"tolerance_reason", info.bit_exact ? "" : info.tolerance_reason},
          {"compute_units", info.compute_units},
          {"lanes", info.lanes},
          {"memory_bytes", info.memory_bytes},
          {"max_buffer_bytes", info.max_buffer_bytes}};
}

int devices(const Common& common) {
  common.check();
  nlohmann::ordered_json json{{"backends", nlohmann::ordered_json::array()}};
  for (const BackendInfo& info : list_backends()) {
    json["backends"].push_back(device_json(info));
    common.print(fmt::format("{:<12} {}", info.name, info.device.empty() ? "cannot be opened" : info.device));
    common.print(fmt::format("{:12} {}", "", verdict(info)));
    std::string properties = info.kind;
    for (const std::string& text : {info.platform, info.version}) {
      if (!text.empty()) properties += ", " + text;
    }
    if (!info.driver.empty()) properties += ", driver " + info.driver;
    common.print(fmt::format("{:12} {}", "", properties));
    if (info.memory_bytes > 0) {
      common.print(fmt::format("{:12} {} compute units, {} lanes, memory {}, largest buffer {}", "", info.compute_units,
                               info.lanes, bytes_text(info.memory_bytes), bytes_text(info.max_buffer_bytes)));
    }
  }
  common.write(json);
  return 0;
}

}  // namespace

std::function<int()> setup_devices(CLI::App& app) {
  auto common = std::make_shared<Common>();
  common->add_to(app);
  return [common] { return devices(*common); };
}

}  // namespace pliant::cli
