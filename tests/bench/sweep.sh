#!/usr/bin/env bash
# Bakes every clip of every character in ../shared/assets/characters and ../shared/assets/mocap, and a half of all clips on
# characters that they were not made for, each with a skirt pinned at the waist and a top of about 4000 vertices each. What is
# no body for a skirt wears a sheet, held along the middle of its back or above its head.
#   tests/bench/sweep.sh [OPTIONS] [CHARACTER ...]
# CHARACTER      only what these wear (names as --list has them, or their beginnings)
# --tenth        a tenth of all bakes, drawn by lot
# --clip PATTERN only bakes whose name matches (an extended regular expression)
# --list         says what there is to bake, and ends
# --frames N     of each clip (48); of a longer clip a part is played that is drawn by lot
# --seed N       of all that is drawn by lot (1)
# --jobs N       bakes at a time (2), each with one thread
# --timeout S    seconds of CPU that a bake may take (900); what takes longer is unfinished
# --out DIR      where all goes (out/sweep): rows.tsv, table.txt, and of each bake its shot, its log, its folder. Caches of
#                bakes with nothing to look at are removed; --keep keeps them
# --force        bakes again what has a row in DIR already; without it a sweep goes on where it ended
# --pictures DIR pictures of the worst frames of the ten worst bakes
# --bin DIR      programs to use; without it they are built
# Needs the assets in ../shared/assets (or FOLLOWTHROUGH_ASSETS). The last line is "RESULT scene=sweep bakes=.. clean=.. ...".
# Exit code 0: all bakes came to their end with exit code 0; 1: not all did.
set -euo pipefail
{ # read to its end before it runs: it takes hours, in which this file may change
source "$(dirname "${BASH_SOURCE[0]}")/../../samples/setup.sh"

usage() { sed -n '2,23s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }
tenth="" pattern="" list_only="" frames=48 seed=1 jobs=2 limit=900 out=$root/out/sweep keep="" force="" pictures="" bin=""
characters=()
while [ $# -gt 0 ]; do
  case $1 in
    --clip | --frames | --seed | --jobs | --timeout | --out | --pictures | --bin) [ $# -gt 1 ] || fail "$1 needs a value" ;;&
    -h | --help) usage; exit 0 ;;
    --tenth) tenth=1 ;;
    --list) list_only=1 ;;
    --keep) keep=1 ;;
    --force) force=1 ;;
    --clip) pattern=$2; shift ;;
    --frames) frames=$2; shift ;;
    --seed) seed=$2; shift ;;
    --jobs) jobs=$2; shift ;;
    --timeout) limit=$2; shift ;;
    --out) out=$2; shift ;;
    --pictures) pictures=$2; shift ;;
    --bin) bin=$2; shift ;;
    -*) fail "what is \"$1\"?" ;;
    *) characters+=("$1") ;;
  esac
  shift
done

assets=${FOLLOWTHROUGH_ASSETS:-$root/../shared/assets}
[ -d "$assets/characters" ] || fail "the characters are not at $assets; set FOLLOWTHROUGH_ASSETS"
assets=$(cd "$assets" && pwd)
if [ -z "$bin" ]; then
  # shellcheck disable=SC2086
  install_packages $packages_build $packages_tests
  build release followthrough make_garments sweep_tool
  bin=$root/build/release/bin
fi
bin=$(cd "$bin" && pwd)
mkdir -p "$out"/{bakes,garments,import,rows}
out=$(cd "$out" && pwd)

# The list: all, then what was asked for.
if ! "$bin/sweep_tool" list "$assets" "$seed" "$frames" "$out" "$out/all.tsv" >"$out/list.log"; then
  cat "$out/list.log" >&2
  fail "the bakes could not be listed (see above)"
fi
selected=$(mktemp) # and not in $out: several sweeps may fill one folder
trap 'rm -f "$selected"' EXIT
awk -F '\t' -v tenth="$tenth" -v pattern="$pattern" -v characters="${characters[*]}" '
  FNR == NR { count = FNR - 1; next }
  FNR == 1 { print; next }
  tenth && FNR - 1 > (count + 9) / 10 { next }
  pattern && $1 !~ pattern { next }
  {
    wanted = characters == "" ? 1 : 0
    for (i = split(characters, names, " "); i > 0; --i) if (index($2, names[i]) == 1) wanted = 1
    if (wanted) print
  }' "$out/all.tsv" "$out/all.tsv" >"$selected"
