#!/usr/bin/env bash
# Sets everything up, builds with warnings as errors, runs all tests. Arguments go to ctest.
source "$(dirname "$0")/setup.sh"
install_packages "${library_packages[@]}" "${tool_packages[@]}" "${test_packages[@]}" "${bench_packages[@]}"
configure_and_build -DFASTCCD_TOOLS=ON -DFASTCCD_TESTS=ON -DFASTCCD_BENCHMARKS=ON -DFASTCCD_WERROR=ON

data=${FASTCCD_DATA:-$root/../shared/data}
[ -d "$data" ] || printf '\n!! No data folder at %s: the tests on public data SKIP. Set FASTCCD_DATA.\n' "$data"
say "testing"
ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)" "$@"
