# The same tests linked with something else in one place: the twins compiled with other flags or by another compiler, and a Pliant
# without OpenCL and Embree. Objects on the command line of the linker win over members of a library, so that the variant of a room
# takes the room's place; tests/meta/variant.sh looks whether it did. Built and run with ./dev test (ctest -C Whole -L variant).

# pliant_variant(VARIANT FOLDER OBJECTS...): test_FOLDER_VARIANT
function(pliant_variant variant folder shards)
  set(name test_${folder}_${variant})
  add_executable(${name} EXCLUDE_FROM_ALL ${ARGN})
  target_link_libraries(${name} PRIVATE test_${folder}_objects pliant_test_source)
  pliant_link_variant(${name} ${variant})
  pliant_shards(${folder}_${variant} ${folder} ${name} variant_${variant} ${shards})
endfunction()

function(pliant_link_variant name variant)
  set(map ${CMAKE_CURRENT_BINARY_DIR}/${name}.map)
  target_link_options(${name} PRIVATE LINKER:--as-needed LINKER:-Map=${map})
  add_dependencies(variant_${variant} ${name})
  add_test(NAME ${name}.linked COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/meta/variant.sh $<TARGET_FILE:${name}> ${map} ${replaced_${variant}}
           CONFIGURATIONS Whole)
  set_tests_properties(${name}.linked PROPERTIES LABELS variant_${variant} TIMEOUT 60)
endfunction()

# --- twins ---------------------------------------------------------------------------------------------------------------------
set(replaced_contract libpliant_ref.a)
set(replaced_clang libpliant_ref.a)
add_custom_target(variant_contract)
add_library(pliant_ref_contract OBJECT EXCLUDE_FROM_ALL ${ref_sources})
target_link_libraries(pliant_ref_contract PRIVATE pliant_flags pliant_backend Threads::Threads)
target_include_directories(pliant_ref_contract PRIVATE $<TARGET_PROPERTY:pliant_ref,INCLUDE_DIRECTORIES>)
target_compile_options(pliant_ref_contract PRIVATE ${ref_options})
set_source_files_properties(${ref_sources} PROPERTIES COMPILE_OPTIONS -ffp-contract=fast)  # of this folder's targets
pliant_variant(contract kernels 4 $<TARGET_OBJECTS:pliant_ref_contract>)

find_program(PLIANT_OTHER_COMPILER clang++)
if(PLIANT_OTHER_COMPILER AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_custom_target(variant_clang)
  get_target_property(flags pliant_flags INTERFACE_COMPILE_OPTIONS)
  set(folders "-I$<JOIN:$<TARGET_PROPERTY:pliant_ref,INCLUDE_DIRECTORIES>,;-I>")
  separate_arguments(configuration UNIX_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_RELEASE}")
  set(objects "")
  foreach(source ${ref_sources})
    get_filename_component(stem ${source} NAME_WE)
    set(object ${CMAKE_CURRENT_BINARY_DIR}/ref_clang/${stem}.o)
    add_custom_command(
      OUTPUT ${object}
      COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${PLIANT_OTHER_COMPILER} ${configuration} ${flags} ${ref_options} -std=c++20 "${folders}"
              -MD -MF ${object}.d -c ${source} -o ${object}
      DEPENDS ${source}
      DEPFILE ${object}.d
      COMMENT "clang++: cpu_ref/${stem}.cpp"
      VERBATIM COMMAND_EXPAND_LISTS)
    list(APPEND objects ${object})
  endforeach()
  set_source_files_properties(${objects} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  file(MAKE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/ref_clang)
  pliant_variant(clang kernels 4 ${objects})
endif()

# --- without OpenCL and Embree -------------------------------------------------------------------------------------------------
if(OpenCL_FOUND AND embree_FOUND)
  add_custom_target(variant_bare)
  set(replaced_bare libpliant_opencl.a distance_embree ray_scene_embree libOpenCL libembree3)
  set(no_opencl $<TARGET_OBJECTS:pliant_opencl_absent>)
  set(no_embree $<TARGET_OBJECTS:pliant_geometry_absent>)
  pliant_variant(bare kernels 2 ${no_opencl} ${no_embree})
  pliant_variant(bare model 2 ${no_embree})
  pliant_variant(bare cutting 4 ${no_opencl} ${no_embree})
  pliant_variant(bare solver 2 ${no_opencl} ${no_embree})
  # The two that take most of the time run the same objects over the same scenes on the twins as in test_solver.
  set_property(TEST solver_bare.1of2 solver_bare.2of2 APPEND PROPERTY ENVIRONMENT "GTEST_FILTER=-Scenes/ResumeMatrix.*:CheckScenes.*")
  pliant_variant(bare api 2 ${no_opencl} ${no_embree})
  pliant_variant(bare render 1 ${no_opencl} ${no_embree} $<TARGET_OBJECTS:pliant_render_absent>)
  add_executable(pliant_cli_bare EXCLUDE_FROM_ALL ${no_opencl} ${no_embree} $<TARGET_OBJECTS:pliant_render_absent>)
  target_link_libraries(pliant_cli_bare PRIVATE pliant_cli_objects)
  set_target_properties(pliant_cli_bare PROPERTIES OUTPUT_NAME pliant_bare)
  pliant_link_variant(pliant_cli_bare bare)
  pliant_python_tests(cli_bare cli pliant_cli_bare variant_bare Whole ${cli_topics})
endif()
