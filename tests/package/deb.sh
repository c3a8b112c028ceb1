#!/usr/bin/env bash
# The Debian packages: complete, with their dependencies, and good enough to build and run a program from.
# Usage: deb.sh SOURCE BUILD COMPILER; skipped without dpkg-dev, or where the pliant command was not built.
set -euo pipefail
export CMAKE_GENERATOR=Ninja
source=$1 build=$2 cxx=$3
grep -q '^PLIANT_SANITIZE:STRING=.\+' "$build/CMakeCache.txt" && { echo 'skipped: a build with sanitizers is not packaged'; exit 77; }
command -v dpkg-shlibdeps >/dev/null && command -v file >/dev/null || { echo 'skipped: needs dpkg-dev and file'; exit 77; }
[ -x "$build/pliant" ] || { echo 'skipped: the command is not built'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

(cd "$work" && cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work/packages") >"$work/log" 2>&1 ||
  { cat "$work/log"; exit 1; }
packages=("$work"/packages/*.deb)
for package in "${packages[@]}"; do
  name=$(dpkg-deb -f "$package" Package)
  dpkg-deb -c "$package" >"$work/list"
  grep -q "/usr/share/doc/$name/copyright$" "$work/list" || { echo "$name has no copyright file"; exit 1; }
  ! grep -vE '^[d-].* root/root ' "$work/list" | grep -v '^l' || { echo "$name: files that are not root's"; exit 1; }
  ! grep -vE ' \./(usr/(bin|include|lib|share)(/|$)|usr/$|$)' "$work/list" || { echo "$name: files in strange places"; exit 1; }
  dpkg-deb -x "$package" "$work/root"
done
depends() { dpkg-deb -f "$work"/packages/"$1"_*.deb Depends; }
[[ $(depends pliant) == *libassimp5* ]] || { echo "the command depends on: $(depends pliant)"; exit 1; }
[[ $(depends libpliant-dev) == *lib* ]] || { echo 'libpliant-dev depends on nothing'; exit 1; }

lib=$(dirname "$(find "$work/root" -name 'libpliant.*' | head -n 1)")
LD_LIBRARY_PATH=$lib "$work/root/usr/bin/pliant" --version
case $cxx in *clang++*) cc=${cxx/clang++/clang} ;; */c++) cc=${cxx%c++}cc ;; *) cc=${cxx/g++/gcc} ;; esac
cmake -S "$source/examples/find_package" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$work/root/usr" -DCMAKE_CXX_COMPILER="$cxx" \
  -DCMAKE_C_COMPILER="$cc" >"$work/log" 2>&1 && cmake --build "$work/consumer" >>"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
"$work/consumer/consumer_c"
