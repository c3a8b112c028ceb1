// Where the shipped scenes are.
#pragma once
#include <filesystem>
#include <string>

namespace pliant::bench {

/// The folder with `file`: the one asked for, else ./scenes or one beside the program where it was built or installed. Throws
/// Error that names the option --scenes.
std::filesystem::path find_shipped_scenes(const std::filesystem::path& asked, const std::string& file);

}  // namespace pliant::bench
