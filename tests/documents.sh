#!/usr/bin/env bash
# documents.sh PROGRAM: baker/SHOT_KEYS.md says of the shot file's keys what the program prints, every sample is in the gallery
# of samples/README.md and has a page of its own, and every file that a document links to or names is there.
set -euo pipefail
program=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
faults=0
fault() { echo "documents: $*" >&2; faults=1; }

# The page has a few lines of its own before the first table.
diff <(sed -n '/^### /,$p' "$root/baker/SHOT_KEYS.md") <("$program" info --shot-keys) >&2 ||
  fault "baker/SHOT_KEYS.md differs from \"followthrough info --shot-keys\" (<: the page, >: the program)"

for shot in "$root"/samples/*/shot.toml; do
  name=$(basename "$(dirname "$shot")")
  [ -f "$root/samples/$name/README.md" ] || fault "samples/$name has no README.md"
  grep -q "($name/README.md)" "$root/samples/README.md" || fault "samples/README.md does not link to $name/README.md"
done

cd "$root"
links=0
while IFS= read -r page; do
  while IFS= read -r link; do
    link=${link%%#*}
    case $link in '' | http://* | https://* | mailto:*) continue ;; esac
    links=$((links + 1))
    [ -e "$(dirname "$page")/$link" ] || fault "${page#./} links to $link, which is not there"
  done < <(grep -o '](\([^)]*\))' "$page" | sed 's/^](//; s/)$//')
done < <(find . -name '*.md' -not -path './build*' -not -path './out/*' -not -path './.*')
[ "$links" -gt 0 ] || fault "no links were found"

# Sources are named with their folders from the root, with or without an ending: `collision/check/crossings`.
names=0
while IFS=: read -r page name; do
  name=${name//\`/}
  names=$((names + 1))
  [ -e "$name" ] || [ -e "$name.h" ] || [ -e "$name.cpp" ] || compgen -G "$name" > /dev/null ||
    fault "$page names $name, which is not there"
done < <(grep -oE '`(baker|collision|io|solvers|tests|samples)/[A-Za-z0-9_/.*]+`' baker/*.md README.md samples/*.md tests/bench/*.md)
[ "$names" -gt 0 ] || fault "no sources were named"
[ "$faults" -eq 0 ] || exit 1
echo "documents: the shot reference is the program's, $links links and $names names of sources lead somewhere"
