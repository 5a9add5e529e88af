#!/usr/bin/env bash
# Sets everything up, builds, runs the benchmarks, records the medians and prints them as tables.
#
#   tools/bench.sh                 everything that is run by default; writes bench/results/<cpu>-<isa>.json and the tables beside it
#   tools/bench.sh --quick         few and short; the record stays in the build folder
#   tools/bench.sh --filter REGEX  only benchmarks of such names, out of all there are; the record stays in the build folder
source "$(dirname "$0")/setup.sh"

quick=false
filter=
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=true ;;
    --filter) filter=${2:?--filter needs a regular expression}; shift ;;
    *) sed -n '4,6s/^# *//p' "$0" >&2; exit 2 ;;
  esac
  shift
done

# Other libraries to compare with. Whatever else is wrong with them must not keep the benchmarks from running.
peer_packages=(libfcl-dev libbullet-dev)
install_packages "${library_packages[@]}" "${tool_packages[@]}" "${bench_packages[@]}" python3
install_packages "${peer_packages[@]}" || echo "going on without ${peer_packages[*]}" >&2
programs=(narrow_phase_bench stage_bench peers_bench)
configure_and_build -DFASTCCD_TOOLS=ON -DFASTCCD_TESTS=OFF -DFASTCCD_BENCHMARKS=ON -- "${programs[@]}"

[ -d "$data" ] || printf '\n!! No data folder at %s: the public scenes are left out. Set FASTCCD_DATA.\n' "$data"

# So many times all of them, not each so many times in a row: medians are of as many minutes, as a shared machine has bad ones, and of as many
# processes, as buffers keep good or bad pages for the life of one (bench/README.md).
rounds=5
options=(--benchmark_min_time=0.2)
if $quick; then
  rounds=3
  options=(--benchmark_min_time=0.02)
  filter=${filter:-'/(random|generated|cloth-ball)/(blocked|indexed)/double/threads:1/|^stage/.*/random$|^peer/.*/random/'}
fi
commit=$(git -C "$root" describe --always --dirty 2>/dev/null || echo unknown)
options+=(--benchmark_enable_random_interleaving=true "--benchmark_context=commit=$commit" --benchmark_out_format=json)

runs=()
run_all() { # NAME: the benchmarks of a program
  local program=$1 names group out status=0
  names=$("$build/bench/$program" ${filter:+"--benchmark_filter=$filter"} --benchmark_list_tests 2>"$build/bench/$program.log") || status=$?
  [ $status -ne 3 ] || return 0  # no name that the filter matches
  [ $status -eq 0 ] || { cat "$build/bench/$program.log" >&2; exit 1; }
  # What is compared with one another takes turns, so that a bad second of the machine is one of all.
  while read -r group; do
    out=$build/bench/run_${#runs[@]}.json
    "$build/bench/$program" "${options[@]}" "--benchmark_filter=$group" "--benchmark_out=$out" 2>"$out.log" </dev/null |
      grep --line-buffered / || { cat "$out.log" >&2; exit 1; }
    runs+=("$out")
  done < <(python3 "$root/bench/report.py" groups <<<"$names")
}
for ((round = 1; round <= rounds; ++round)); do
  say "round $round of $rounds"
  for program in "${programs[@]}"; do run_all "$program"; done
done
[ ${#runs[@]} -gt 0 ] || { echo "no benchmark has a name that matches $filter" >&2; exit 1; }

results=$root/bench/results
[ -z "$filter" ] || results=$build/bench/results
record=$(python3 "$root/bench/report.py" merge "$results" "${runs[@]}")
say "$record"
python3 "$root/bench/report.py" table "$record"
[ -n "$filter" ] || python3 "$root/bench/report.py" readme
