#!/usr/bin/env bash
# kill_resume.sh PROGRAM SHOT [bake arguments]: an undisturbed bake, then 25 kills with kill -9 at random instants, each followed by a
# resume; all caches and the manifest must have the bytes of the undisturbed bake. 15 bakes are killed once; 10 kills hit one bake again
# and again, its resumes included. Instants come from SEED (default 1) and the time that the undisturbed bake took.
# report.json holds times and .state the program's own notes: neither is compared.
set -euo pipefail
if [ $# -lt 2 ]; then sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 2; fi
program=$1 shot=$2
shift 2
extra=("$@")
kills=${KILLS:-25}
RANDOM=${SEED:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "kill_resume: $*" >&2; exit 1; }
sums() { (cd "$1" && find . -type f ! -path './.state/*' ! -name report.json -print0 | sort -z | xargs -0 sha256sum); }
bake() { "$program" bake "$shot" --progress none "${extra[@]}" --out "$@"; }
now_ms() { echo $(($(date +%s%N) / 1000000)); }

started=$(now_ms)
bake "$work/reference" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "the undisturbed bake failed"; }
duration=$(($(now_ms) - started))
sums "$work/reference" >"$work/reference.sums"
[ "$(grep -c -E '\.(abc|pc2)$' "$work/reference.sums")" -ge 1 ] || fail "the undisturbed bake left no caches"

# Starts (or resumes) a bake in folder $1 and kills it within $2 ms; 1 when it was done before.
bake_and_kill() {
  local after=$((RANDOM * 32768 + RANDOM))
  after=$((after % $2 + 1))
  "$program" bake "$shot" --progress none "${extra[@]}" --out "$1" --resume >"$work/log" 2>&1 &
  local pid=$! code=0
  sleep "$(printf '%d.%03d' $((after / 1000)) $((after % 1000)))"
  kill -9 "$pid" 2>/dev/null || true
  wait "$pid" 2>/dev/null || code=$?
  [ "$code" -eq 137 ] && return 0
  [ "$code" -eq 0 ] || { cat "$work/log" >&2; fail "a resumed bake ended with exit code $code"; }
  return 1
}

finish_and_compare() {
  local code=0
  bake "$1" --resume >"$work/log" 2>&1 || code=$?
  [ "$code" -eq 0 ] || { cat "$work/log" >&2; fail "the resume after $2 ended with exit code $code"; }
  sums "$1" >"$work/resumed.sums"
  diff "$work/reference.sums" "$work/resumed.sums" || fail "the resume after $2 gave other bytes (see above)"
}

single=$((kills * 3 / 5)) done_kills=0 too_late=0
while [ "$done_kills" -lt "$single" ]; do
  rm -rf "$work/bake"
  if bake_and_kill "$work/bake" "$duration"; then
    done_kills=$((done_kills + 1))
    finish_and_compare "$work/bake" "kill $done_kills"
    echo "kill $done_kills of $kills: resumed to the same bytes"
  else
    too_late=$((too_late + 1))
    [ "$too_late" -lt 100 ] || fail "the bake is too quick to be killed"
  fi
done
rm -rf "$work/bake"
chain=0
while [ "$done_kills" -lt "$kills" ]; do
  if bake_and_kill "$work/bake" $((duration * 3 / 5 + 1)); then
    done_kills=$((done_kills + 1)) chain=$((chain + 1))
    echo "kill $done_kills of $kills: of a bake killed $chain times"
  else
    finish_and_compare "$work/bake" "$chain kills in turn"
    rm -rf "$work/bake"
    chain=0
  fi
done
finish_and_compare "$work/bake" "$chain kills in turn"
echo "kill_resume: $kills kills, $(wc -l <"$work/reference.sums") files, one SHA-256 each"
