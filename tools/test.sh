#!/usr/bin/env bash
# Sets everything up, builds with warnings as errors, runs all tests.
#
#   tools/test.sh [ARGUMENT...]   arguments go to ctest
#   tools/test.sh --all           and then: sanitizers, short fuzzing, an emulated x86-64 without AVX, one with AVX-512 if this one has
#                                 none, an emulated arm64, races, clang 19
source "$(dirname "$0")/setup.sh"

all=false
if [ "${1:-}" = --all ]; then
  all=true
  shift
fi

install_packages "${library_packages[@]}" "${tool_packages[@]}" "${test_packages[@]}" "${bench_packages[@]}"
# To look at the page of `fastccd report`; without it one test skips.
install_packages chromium || printf '\n!! No chromium: the page of the report is NOT LOOKED AT.\n' >&2
# For subdirectory_test, which builds the library once more within another project, with the same commands for most of it.
export CMAKE_CXX_COMPILER_LAUNCHER=ccache
CCACHE_DIR=$(realpath -m "$build")/ccache
export CCACHE_DIR
configure_and_build -DFASTCCD_TOOLS=ON -DFASTCCD_TESTS=ON -DFASTCCD_BENCHMARKS=ON -DFASTCCD_WERROR=ON

[ -d "$data" ] || printf '\n!! No data folder at %s: the tests on public data SKIP. Set FASTCCD_DATA.\n' "$data"
say "testing"
ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" "$@"
# A test that skips has passed, for ctest.
skipped=$(grep -ahoE '(NO DATA|NO BROWSER|NOT TESTED).*' "$build/Testing/Temporary/LastTest.log" | sort | uniq -c || true)
[ -z "$skipped" ] || printf '\n!! Not all was tested; how often that was said, and what:\n%s\n' "$skipped"
$all || exit 0

unset CMAKE_CXX_COMPILER_LAUNCHER CCACHE_DIR
source "$root/tools/test_all.sh"
install_for_all
test_sanitized_and_fuzz
test_other_machines  # emulated, what runs beside takes longest
test_races
test_other_compiler
finish_beside
say "all passed"
