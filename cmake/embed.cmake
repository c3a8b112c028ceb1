# cmake -D OUT=file.cpp -D FILES=a;b -P embed.cmake: every file becomes one raw string literal in pliant::kernel_files().
set(text "// Generated from kernels/. Do not edit.\n#include \"backends/opencl/kernel_text.h\"\nnamespace pliant {\nconst std::map<std::string, std::string>& kernel_files() {\n  static const std::map<std::string, std::string> files{\n")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} content)
  string(APPEND text "      {\"${name}\", R\"pliant__(${content})pliant__\"},\n")
endforeach()
string(APPEND text "  };\n  return files;\n}\n}  // namespace pliant\n")
file(WRITE ${OUT} "${text}")
