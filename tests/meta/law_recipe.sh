#!/usr/bin/env bash
# The recipe "Adding a material law" of ARCHITECTURE.md, followed for every row of kernels/laws.h: each file it names must be there
# and name the law, and no other source file may name a law that is not in all of them. Usage: law_recipe.sh SOURCE_FOLDER.
set -uo pipefail
cd "$1" || exit 2
broken=0
report() {
  printf '%s\n' "$*"
  broken=$((broken + 1))
}

# What the recipe says: the paths in code quotes of its numbered lines.
recipe=$(sed -n '/^## Adding a material law/,/^## Adding an integrator/p' ARCHITECTURE.md | grep -oE '^[1-8]\. `[^`]+`( and 7\. `[^`]+`)?' |
  grep -oE '`[^`]+`' | tr -d '`' | sort)
expected=$(printf '%s\n' kernels/laws.h host/material/law_STEM.h kernels/law_STEM.cl cpu_ref/law_STEM.h \
  tests/kernels/law_oracle.h scenes/schema.json docs/scene.md CHANGELOG.md | sort)
[ "$recipe" = "$expected" ] || report "ARCHITECTURE.md: the recipe names other files than this test follows: $(tr '\n' ' ' <<<"$recipe")"

mapfile -t rows < <(grep -oE 'LAW\([a-z0-9_]+, [A-Za-z0-9]+\)' kernels/laws.h | sed -E 's/LAW\(([^,]+), ([^)]+)\)/\1 \2/')
[ ${#rows[@]} -ge 3 ] || report "kernels/laws.h: no rows found"
stems=()
for row in "${rows[@]}"; do
  read -r stem type <<<"$row"
  stems+=("$stem")
  word=${stem//_/-}
  holds() {  # FILE TEXT
    grep -qF -- "$2" "$1" 2>/dev/null || report "$1: the law $stem needs \"$2\" there"
  }
  holds "host/material/law_$stem.h" "struct $type {"
  holds "host/material/law_$stem.h" ".word = \"$word\""
  holds "kernels/law_$stem.cl" 'static inline mat3 law_stress('
  holds "kernels/law_$stem.cl" '#define LAW_INVERTIBLE '
  holds "cpu_ref/law_$stem.h" "struct $type {"
  holds tests/kernels/law_oracle.h "case Law::$stem:"
  holds scenes/schema.json "\"$word\""
  holds docs/scene.md "| \`$word\` |"
  # The three say the same of J <= 0.
  host=$(grep -qE 'invertible = true' "host/material/law_$stem.h" && echo 1 || echo 0)
  twin=$(grep -qE 'invertible = true' "cpu_ref/law_$stem.h" && echo 1 || echo 0)
  grep -qE "#define LAW_INVERTIBLE $host\$" "kernels/law_$stem.cl" || report "law_$stem: the kernel is not invertible as the host is"
  [ "$host" = "$twin" ] || report "law_$stem: the twin is not invertible as the host is"
done

# A file of a law without a row.
for file in kernels/law_*.cl cpu_ref/law_*.h host/material/law_*.h; do
  stem=$(basename "$file" | sed -E 's/^law_(.*)\.[a-z]+$/\1/')
  [[ " ${stems[*]} " == *" $stem "* ]] || report "$file: kernels/laws.h has no row for it"
done

# Nobody else asks which law it is: what differs between laws stands in their files. The default of a material may be named.
while read -r found; do
  report "$found: a law by its name outside its files"
done < <(grep -rnE 'Law::[a-z_]+' host cpu_ref include --include=*.h --include=*.cpp | grep -vE 'Law law = Law::neo_hookean|Law::stem')

[ "$broken" = 0 ] || { printf '%d rule(s) broken\n' "$broken"; exit 1; }
