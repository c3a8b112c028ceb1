// The sources of kernels/, embedded at build time.
#pragma once
#include <map>
#include <string>

namespace pliant {
/// File name ("tled_tet4_force.cl") to text.
const std::map<std::string, std::string>& kernel_files();
}  // namespace pliant
