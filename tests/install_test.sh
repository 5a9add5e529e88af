#!/usr/bin/env bash
# The installed package as its users meet it: found by CMake (shared and static) and by pkg-config, from C++ and C, and the
# program of the README prints the contacts it should. Arguments: build folder, C++ compiler, C compiler.
set -euo pipefail
build=$1 cxx=$2 cc=$3
tests=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix

fail() { echo "FAILED: $*" >&2; exit 1; }
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "$*"; }; }
run() {
  "$@" >"$work/output" || fail "$*"
  diff "$tests/consumer/expected.txt" "$work/output" || fail "$* printed something else"
}

quietly cmake --install "$build" --prefix "$prefix"
mv "$prefix" "$work/moved"  # an installation may be moved
prefix=$work/moved

for consumer in find_package find_package_static; do
  quietly env CXX="$cxx" cmake -S "$tests/consumer/$consumer" -B "$work/$consumer" -DCMAKE_PREFIX_PATH="$prefix"
  quietly cmake --build "$work/$consumer"
  run "$work/$consumer/two_meshes"
done
# Whole outputs: with pipefail a `grep -q` that leaves early may fail what still writes to it.
linked=$(ldd "$work/find_package/two_meshes") linked_static=$(ldd "$work/find_package_static/two_meshes")
[[ $linked == *libfastccd.so*"$prefix"* ]] || fail "find_package did not link the installed shared library: $linked"
[[ $linked_static != *libfastccd* ]] || fail "find_package with COMPONENTS static linked the shared library"

# Both at once, each by its own name; the first is fastccd::fastccd.
mkdir "$work/both"
cat >"$work/both/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.22)
project(both LANGUAGES CXX)
find_package(fastccd 0.1 REQUIRED COMPONENTS static shared)
foreach(linkage IN ITEMS static shared)
  if(NOT TARGET fastccd::${linkage})
    message(FATAL_ERROR "there is no fastccd::${linkage}")
  endif()
endforeach()
get_target_property(aliased fastccd::fastccd ALIASED_TARGET)
if(NOT aliased STREQUAL fastccd::static)
  message(FATAL_ERROR "fastccd::fastccd is ${aliased}")
endif()
END
quietly env CXX="$cxx" cmake -S "$work/both" -B "$work/both/build" -DCMAKE_PREFIX_PATH="$prefix"

# Without oneTBB's development files there is no static library, and if it was optional, no error.
mkdir "$work/without_tbb"
cat >"$work/without_tbb/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.22)
project(without_tbb LANGUAGES CXX)
set(CMAKE_DISABLE_FIND_PACKAGE_TBB ON)
find_package(fastccd 0.1 REQUIRED COMPONENTS shared OPTIONAL_COMPONENTS static)
get_target_property(aliased fastccd::fastccd ALIASED_TARGET)
if(fastccd_static_FOUND OR TARGET fastccd::static OR NOT aliased STREQUAL fastccd::shared)
  message(FATAL_ERROR "fastccd::fastccd is ${aliased}, and the static library is there without oneTBB")
endif()
find_package(fastccd 0.1 QUIET COMPONENTS static)
if(fastccd_FOUND)
  message(FATAL_ERROR "the static library without oneTBB")
endif()
find_package(fastccd 0.1 REQUIRED OPTIONAL_COMPONENTS static)
END
quietly env CXX="$cxx" cmake -S "$work/without_tbb" -B "$work/without_tbb/build" -DCMAKE_PREFIX_PATH="$prefix"

# Another version, or a component that is not there, is refused.
mkdir "$work/refused"
for wanted in "9.0" "0.0.1" "0.1 COMPONENTS no_such_component"; do
  printf 'cmake_minimum_required(VERSION 3.22)\nproject(refused LANGUAGES CXX)\nfind_package(fastccd %s REQUIRED)\n' "$wanted" >"$work/refused/CMakeLists.txt"
  rm -rf "$work/refused/build"
  if env CXX="$cxx" cmake -S "$work/refused" -B "$work/refused/build" -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1; then
    fail "find_package(fastccd $wanted) was accepted"
  fi
done
grep -q "there is no component 'no_such_component'" "$work/log" || fail "the component that is not there is not named: $(cat "$work/log")"

