#!/usr/bin/env bash
# The rules can fail: a small tree that breaks each of them once is reported once for each. Usage: house_rules_test.sh SOURCE_FOLDER
set -euo pipefail
source=$1
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{kernels,cpu_ref,include/pliant,tests/meta,tests/kernels,host/{scene,model,io,cli,opencl}}
cd "$tree"
printf 'host/io/gone.cpp 500 it was long\nhost/io/short.cpp 500 it was long\n' >tests/meta/size_exceptions.txt
printf '#pragma OPENCL FP_CONTRACT ON\n' >kernels/arith.cl
printf '#include "texels.cl"\n__kernel void twist(float x) { x = dot(x, x); }\n' >kernels/turn.cl
printf '#include "../host/scene/scene.h"\n' >kernels/texels.cl
yes '// a long kernel' | head -n 151 >kernels/long.cl || true
yes '// a long file' | head -n 401 >host/io/long.cpp || true
yes '// a long header' | head -n 201 >host/io/long.h || true
printf '#include <vector>\n' >host/io/short.cpp
printf '#include <Eigen/Dense>\n#include "backends/opencl/devices.h"\n#include "turn.cl"\n' >cpu_ref/arms.cpp
printf '' >cpu_ref/registry.cpp
printf '#include <fmt/format.h>\n' >include/pliant/api.h
printf '#include "model/mesh.h"\n#include <CL/cl.h>\n' >host/scene/load.cpp
printf '#include "turn.cl"\n' >host/model/text.cpp
printf '#include "backends/opencl/devices.h"\n' >host/cli/devices.cpp
printf 'host/io/folded.cpp fold 70 it was long\n' >tests/meta/function_exceptions.txt
{
  printf 'namespace pliant {\nint endless(int a,\n            int b) {\n  const char* text = R"(\nvoid inner() {\n}\n)";\n'
  yes '  a += b;' | head -n 60 || true
  printf '  return a;\n}\nint brief() { return 1; }\nstruct Kept {\n  int x = 0;\n};\n}  // namespace pliant\n'
} >host/io/endless.cpp
mkdir tests/golden
printf '{}\n' >tests/golden/hashes.json
printf '### Bits\n\nsha256 0123456789abcdef\n' >CHANGELOG.md
printf 'frobnicate\n' >tests/meta/banned_words.txt
printf '// Frobnicate the nodes.\n' >host/io/words.cpp
git init -q . && git add host/io/words.cpp
found=$(bash "$source/tests/meta/house_rules.sh" "$tree") && { echo 'a tree that breaks every rule passed'; exit 1; }
missing=0
expect() {
  grep -qE "$1" <<<"$found" || { echo "not reported: $1"; missing=1; }
}
expect '^kernels/long\.cl: 151 lines, allowed are 150'
expect '^host/io/long\.cpp: 401 lines, allowed are 400'
expect '^host/io/endless\.cpp:2: endless has 68 lines, allowed are 60'
expect '^host/io/folded\.cpp fold needs no exception'
expect '^host/io/words\.cpp:1: "frobnicate" is banned'
expect '^host/io/long\.h: 201 lines, allowed are 200'
expect '^host/io/short\.cpp: 1 lines need no exception'
expect '^host/io/gone\.cpp: is gone'
expect '^kernels/texels\.cl includes .*scene\.h'
expect '^include/pliant/api\.h includes <fmt/format\.h>'
expect '^host/scene/load\.cpp includes <CL/cl\.h>'
expect '^host/scene/load\.cpp includes "model/mesh\.h": host/scene knows only'
expect '^host/cli/devices\.cpp includes "backends/opencl/devices\.h"'
expect '^host/model/text\.cpp includes "turn\.cl": a \.cl file is text'
expect '^cpu_ref/arms\.cpp includes <Eigen/Dense>'
expect '^cpu_ref/arms\.cpp includes "backends/opencl/devices\.h"'
expect '^cpu_ref/arms\.cpp includes "turn\.cl"'
expect '^kernels/turn\.cl: forbidden on values .*dot'
expect '^kernels/turn\.cl: must include arith\.cl first'
expect '^kernels/turn\.cl: holds no kernel of its own name'
expect '^kernels/turn\.cl: no twin'
expect '^kernels/turn\.cl: no row'
expect '^kernels/turn\.cl: named by no test'
expect '^tests/golden/hashes\.json: its sha256 \(ca3d163bab055381'
expect '^kernels/arith\.cl: must turn contraction off'
[ "$missing" = 0 ] || { printf '%s\n' "$found"; exit 1; }
