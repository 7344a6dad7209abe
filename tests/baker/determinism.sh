#!/usr/bin/env bash
# determinism.sh PROGRAM SHOT [bake arguments]: bakes the shot at 1, 2, 3 and 8 threads and twice at 2; every cache and the
# manifest must have the same bytes. report.json holds times and .state the program's own notes: neither is compared.
set -euo pipefail
program=$1 shot=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

sums() { (cd "$1" && find . -type f ! -path './.state/*' ! -name report.json -print0 | sort -z | xargs -0 sha256sum); }

reference=""
for run in 1 2 3 8 2again; do
  "$program" bake "$shot" --out "$work/$run" --threads "${run%again}" --progress none "$@" >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    echo "determinism: the bake at ${run%again} threads failed" >&2
    exit 1
  }
  sums "$work/$run" >"$work/$run.sums"
  if [ -z "$reference" ]; then
    reference=$work/$run.sums
    [ "$(grep -c -E '\.(abc|pc2)$' "$reference")" -ge 2 ] || { echo "determinism: the bake left no caches" >&2; exit 1; }
    continue
  fi
  diff "$reference" "$work/$run.sums" || { echo "determinism: 1 thread and ${run%again} threads differ (see above)" >&2; exit 1; }
done
echo "determinism: $(wc -l <"$reference") files, equal bytes at 1, 2, 3 and 8 threads"
