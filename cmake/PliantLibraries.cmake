# One static library per room, from the inside out; who may include whom is what these lines allow.
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

# pliant_room(NAME FOLDER LINKS...): the .cpp files of the folder and of its shelves (subfolders).
function(pliant_room name folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC pliant_flags ${ARGN})
endfunction()

# What runs: a Program, and the interface of what runs it. Neither knows where a Program comes from.
pliant_room(pliant_program host/program fmt::fmt)
pliant_room(pliant_backend host/backend pliant_program)

# The twins: their own flags, so that nothing a consumer sets can change a bit.
pliant_room(pliant_ref cpu_ref pliant_backend Threads::Threads)
target_include_directories(pliant_ref PUBLIC ${CMAKE_SOURCE_DIR})  # "cpu_ref/backend.h"
target_include_directories(pliant_ref PRIVATE ${PLIANT_GENERATED})  # "twin_laws.h"
separate_arguments(twin_flags UNIX_COMMAND "${PLIANT_TWIN_FLAGS}")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(pliant_ref PRIVATE -mfma -mavx2)
endif()
target_compile_options(pliant_ref PRIVATE -O3 -fno-math-errno -fno-trapping-math ${twin_flags})

if(OpenCL_FOUND)
  include(EmbedKernels)
  pliant_room(pliant_opencl host/opencl pliant_backend)
  target_sources(pliant_opencl PRIVATE ${PLIANT_KERNEL_TEXT})
  target_link_libraries(pliant_opencl PRIVATE OpenCL::OpenCL)
  target_compile_definitions(pliant_opencl PRIVATE CL_TARGET_OPENCL_VERSION=120)
endif()

# The choice of a backend by name: the only room that knows them all.
pliant_room(pliant_backends host/backends pliant_ref)
if(OpenCL_FOUND)
  target_link_libraries(pliant_backends PUBLIC pliant_opencl)
  target_compile_definitions(pliant_backends PUBLIC PLIANT_HAVE_OPENCL)
endif()

# What is simulated: from files to the Model.
pliant_room(pliant_geometry host/geometry fmt::fmt Eigen3::Eigen Threads::Threads)
pliant_room(pliant_material host/material Eigen3::Eigen fmt::fmt)
target_include_directories(pliant_material PRIVATE ${PLIANT_GENERATED})  # "material/host_laws.h"
pliant_room(pliant_scene host/scene pliant_material pliant_geometry nlohmann_json::nlohmann_json)
pliant_room(pliant_mesh_io host/mesh_io pliant_geometry nlohmann_json::nlohmann_json)
target_link_libraries(pliant_mesh_io PRIVATE assimp::assimp pugixml::pugixml)
if(ZLIB_FOUND)
  target_link_libraries(pliant_mesh_io PRIVATE ZLIB::ZLIB)
  target_compile_definitions(pliant_mesh_io PRIVATE PLIANT_HAVE_ZLIB)
endif()
if(embree_FOUND)
  target_link_libraries(pliant_geometry PRIVATE embree)
  target_compile_definitions(pliant_geometry PRIVATE PLIANT_HAVE_EMBREE)
endif()
pliant_room(pliant_lattice host/lattice pliant_scene)
pliant_room(pliant_model host/model pliant_lattice pliant_mesh_io)
pliant_room(pliant_cutting host/cutting pliant_model)
pliant_room(pliant_tearing host/tearing pliant_cutting)
pliant_room(pliant_cutting_methods host/cutting_methods pliant_tearing)

# The Model on a backend, step by step.
pliant_room(pliant_schedule host/schedule pliant_model pliant_program)
pliant_room(pliant_simulation "host/simulation" pliant_schedule pliant_backend pliant_tearing)
file(GLOB edits CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/host/edits/*.cpp)
target_sources(pliant_simulation PRIVATE ${edits})

pliant_room(pliant_statics host/statics pliant_model)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")  # the twins need these instructions too
  set_source_files_properties(host/statics/dense.cpp PROPERTIES COMPILE_OPTIONS "-mfma;-mavx2")
endif()

pliant_room(pliant_io host/io pliant_simulation)
target_link_libraries(pliant_io PRIVATE pugixml::pugixml)

pliant_room(pliant_render host/render pliant_io Threads::Threads)
if(embree_FOUND)
  target_link_libraries(pliant_render PRIVATE embree)
  target_compile_definitions(pliant_render PRIVATE PLIANT_HAVE_EMBREE)
endif()

# What include/pliant declares.
pliant_room(pliant_api host/api pliant_io pliant_backends)

pliant_room(pliant_plan host/plan pliant_simulation pliant_backends pliant_statics)

file(GLOB_RECURSE bench_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/bench/*.cpp)
list(FILTER bench_sources EXCLUDE REGEX "/bench/api/")
add_library(pliant_bench STATIC ${bench_sources})
target_link_libraries(pliant_bench PUBLIC pliant_io pliant_backends pliant_statics pliant_cutting_methods)
target_include_directories(pliant_bench PUBLIC ${CMAKE_SOURCE_DIR})  # "bench/kernels/kernels.h"

file(GLOB cli_sources CONFIGURE_DEPENDS host/cli/*.cpp)
add_executable(pliant_cli ${cli_sources})
set_target_properties(pliant_cli PROPERTIES OUTPUT_NAME pliant)
target_link_libraries(pliant_cli PRIVATE pliant_bench pliant_plan pliant_render CLI11::CLI11)
target_compile_definitions(pliant_cli PRIVATE PLIANT_VERSION="${PROJECT_VERSION}")
