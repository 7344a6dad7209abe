#!/usr/bin/env bash
# Runs a benchmark scene, and Blender beside it, in one run on one machine; both results go to the same judge.
#   tests/bench/run.sh SCENE [--n N] [--frames N] [--preset NAME] [--threads N] [--keep FOLDER] [--peer FOLDER] [-- BAKE ARGUMENTS]
#   tests/bench/run.sh torture NAME|all [--frames N] [--obj FOLDER]
#   tests/bench/run.sh size [--frames N] [CELLS ...]
#   tests/bench/run.sh rumba_dress [--keep FOLDER] [-- BAKE ARGUMENTS]
#   tests/bench/run.sh hair [--threads N] [--keep FOLDER] [-- BAKE ARGUMENTS]
#   tests/bench/run.sh splash [CELLS ...] [--keep FOLDER]
#   tests/bench/run.sh jumps SHOT.toml [POSES A SECOND] [MILLIMETRES]
# SCENE     S1 (a square of N x N vertices on a swinging sphere), S2 (a skirt on a motion-captured capsule character)
# torture   the scenes of tests/support/torture, without a peer, each for at most FOLLOWTHROUGH_TORTURE_SECONDS (600)
# size      what S1 costs as N grows, without a peer: 50, 100, 200 and 400
# rumba_dress  samples/sewn_dress, sewn and danced, without a peer; then the dress in its authors' fabric beside their drape
# hair      200 strands of 32 vertices on a head that stands still for two seconds, then turns to and fro; three times in turn
# splash    a ball falls into a pool three times; beside Blender's liquid (Mantaflow), with 32 and 48 cells along the pool
# jumps     where the feasible collider of a shot moves by more than 4 mm against the drawn body within 2 ms
# --preset  of the peer: default, hq, hqfit. --peer FOLDER takes the peer's result of an earlier run with --keep instead of
#           running it: good for looking, not for claims of speed.
# Every clip of every character: tests/bench/sweep.sh.
# Needs the scenes and the judge of ../shared/bench (or FOLLOWTHROUGH_BENCH), but for hair and splash. The last line is "RESULT scene=.. n=.. ...".
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../samples/setup.sh"

usage() { sed -n '2,21s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }
scene=${1:-}
case $scene in
  -h | --help) usage; exit 0 ;;
  size | jumps) shift ;;
  torture) [ $# -ge 2 ] || { usage >&2; exit 2; }; shift ;;
  S1 | S2 | rumba_dress | hair | splash) shift ;;
  *) usage >&2; exit 2 ;;
esac

if [ "$scene" = size ] || [ "$scene" = jumps ]; then
  # shellcheck disable=SC2086
  install_packages $packages_build $packages_tests
  build release "${scene}_bench"
  exec "$root/build/release/bin/${scene}_bench" "$@"
fi
if [ "$scene" = torture ]; then
  # shellcheck disable=SC2086
  install_packages $packages_build $packages_tests $packages_bench
  build release torture_bench
  tool=$root/build/release/bin/torture_bench names=$1 failed=0
  shift
  [ "$names" != all ] || names=$("$tool" list)
  for name in $names; do
    status=0
    timeout "${FOLLOWTHROUGH_TORTURE_SECONDS:-600}" "$tool" "$name" "$@" || status=$?
    [ $status -ne 124 ] || echo "RESULT scene=$name verdict=too_slow"
    [ $status -eq 0 ] || failed=1
  done
  exit $failed
fi
n=100 frames=100 preset=default keep="" peer="" bake_arguments=() cells=()
while [ $# -gt 0 ]; do
  case $1 in
    --n | --frames | --preset | --threads | --keep | --peer) [ $# -gt 1 ] || fail "$1 needs a value" ;;&
    --n) [ "$scene" = S1 ] || fail "--n is S1's"; n=$2; shift ;;
    --frames) frames=$2; shift ;;
    --preset) preset=$2; shift ;;
    --threads) bake_arguments+=(--threads "$2"); shift ;;
    --keep) keep=$2; shift ;;
    --peer) peer=$(cd "$2" && pwd); shift ;;
    --) shift; bake_arguments+=("$@"); break ;;
    [1-9]*) [ "$scene" = splash ] || fail "cells are splash's"; cells+=("$1") ;;
    *) fail "what is \"$1\"?" ;;
  esac
  shift
done

bench=${FOLLOWTHROUGH_BENCH:-$root/../shared/bench}
tools=(followthrough case_tool)
[ "$scene" != rumba_dress ] || tools+=(test_baker)
[ "$scene" != hair ] || tools=(followthrough hair_tool)
[ "$scene" != splash ] || tools=(followthrough splash_tool)
[ "$scene" = hair ] || [ "$scene" = splash ] || [ -f "$bench/judge.cpp" ] || fail "the scenes and the judge are not at $bench; set FOLLOWTHROUGH_BENCH"
# shellcheck disable=SC2086
if [ "$scene" = splash ]; then
  install_packages $packages_build $packages_tests
  (install_packages $packages_bench) || command -v blender >/dev/null || { echo "skipped: splash: blender is not installed"; exit 0; }
else
  install_packages $packages_build $packages_tests $packages_bench
fi
build release "${tools[@]}"
bin=$root/build/release/bin
if [ "$scene" != hair ] && [ "$scene" != splash ] && { [ ! -x "$bin/judge" ] || [ "$bench/judge.cpp" -nt "$bin/judge" ]; }; then
  g++ -O2 -o "$bin/judge" "$bench/judge.cpp"
