#!/usr/bin/env bash
# fastccd inside another project: builds with oneTBB and xsimd alone, here also without the kernels for AVX, asks the consumer for nothing, and
# is a shared library if that project sets BUILD_SHARED_LIBS. Arguments: source folder, C++ compiler.
set -euo pipefail
source=$1 cxx=$2
tests=$source/tests
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "$*"; }; }

# build_with BUILD_SHARED_LIBS: in one folder for both, as few objects differ; by the commands of tools/test.sh, for ccache: hence the warnings.
build_with() {
  quietly env CXX="$cxx" cmake -S "$tests/consumer/add_subdirectory" -B "$work/build" -DFASTCCD_SOURCE="$source" -DFASTCCD_AVX=OFF \
    -DFASTCCD_WERROR=ON -DBUILD_SHARED_LIBS="$1"
  quietly cmake --build "$work/build"
  "$work/build/two_meshes" | diff "$tests/consumer/expected.txt" -
}
needs_library() { objdump -p "$work/build/two_meshes" | grep 'NEEDED *libfastccd' >/dev/null; }

build_with OFF
if grep -E '^(GMP|GTest|CLI11|fmt|nlohmann_json|benchmark|Eigen3)' "$work/build/CMakeCache.txt"; then
  fail "the library alone looked for more than oneTBB and xsimd"
fi
nm -C "$work/build/fastccd/libfastccd.a" >"$work/symbols"
if grep -E 'avx(2|512)_lanes' "$work/symbols"; then
  fail "kernels for AVX in a build without"
fi
if needs_library; then fail "a shared library without BUILD_SHARED_LIBS"; fi
build_with ON
needs_library || fail "no shared library with BUILD_SHARED_LIBS"
echo "builds as part of another project, static and shared"
