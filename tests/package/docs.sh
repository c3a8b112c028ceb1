#!/usr/bin/env bash
# The reference is complete: Doxygen finds nothing to complain about. Usage: docs.sh SOURCE; skipped without doxygen.
set -euo pipefail
command -v doxygen >/dev/null || { echo 'skipped: doxygen is not installed'; exit 77; }
cd "$1"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
sed "s|^OUTPUT_DIRECTORY .*|OUTPUT_DIRECTORY = $out|" docs/Doxyfile | doxygen -
[ -f "$out/html/index.html" ]
