#include "io/png.h"

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "pliant/error.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace pliant {

void write_png(const std::filesystem::path& file, const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    throw Error(ErrorCode::internal, fmt::format("cannot write '{}': {} bytes for {} x {} pixels", file.string(),
                                                 image.rgb.size(), image.width, image.height));
  }
  AtomicFile out(file);
  const auto put = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  std::string bytes;
  if (stbi_write_png_to_func(put, &bytes, image.width, image.height, 3, image.rgb.data(), 3 * image.width) == 0) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: a picture of {} x {} pixels could not be encoded", file.string(), image.width, image.height));
  }
  out.write(bytes);
  out.commit();
}

}  // namespace pliant
