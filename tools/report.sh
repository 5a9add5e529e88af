#!/usr/bin/env bash
# Sets everything up, builds, and writes a report of speed against error on this machine: a page, pictures, figures as JSON.
#
#   tools/report.sh [--quick] [--out DIR] [--pairs N] [--data DIR] [ARGUMENT...]   arguments go to `fastccd report`
#   tools/report.sh --record   into bench/results/report, public data included, and its table into README.md
#
# 3 to 10 minutes on two cores, with --quick about one, and two more for building. Default folder: build/report.
source "$(dirname "$0")/setup.sh"

record=false
if [ "${1:-}" = --record ]; then
  record=true
  shift
  [ -d "$data" ] || { echo "no data folder at $data: what is recorded includes public data; set FASTCCD_DATA" >&2; exit 1; }
fi

# Other libraries to compare with. Whatever else is wrong with them must not keep the report from being made.
peer_packages=(libfcl-dev libbullet-dev)
install_packages "${library_packages[@]}" "${tool_packages[@]}"
install_packages "${peer_packages[@]}" || echo "going on without ${peer_packages[*]}" >&2
configure_and_build -DFASTCCD_TOOLS=ON -DFASTCCD_PEERS=ON -DFASTCCD_TESTS=OFF -DFASTCCD_BENCHMARKS=OFF -- fastccd_command

arguments=()
[[ " $* " == *" --out"* ]] || arguments+=(--out "$build/report")
if $record; then
  install_packages python3
  arguments=(--out "$root/bench/results/report")
  arguments+=(--data "$data")
fi
say "measuring"
"$build/fastccd" report "${arguments[@]}" "$@"
if $record; then python3 "$root/bench/fill_readme.py"; fi
