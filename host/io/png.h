// PNG files: 8 bits per channel, red, green, blue.
#pragma once
#include <filesystem>

#include "io/image.h"

namespace pliant {

/// The bytes depend on the image alone; the file appears only when complete. Throws Error when it cannot be written, or
/// (internal) when the image holds another number of bytes than its size says.
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace pliant
