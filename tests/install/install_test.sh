#!/usr/bin/env bash
# install_test.sh PROGRAM BUILD_FOLDER OBJ [C++ COMPILER]: installs the build into a fresh folder, builds a stranger's project
# against it, and runs both that and the installed program.
set -euo pipefail
build=$2 obj=$3 compiler=${4:-c++}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
step() { "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; echo "install: failed: $*" >&2; exit 1; }; }
step cmake --install "$build" --prefix "$work/prefix"
step "$work/prefix/bin/followthrough" --version
step cmake -S "$here" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler"
step cmake --build "$work/build"
"$work/build/consumer" "$obj"
# Nothing of what is installed may point back at where it was built.
if grep -rIl -e "$build" "$work/prefix"; then echo "install: these name the build folder" >&2; exit 1; fi
