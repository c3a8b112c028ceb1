// `pliant bench contact`: whether contact rests, feels, keeps what is to be kept, and what it costs.
#pragma once
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::bench {

struct ContactOptions {
  std::vector<std::string> parts;                            ///< names; empty: all
  std::string backend = "cpu";                               ///< of all parts but costs
  std::vector<std::string> backends;                         ///< of part costs; empty: cpu and the first OpenCL device
  std::vector<std::int64_t> sizes{3000, 30'000, 300'000};    ///< of part costs, nodes
  std::int64_t tools = 200;                                  ///< pressed in part rest
  std::int64_t strokes = 10'000;                             ///< of part strokes
  bool quick = false;                                        ///< few of everything, small bodies
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
};

/// {"machine": {...}, "quick": ..., "parts": [{"name", "question", "seconds"}], "summary": {...}, "rows": [...]},
/// docs/schema/bench-contact.json. Throws Error for bad options.
nlohmann::json bench_contact(const ContactOptions& options);

/// The rows for people: a line per test, and one per row that is not as it should be.
std::string contact_table(const nlohmann::json& result);

}  // namespace pliant::bench
