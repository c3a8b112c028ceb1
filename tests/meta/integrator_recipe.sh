#!/usr/bin/env bash
# The recipe "Adding an integrator" of ARCHITECTURE.md, followed for every row of kernels/integrators.h: each file it names must be there
# and name the integrator, and no other source file may name one. Usage: integrator_recipe.sh SOURCE_FOLDER.
set -uo pipefail
cd "$1" || exit 2
broken=0
report() {
  printf '%s\n' "$*"
  broken=$((broken + 1))
}

# What the recipe says: the paths in code quotes of its numbered lines.
recipe=$(sed -n '/^## Adding an integrator/,/^## Adding a kernel/p' ARCHITECTURE.md | grep -oE '^[1-8]\. `[^`]+`( and 7\. `[^`]+`)?' |
  grep -oE '`[^`]+`' | tr -d '`' | sort)
expected=$(printf '%s\n' kernels/integrators.h host/integrators/STEM.h kernels/integrate_STEM.cl cpu_ref/integrate_STEM.h \
  tests/kernels/integrator_oracle.h scenes/schema.json docs/scene.md CHANGELOG.md | sort)
[ "$recipe" = "$expected" ] || report "ARCHITECTURE.md: the recipe names other files than this test follows: $(tr '\n' ' ' <<<"$recipe")"

mapfile -t rows < <(grep -oE 'INTEGRATOR\([a-z0-9_]+, [A-Za-z0-9]+\)' kernels/integrators.h | sed -E 's/INTEGRATOR\(([^,]+), ([^)]+)\)/\1 \2/')
[ ${#rows[@]} -ge 2 ] || report "kernels/integrators.h: no rows found"
stems=()
for row in "${rows[@]}"; do
  read -r stem type <<<"$row"
  stems+=("$stem")
  word=${stem//_/-}
  holds() {  # FILE TEXT
    grep -qF -- "$2" "$1" 2>/dev/null || report "$1: the integrator $stem needs \"$2\" there"
  }
  holds "host/integrators/$stem.h" "struct $type {"
  holds "host/integrators/$stem.h" ".word = \"$word\""
  holds "kernels/integrate_$stem.cl" 'static inline motion advance('
  holds "kernels/integrate_$stem.cl" '#define W_OF('
  holds "cpu_ref/integrate_$stem.h" "struct $type {"
  holds tests/kernels/integrator_oracle.h "case Integrator::$stem:"
  holds scenes/schema.json "\"$word\""
  holds docs/scene.md "\`\"$word\"\`"
done

# A file of an integrator without a row.
for file in kernels/integrate_*.cl cpu_ref/integrate_*.h; do
  stem=$(basename "$file" | sed -E 's/^integrate_(.*)\.[a-z]+$/\1/')
  [[ " ${stems[*]} " == *" $stem "* ]] || report "$file: kernels/integrators.h has no row for it"
done

# Nobody else asks which one it is: what differs between integrators stands in their files. The default may be named.
while read -r found; do
  report "$found: an integrator by its name outside its files"
done < <(grep -rnE 'Integrator::[a-z_]+' host cpu_ref include --include=*.h --include=*.cpp |
  grep -vE 'Integrator integrator = Integrator::increment|Integrator::stem')

[ "$broken" = 0 ] || { printf '%d rule(s) broken\n' "$broken"; exit 1; }
