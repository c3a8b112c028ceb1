#!/usr/bin/env bash
# A variant is linked as it says: of what it replaces nothing was taken. Usage: variant.sh EXECUTABLE MAP WORD...: a library
# (libNAME.a), a file of one, or a shared library (libNAME).
set -euo pipefail
executable=$1 map=$2
shift 2
taken=$(sed -n '1,/^\(Allocating common symbols\|Discarded input sections\|Memory Configuration\)/p' "$map" | grep -oE '[^ /]+\.a\([^)]+\)' | sort -u)
[ -n "$taken" ] || { echo "$map names no library: does this linker write another format?"; exit 1; }
needed=$(objdump -p "$executable" | sed -n 's/^ *NEEDED *//p')
status=0
for word in "$@"; do
  ! grep -F "$word" <<<"$taken"$'\n'"$needed" || { echo "$executable: $word should have been replaced"; status=1; }
done
exit $status
