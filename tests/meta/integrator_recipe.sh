#!/usr/bin/env bash
# The recipe "Adding an integrator" of ARCHITECTURE.md, followed for every row of kernels/integrators.h: each file it names must be there
# and name the integrator, and no other source file may name one. Usage: integrator_recipe.sh SOURCE_FOLDER.
set -uo pipefail
cd "$1" || exit 2
. tests/meta/recipe.sh

recipe_is 'Adding an integrator' kernels/integrators.h host/integrators/STEM.h kernels/nodes/integrate_STEM.cl cpu_ref/nodes/integrate_STEM.h \
  tests/kernels/nodes/integrator_oracle.h scenes/schema.json docs/scene.md CHANGELOG.md
read_rows INTEGRATOR kernels/integrators.h 2
stems=()
for row in "${rows[@]}"; do
  read -r stem type <<<"$row"
  stems+=("$stem")
  word=${stem//_/-}
  holds "host/integrators/$stem.h" "struct $type {"
  holds "host/integrators/$stem.h" ".word = \"$word\""
  holds "kernels/nodes/integrate_$stem.cl" 'static inline motion advance('
  holds "kernels/nodes/integrate_$stem.cl" '#define W_OF('
  holds "cpu_ref/nodes/integrate_$stem.h" "struct $type {"
  holds tests/kernels/nodes/integrator_oracle.h "case Integrator::$stem:"
  holds scenes/schema.json "\"$word\""
  holds docs/scene.md "\`\"$word\"\`"
done
files_have_rows integrate kernels/integrators.h kernels/nodes/integrate_*.cl cpu_ref/nodes/integrate_*.h

# Nobody else asks which one it is: what differs between integrators stands in their files. The default may be named.
named_only Integrator 'Integrator integrator = Integrator::increment|Integrator::stem'
finish
