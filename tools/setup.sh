# Sourced by the scripts beside it: packages, build folder, messages. Debian 12 and later; needs root or sudo
# only when a package is missing.

set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath -m "${FASTCCD_BUILD:-$root/build}")

# Where the public data are, if anywhere; absolute, since tests run elsewhere.
data=$(realpath -m "${FASTCCD_DATA:-$root/../shared/data}")
export FASTCCD_DATA=$data

say() { printf '\n== %d:%02d %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"; }

library_packages=(g++ cmake ninja-build pkg-config libtbb-dev libxsimd-dev)
tool_packages=(libcli11-dev libfmt-dev nlohmann-json3-dev libgmp-dev)
# dpkg-dev, file: for cpack; binutils: for what the libraries export; ccache: what is compiled twice.
test_packages=(libgtest-dev libeigen3-dev python3 python3-numpy dpkg-dev file binutils ccache)
bench_packages=(libbenchmark-dev)
# For tests/emulated_avx512.sh.
emulator_packages=(bochs bochs-term busybox-static cpio isolinux syslinux-common xorriso)

# install_packages NAME...: installs what is missing, and says so.
install_packages() {
  local missing=() package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null) == *'ok installed'* ]] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  say "installing packages: ${missing[*]}"
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "needs root, or sudo, for: $*" >&2
    return 1
  fi
}

# configure_and_build OPTION... -- TARGET...
configure_and_build() {
  local options=() ; while [ $# -gt 0 ] && [ "$1" != -- ]; do options+=("$1"); shift; done
  [ $# -gt 0 ] && shift
  # A folder that was configured by hand before keeps its generator, compiler and flags, but none of our options; FASTCCD_WERROR alone stays, as
  # all would be compiled anew by each of these scripts.
  local generator=() parallel=()
  [ -f "$build/CMakeCache.txt" ] || generator=(-G Ninja)
  say "configuring in $build"
  mkdir -p "$build"
  cmake -S "$root" -B "$build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release -DFASTCCD_EXACT=ON -DFASTCCD_AVX=ON -DFASTCCD_AVX512=ON \
    -DFASTCCD_INSTALL=ON -DFASTCCD_FUZZERS=OFF -DFASTCCD_SANITIZE= -DBUILD_SHARED_LIBS=OFF "${options[@]}" >"$build.configure.log" 2>&1 ||
    { cat "$build.configure.log" >&2; return 1; }
  grep -A1 'NOT TESTED' "$build.configure.log" >&2 || true
  rm -f "$build.configure.log"
  say "building"
  [ -f "$build/build.ninja" ] || parallel=(--parallel "$(nproc)")
  local log=$build.build.log command=(cmake --build "$build" "${parallel[@]}" ${1:+--target "$@"})
  # A terminal keeps its one line of progress, and somebody who sees why it ended. Elsewhere a crash of the compiler, which says nothing of the
  # code, is not to fail all tests.
  if [ -t 1 ]; then
    "${command[@]}"
  elif ! "${command[@]}" 2>&1 | tee "$log"; then
    # g++ 12 has been seen to end by a segmentation fault, on a file that it then compiled 400 times.
    local crashed=false
    if grep -q 'internal compiler error: Segmentation fault' "$log"; then crashed=true; fi
    rm "$log"
    $crashed || return 1
    say "the compiler crashed: building once more"
    "${command[@]}"
  else
    rm "$log"
  fi
}
