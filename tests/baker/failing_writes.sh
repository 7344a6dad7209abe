#!/usr/bin/env bash
# failing_writes.sh PROGRAM SHOT [bake arguments]: makes every call of a ten-frame bake that changes a file of the output folder fail in
# turn, as on a full disk. The bake must end with exit code 6 (or do without what failed and give the same bytes), its caches must stay
# readable, and --resume must give the bytes of an undisturbed bake.
#   FT_FAILING_WRITE=LIBRARY   libfailing_write.so of the tests; default: ../lib beside the program
#   FRAMES=1-10                what is baked
#   STEP=1                     1: every call; 7: every seventh
#   JOBS=N                     bakes at the same time; default: one per core
# report.json holds times and .state the program's own notes: neither is compared.
set -euo pipefail
if [ $# -lt 2 ]; then sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 2; fi
program=$(realpath "$1") shot=$(realpath "$2")
shift 2
extra=("$@")
library=${FT_FAILING_WRITE:-$(dirname "$program")/../lib/libfailing_write.so}
[ -e "$library" ] || { echo "failing_writes: skipped: $library is not built"; exit 77; }
library=$(realpath "$library")
frames=${FRAMES:-1-10} step=${STEP:-1} jobs=${JOBS:-$(nproc)}
# What is tested is which calls come in which order: memory does as well as a disk, and syncs faster.
base=${TMPDIR:-/tmp}
[ -w /dev/shm ] && base=/dev/shm
work=$(realpath "$(mktemp -d "$base/failing_writes_XXXXXX")")
trap 'rm -rf "$work"' EXIT

fail() { echo "failing_writes: $*" >&2; exit 1; }
sums() { (cd "$1" && find . -type f ! -path './.state/*' ! -name report.json -print0 | sort -z | xargs -0 sha256sum); }
bake() { "$program" bake "$shot" --frames "$frames" --threads 1 --progress none "${extra[@]}" --out "$@"; }
failing_bake() {  # FOLDER CALL
  FT_FAIL_FOLDER=$1 FT_FAIL_AT=$2 FT_COUNT_FILE=$1.count FT_FAIL_KEEP=1 FT_FAIL_SHORT=1 \
    ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD=$library bake "$1"
}

bake "$work/reference" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "the undisturbed bake failed"; }
sums "$work/reference" >"$work/reference.sums"
[ "$(grep -c -E '\.(abc|pc2)$' "$work/reference.sums")" -ge 1 ] || fail "the undisturbed bake left no caches"
failing_bake "$work/counted" 0 >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "the counted bake failed"; }
calls=$((10#$(cat "$work/counted.count")))
[ "$calls" -gt 20 ] || fail "only $calls calls were counted"
rm -rf "$work/counted"
echo "failing_writes: $calls calls change files in a bake of frames $frames"

# One call: prints "failed" or "did without"; on a broken promise says so and returns 1.
one_call() {
  local n=$1 out=$work/bake$1 code=0 cache
  failing_bake "$out" "$n" >"$out.log" 2>&1 || code=$?
  if [ "$code" -ne 6 ] && [ "$code" -ne 0 ]; then
    cat "$out.log" >&2
    echo "call $n: exit code $code instead of 6" >&2
    return 1
  fi
  for cache in "$out"/*.abc "$out"/*.pc2; do
    [ -e "$cache" ] || continue
    "$program" info "$cache" >"$out.log" 2>&1 || { cat "$out.log" >&2; echo "call $n: $(basename "$cache") cannot be read" >&2; return 1; }
  done
  if [ "$code" -eq 6 ]; then
    bake "$out" --resume >"$out.log" 2>&1 || { cat "$out.log" >&2; echo "call $n: the resume failed" >&2; return 1; }
  fi
  sums "$out" >"$out.sums"
  diff "$work/reference.sums" "$out.sums" >&2 || { echo "call $n: other bytes (see above)" >&2; return 1; }
  rm -rf "$out" "$out".*
  if [ "$code" -eq 6 ]; then echo failed; else echo "did without"; fi
}

worker() {  # every jobs-th of the calls
  local n=$((1 + $1 * step))
  while [ "$n" -le "$calls" ] && [ ! -e "$work/broken" ]; do
    one_call "$n" >>"$work/results$1" || { touch "$work/broken"; return 1; }
    n=$((n + jobs * step))
  done
}
pids=() bad=0
for ((job = 0; job < jobs; ++job)); do
  touch "$work/results$job"
  worker "$job" &
  pids+=($!)
done
for pid in "${pids[@]}"; do wait "$pid" || bad=1; done
[ "$bad" -eq 0 ] || fail "a promise was broken (see above)"
echo "failing_writes: $(cat "$work"/results* | grep -c '^failed') failures with exit code 6, all resumed to the same bytes;" \
  "$(cat "$work"/results* | grep -c '^did without' || true) calls that the bake could do without"
