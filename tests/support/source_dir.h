// Where the sources are: scenes, meshes and recorded results that tests read.
#pragma once
#include <string>

namespace pliant::test {

/// The folder that holds CMakeLists.txt, without a slash at its end.
std::string source_dir();

}  // namespace pliant::test
