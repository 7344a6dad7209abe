#!/usr/bin/env bash
# Small scenes whose caches are pinned: the same bytes as on record, for this compiler, C library and kind of processor. Where
# there is no record the test is skipped and prints the lines to be added to data/pinned/hashes.txt. A change of the solvers
# that is meant to change results replaces the lines.
#   pinned.sh PROGRAM COMPILER
set -euo pipefail
program=$1
processor=$(grep -m1 -o '^vendor_id.*' /proc/cpuinfo | tr -d ' \t' | cut -d: -f2 || true)
grep -qm1 ' avx512f' /proc/cpuinfo && processor+=-avx512
key="$2 $(getconf GNU_LIBC_VERSION | tr ' ' '-') ${processor:-unknown}"
data=$(cd "$(dirname "${BASH_SOURCE[0]}")/data" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
hashes() { # NAME SHOT [bake arguments]
  local name=$1 shot=$2
  shift 2
  "$program" bake "$shot" --out "$scratch/$name" --progress none "$@"
  for cache in "$scratch/$name"/*.pc2; do
    echo "$key $name $(basename "$cache" .pc2) $(md5sum <"$cache" | cut -d' ' -f1)"
  done
}
{
  hashes skirt "$data/small_shot/shot.toml" --frames 1-6
  hashes net "$data/pinned/net.toml"
  hashes scene "$data/pinned/scene.toml"
} >"$scratch/now.txt"
if ! grep -q "^$key " "$data/pinned/hashes.txt" 2>/dev/null; then
  echo "no hashes are on record for: $key"
  cat "$scratch/now.txt"
  exit 77
fi
if ! diff <(grep "^$key " "$data/pinned/hashes.txt") "$scratch/now.txt"; then
  echo "caches differ from those on record (<): if that is meant, put the new lines (>) into data/pinned/hashes.txt"
  exit 1
fi
echo "$(wc -l <"$scratch/now.txt") caches are as on record for $key"
