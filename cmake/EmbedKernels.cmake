# Turn the files of kernels/ into one C++ file of string literals, so that no path is needed at run time.
file(GLOB_RECURSE kernel_files CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/kernels/*.cl ${CMAKE_SOURCE_DIR}/kernels/*.h)
list(APPEND kernel_files ${PLIANT_GENERATED}/kernels/laws.cl ${PLIANT_GENERATED}/kernels/integrators.cl)
set(PLIANT_KERNEL_TEXT ${CMAKE_BINARY_DIR}/generated/kernel_text.cpp)
add_custom_command(
  OUTPUT ${PLIANT_KERNEL_TEXT}
  COMMAND ${CMAKE_COMMAND} -D OUT=${PLIANT_KERNEL_TEXT} "-DFILES=${kernel_files}" -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
  DEPENDS ${kernel_files} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
  COMMENT "Embedding kernels"
  VERBATIM)
