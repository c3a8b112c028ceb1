#!/usr/bin/env bash
# Install into an empty prefix, then build and run examples/find_package against it, with find_package and with pkg-config.
# Usage: install.sh SOURCE BUILD STATIC_LIBRARY|SHARED_LIBRARY COMPILER
set -euo pipefail
export CMAKE_GENERATOR=Ninja  # make need not be there
source=$1 build=$2 kind=$3 cxx=$4
grep -q '^PLIANT_SANITIZE:STRING=.\+' "$build/CMakeCache.txt" && { echo 'skipped: a library with sanitizers is not for consumers'; exit 77; }
case $cxx in *clang++*) cc=${cxx/clang++/clang} ;; *) cc=${cxx/g++/gcc} ;; esac
case $cxx in */c++) cc=${cxx%c++}cc ;; esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix

cmake --install "$build" --prefix "$prefix" --component dev >/dev/null
cmake --install "$build" --prefix "$prefix" --component runtime >/dev/null
lib=$(dirname "$(find "$prefix" -name 'libpliant.*' | head -n 1)")
version=$(sed -n 's/^Version: //p' "$lib/pkgconfig/pliant.pc")
[ -f "$prefix/include/pliant/c/pliant.h" ] || { echo 'the headers are missing'; exit 1; }
printf '#include <pliant/pliant.h>\n' | "$cc" -x c -I "$prefix/include" -fsyntax-only - 2>"$work/log" && { echo 'C takes the C++ API'; exit 1; }
grep -q 'the C API is <pliant/c/pliant.h>' "$work/log" || { cat "$work/log"; exit 1; }
printf '#include <pliant/pliant.h>\nint main() { return pliant::version() == nullptr; }\n' |
  "$cxx" -std=c++17 -x c++ -I "$prefix/include" -fsyntax-only -

if [ "$kind" = SHARED_LIBRARY ]; then
  [ -f "$lib/libpliant.so.$version" ] || { echo "there is no libpliant.so.$version"; exit 1; }
  # Only the API can be seen.
  seen=$(nm -D --defined-only -C "$lib/libpliant.so" | sed 's/^[0-9a-f]* [A-Z] //' | grep -vE \
    '^(pliant_[a-z_]+|pliant::(World::|HapticDevice::|HapticLoop::|ManualDevice::|version|backend_names|box_surface|open_haptic_device).*|(typeinfo|typeinfo name|vtable) for pliant::(Error|HapticDevice|ManualDevice))$' || true)
  seen+=$(nm -D --defined-only -C "$lib/libpliant.so" | grep '::Impl::' || true)
  [ -z "$seen" ] || { printf 'symbols that should be hidden:\n%s\n' "$seen" | head -n 20; exit 1; }
fi

cmake -S "$source/examples/find_package" -B "$work/consumer" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
cmake --build "$work/consumer" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
! grep -q 'warning:' "$work/log" || { cat "$work/log"; exit 1; }
"$work/consumer/consumer"
"$work/consumer/consumer_c"

# The library may become a part of somebody's shared one, also the static library: a plugin, loaded by a program that knows nothing of it.
cat >"$work/plugin.c" <<'C'
#include <pliant/c/pliant.h>
#include <string.h>
int plugin_works(void) {
  char names[4000];
  pliant_world none = {0};
  return pliant_backend_names(names, sizeof names, NULL) == PLIANT_OK && strncmp(names, "cpu", 3) == 0 &&
         pliant_world_step(none, 1, NULL) == PLIANT_USAGE;
}
C
cat >"$work/host.c" <<'C'
#include <dlfcn.h>
#include <stdio.h>
int main(int count, char** words) {
  void* plugin = dlopen(words[count - 1], RTLD_NOW | RTLD_LOCAL);
  int (*works)(void) = plugin ? (int (*)(void))dlsym(plugin, "plugin_works") : 0;
  if (!works) fprintf(stderr, "%s\n", dlerror());
  return works && works() ? 0 : 1;
}
C
mkdir "$work/plugin"
cat >"$work/plugin/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.16)
project(plugin LANGUAGES C CXX)
find_package(pliant REQUIRED)
add_library(plugin SHARED ../plugin.c)
target_link_libraries(plugin PRIVATE pliant::pliant)
set_target_properties(plugin PROPERTIES LINKER_LANGUAGE CXX)
target_link_options(plugin PRIVATE LINKER:--no-undefined)
add_executable(host ../host.c)
target_link_libraries(host PRIVATE ${CMAKE_DL_LIBS})
CMAKE
cmake -S "$work/plugin" -B "$work/plugin/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc" \
  >"$work/log" 2>&1 && cmake --build "$work/plugin/build" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
LD_LIBRARY_PATH=$lib "$work/plugin/build/host" "$work/plugin/build/libplugin.so"

# A component that this build has is found; one that it lacks is refused by name.
for component in OpenCL Embree Teleport; do
  printf 'find_package(pliant REQUIRED COMPONENTS %s)\n' "$component" >"$work/need.cmake"
  expected=refused answer=refused
  grep -qiE "^set\(pliant_${component}_FOUND (1|ON|TRUE|YES)\)" "$lib/cmake/pliant/pliantConfig.cmake" && expected=found
  cmake -S "$source/examples/find_package" -B "$work/with_$component" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_PROJECT_INCLUDE="$work/need.cmake" \
    -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_C_COMPILER="$cc" >"$work/log" 2>&1 && answer=found
  [ "$answer" = refused ] && ! grep -q "lacks the component $component" "$work/log" && { cat "$work/log"; exit 1; }
  [ "$answer" = "$expected" ] || { echo "component $component: $answer, expected: $expected"; exit 1; }
done

if command -v pkg-config >/dev/null; then
  read -ra flags < <(PKG_CONFIG_PATH=$lib/pkgconfig pkg-config --cflags --libs pliant)
  [ "$(PKG_CONFIG_PATH=$lib/pkgconfig pkg-config --modversion pliant)" = "$version" ]
  "$cxx" -std=c++17 "$source/examples/find_package/main.cpp" "${flags[@]}" -o "$work/by_pkg_config"
  LD_LIBRARY_PATH=$lib "$work/by_pkg_config"
fi
