#!/usr/bin/env bash
# Files that once broke readers of their kind, or are made to: the program says what is wrong and ends with an exit code of
# its own, 2 or 3, or reads the file; it never crashes, hangs, or reports a fault of its own (70).
#   crashers.sh PROGRAM
set -uo pipefail
program=$1
folder=$(cd "$(dirname "${BASH_SOURCE[0]}")/data/crashers" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0 count=0
tell() { echo "$1"; failed=1; }
run() { # FILE expected-codes command...
  local file=$1 code=0
  shift
  timeout 60 "$@" >"$scratch/out" 2>&1 || code=$?
  count=$((count + 1))
  case $code in
    0 | 2 | 3) ;;
    *) tell "$(basename "$file"): exit code $code of: ${*##*/}"; sed -n '1,3p' "$scratch/out" ;;
  esac
  if [ $code -ne 0 ] && [ ! -s "$scratch/out" ]; then tell "$(basename "$file"): nothing was said"; fi
}
for file in "$folder"/*; do
  case $file in
    *.toml) run "$file" "$program" bake "$file" --out "$scratch/bake" --dry-run ;;
    *) run "$file" "$program" info "$file" ;;
  esac
done
[ $count -ge 20 ] || tell "only $count files were tried"
[ $failed -eq 0 ] && echo "$count files, no crash"
exit $failed
