#!/usr/bin/env bash
# sweep_test.sh PROGRAM: a tenth of the sweep's bakes, drawn by lot, the first 10 frames of each. They come to their end,
# at least 19 of 20 never cross the collider or cloth, and none does in its last frame.
set -euo pipefail
bin=$(cd "$(dirname "$1")" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
assets=${FOLLOWTHROUGH_ASSETS:-$here/../../../shared/assets}
[ -d "$assets/characters" ] || { echo "skipped: $assets/characters not present"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "sweep_test.sh: $*" >&2; exit 1; }

bash "$here/sweep.sh" --tenth --frames 10 --bin "$bin" --out "$work" | tee "$work/said.txt" || fail "a bake did not come to its end"
characters=$(grep -c '^[a-z0-9_]*: .* vertices' "$work/said.txt") || fail "no garments were made"
dressed=$(grep -c '^[a-z0-9_]*: skirt of ' "$work/said.txt") || fail "no character wears a skirt"
[ $((2 * dressed)) -gt "$characters" ] || fail "only $dressed of $characters characters wear a skirt"
tail -1 "$work/said.txt" | awk '
  { for (i = 2; i <= NF; ++i) { split($i, pair, "="); value[pair[1]] = pair[2] } }
  END { exit !($1 == "RESULT" && value["bakes"] > 0 && value["clean"] >= 0.95 && value["clean_last"] == 1 &&
               value["unfinished"] == 0 && value["failed"] == 0) }' || fail "the sum is not as it should be"
