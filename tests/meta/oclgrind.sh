#!/usr/bin/env bash
# Usage: oclgrind.sh OCLGRIND PLIANT SCENE: two steps of a scene on the simulated device. Fails at the first out-of-bounds access
# or data race between work-items. Nothing is optimised: the simulator does not know what inlining leaves behind. (Its check for
# values never written does not know the instruction `freeze`, which the compiler makes of our loops, and then reports what is
# not so.)
set -euo pipefail
log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
# Uniform writes (several work-items storing the same value) are races too: no kernel relies on them.
"$1" --build-options -cl-opt-disable --data-races --uniform-writes --max-errors 20 --num-threads 1 --log "$log" \
  "$2" run "$3" --backend opencl:0 --steps 2 --quiet || status=$?
if [ -s "$log" ]; then
  cat "$log"
  exit 1
fi
exit $status
