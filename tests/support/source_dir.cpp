#include "support/source_dir.h"

namespace pliant::test {

std::string source_dir() { return PLIANT_SOURCE_DIR; }

}  // namespace pliant::test
