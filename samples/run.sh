#!/usr/bin/env bash
# Bakes a sample, from nothing: installs what is missing with apt (Debian 12), builds, makes the garments, bakes, writes the
# preview page, and says where everything is.
#   samples/run.sh                  the main sample, samples/playground
#   samples/run.sh NAME...          other samples (folders of samples/), or "all"
#   samples/run.sh NAME -- ARGS...  passes ARGS to `followthrough bake`, such as --threads 1 or --force
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

names=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  case $1 in
    -h | --help) sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    all) for shot in "$root"/samples/*/shot.toml; do names+=("$(basename "$(dirname "$shot")")"); done ;;
    *) names+=("$1") ;;
  esac
  shift
done
[ "${1:-}" != -- ] || shift
[ ${#names[@]} -gt 0 ] || names=(playground)
for name in "${names[@]}"; do
  [ -f "$root/samples/$name/shot.toml" ] ||
    fail "there is no sample \"$name\"; there are: $(cd "$root/samples" && ls -d ./*/shot.toml | sed 's,^\./,,; s,/shot.toml,,' | tr '\n' ' ')"
done

# shellcheck disable=SC2086
install_packages $packages_build $packages_samples
build release followthrough make_garments
bin=$root/build/release/bin

# run_sample NAME [bake arguments]: 0 done, 10 skipped because a file that is not ours is absent.
run_sample() {
  local name=$1 folder=$root/samples/$1 out=$root/out/$1
  shift
  if [ -f "$folder/needs.txt" ]; then
    while IFS= read -r file; do
      [ -z "$file" ] || (cd "$folder" && [ -e "$file" ]) || { say "Skipped sample $name: it reads $file, which is not on this machine"; return 10; }
    done <"$folder/needs.txt"
  fi
  if [ -f "$folder/garments.sh" ]; then
    say "Making the garments of sample $name"
    (cd "$folder" && make_garments=$bin/make_garments bash -euo pipefail garments.sh) || fail "the garments of $name could not be made (see above)"
  fi
  say "Baking sample $name into $out"
  "$bin/followthrough" bake "$folder/shot.toml" --out "$out" "$@" || fail "the bake of $name ended with exit code $? (see above)"
  say "Writing the preview page"
  "$bin/followthrough" preview "$out" -o "$out/preview.html" || fail "the preview of $name could not be written (see above)"
}

summary=()
for name in "${names[@]}"; do
  code=0
  run_sample "$name" "$@" || code=$?
  case $code in
    0) summary+=("$name: caches in $root/out/$name" "    $(cd "$root/out/$name" && ls ./*.abc ./*.pc2 2>/dev/null | sed 's,^\./,,' | tr '\n' ' ')"
                 "    preview page: file://$root/out/$name/preview.html") ;;
    10) summary+=("$name: skipped, its input is not on this machine") ;;
    *) exit "$code" ;;
  esac
done
say "Done"
printf '%s\n' "${summary[@]}"
