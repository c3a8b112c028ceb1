# cmake -D OUT=file.cpp -D FONT=file.ttf -P embed_font.cmake: the bytes of the font become a string literal, which compilers read faster than an array.
file(READ ${FONT} bytes HEX)
string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
file(WRITE ${OUT} "// Generated from ${FONT}. Do not edit.
#include \"render/font_bytes.h\"
namespace pliant::render {
std::string_view font_bytes() {
  static constexpr char kBytes[] = \"${bytes}\";
  return {kBytes, sizeof kBytes - 1};
}
}  // namespace pliant::render
")
