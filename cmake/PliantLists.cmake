# The includes that follow from a list of kernels/, one per row ROW(STEM, TYPE): for the kernels, where the number of the row is a
# define, for the twins, and for the host. Everything else about a list is a macro there.
set(PLIANT_GENERATED ${CMAKE_BINARY_DIR}/generated)

# pliant_list(NAME ROW SHELF/PREFIX HOST): makes kernels/NAME.cl and twin_NAME.h of the files SHELF/PREFIX_STEM, and ROOM/host_NAME.h of HOSTSTEM.h,
# where HOST is "ROOM/" and what the names of the files begin with.
function(pliant_list list row prefix host)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/kernels/${list}.h)
  file(READ ${CMAKE_SOURCE_DIR}/kernels/${list}.h text)
  get_filename_component(kernel ${prefix} NAME)  # kernels are included by their names alone
  string(REGEX MATCHALL "${row}\\([a-z0-9_]+, [A-Za-z0-9]+\\)" rows "${text}")
  set(kernels "// Generated from ${list}.h: the fragment of the row whose number is ${row}.\n")
  set(twins "// Generated from kernels/${list}.h.\n#pragma once\n")
  set(hosts "// Generated from kernels/${list}.h.\n#pragma once\n")
  set(number 0)
  foreach(entry IN LISTS rows)
    string(REGEX REPLACE "${row}\\(([a-z0-9_]+),.*" "\\1" stem "${entry}")
    string(APPEND kernels "#if ${row} == ${number}\n#include \"${kernel}_${stem}.cl\"\n#endif\n")
    string(APPEND twins "#include \"cpu_ref/${prefix}_${stem}.h\"\n")
    string(APPEND hosts "#include \"${host}${stem}.h\"\n")
    math(EXPR number "${number} + 1")
  endforeach()
  string(REGEX REPLACE "/.*" "" room "${host}")
  file(CONFIGURE OUTPUT ${PLIANT_GENERATED}/kernels/${list}.cl CONTENT "${kernels}" @ONLY)
  file(CONFIGURE OUTPUT ${PLIANT_GENERATED}/twin_${list}.h CONTENT "${twins}" @ONLY)
  file(CONFIGURE OUTPUT ${PLIANT_GENERATED}/${room}/host_${list}.h CONTENT "${hosts}" @ONLY)
endfunction()

pliant_list(laws LAW laws/law material/law_)
pliant_list(integrators INTEGRATOR nodes/integrate integrators/)
