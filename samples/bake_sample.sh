# How a sample is baked. Sourced by samples/run.sh, which sets $root (with the folders samples/ and out/ in it), $bin, and the
# functions say and fail.
#   samples/NAME/needs.txt      files that it reads and that are not ours; without them it is skipped
#   samples/NAME/garments.sh    makes its garments, and the set where that is ours, too
#   samples/NAME/variants.txt   bakes of one shot, to be seen beside each other: VARIANT [bake arguments] on each line

# Lines of variants.txt without comments; nothing for a sample that is one bake.
variants_of() {
  [ ! -f "$root/samples/$1/variants.txt" ] || grep -Ev '^[[:space:]]*(#|$)' "$root/samples/$1/variants.txt"
}

# bake_folders NAME: where its bakes go, one a line.
bake_folders() {
  local variants
  variants=$(variants_of "$1")
  if [ -z "$variants" ]; then echo "$root/out/$1"; else awk -v out="$root/out/$1" '{ print out "/" $1 }' <<<"$variants"; fi
}

# bake_one NAME FOLDER [bake arguments]
bake_one() {
  local name=$1 out=$2
  shift 2
  say "Baking sample $name into $out"
  "$bin/followthrough" bake "$root/samples/$name/shot.toml" --out "$out" "$@" || fail "the bake of $name ended with exit code $? (see above)"
}

# run_sample NAME [bake arguments]: 0 done, 10 skipped because a file that is not ours is absent.
run_sample() {
  local name=$1 folder=$root/samples/$1 file variant arguments folders
  shift
  if [ -f "$folder/needs.txt" ]; then
    while IFS= read -r file; do
      [ -z "$file" ] || (cd "$folder" && [ -e "$file" ]) || { say "Skipped sample $name: it reads $file, which is not on this machine"; return 10; }
    done <"$folder/needs.txt"
  fi
  if [ -f "$folder/garments.sh" ]; then
    say "Making the garments of sample $name"
    (cd "$folder" && make_garments=$bin/make_garments make_set=$bin/make_set bash -euo pipefail garments.sh) ||
      fail "the garments of $name could not be made (see above)"
  fi
  mapfile -t folders < <(bake_folders "$name")
  if [ ! -f "$folder/variants.txt" ]; then
    bake_one "$name" "${folders[0]}" "$@"
  else
    while read -r variant arguments; do
      # shellcheck disable=SC2086
      bake_one "$name" "$root/out/$name/$variant" $arguments "$@" </dev/null
    done < <(variants_of "$name")
  fi
  say "Writing the preview page"
  "$bin/followthrough" preview "${folders[@]}" -o "$root/out/$name/preview.html" || fail "the preview of $name could not be written (see above)"
}

# where_is NAME: what there is now, for people.
where_is() {
  local name=$1 folders folder
  mapfile -t folders < <(bake_folders "$name")
  for folder in "${folders[@]}"; do
    echo "$name: caches in $folder"
    echo "    $(cd "$folder" && ls ./*.abc ./*.pc2 2>/dev/null | sed 's,^\./,,' | tr '\n' ' ')"
    [ "$folder" = "${folders[0]}" ] || { # what became of the primary and of the forces, beside the first
      echo "    a: $(basename "${folders[0]}"), b: $(basename "$folder")"
      "$bin/followthrough" compare "${folders[0]}" "$folder" | grep -E '^(primary|force) ' | sed 's/^/    /' || true
    }
  done
  echo "    preview page: file://$root/out/$name/preview.html"
}
