#!/usr/bin/env bash
# Usage: oclgrind.sh OCLGRIND PLIANT SCENE: two steps of a scene on the simulated device. Fails at the first out-of-bounds access,
# read of a value never written, or data race between work-items.
set -euo pipefail
log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
# Uniform writes (several work-items storing the same value) are races too: no kernel relies on them.
"$1" --data-races --uniform-writes --uninitialized --max-errors 20 --num-threads 1 --log "$log" \
  "$2" run "$3" --backend opencl:0 --steps 2 --quiet || status=$?
if [ -s "$log" ]; then
  cat "$log"
  exit 1
fi
exit $status
