#!/usr/bin/env bash
# The shared library exports what exported_symbols.txt lists: no more, no less. Whoever changes the list changes the binary
# interface, and its version with it. Arguments: shared library, list.
set -euo pipefail
export LC_ALL=C
nm --dynamic --demangle --defined-only "$1" | sed -E 's/^[0-9a-f]+ [A-Z] //' | sort -u |
  diff <(grep -v '^#' "$2" | sort -u) - || { echo "FAILED: < is listed and not exported, > is exported and not listed" >&2; exit 1; }
soname=$(readelf --dynamic "$1" | sed -n 's/.*SONAME.*\[\(.*\)\]/\1/p')
[[ $soname =~ ^libfastccd\.so\.0\.[0-9]+$ ]] || { echo "FAILED: soname $soname" >&2; exit 1; }
echo "exports as listed, soname $soname"
