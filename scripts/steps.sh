# What ./quickstart and ./check share. Sourced by bash, with the repository's root as working directory.
# Everything said here goes to standard error: standard output is for results.

# The Debian packages of each step; nothing is installed that the chosen step does not need.
packages_to_build="g++ cmake ninja-build libeigen3-dev libboost-dev libgmp-dev libflint-dev nlohmann-json3-dev libfmt-dev libcli11-dev zlib1g-dev"
packages_to_learn="libtorch-dev libopenblas0-pthread"
packages_to_test="libgtest-dev librapidcheck-dev python3 coq libcoq-mathcomp-algebra"
packages_to_check_fully="clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev libbenchmark-dev"

say() { printf '== %s\n' "$*" >&2; }

# need PACKAGE...: installs by apt-get those that dpkg does not know as installed; does nothing, and needs no network,
# when there are none. MAXIMIN_NO_INSTALL=1 leaves it out, for machines whose tools come from elsewhere.
need() {
  local package missing=() as_root=()
  [ "${MAXIMIN_NO_INSTALL:-}" = 1 ] && return 0
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    say "not a Debian system: going on with what is installed (needed, by their Debian names: $*)"
    return 0
  fi
  for package; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  say "installing ${missing[*]}"
  "${as_root[@]}" apt-get -qq -o Acquire::Retries=3 update >&2 || say "apt-get update failed, trying with the old lists"
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Acquire::Retries=3 -o Dpkg::Use-Pty=0 \
    install --yes --no-install-recommends "${missing[@]}" >&2; then
    say "FAILED: apt-get could not install ${missing[*]}; install them by hand and run this again"
    return 1
  fi
}

# build PRESET [cmake option...] [-- target...]: configures and builds, quietly unless something is wrong.
build() {
  local preset=$1 options=() targets=()
  shift
  while [ $# -gt 0 ] && [ "$1" != -- ]; do
    options+=("$1")
    shift
  done
  [ $# -gt 0 ] && shift && targets=(--target "$@")
  # All at once, sources are compiled several to a unit: a third of the time. Whoever works on the code builds them apart.
  cmake --preset "$preset" -DCMAKE_UNITY_BUILD=ON "${options[@]}" >"build/$preset.configure.log" 2>&1 || {
    cat "build/$preset.configure.log" >&2
    return 1
  }
  cmake --build "build/$preset" --parallel "$(jobs_that_fit)" "${targets[@]}" >&2
}

# How many compilers run at once: one per core, and 1 GiB of memory for each.
jobs_that_fit() {
  local cores memory
  cores=$(env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc)  # which they would mislead
  memory=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo 2>/dev/null || echo "$cores")
  [ "${memory:-0}" -lt 1 ] && memory=1
  echo $((memory < cores ? memory : cores))
}