total=$(($(wc -l <"$selected") - 1))
[ "$total" -gt 0 ] || fail "no bake is as asked for; --list says what there is"
if [ -n "$list_only" ]; then
  cat "$out/list.log"
  column -t -s $'\t' "$selected"
  exit 0
fi

# cut KIND FOLDER OPTIONS: whether there is a garment now. The tailor writes none that would start through the body or
# itself; one with needles for triangles was not made for such a body either.
cut() {
  local kind=$1 folder=$2 status=0
  shift 2
  rm -f "$folder/$kind.new.obj"
  "$bin/make_garments" "$@" --kind "$kind" --out "$folder/$kind.new.obj" >"$folder/$kind.log" 2>&1 || status=$?
  cat "$folder/$kind.log" >>"$folder/log"
  [ $status = 0 ] && sed -n 's/.*smallest angle \([0-9]\+\) degrees.*/\1/p' "$folder/$kind.log" |
    awk '$1 >= 3 { good = 1 } END { exit !good }'
}

# tailor FOLDER CHARACTER_FILE MESHES HEIGHT: skirt.obj and top.obj of about 4000 vertices each, or blanket.obj where no skirt
# can be cut. The waist is looked for lower, too, where a short body has it.
tailor() {
  local folder=$1 arguments=("$2") share waist cell count off best=1000000 mesh try
  [ "$4" = 0 ] || arguments+=(--height "$4")
  if [ "$3" != - ]; then
    for mesh in ${3//,/ }; do arguments+=(--mesh "$mesh"); done
  fi
  mkdir -p "$folder"
  : >"$folder/log"
  for share in 0 0.5 0.45; do
    waist=()
    [ $share = 0 ] || waist=(--waist $share)
    if cut skirt "$folder" "${arguments[@]}" "${waist[@]}" --rings 40 --segments 100; then
      mv "$folder/skirt.new.obj" "$folder/skirt.obj"
      break
    fi
  done
  for share in $share 0.52; do
    [ -f "$folder/skirt.obj" ] && [ ! -f "$folder/top.obj" ] || break
    waist=()
    [ $share = 0 ] || waist=(--waist $share)
    cell=0.016
    for try in 1 2 3 4 5 6; do # until it has as many vertices; some cells give no good mesh
      if cut top "$folder" "${arguments[@]}" "${waist[@]}" --cell "$cell"; then
        count=$(grep -c '^v ' "$folder/top.new.obj")
        off=$((count > 4000 ? count - 4000 : 4000 - count))
        if [ $off -lt $best ]; then best=$off; mv "$folder/top.new.obj" "$folder/top.obj"; fi
        [ $off -gt 200 ] || break
        cell=$(awk -v cell="$cell" -v count="$count" 'BEGIN { printf "%.5f", cell * sqrt(count / 4000) }')
      else
        cell=$(awk -v cell="$cell" -v try="$try" 'BEGIN { printf "%.5f", (try % 2 ? 1.31 : 0.72) * cell }')
      fi
    done
  done
  rm -f "$folder"/*.new.obj "$folder"/{skirt,top}.log
  if [ ! -f "$folder/skirt.obj" ]; then # not the body of somebody who stands on two legs
    "$bin/sweep_tool" blanket "$2" "$4" "$folder/blanket.obj" >>"$folder/log" 2>&1 ||
      { cat "$folder/log" >&2; fail "nothing can be made for $2 (see above)"; }
  fi
  touch "$folder/done"
}

worn() { # FOLDER: "skirt+top"
  local names="" garment
  for garment in skirt top blanket; do
    [ ! -f "$1/$garment.obj" ] || names+=${names:++}$garment
  done
  echo "$names"
}

say "Garments"
while IFS=$'\t' read -r character file meshes height; do
  folder=$out/garments/$character
  [ -f "$folder/done" ] || tailor "$folder" "$file" "$meshes" "$height"
  (cd "$folder" && grep -Hc '^v ' ./*.obj) | sed 's,^\./,,; s/\.obj:/ of /; s/$/ vertices/' | paste -sd, | sed "s/^/$character: /; s/,/, /"
done < <(awk -F '\t' 'FNR > 1 && !seen[$2]++ { print $2 "\t" $3 "\t" $9 "\t" $10 }' "$selected")

# bake NAME CHARACTER: leaves its row.
bake() {
  local name=$1 garments=$out/garments/$2 folder=$out/bakes/$1
  rm -rf "$folder"
  mkdir -p "$folder"
  "$bin/sweep_tool" shot "$out/all.tsv" "$name" "$garments" "$folder/$name.toml"
  "$bin/sweep_tool" run "$limit" "$folder/log" "$folder/run" \
    "$bin/followthrough" bake "$folder/$name.toml" --out "$folder/bake" --threads 1 --progress plain
  "$bin/sweep_tool" row "$name" "$folder/bake" "$folder/run" "$(worn "$garments")" >"$folder/row"
  # Nothing to look at: complete, without crossings, hardly strained.
  if [ -z "$keep" ] && awk -F '\t' '{ exit !($3 == 0 && $5 + $6 == 0 && $10 < 0.1) }' "$folder/row"; then
    rm -f "$folder"/bake/*.abc
  fi
  mv "$folder/row" "$out/rows/$name.tsv"
  awk -F '\t' '{ printf "%s: exit code %d, %d + %d crossings in %d of %d frames, p99 %.2f %%, %.3f s a frame\n", $1, $3, $5, $6, $7, $2, 100 * $10, $12 }' \
    "$out/rows/$name.tsv"
}

# children PROCESS: and theirs.
children() {
  local child
  for child in $(ps -o pid= --ppid "$1"); do
    echo "$child"
    children "$child"
  done
}
stop_all() {
  local job
  for job in $(jobs -p); do
    # shellcheck disable=SC2046
    kill "$job" $(children "$job") 2>/dev/null || true
  done
}
trap 'stop_all; exit 130' INT TERM

say "$total bakes, $jobs at a time"
number=0
while IFS=$'\t' read -r name character; do
  number=$((number + 1))
  if [ -z "$force" ] && [ -f "$out/rows/$name.tsv" ]; then continue; fi
  rm -f "$out/rows/$name.tsv"
  while [ "$(jobs -pr | wc -l)" -ge "$jobs" ]; do wait -n || true; done
  { text=$(bake "$name" "$character") && echo "[$number/$total] $text"; } &
done < <(awk -F '\t' 'FNR > 1 { print $1 "\t" $2 }' "$selected")
wait

say "The sum"
"$bin/sweep_tool" sum "$selected" "$out/rows" "$out/rows.tsv" >"$out/table.txt" || { cat "$out/table.txt" >&2; fail "the rows could not be added up"; }

if [ -n "$pictures" ]; then
  mkdir -p "$pictures"
  number=0
  while read -r name frame; do
    number=$((number + 1))
    folder=$out/bakes/$name/bake
    ls "$folder"/*.abc >/dev/null 2>&1 || continue
    "$bin/followthrough" preview "$folder" -o "$out/bakes/$name/preview.html" >"$out/bakes/$name/preview.log" 2>&1 || { cat "$out/bakes/$name/preview.log"; continue; }
    picture=$pictures/$(printf '%02d' $number)_$name.png
    timeout 120 chromium --headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
      --hide-scrollbars --window-size=1400,1000 --virtual-time-budget=8000 --screenshot="$picture" \
      "file://$out/bakes/$name/preview.html#frame=$frame" >>"$out/bakes/$name/preview.log" 2>&1 || true
    rm -f "$out/bakes/$name/preview.html"
    if [ -f "$picture" ]; then echo "$picture: frame $frame"; else echo "no picture of $name, see $out/bakes/$name/preview.log"; fi
  done < <("$bin/sweep_tool" worst "$out/rows.tsv" 10)
fi

cat "$out/table.txt"
awk -F '\t' 'FNR > 1 && $3 != 0 { bad = 1 } END { exit bad }' "$out/rows.tsv"
exit
}
