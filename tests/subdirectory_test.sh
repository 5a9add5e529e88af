#!/usr/bin/env bash
# fastccd inside another project: builds with oneTBB and xsimd alone, here also without the kernels for AVX, and asks the
# consumer for nothing. Arguments: source folder, C++ compiler, and whether BUILD_SHARED_LIBS is on.
set -euo pipefail
source=$1 cxx=$2 shared=$3
tests=$source/tests
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; echo "FAILED: $*" >&2; exit 1; }; }

quietly env CXX="$cxx" cmake -S "$tests/consumer/add_subdirectory" -B "$work/build" -DFASTCCD_SOURCE="$source" -DFASTCCD_AVX=OFF \
  -DBUILD_SHARED_LIBS="$shared"
if grep -E '^(GMP|GTest|CLI11|fmt|nlohmann_json|benchmark|Eigen3)' "$work/build/CMakeCache.txt"; then
  echo "FAILED: the library alone looked for more than oneTBB and xsimd" >&2
  exit 1
fi
quietly cmake --build "$work/build"
"$work/build/two_meshes" | diff "$tests/consumer/expected.txt" -
if nm -C "$work/build/fastccd/libfastccd.a" 2>/dev/null | grep -E 'avx(2|512)_lanes'; then
  echo "FAILED: kernels for AVX in a build without" >&2
  exit 1
fi
echo "builds as part of another project, BUILD_SHARED_LIBS=$shared"
