// The font of labels, a TrueType file that the build puts into the program, so that a picture does not depend on the machine's
// fonts.
#pragma once
#include <string_view>

namespace pliant::render {

std::string_view font_bytes();

}  // namespace pliant::render
