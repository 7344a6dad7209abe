#!/usr/bin/env bash
# sweep_test.sh PROGRAM: a tenth of the sweep's bakes, drawn by lot, come to their end, and the sum is printed.
set -euo pipefail
bin=$(cd "$(dirname "$1")" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
assets=${FOLLOWTHROUGH_ASSETS:-$here/../../../shared/assets}
[ -d "$assets/characters" ] || { echo "skipped: $assets/characters not present"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "sweep_test.sh: $*" >&2; exit 1; }

bash "$here/sweep.sh" --tenth --bin "$bin" --out "$work" | tee "$work/said.txt" || fail "a bake did not come to its end"
tail -1 "$work/said.txt" | grep -q '^RESULT scene=sweep bakes=[1-9][0-9]* .* unfinished=0 failed=0 ' || fail "the sum is not as it should be"