fi
if [ -n "$keep" ]; then
  mkdir -p "$keep"
  work=$(cd "$keep" && pwd)
else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi

# bake SHOT: into $work/bake; its seconds of CPU are $our_cpu.
bake() {
  local TIMEFORMAT='%U %S'
  rm -rf "$work/bake"
  { time "$bin/followthrough" bake "$1" --out "$work/bake" --progress plain "${bake_arguments[@]}" >"$work/bake.log" 2>&1; } \
    2>"$work/cpu.txt" || { tail -20 "$work/bake.log" >&2; fail "the bake failed (see above)"; }
  our_cpu=$(awk '{ print $1 + $2 }' "$work/cpu.txt")
}

if [ "$scene" = rumba_dress ]; then
  garment=${FOLLOWTHROUGH_ASSETS:-$root/../shared/assets}/garments/cipc_dress_knife failed=0
  say "The dress is sewn and dances"
  bake "$root/samples/sewn_dress/shot.toml"
  say "The judge"
  "$bin/followthrough" check "$work/bake" --json "$work/check.json" | tail -1 || failed=1
  "$bin/case_tool" to-judge "$work/bake" dress mannequin "$garment/stage.obj" "$work/feasible"
  "$bin/judge" "$work/feasible" >"$work/judge_feasible.txt"
  say "The dress in its authors' fabric, beside their drape"
  "$bin/test_baker" --gtest_filter='SewnDress.*' | grep -E '^[a-z_0-9]+ [0-9.-]+$|Failure|FAILED|PASSED|SKIPPED' || failed=1
  "$bin/case_tool" result-alone "$scene" 15656 "$work/bake/report.json" "$our_cpu" "$work/judge_feasible.txt" "$work/check.json"
  exit $failed
fi

if [ "$scene" = hair ]; then
  "$bin/hair_tool" scene "$work/scene"
  rounds=()
  for k in 1 2 3; do
    round=$work/round$k
    rounds+=("$round")
    rm -rf "$round"
    mkdir -p "$round"
    say "Round $k of 3: Blender's hair dynamics, and ours"
    blender -b --factory-startup -P "$root/tests/bench/hair_peer.py" -- "$work/scene" "$round" >"$round/peer.log" 2>&1 || true
    grep RESULT "$round/peer.log" || { tail -20 "$round/peer.log" >&2; fail "Blender gave no result (see above)"; }
    bake "$work/scene/shot.toml"
    mv "$work/bake" "$round/bake"
    echo "$our_cpu" >"$round/cpu.txt"
  done
  "$bin/hair_tool" result "${rounds[@]}"
  exit
fi

if [ "$scene" = splash ]; then
  [ ${#cells[@]} -gt 0 ] || cells=(32 48)
  "$bin/splash_tool" scene "$work/scene" "${cells[@]}"
  for n in "${cells[@]}"; do
    round=$work/cells$n
    rm -rf "$round"
    mkdir -p "$round/peer"
    say "$n x $n cells: Blender's liquid, and ours"
    blender -b --factory-startup -P "$root/tests/bench/splash_peer.py" -- "$work/scene" "$n" "$round/peer" >"$round/peer.log" 2>&1 || true
    grep RESULT "$round/peer.log" || { tail -20 "$round/peer.log" >&2; fail "Blender gave no result (see above)"; }
    bake "$work/scene/shot$n.toml"
    mv "$work/bake" "$round/bake"
    echo "$our_cpu" >"$round/cpu.txt"
    "$bin/splash_tool" result "$n" "$round"
  done
  exit
fi

case $scene in
  S1) pins=() skip=0; script=(S1_sphere.py -- --n "$n"); n=$((n * n)) ;;
  S2) n=4000 pins=(--pins 0-199) skip=200; script=(S2_skirt.py -- --rings 40 --segs 100) ;;
esac
if [ -z "$peer" ]; then
  peer=$work/peer
  say "The peer: Blender, $scene, preset $preset, $frames frames"
  blender -b --factory-startup -P "$bench/${script[0]}" "${script[@]:1}" --frames "$frames" --preset "$preset" --out "$peer" \
    >"$work/peer.log" 2>&1 || { tail -20 "$work/peer.log" >&2; fail "Blender failed (see above)"; }
  grep RESULT "$work/peer.log" || { tail -20 "$work/peer.log" >&2; fail "Blender gave no result (see above)"; }
fi

say "Ours: the same character, garment and frames"
rm -rf "$work/shot"
"$bin/case_tool" to-shot "$peer" "$work/shot" "${pins[@]}"
bake "$work/shot/shot.toml"

say "The judge"
"$bin/case_tool" from-bake "$peer" "$work/bake" "$work/drawn" drawn
"$bin/case_tool" from-bake "$peer" "$work/bake" "$work/feasible" feasible
for who in peer drawn feasible; do
  folder=$work/$who
  [ "$who" != peer ] || folder=$peer
  SKIP=$skip "$bin/judge" "$folder" >"$work/judge_$who.txt"
  echo "$who: $(grep SUMMARY "$work/judge_$who.txt" | sed 's/^SUMMARY [^ ]* //')"
done
"$bin/case_tool" result "$scene" "$n" "$work/bake/report.json" "$our_cpu" "$peer/timing.txt" "$work"/judge_{peer,drawn,feasible}.txt
