#!/usr/bin/env bash
# The rules of the house that a compiler does not check. Usage: house_rules.sh SOURCE_FOLDER; prints what breaks a rule, one line
# each, and fails if there is any. The rules are stated in ARCHITECTURE.md and docs/determinism.md.
set -uo pipefail
cd "$1" || exit 2
broken=0
report() {
  printf '%s\n' "$*"
  broken=$((broken + 1))
}

# --- sizes -------------------------------------------------------------------------------------------------------------------
# Exceptions: file, its own limit, why. One that is no longer needed is itself reported, so that the list only shrinks.
declare -A exception=()
while read -r file limit _; do
  [[ -z $file || $file == \#* ]] || exception[$file]=$limit
done <tests/meta/size_exceptions.txt

check_size() {  # LIMIT FILE...
  local limit=$1 file lines
  shift
  for file in "$@"; do
    [ -f "$file" ] || continue
    lines=$(wc -l <"$file")
    if [[ -n ${exception[$file]:-} ]]; then
      [ "$lines" -gt "$limit" ] || report "$file: $lines lines need no exception any more (limit $limit): tests/meta/size_exceptions.txt"
      [ "$lines" -le "${exception[$file]}" ] || report "$file: $lines lines, its exception allows ${exception[$file]}"
    elif [ "$lines" -gt "$limit" ]; then
      report "$file: $lines lines, allowed are $limit: split it by topic"
    fi
  done
}
shopt -s globstar nullglob
check_size 150 kernels/**/*.cl kernels/**/*.h
check_size 400 host/**/*.cpp cpu_ref/**/*.cpp tests/**/*.cpp bench/**/*.cpp scenes/**/*.cpp examples/**/*.cpp
check_size 200 include/**/*.h host/**/*.h cpu_ref/**/*.h
for file in "${!exception[@]}"; do
  [ -f "$file" ] || report "$file: is gone; remove its exception from tests/meta/size_exceptions.txt"
done

# Functions at the margin of a .cpp file (clang-format puts their last brace there) have 60 lines, from the first of their own to that
# brace. Exceptions: file, the function as its first line names it, its own limit, why.
declare -A long_function=() long_seen=()
if [ -f tests/meta/function_exceptions.txt ]; then
  while read -r file name limit _; do
    [[ -z $file || $file == \#* ]] || long_function[$file $name]=$limit
  done <tests/meta/function_exceptions.txt
fi
while IFS=: read -r file line lines name; do
  key="$file $name"
  long_seen[$key]=1
  [ "$lines" -le "${long_function[$key]:-60}" ] || report "$file:$line: $name has $lines lines, allowed are ${long_function[$key]:-60}"
done < <(awk '
  FNR == 1 { start = 0; open = 0; raw = 0 }
  raw { if (index($0, close_)) raw = 0; next }
  match($0, /R"[a-z_]*\(/) {
    close_ = ")" substr($0, RSTART + 2, RLENGTH - 3) "\""
    raw = index(substr($0, RSTART + RLENGTH), close_) == 0
  }
  !open && /^[A-Za-z_~[]/ && !/^(namespace|struct|class|enum|union|using|typedef|static_assert|extern) / { start = FNR; name = $0 }
  start && !open && /\{$/ { if (name ~ /\(/) open = 1; else start = 0 }
  start && !open && /[;}]$/ { start = 0 }  # a declaration, or a function of one line
  /^}/ {
    if (open && FNR - start >= 60) {
      sub(/\(.*/, "", name)
      sub(/.*[ &*]/, "", name)
      printf "%s:%d:%d:%s\n", FILENAME, start, FNR - start + 1, name
    }
    start = 0
    open = 0
  }' host/**/*.cpp cpu_ref/**/*.cpp bench/**/*.cpp scenes/**/*.cpp examples/**/*.cpp python/*.cpp tests/**/*.cpp /dev/null)
for key in "${!long_function[@]}"; do
  [ -n "${long_seen[$key]:-}" ] || report "$key needs no exception any more: tests/meta/function_exceptions.txt"
done

# --- words that strangers do not know --------------------------------------------------------------------------------------------
# One extended regular expression a line, matched as a word and whatever its case; what stands in git is searched.
if [ -f tests/meta/banned_words.txt ] && git rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  while IFS= read -r word; do
    [[ -z $word || $word == \#* ]] && continue
    while IFS= read -r place; do
      report "$place: \"$word\" is banned by tests/meta/banned_words.txt"
    done < <(git grep -nwiEI -e "$word" -- . ':!tests/meta/banned_words.txt' ':!tests/meta/house_rules_test.sh' | cut -d: -f1-2)
  done <tests/meta/banned_words.txt
fi

# --- who includes whom ---------------------------------------------------------------------------------------------------------
# includes FILE: what it includes, with its brackets or quotes.
includes() { sed -nE 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*([<"][^>"]+[>"]).*/\1/p' "$1"; }

# allow WHY PATTERN FILE...: every include of these files matches the extended regular expression.
allow() {
  local why=$1 pattern=$2 file name
  shift 2
  for file in "$@"; do
    while read -r name; do
      [[ $name =~ $pattern ]] || report "$file includes $name: $why"
    done < <(includes "$file")
  done
}
# forbid WHY PATTERN FILE...
forbid() {
  local why=$1 pattern=$2 file name
  shift 2
  for file in "$@"; do
    while read -r name; do
      [[ ! $name =~ $pattern ]] || report "$file includes $name: $why"
    done < <(includes "$file")
  done
}
cl='^[<"]CL/|opencl\.hpp|cl\.h[>"]$'
allow 'kernels include kernels and layout.h only' '^"([a-z0-9_]+\.cl|layout\.h)"$' kernels/**/*.cl kernels/**/*.h
allow 'the public API uses the standard library only' '^(<[a-z_0-9]+>|<std(def|int)\.h>|"pliant/[a-z_/]+\.h")$' include/**/*.h
core=()
for file in host/**/*.h host/**/*.cpp; do
  [[ $file == host/backends/opencl/* ]] || core+=("$file")
done
forbid 'only host/backends/opencl includes OpenCL headers' "$cl" "${core[@]}" cpu_ref/**/*.h cpu_ref/**/*.cpp
forbid 'the twins are independent of the OpenCL backend and of the kernels' '"backends/(opencl|twins|choice)/|\.cl[>"]$' cpu_ref/**/*.h cpu_ref/**/*.cpp
forbid 'no Eigen in the twins' '[<"]Eigen/' cpu_ref/**/*.h cpu_ref/**/*.cpp
forbid 'a .cl file is text, not a header' '\.cl[>"]$' host/**/*.h host/**/*.cpp include/**/*.h
# Rooms, from the inside out: each knows those before it.
allow_room() {  # ROOM INNER_ROOMS
  allow "host/$1 knows only: $2" "^<|^\"(pliant/|(layout|laws|integrators)\.h|($1|$2)/)" host/"$1"/**/*.h host/"$1"/**/*.cpp
}
allow_room program 'program'
allow_room backends/interface 'program'
allow_room backends/opencl 'backends/interface|program'
allow_room backends/twins 'backends/interface|program|cpu_ref'
allow_room backends/choice 'backends/opencl|backends/twins|cpu_ref|backends/interface|program'
allow_room material 'material'
allow_room integrators 'integrators'
allow_room geometry 'geometry'
allow_room elements 'material|geometry'
allow_room scene 'integrators|mesh_io|elements|material|geometry'
allow_room mesh_io 'geometry'
allow_room lattice 'scene|elements|material|geometry'
allow_room model 'lattice|mesh_io|scene|elements|material|geometry'
allow_room cutting 'model|lattice|mesh_io|scene|elements|material|geometry'
allow_room tearing 'cutting|model|lattice|scene|elements|material|geometry'
allow_room cutting_methods 'tearing|cutting|model|lattice|scene|elements|material|geometry'
allow_room schedule 'program|model|lattice|scene|elements|material|geometry'
allow_room simulation 'schedule|backends/interface|program|tearing|cutting|model|lattice|scene|elements|material|geometry'
allow_room statics 'model|lattice|scene|elements|material|geometry'
allow_room io 'simulation|schedule|backends/interface|program|model|lattice|scene|elements|material|geometry'
allow_room render 'io|simulation|schedule|backends/interface|program|tearing|cutting|model|lattice|scene|elements|material|geometry'
allow_room api 'backends/choice|cutting|io|simulation|schedule|backends/interface|program|model|lattice|mesh_io|scene|elements|material|geometry'
allow_room plan 'backends/choice|mesh_io|simulation|schedule|backends/interface|program|statics|model|lattice|scene|elements|material|geometry'
allow 'cpu_ref knows only backend and program' '^<|^"(pliant/|(layout|laws|integrators)\.h|cpu_ref/|[a-z0-9_]+\.h|(backends/interface|program)/)' cpu_ref/**/*.h cpu_ref/**/*.cpp
forbid 'the command asks host/backends for a backend' '"backends/(opencl|twins)/' host/cli/*.h host/cli/*.cpp

# --- elements --------------------------------------------------------------------------------------------------------------------
# Who names a concrete element must change when one comes. Not counted: its own files, and files that read what others wrote. The number may
# only fall; what is left is mostly statics, which has its own list, and comments.
elements_named=23
mapfile -t naming < <(git ls-files 'host/*' 'kernels/*' 'cpu_ref/*' 'include/*' | grep -E '\.(h|cpp|cl)$' |
  grep -vE '^host/(elements|mesh_io|statics)/|/(tled_)?(tet4|hex8)' |
  xargs grep -lE '\b(tet4|tet4anp|hex8|hex8full|Tet4|Tet4Anp|Hex8|Hex8Full)\b|ElementKind::')
[ "${#naming[@]}" -le "$elements_named" ] ||
  report "${#naming[@]} files name a concrete element, at most $elements_named may; ask element_info (host/elements/element.h): ${naming[*]}"

# --- bits ------------------------------------------------------------------------------------------------------------------------
# Whoever writes other golden hashes comes past the section that says why.
if [ -f tests/golden/hashes.json ]; then
  digest=$(sha256sum tests/golden/hashes.json | cut -c1-16)
  grep -qs "$digest" CHANGELOG.md ||
    report "tests/golden/hashes.json: its sha256 ($digest...) is not the one under \"Bits\" in CHANGELOG.md: say there what changed, and why"
fi

# --- kernels and twins -----------------------------------------------------------------------------------------------------------
for file in kernels/**/*.cl; do
  stem=$(basename "$file" .cl)
  # Comments may name what the code must not use.
  code=$(sed -E 's,//.*,,' "$file")
  forbidden=$(grep -noE '\b(mad|dot|cross|length|normalize|distance|mix|min|max|fmin|fmax|clamp|rsqrt|native_[a-z0-9]+|half_[a-z0-9]+|sin|cos|tan|exp|log|pow|cbrt)[[:space:]]*\(' <<<"$code")
  [ -z "$forbidden" ] || report "$file: forbidden on values (docs/determinism.md): $(tr '\n' ' ' <<<"$forbidden")"
  grep -q '__kernel' <<<"$code" || continue
  first=$(includes "$file" | head -n 1)
  [ "$first" = '"arith.cl"' ] || report "$file: must include arith.cl first, which turns contraction off (first is ${first:-nothing})"
  grep -qE "__kernel[[:space:]]+.*\b$stem\b" <<<"$code" || report "$file: holds no kernel of its own name"
  twin=${file#kernels/}
  [ -f "cpu_ref/${twin%.cl}.cpp" ] || report "$file: no twin cpu_ref/${twin%.cl}.cpp"
  grep -qE "ROW\($stem\)" cpu_ref/registry.cpp || report "$file: no row in cpu_ref/registry.cpp"
  grep -qsE "\b$stem\b" tests/kernels/**/*_test.cpp || report "$file: named by no test in tests/kernels"
done
grep -q '#pragma OPENCL FP_CONTRACT OFF' kernels/arith.cl || report 'kernels/arith.cl: must turn contraction off'

[ "$broken" = 0 ] || { printf '%d rule(s) broken\n' "$broken"; exit 1; }
