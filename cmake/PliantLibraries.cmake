# One static library per room, from the inside out. Which room links which follows from rooms.txt; what they link from outside stands here.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)
find_package(assimp REQUIRED)
find_package(pugixml REQUIRED)
find_package(CLI11 REQUIRED)
find_package(ZLIB QUIET)  # compressed .vtu files; without it they are refused with a message
if(PLIANT_EMBREE)
  find_package(embree 3 QUIET)
endif()
if(PLIANT_OPENCL)
  find_package(OpenCL QUIET)
endif()

# The headers behind most of the compile time: of the library, and of the command and the benchmarks.
set(standard_headers <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits> <map> <memory>
    <numeric> <optional> <random> <set> <span> <sstream> <string> <utility> <vector> <fmt/format.h> <fmt/ranges.h>)
pliant_headers(pliant_room_headers pliant_flags fmt::fmt Eigen3::Eigen HEADERS ${standard_headers} <Eigen/Dense>)
pliant_headers(pliant_command_headers pliant_flags fmt::fmt Eigen3::Eigen nlohmann_json::nlohmann_json
               HEADERS ${standard_headers} <Eigen/Dense> <nlohmann/json.hpp>)

# libpliant is made of rooms, and a host may link it into a shared library of its own, of which only what PLIANT_API marks can be seen.
set(shareable POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
set_target_properties(pliant_room_headers PROPERTIES ${shareable})

# Of each row in rooms.txt: folder_LIBRARY, and links_LIBRARY, the libraries of the rooms that it names outside brackets.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/cmake/rooms.txt)
file(STRINGS ${CMAKE_SOURCE_DIR}/cmake/rooms.txt rows REGEX "^[^#]")
list(TRANSFORM rows REPLACE "[(][^)]*[)]" "")
foreach(row IN LISTS rows)
  string(REGEX MATCH "^([^ ]+) +(host/)?([^ ]+)" row_start "${row}")
  set(library_${CMAKE_MATCH_3} ${CMAKE_MATCH_1})
endforeach()
foreach(row IN LISTS rows)
  separate_arguments(inner UNIX_COMMAND "${row}")
  list(POP_FRONT inner library folder)
  set(folder_${library} ${folder})
  foreach(room IN LISTS inner)
    if(NOT DEFINED library_${room})
      message(FATAL_ERROR "cmake/rooms.txt: ${folder} may include ${room}, which has no row")
    endif()
    list(APPEND links_${library} ${library_${room}})
  endforeach()
endforeach()

# pliant_room(LIBRARY LINKS...): the .cpp files of its folder in rooms.txt and of the shelves (subfolders) there. LINKS come from outside.
function(pliant_room name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder_${name}}/*.cpp)
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC pliant_flags ${links_${name}} ${ARGN})
  target_precompile_headers(${name} REUSE_FROM pliant_room_headers)
  set_target_properties(${name} PROPERTIES ${shareable})
endfunction()

# pliant_with_embree(ROOM STEM): of STEM_embree.cpp and STEM_no_embree.cpp the room gets one, and ROOM_absent is the other.
function(pliant_with_embree room stem)
  set(with ${CMAKE_SOURCE_DIR}/${stem}_embree.cpp)
  # Members of the library by themselves, so that the linker can leave one out: tests/variants.cmake.
  set_source_files_properties(${CMAKE_SOURCE_DIR}/${stem}_embree.cpp ${CMAKE_SOURCE_DIR}/${stem}_no_embree.cpp
                              PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set(without ${CMAKE_SOURCE_DIR}/${stem}_no_embree.cpp)
  get_target_property(sources ${room} SOURCES)
  list(REMOVE_ITEM sources ${with} ${without})
  if(embree_FOUND)
    target_link_libraries(${room} PRIVATE embree)
    list(APPEND sources ${with})
  else()
    list(APPEND sources ${without})
  endif()
  set_target_properties(${room} PROPERTIES SOURCES "${sources}")
  add_library(${room}_absent OBJECT EXCLUDE_FROM_ALL ${without})
  target_link_libraries(${room}_absent PRIVATE $<TARGET_PROPERTY:${room},LINK_LIBRARIES>)
endfunction()

# What runs: a Program, and the interface of what runs it. Neither knows where a Program comes from.
pliant_room(pliant_program fmt::fmt)
find_path(PLIANT_XXHASH xxhash.h REQUIRED DOC "the header of xxHash (Debian: libxxhash-dev)")
target_include_directories(pliant_program SYSTEM PRIVATE ${PLIANT_XXHASH})
pliant_room(pliant_backend)

# The twins: their own flags, so that nothing a consumer sets can change a bit.
pliant_room(pliant_ref)
target_include_directories(pliant_ref PUBLIC ${CMAKE_SOURCE_DIR})  # "cpu_ref/registry.h"
target_include_directories(pliant_ref PRIVATE ${PLIANT_GENERATED})  # "twin_laws.h"
set(ref_options -O3 -fno-math-errno -fno-trapping-math)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(PREPEND ref_options -mfma -mavx2)
endif()
target_compile_options(pliant_ref PRIVATE ${ref_options})
set_target_properties(pliant_ref PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
# Options of a source file come last on the command line, after the -ffp-contract=off that everybody gets.
separate_arguments(twin_flags UNIX_COMMAND "${PLIANT_TWIN_FLAGS}")
file(GLOB_RECURSE ref_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/cpu_ref/*.cpp)
set_source_files_properties(${ref_sources} PROPERTIES COMPILE_OPTIONS "${twin_flags}" SKIP_UNITY_BUILD_INCLUSION ON)

# The backends that run them.
pliant_room(pliant_twins Threads::Threads)

# The OpenCL backend, or what says that there is none: the same functions, so that nothing else asks which of the two was built.
include(EmbedKernels)
pliant_room(pliant_opencl_absent)
target_sources(pliant_opencl_absent PRIVATE ${PLIANT_KERNEL_TEXT})
if(OpenCL_FOUND)
  pliant_room(pliant_opencl)
  target_sources(pliant_opencl PRIVATE ${PLIANT_KERNEL_TEXT})
  target_link_libraries(pliant_opencl PRIVATE OpenCL::OpenCL)
  target_compile_definitions(pliant_opencl PRIVATE CL_TARGET_OPENCL_VERSION=120)
  set(opencl_room pliant_opencl)
else()
  set(opencl_room pliant_opencl_absent)
endif()

# The choice of a backend by name: the only room that knows them all.
pliant_room(pliant_backends pliant_twins ${opencl_room})

# What is simulated: from files to the Model.
pliant_room(pliant_geometry fmt::fmt Eigen3::Eigen Threads::Threads)
pliant_room(pliant_material Eigen3::Eigen fmt::fmt)
target_include_directories(pliant_material PRIVATE ${PLIANT_GENERATED})  # "material/host_laws.h"
pliant_room(pliant_integrators Eigen3::Eigen fmt::fmt)
target_include_directories(pliant_integrators PRIVATE ${PLIANT_GENERATED})  # "integrators/host_integrators.h"
pliant_with_embree(pliant_geometry host/geometry/distance)
pliant_room(pliant_elements)
pliant_room(pliant_scene nlohmann_json::nlohmann_json)
pliant_room(pliant_mesh_io nlohmann_json::nlohmann_json)
target_link_libraries(pliant_mesh_io PRIVATE assimp::assimp pugixml::pugixml)
if(ZLIB_FOUND)
  target_link_libraries(pliant_mesh_io PRIVATE ZLIB::ZLIB)
  target_compile_definitions(pliant_mesh_io PRIVATE PLIANT_HAVE_ZLIB)
endif()
pliant_room(pliant_lattice)
pliant_room(pliant_model)
pliant_room(pliant_cutting)
pliant_room(pliant_tearing)
pliant_room(pliant_cutting_methods)

# The Model on a backend, step by step.
pliant_room(pliant_schedule)
pliant_room(pliant_simulation)

pliant_room(pliant_statics)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")  # the twins need these instructions too
  set_source_files_properties(host/statics/dense.cpp PROPERTIES COMPILE_OPTIONS "-mfma;-mavx2" SKIP_PRECOMPILE_HEADERS ON)
endif()

pliant_room(pliant_io)
target_link_libraries(pliant_io PRIVATE pugixml::pugixml)

pliant_room(pliant_render Threads::Threads)
pliant_with_embree(pliant_render host/render/ray_scene)
find_file(PLIANT_FONT DejaVuSans.ttf PATHS /usr/share/fonts /usr/local/share/fonts PATH_SUFFIXES truetype/dejavu dejavu dejavu-sans-fonts TTF
          NO_DEFAULT_PATH REQUIRED DOC "the TrueType font of labels in pictures (Debian: fonts-dejavu-core)")
set(font_text ${CMAKE_BINARY_DIR}/generated/font_bytes.cpp)
add_custom_command(
  OUTPUT ${font_text}
  COMMAND ${CMAKE_COMMAND} -D OUT=${font_text} -D FONT=${PLIANT_FONT} -P ${CMAKE_SOURCE_DIR}/cmake/embed_font.cmake
  DEPENDS ${PLIANT_FONT} ${CMAKE_SOURCE_DIR}/cmake/embed_font.cmake
  COMMENT "Embedding the font of labels"
  VERBATIM)
target_sources(pliant_render PRIVATE ${font_text})

# Touch: devices that a hand holds, and the forces on them at their own rate.
pliant_room(pliant_devices fmt::fmt nlohmann_json::nlohmann_json Threads::Threads)
# pliant_loaded(FILE HEADER LIBRARY MACRO): a C library that host/devices loads when a device needs it, so that nobody links it. FILE is
# compiled with the name of its shared object, or without what needs it.
function(pliant_loaded file header library macro)
  find_path(${macro}_HEADERS ${header})
  find_library(${macro} ${library})
  if(NOT ${macro}_HEADERS OR NOT ${macro})
    return()
  endif()
  file(REAL_PATH ${${macro}} shared_object)
  if(shared_object MATCHES "/(lib[^/]*[.]so[.][0-9]+)[^/]*$")
    set_source_files_properties(${CMAKE_SOURCE_DIR}/${file} PROPERTIES COMPILE_DEFINITIONS "${macro}=\"${CMAKE_MATCH_1}\"")
  endif()
endfunction()
pliant_loaded(host/devices/websocket_device.cpp libwebsockets.h websockets PLIANT_WEBSOCKETS_LIBRARY)
pliant_loaded(host/devices/spacenav_device.cpp spnav.h spnav PLIANT_SPNAV_LIBRARY)
pliant_room(pliant_haptics pliant_twins Threads::Threads)

# What include/pliant declares.
pliant_room(pliant_api)

pliant_room(pliant_plan)

file(GLOB_RECURSE bench_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/bench/*.cpp)
list(FILTER bench_sources EXCLUDE REGEX "/bench/(api|trainer|haptics)/")
add_library(pliant_bench STATIC ${bench_sources})
pliant_unity_folders(pliant_bench)  # each folder is a namespace of its own
target_link_libraries(pliant_bench PUBLIC ${links_pliant_bench})
target_include_directories(pliant_bench PUBLIC ${CMAKE_SOURCE_DIR})  # "bench/kernels/kernels.h"
target_precompile_headers(pliant_bench REUSE_FROM pliant_command_headers)
add_library(pliant_bench_trainer STATIC bench/trainer/trainer.cpp)
target_link_libraries(pliant_bench_trainer PUBLIC ${links_pliant_bench_trainer})
file(GLOB haptics_bench_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/bench/haptics/*.cpp)
add_library(pliant_bench_haptics STATIC ${haptics_bench_sources})
target_link_libraries(pliant_bench_haptics PUBLIC ${links_pliant_bench_haptics})
target_precompile_headers(pliant_bench_haptics REUSE_FROM pliant_command_headers)

file(GLOB cli_sources CONFIGURE_DEPENDS host/cli/*.cpp)
add_library(pliant_cli_objects OBJECT ${cli_sources})
target_link_libraries(pliant_cli_objects PUBLIC ${links_pliant_cli_objects} CLI11::CLI11)
target_compile_definitions(pliant_cli_objects PRIVATE PLIANT_VERSION="${PROJECT_VERSION}")
target_precompile_headers(pliant_cli_objects REUSE_FROM pliant_command_headers)
add_executable(pliant_cli)
set_target_properties(pliant_cli PROPERTIES OUTPUT_NAME pliant LINKER_LANGUAGE CXX)
target_link_libraries(pliant_cli PRIVATE pliant_cli_objects)
