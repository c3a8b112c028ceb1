#!/usr/bin/env bash
# dev.sh ROOT: every command that ./dev knows has the function that it calls. The stages of its test are tests/meta/stages_test.py's.
set -euo pipefail
cd "$1"
status=0
has() {
  grep -qE "^$1\(\)" dev || {
    printf 'dev: "%s" is called and not there\n' "$1"
    status=1
  }
}
# In the last case: `  word) function ...;;`.
calls=$(awk '/^command=/ { on = 1 } on && match($0, /^  [a-z]+\) [a-z_]+/) { print $2 }' dev)
[ "$(wc -w <<<"$calls")" -ge 10 ] || { echo 'dev.sh: too few calls found; has dev changed its form?'; exit 1; }
for name in $calls; do has "$name"; done
# What `help` lists is what the case takes.
for name in $(./dev help | sed -nE 's/^  ([a-z]+) .*/\1/p' | sort -u); do
  grep -qE "^  $name( \||\))" dev || { printf 'dev: help names "%s", which is no command\n' "$name"; status=1; }
done
exit "$status"
