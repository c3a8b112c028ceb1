# Warnings for everything; floating-point flags for everything that computes a number a backend sees.
add_library(pliant_flags INTERFACE)
target_compile_options(pliant_flags INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Werror=switch -ffp-contract=off)
target_include_directories(pliant_flags INTERFACE ${CMAKE_SOURCE_DIR}/include ${CMAKE_SOURCE_DIR}/host ${CMAKE_SOURCE_DIR}/kernels)
if(PLIANT_SANITIZE)
  target_compile_options(pliant_flags INTERFACE -fsanitize=${PLIANT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(pliant_flags INTERFACE -fsanitize=${PLIANT_SANITIZE})
endif()
if(PLIANT_FUZZ)
  # Coverage for libFuzzer; the address sanitizer also supplies the hooks to executables that are no fuzzers.
  target_compile_options(pliant_flags INTERFACE -fsanitize=fuzzer-no-link,address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(pliant_flags INTERFACE -fsanitize=address,undefined)
endif()
