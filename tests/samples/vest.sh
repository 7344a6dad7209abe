#!/usr/bin/env bash
# vest.sh PROGRAM: the vest of O'Brien, Zordan and Hodgins (2000), 0.5 kg on somebody of 46.56 kg who stands still. Its
# effective acceleration settles at m g / M = 0.105 m/s2, and one-way is what advise says.
set -euo pipefail
bin=$(cd "$(dirname "$1")" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
character=${FOLLOWTHROUGH_ASSETS:-$here/../../../shared/assets}/characters/mh_adult_cmu_dressed/adult_cmu01.glb
[ -f "$character" ] || { echo "skipped: $character not present"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "vest.sh: $*" >&2; exit 1; }

"$bin/make_garments" "$character" --mesh Body --kind top --sleeve 0 --hem -0.05 --out vest.obj
density=$(awk '
  $1 == "v" { ++n; x[n] = $2; y[n] = $3; z[n] = $4 }
  function area(a, b, c,   ux, uy, uz, vx, vy, vz) {
    ux = x[b] - x[a]; uy = y[b] - y[a]; uz = z[b] - z[a]; vx = x[c] - x[a]; vy = y[c] - y[a]; vz = z[c] - z[a]
    return sqrt((uy * vz - uz * vy) ^ 2 + (uz * vx - ux * vz) ^ 2 + (ux * vy - uy * vx) ^ 2) / 2
  }
  $1 == "f" { for (k = 3; k < NF; ++k) sum += area($2 + 0, $(k) + 0, $(k + 1) + 0) }
  END { printf "%.6f", 0.5 / sum }' vest.obj)

cat >shot.toml <<TOML
[shot]
frames = "1-48"
fps = 24
preroll = 48

[primary.alien]
file = "$character"
clip = "01_01_forward_jumps_turn"
meshes = ["Body"]
clip_start = 0.5
speed = 0.01                      # stands still
mass = 46.56

[cloth.vest]
mesh = "vest.obj"
fabric = "denim"
on = "alien"
mass_per_area = $density

[cache]
formats = ["pc2"]
TOML

"$bin/followthrough" bake shot.toml --out out --progress plain >bake.txt
tail -2 bake.txt
grep -q 'vest *48 frames .* a = 0\.105 / 0\.105 / 0\.105 m/s2' bake.txt || fail "the acceleration has not settled at 0.105 m/s2"
"$bin/followthrough" check out >check.txt || { cat check.txt; fail "the caches do not pass"; }
"$bin/followthrough" advise shot.toml | tee advice.txt
grep -q '^"vest" on "alien": one-way$' advice.txt || fail "one-way was not advised"
