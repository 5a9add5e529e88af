#!/usr/bin/env bash
# Every weak symbol of the kernels' objects for an instruction set carries that instruction set in its name.
# Otherwise the linker could keep code with wide instructions for everybody. Arguments: the ISA, its object files.
set -euo pipefail
isa=$1
shift
# Of each of several files nm gives the name, too, in a line of one word.
weak=$(nm --defined-only "$@" | awk '$2 ~ /^[wWvVu]$/ { print $3 }')
# DW.ref.* is a pointer of the exception tables, not code.
foreign=$(printf '%s\n' "$weak" | grep -v "${isa}_lanes" | grep -v '^DW\.ref\.' | grep -v '^$' || true)
if [ -n "$foreign" ]; then
  echo "$* define weak symbols that other translation units may share:" >&2
  printf '%s\n' "$foreign" | c++filt >&2
  exit 1
fi
table=$(nm --defined-only "$@" | grep -c "${isa}_lanes5table" || true)
if [ "$table" -ne 1 ]; then
  echo "$* define $table kernel tables of $isa, not one" >&2
  exit 1
fi
echo "$isa: $(printf '%s\n' "$weak" | grep -c "${isa}_lanes" || true) weak symbols, all its own"
