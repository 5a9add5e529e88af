#!/usr/bin/env bash
# Does a program end with this status and print this? (ctest looks at the one or at the other.)
#
#   tests/says.sh STATUS REGEX PROGRAM [ARGUMENT...]
set -euo pipefail
wanted=$1 regex=$2
shift 2
status=0
printed=$("$@" 2>&1) || status=$?
printf '%s\n' "$printed"
[ "$status" -eq "$wanted" ] || { echo "status $status instead of $wanted"; exit 1; }
grep -qE -- "$regex" <<<"$printed" || { echo "it does not print $regex"; exit 1; }
