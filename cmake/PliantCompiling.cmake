# How fast things compile: the compiler cache, and what headers are read once for many files. Neither changes what is built.
option(PLIANT_CCACHE "Compile through ccache where it is installed" ON)
option(PLIANT_PCH "Precompile the headers that many files share" ON)

# The settings are given with every call, so that no configuration of ccache matters: paths below the source folder are taken
# relative to it, so that another checkout finds what this one compiled.
if(PLIANT_CCACHE AND (NOT CMAKE_CXX_COMPILER_LAUNCHER OR CMAKE_CXX_COMPILER_LAUNCHER MATCHES "(^|/)ccache$"))
  find_program(PLIANT_CCACHE_PROGRAM ccache)
  if(PLIANT_CCACHE_PROGRAM)
    set(CMAKE_CXX_COMPILER_LAUNCHER
        env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${PLIANT_CCACHE_PROGRAM})
  endif()
endif()
if(NOT PLIANT_PCH)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")  # a time in the file would make every one different for ccache
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang -fno-pch-timestamp>")
endif()

# The presets that only ./dev test builds compile several files at a time (CMAKE_UNITY_BUILD), which takes two thirds of
# the processor time from scratch; `release` compiles each by itself, so that a change of one file is soon compiled.
# pliant_unity_folders(TARGET): in such a build the files of a folder go together, and no others with them.
function(pliant_unity_folders target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    get_filename_component(folder ${folder} NAME)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
endfunction()

# pliant_headers(NAME LINKS... HEADERS headers...): a set of headers, compiled once, for targets with the same flags.
function(pliant_headers name)
  cmake_parse_arguments(set "" "" "HEADERS" ${ARGN})
  set(file ${CMAKE_BINARY_DIR}/generated/${name}.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT "// The headers that ${name} precompiles belong to a target, and a target needs a file.\n")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${file})
  target_link_libraries(${name} PRIVATE ${set_UNPARSED_ARGUMENTS})
  target_precompile_headers(${name} PRIVATE ${set_HEADERS})
endfunction()
