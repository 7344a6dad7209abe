#!/usr/bin/env bash
# Bakes a sample, from nothing: installs what is missing with apt (Debian 12), builds, makes the garments, bakes, writes the
# preview page, and says where everything is.
#   samples/run.sh                  the main sample, samples/playground
#   samples/run.sh NAME...          other samples (folders of samples/), or "all"
#   samples/run.sh NAME -- ARGS...  passes ARGS to `followthrough bake`, such as --threads 1 or --force
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
source "$root/samples/bake_sample.sh"

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
build release followthrough make_garments make_set
bin=$root/build/release/bin

summary=()
for name in "${names[@]}"; do
  code=0
  run_sample "$name" "$@" || code=$?
  case $code in
    0) while IFS= read -r line; do summary+=("$line"); done < <(where_is "$name") ;;
    10) summary+=("$name: skipped, its input is not on this machine") ;;
    *) exit "$code" ;;
  esac
done
say "Done"
printf '%s\n' "${summary[@]}"
