#include "bench/common/shipped_scenes.h"

#include <fmt/format.h>

#include "pliant/error.h"

namespace pliant::bench {

namespace fs = std::filesystem;

fs::path find_shipped_scenes(const fs::path& asked, const std::string& file) {
  std::error_code ignored;
  if (!asked.empty()) {
    if (!fs::exists(asked / file, ignored))
      throw Error(ErrorCode::bad_input, fmt::format("--scenes: folder \"{}\" holds no {}", asked.string(), file));
    return asked;
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& folder : {fs::path("scenes"), program / "scenes", program / "../scenes", program / "../../scenes",
                                 program / "../share/pliant/scenes"}) {
    if (fs::exists(folder / file, ignored)) return folder;
  }
  throw Error(ErrorCode::bad_input,
              "--scenes: the shipped scenes are neither in ./scenes nor near the program; name their folder");
}

}  // namespace pliant::bench
