#!/usr/bin/env bash
# Every weak symbol of the kernels' object for an instruction set carries that instruction set in its name.
# Otherwise the linker could keep code with wide instructions for everybody. Arguments: the ISA, its object file.
set -euo pipefail
isa=$1
object=$2
weak=$(nm --defined-only "$object" | awk '$2 ~ /^[wWvVu]$/ { print $3 }')
# DW.ref.* is a pointer of the exception tables, not code.
foreign=$(printf '%s\n' "$weak" | grep -v "${isa}_lanes" | grep -v '^DW\.ref\.' | grep -v '^$' || true)
if [ -n "$foreign" ]; then
  echo "$object defines weak symbols that other translation units may share:" >&2
  printf '%s\n' "$foreign" | c++filt >&2
  exit 1
fi
table=$(nm --defined-only "$object" | grep -c "${isa}_lanes5table" || true)
if [ "$table" -ne 1 ]; then
  echo "$object does not define the kernel table of $isa" >&2
  exit 1
fi
echo "$isa: $(printf '%s\n' "$weak" | grep -c "${isa}_lanes" || true) weak symbols, all its own"
