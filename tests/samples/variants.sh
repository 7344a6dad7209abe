#!/usr/bin/env bash
# variants.sh PROGRAM: a sample with variants is baked into a folder each, has one preview page, and says how they differ.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../../samples/bake_sample.sh"
bin=$(dirname "$1")
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
say() { echo "== $*"; }
fail() { echo "variants.sh: $*" >&2; exit 1; }

mkdir -p "$root/samples/drop"
cat >"$root/samples/drop/shot.toml" <<'TOML'
[shot]
frames = "1-8"
fps = 50
preroll = 0

[primary.ball]
shape = "sphere"
radius = 0.05
mass = 0.1
position = [0, 0.06, 0]
velocity = [0, -1, 0]

[cords.line]
shape = "rope"
on = "ball"
mass = 0.01
position = [-0.3, 0, 0]
to = [0.3, 0, 0]
held = "both"
points = 6

[cache]
formats = ["pc2"]
TOML
printf '%s\n' '# two couplings' '' 'both --set cords.line.coupling=two-way' 'one --set cords.line.coupling=one-way --threads 1' \
  >"$root/samples/drop/variants.txt"

run_sample drop || fail "the sample was not baked"
summary=$(where_is drop)
echo "$summary"
for file in both/line.pc2 one/line.pc2 both/manifest.json preview.html; do
  [ -s "$root/out/drop/$file" ] || fail "$file is missing"
done
grep -q 'primary "ball": paths differ by up to' <<<"$summary" || fail "how far the paths differ is not said"
grep -q '^drop: caches in .*/out/drop/one$' <<<"$summary" || fail "where the caches are is not said"

# Without variants a sample is one bake.
rm "$root/samples/drop/variants.txt"
run_sample drop || fail "the sample without variants was not baked"
[ -s "$root/out/drop/line.pc2" ] || fail "the one bake is not in the sample's own folder"

# What reads a file that is not there is skipped.
echo elsewhere.fbx >"$root/samples/drop/needs.txt"
code=0
run_sample drop || code=$?
[ "$code" -eq 10 ] || fail "a sample without its input gave $code"
