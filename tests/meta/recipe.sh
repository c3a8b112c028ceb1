# What law_recipe.sh and integrator_recipe.sh share. Source it in the folder of the sources.
broken=0
report() {
  printf '%s\n' "$*"
  broken=$((broken + 1))
}

# recipe_is TITLE FILE...: the paths in code quotes of the numbered lines under that title of ARCHITECTURE.md are these.
recipe_is() {
  local title=$1 recipe
  shift
  recipe=$(awk -v title="## $title" '/^## /{on = $0 == title} on' ARCHITECTURE.md | grep -oE '^[1-8]\. `[^`]+`( and 7\. `[^`]+`)?' |
    grep -oE '`[^`]+`' | tr -d '`' | sort)
  [ "$recipe" = "$(printf '%s\n' "$@" | sort)" ] ||
    report "ARCHITECTURE.md, $title: the recipe names other files than this test follows: $(tr '\n' ' ' <<<"$recipe")"
}

# read_rows MACRO LIST LEAST: the rows MACRO(STEM, TYPE) of a list into `rows`, "STEM TYPE" each.
read_rows() {
  mapfile -t rows < <(grep -oE "\\b$1\([a-z0-9_]+, [A-Za-z0-9]+\)" "$2" | sed -E "s/$1\(([^,]+), ([^)]+)\)/\1 \2/")
  [ ${#rows[@]} -ge "$3" ] || report "$2: no rows found"
}

# holds FILE TEXT: what `stem` needs there.
holds() { grep -qF -- "$2" "$1" 2>/dev/null || report "$1: $stem needs \"$2\" there"; }

# files_have_rows PREFIX LIST FILE...: PREFIX_STEM.EXTENSION of each file is that of one of `stems`.
files_have_rows() {
  local prefix=$1 list=$2 file stem
  shift 2
  for file in "$@"; do
    stem=$(basename "$file" | sed -E "s/^${prefix}_(.*)\.[a-z]+\$/\1/")
    [[ " ${stems[*]} " == *" $stem "* ]] || report "$file: $list has no row for it"
  done
}

# named_only TYPE PATTERN: no source names an enumerator of TYPE but in lines of this pattern.
named_only() {
  local found
  while read -r found; do
    report "$found: by its name outside its files"
  done < <(grep -rnE "\\b$1::[a-z_]+" host cpu_ref include --include=*.h --include=*.cpp | grep -vE "$2")
}

finish() {
  [ "$broken" = 0 ] || { printf '%d rule(s) broken\n' "$broken"; exit 1; }
}