# The static library is for projects with C++: in C alone nothing would link the standard library.
cat >"$work/refused/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.22)
project(c_alone LANGUAGES C)
find_package(fastccd 0.1 QUIET COMPONENTS static)
if(fastccd_FOUND OR TARGET fastccd::fastccd)
  message(FATAL_ERROR "the static library without C++")
endif()
find_package(fastccd 0.1 REQUIRED COMPONENTS shared OPTIONAL_COMPONENTS static)
get_target_property(aliased fastccd::fastccd ALIASED_TARGET)
if(fastccd_static_FOUND OR NOT aliased STREQUAL fastccd::shared)
  message(FATAL_ERROR "fastccd::fastccd is ${aliased}")
endif()
find_package(fastccd 0.1 REQUIRED COMPONENTS static)
END
rm -rf "$work/refused/build"
if env CC="$cc" cmake -S "$work/refused" -B "$work/refused/build" -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1; then
  fail "find_package with COMPONENTS static was accepted without C++"
fi
grep -q "enable_language(CXX)" "$work/log" || fail "what the static library needs is not said: $(cat "$work/log")"

# pkg-config: the shared library, then the static one with what it needs.
# Alone: whoever has no development files of oneTBB and GMP can link the shared library.
PKG_CONFIG_LIBDIR=$(dirname "$(find "$prefix" -name fastccd.pc)")
export PKG_CONFIG_LIBDIR
eval "library=$(pkg-config --variable=libdir fastccd)"
export LD_LIBRARY_PATH=$library
program=$tests/consumer/find_package/two_meshes.cpp
eval "shared=($(pkg-config --cflags --libs fastccd))"  # blanks in paths come quoted
quietly "$cxx" -std=c++20 -Wall -Wextra -Wpedantic -Werror "$program" "${shared[@]}" -o "$work/by_pkg_config"
run "$work/by_pkg_config"
quietly "$cc" -std=c99 -Wall -Wextra -pedantic -Werror "$tests/c_interface_test.c" "${shared[@]}" -lm -o "$work/in_c"
quietly "$work/in_c"
eval "static=($(pkg-config --cflags fastccd) $(pkg-config --static --libs fastccd | sed 's/-lfastccd/-l:libfastccd.a/'))"
unset LD_LIBRARY_PATH
quietly "$cxx" -std=c++20 "$program" "${static[@]}" -o "$work/static_by_pkg_config"
run "$work/static_by_pkg_config"
quietly "$cc" -std=c99 "$tests/c_interface_test.c" "${static[@]}" -o "$work/static_in_c"
quietly "$work/static_in_c"
[ "$(pkg-config --modversion fastccd)" = "$(sed -n 's/#define FASTCCD_VERSION "\(.*\)"/\1/p' "$prefix/include/fastccd/version.h")" ] ||
  fail "fastccd.pc and version.h name different versions"

# Simulators may be built without exceptions and run-time types.
quietly "$cxx" -std=c++20 -fno-exceptions -fno-rtti -Wall -Wextra -Werror "$program" "${shared[@]}" -o "$work/without_exceptions"
LD_LIBRARY_PATH=$library run "$work/without_exceptions"

# Each header stands alone, under a consumer's warnings; nothing leaks of how the library is built.
echo 'typedef int something;' >"$work/something.c"
for header in $(cd "$prefix/include" && find fastccd -type f); do
  case $header in
    *.h) quietly "$cc" -x c -std=c99 -Wall -Wextra -pedantic -Werror -fsyntax-only -I"$prefix/include" -include "$header" "$work/something.c" ;;
  esac
  quietly "$cxx" -x c++ -std=c++20 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -I"$prefix/include" \
    -isystem /usr/include/eigen3 -include "$header" "$work/something.c"
done
grep -rnE '#include <(tbb|oneapi|xsimd|CLI|gmp)|(tbb|xsimd|mpz)[_:]' "$prefix/include" && fail "a public header names what is ours alone"
grep -rlE 'Eigen(::|/)' "$prefix/include" | grep -vE '/eigen\.hpp$|/adapters/' && fail "Eigen outside its adapters"
grep -rnE -- '-m(arch|tune|avx|sse|fma)|-ffp|-O[0-9]|-W' "$PKG_CONFIG_LIBDIR" "$library/cmake" && fail "compiler options of the library reach its users"
grep -rnF -- "$build" "$library/cmake" "$PKG_CONFIG_LIBDIR" && fail "the installation names its build folder"
echo "the installed package works for CMake, shared and static, pkg-config, C++ and C"
