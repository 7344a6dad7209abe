#!/usr/bin/env bash
# Runs the tests, from nothing: installs what is missing with apt (Debian 12), builds, runs ctest, prints a summary.
#   tests/run.sh [--asan | --tsan | --clang] [--quick] [ctest arguments]
# --asan (addresses, leaks and undefined behaviour), --tsan (races) and --clang build and test those presets instead of
# release; --quick leaves out the tests labelled slow.
# Example: tests/run.sh --asan -R collision
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../samples/setup.sh"

preset=release
arguments=()
for argument in "$@"; do
  case $argument in
    -h | --help) sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    --asan) preset=asan ;;
    --tsan) preset=tsan ;;
    --clang) preset=clang ;;
    --quick) arguments+=(-LE slow) ;;
    *) arguments+=("$argument") ;;
  esac
done

packages="$packages_build $packages_tests"
[ "$preset" != clang ] || packages="$packages $packages_clang"
# shellcheck disable=SC2086
install_packages $packages
build "$preset"

# Any report of a sanitizer ends the program with an error, and so fails the test. Options of the caller's come last and win.
case $preset in
  asan)
    export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:suppressions=$root/tests/asan.supp:${ASAN_OPTIONS:-}
    export LSAN_OPTIONS=suppressions=$root/tests/lsan.supp:print_suppressions=0:${LSAN_OPTIONS:-}
    export UBSAN_OPTIONS=print_stacktrace=1:${UBSAN_OPTIONS:-}
    ;;
  tsan) export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1:${TSAN_OPTIONS:-} ;;
esac

say "Running the tests of preset $preset"
log=$root/build/$preset/test.log
code=0
ctest --test-dir "$root/build/$preset" --output-on-failure --no-tests=error -j "$(nproc)" "${arguments[@]}" 2>&1 | tee "$log" || code=$?

say "Summary of preset $preset"
grep -E '^[0-9]+% tests passed|^Total Test time' "$log" || true
skipped=$(grep -cE '\*\*\*(Skipped|Not Run)' "$log" || true)
[ "$skipped" -eq 0 ] || echo "$skipped tests were skipped, each because something is not on this machine"
if [ "$code" -ne 0 ]; then
  sed -n '/^The following tests FAILED/,/^Errors while/p' "$log"
  fail "tests failed; the whole output is in $log"
fi
echo "All tests passed; the whole output is in $log"
