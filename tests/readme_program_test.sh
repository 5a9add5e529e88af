#!/usr/bin/env bash
# What the README shows of embedding is what the tests build and run: programs, CMakeLists.txt and output, letter by letter.
# Argument: source folder.
set -euo pipefail
source=$1
# shown NAME: the block of code between <!-- NAME begin --> and <!-- NAME end -->.
shown() { sed -n "/<!-- $1 begin -->/,/<!-- $1 end -->/p" "$source/README.md" | sed '/^<!-- /d; /^```/d'; }
compare() {
  [ -n "$(shown "$1")" ] || { echo "FAILED: the README has no block '$1'" >&2; exit 1; }
  diff <(shown "$1") "$source/tests/consumer/$2" || { echo "FAILED: the README shows another $2" >&2; exit 1; }
}
compare "two_meshes.cpp" find_package/two_meshes.cpp
compare "CMakeLists.txt" find_package/CMakeLists.txt
compare "two_meshes output" expected.txt
compare "pairs.py" pairs.py
[ "$(grep -c . "$source/tests/consumer/find_package/two_meshes.cpp")" -le 25 ] || { echo "FAILED: the program has grown past 25 lines" >&2; exit 1; }
echo "the README shows what is tested"
