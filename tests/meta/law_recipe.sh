#!/usr/bin/env bash
# The recipe "Adding a material law" of ARCHITECTURE.md, followed for every row of kernels/laws.h: each file it names must be there
# and name the law, and no other source file may name a law that is not in all of them. Usage: law_recipe.sh SOURCE_FOLDER.
set -uo pipefail
cd "$1" || exit 2
. tests/meta/recipe.sh

recipe_is 'Adding a material law' kernels/laws.h host/material/law_STEM.h kernels/laws/law_STEM.cl cpu_ref/laws/law_STEM.h \
  tests/kernels/laws/law_oracle.h scenes/schema.json docs/scene.md CHANGELOG.md
read_rows LAW kernels/laws.h 3
stems=()
for row in "${rows[@]}"; do
  read -r stem type <<<"$row"
  stems+=("$stem")
  word=${stem//_/-}
  holds "host/material/law_$stem.h" "struct $type {"
  holds "host/material/law_$stem.h" ".word = \"$word\""
  holds "kernels/laws/law_$stem.cl" 'INLINE mat3 law_stress('
  holds "kernels/laws/law_$stem.cl" '#define LAW_INVERTIBLE '
  holds "cpu_ref/laws/law_$stem.h" "struct $type {"
  holds tests/kernels/laws/law_oracle.h "case Law::$stem:"
  holds scenes/schema.json "\"$word\""
  holds docs/scene.md "| \`$word\` |"
  # The three say the same of J <= 0.
  host=$(grep -qE 'invertible = true' "host/material/law_$stem.h" && echo 1 || echo 0)
  twin=$(grep -qE 'invertible = true' "cpu_ref/laws/law_$stem.h" && echo 1 || echo 0)
  grep -qE "#define LAW_INVERTIBLE $host\$" "kernels/laws/law_$stem.cl" || report "law_$stem: the kernel is not invertible as the host is"
  [ "$host" = "$twin" ] || report "law_$stem: the twin is not invertible as the host is"
done
files_have_rows law kernels/laws.h kernels/laws/law_*.cl cpu_ref/laws/law_*.h host/material/law_*.h

# Nobody else asks which law it is: what differs between laws stands in their files. The default of a material may be named.
named_only Law 'Law law = Law::neo_hookean|Law::stem'
finish
