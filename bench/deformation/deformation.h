// `pliant bench deformation`: what a step of hybrid, finite-element and shape-matching bodies costs, beside the
// published times (Hybrid Deformation Model, docs/references.md).
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant::bench {

struct DeformationOptions {
  std::filesystem::path scenes;                              ///< folder of the shipped scenes; empty: find it
  std::vector<std::string> only;                             ///< of bunny, apple, liver, kidney; empty: all
  std::vector<std::string> parts;                            ///< of scenes, scaling, accuracy; empty: all
  std::vector<std::string> backends{"auto", "cpu"};          ///< of part scenes; the first one serves the other parts too
  std::vector<std::int64_t> sizes;                           ///< nodes of the liver in part scaling; empty: 10 000 and 100 000
  std::vector<double> ratios;                                ///< of part accuracy; empty: 0.1, 0.2, ... 0.9
  bool full = false;                                         ///< scaling also to 1 000 000 nodes
  bool quick = false;                                        ///< a few steps of everything: for tests, the times mean nothing
  std::function<void(double, const std::string&)> progress;  ///< share done, what is being measured
};

/// {"machine": {...}, "rows": [...]}; "part" of a row says which of its members are there (docs/schema/bench-deformation.json).
/// Throws Error for bad options, for scenes or meshes that are not there, and for a run that diverges.
nlohmann::json bench_deformation(const DeformationOptions& options);

/// The rows as tables for people.
std::string deformation_table(const nlohmann::json& result);

}  // namespace pliant::bench
