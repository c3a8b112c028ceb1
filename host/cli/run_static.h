// `pliant run` for scenes with "solver": {"type": "static"}.
#pragma once
#include <set>
#include <string>

#include "cli/cli.h"
#include "cli/frames.h"
#include "scene/scene.h"

namespace pliant::cli {

struct StaticRun {
  Common common;
  std::string stem;                ///< of the files
  std::string out;                 ///< folder for the result; empty: none
  std::set<OutputFormat> formats;  ///< vtu, obj
  bool hash = false;               ///< print it also with --quiet
};

/// Solves every body, writes and reports. Throws Error for features that the static solver lacks, and (diverged) when it does
/// not converge; the last converged state is then written under <stem>-last-good.
int run_static(const Scene& scene, const StaticRun& run);

}  // namespace pliant::cli
