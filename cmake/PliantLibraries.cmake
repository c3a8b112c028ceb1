# One static library per room; who may include whom is what these lines allow.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Threads REQUIRED)

function(pliant_room name folder)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  if(NOT sources)  # a room that is still empty
    set(sources ${CMAKE_BINARY_DIR}/generated/${name}_empty.cpp)
    file(WRITE ${sources} "")
  endif()
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC pliant_flags ${ARGN})
endfunction()

pliant_room(pliant_scene host/scene fmt::fmt nlohmann_json::nlohmann_json)

find_package(assimp REQUIRED)
find_package(pugixml REQUIRED)
pliant_room(pliant_model host/model pliant_scene Eigen3::Eigen Threads::Threads)
target_link_libraries(pliant_model PRIVATE assimp::assimp pugixml::pugixml)
find_package(ZLIB QUIET)  # compressed .vtu files; without it they are refused with a message
if(ZLIB_FOUND)
  target_link_libraries(pliant_model PRIVATE ZLIB::ZLIB)
  target_compile_definitions(pliant_model PRIVATE PLIANT_HAVE_ZLIB)
endif()
if(PLIANT_EMBREE)
  find_package(embree 3 QUIET)
endif()
if(embree_FOUND)
  target_link_libraries(pliant_model PRIVATE embree)
  target_compile_definitions(pliant_model PRIVATE PLIANT_HAVE_EMBREE)
endif()

pliant_room(pliant_cutting host/cutting pliant_model)

pliant_room(pliant_solver host/solver pliant_cutting)

pliant_room(pliant_statics host/statics pliant_model)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")  # the twins need these instructions too
  set_source_files_properties(host/statics/dense.cpp PROPERTIES COMPILE_OPTIONS "-mfma;-mavx2")
endif()

pliant_room(pliant_io host/io pliant_solver)
target_link_libraries(pliant_io PRIVATE pugixml::pugixml)

pliant_room(pliant_render host/render pliant_io Threads::Threads)
if(embree_FOUND)
  target_link_libraries(pliant_render PRIVATE embree)
  target_compile_definitions(pliant_render PRIVATE PLIANT_HAVE_EMBREE)
endif()

# The twins: their own flags, so that nothing a consumer sets can change a bit.
pliant_room(pliant_ref cpu_ref pliant_solver Threads::Threads)
target_include_directories(pliant_ref PUBLIC ${CMAKE_SOURCE_DIR})  # "cpu_ref/backend.h"
separate_arguments(twin_flags UNIX_COMMAND "${PLIANT_TWIN_FLAGS}")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(pliant_ref PRIVATE -mfma -mavx2)
endif()
target_compile_options(pliant_ref PRIVATE -O3 -fno-math-errno -fno-trapping-math ${twin_flags})

if(PLIANT_OPENCL)
  find_package(OpenCL QUIET)
endif()
if(OpenCL_FOUND)
  include(EmbedKernels)
  pliant_room(pliant_opencl host/opencl pliant_solver)
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

# What include/pliant declares.
pliant_room(pliant_api host/api pliant_io pliant_backends)

pliant_room(pliant_bench bench pliant_io pliant_backends pliant_statics)
target_include_directories(pliant_bench PUBLIC ${CMAKE_SOURCE_DIR})  # "bench/kernels.h"

find_package(CLI11 REQUIRED)
file(GLOB cli_sources CONFIGURE_DEPENDS host/cli/*.cpp)
if(cli_sources)
  add_executable(pliant_cli ${cli_sources})
  set_target_properties(pliant_cli PROPERTIES OUTPUT_NAME pliant)
  target_link_libraries(pliant_cli PRIVATE pliant_bench pliant_render CLI11::CLI11)
  target_compile_definitions(pliant_cli PRIVATE PLIANT_VERSION="${PROJECT_VERSION}")
endif()
