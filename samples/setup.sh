# Set-up shared by samples/run.sh, tests/run.sh and tests/bench/run.sh: the one list of Debian packages, and how to configure
# and build. Sourced, not run. Needs bash and apt; calls apt only when a package is missing.
# The caller sets nothing; it gets the functions below and $root, the project's top folder.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# What the program needs to build, and what the samples read.
packages_build="g++ cmake ninja-build libeigen3-dev libassimp-dev libfcl-dev libccd-dev libtbb-dev libopenvdb-dev
  libboost-dev libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev libxxhash-dev libkissfft-dev
  libjs-three libmeshoptimizer-dev libdraco-dev libpugixml-dev zlib1g-dev"
packages_samples="assimp-testmodels"
# What the tests need on top. Chromium opens the preview page. Blender, which reads our caches and is the peer of the
# benchmarks, is 500 MB: tests that want it skip when it is absent.
packages_tests="assimp-testmodels libgtest-dev chromium clang-format"
packages_clang="clang-14"
packages_bench="assimp-testmodels blender python3-numpy"

say() { printf '\n== %s\n' "$*"; }
fail() { printf '\n%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# Prints those of the given packages that are not installed.
missing_packages() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || printf '%s ' "$package"
  done
}

# install_packages NAME...: with apt, as root or through sudo, and only what is missing.
install_packages() {
  command -v dpkg-query >/dev/null || fail "this set-up is for Debian 12 and there is no dpkg here; install by hand: $*"
  local missing as_root=""
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  say "Installing with apt: $missing"
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "these packages are missing and neither root nor sudo is at hand; run as root: apt-get install $missing"
    as_root="sudo"
  fi
  $as_root apt-get update -q || fail "apt-get update failed (see above); is the network there?"
  # shellcheck disable=SC2086
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing ||
    fail "apt-get could not install: $missing(see above)"
}

# Parallel compile jobs: one per core, but no more than one per 1.5 GB of memory that is free.
job_count() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/MemAvailable/ { print int($2 / 1.5e6) }' /proc/meminfo)
  [ "${memory:-1}" -ge 1 ] || memory=1
  [ "$memory" -lt "$cores" ] && echo "$memory" || echo "$cores"
}

# build PRESET [target...]: configures into build/PRESET and builds.
build() {
  local preset=$1 launcher=()
  shift
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  say "Building preset $preset in $root/build/$preset"
  # -S and --preset: the presets are found from the project's folder, whatever the caller's.
  (cd "$root" && cmake --preset "$preset" "${launcher[@]}" >"$root/build-configure.tmp" 2>&1) || {
    cat "$root/build-configure.tmp" >&2
    rm -f "$root/build-configure.tmp"
    fail "cmake could not configure preset $preset (see above)"
  }
  rm -f "$root/build-configure.tmp"
  cmake --build "$root/build/$preset" -j "$(job_count)" ${1:+--target "$@"} || fail "the build of preset $preset failed (see above)"
}
