#!/usr/bin/env bash
# Does a test fail when a proof is weakened? For each mutant below, in a copy of the tree: sets a rounding error bound to
# zero, or loosens a comparison, builds, and runs the tests named until one fails. Prints mutant -> killed by. Exit 1 if
# a mutant survives. Takes a minute or two for each of some 300 on one core, hours for all.
#
#   tests/mutation.sh [PATTERN]      only mutants whose name matches the extended regular expression
#   tests/mutation.sh --check        no builds: only that each of them still changes something
set -euo pipefail

source=$(cd "$(dirname "$0")/.." && pwd)
pattern=${1:-.} check_only=false
if [ "$pattern" = --check ]; then check_only=true pattern=.; fi
work=$(mktemp -d "${TMPDIR:-/tmp}/mutants.XXXXXX")
trap 'rm -rf "$work"' EXIT
tree=$work/tree build=$work/build
mkdir "$tree"
cp -r "$source"/{CMakeLists.txt,kernels,scalar,simd,scheduler,tests} "$tree"
export FASTCCD_DATA=${FASTCCD_DATA:-$source/../shared/data}

configure() {
  # The mathematics is one text for all instruction sets: the scalar lanes alone build four times as fast.
  sed -i 's/if(CMAKE_SYSTEM_PROCESSOR MATCHES .*/if(FALSE)/; s/elseif(CMAKE_SYSTEM_PROCESSOR MATCHES .*/elseif(FALSE)/' "$tree/simd/isa_libraries.cmake"
  sed -i 's/set(optimised -O3)/set(optimised -O1)/' "$tree/simd/isa_libraries.cmake"
  cmake -S "$tree" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 \
    -DFASTCCD_TOOLS=OFF -DFASTCCD_BENCHMARKS=OFF -DFASTCCD_WERROR=OFF > "$work/cmake.log"
}

# True if the test passes. One that cannot be built, or that somebody stopped, says nothing.
passes() {
  local target=$1 status=0
  [ "$1" = stress ] && target=fastccd_stress
  if ! ninja -C "$build" -j "${JOBS:-1}" "$target" > "$work/build.log" 2>&1; then
    tail -n 20 "$work/build.log"
    echo "mutation.sh: $target does not build" >&2
    exit 2
  fi
  case $1 in
    stress) "$build/tests/fastccd_stress" --minutes 0.5 --seed 7 ;;
    *) "$build/tests/$1" --gtest_fail_fast ;;
  esac > "$work/test.log" 2>&1 || status=$?
  if [ $status -eq 130 ] || [ $status -eq 137 ] || [ $status -eq 143 ]; then
    echo "mutation.sh: $1 was stopped from outside" >&2
    exit 2
  fi
  return $status
}

survivors=0 mutants=0 dry=true
declare -A killers
# mutant NAME FILE PERL_SUBSTITUTION TEST...
mutant() {
  local name=$1 file=$tree/$2 change=$3 killer=
  shift 3
  [[ $name =~ $pattern ]] || return 0
  mutants=$((mutants + 1))
  cp -p "$file" "$work/original"
  perl -0pi -e "$change" "$file"
  if cmp -s "$file" "$work/original"; then
    echo "mutation.sh: $name: nothing in ${file#"$tree"/} matches; the mutant is out of date" >&2
    exit 2
  fi
  if $dry; then
    cp -p "$work/original" "$file"
    for test in "$@"; do
      killers[$test]=
      [ "$test" = stress ] || grep -q "^ *fastccd_add_test($test\>" "$tree/tests/CMakeLists.txt" || {
        echo "mutation.sh: $name: there is no $test without the command" >&2
        exit 2
      }
    done
    return 0
  fi
  for test in "$@"; do
    if ! passes "$test"; then
      killer=$test
      break
    fi
  done
  cp "$work/original" "$file"  # with a new time, so that it is compiled again
  if [ -n "$killer" ]; then
    printf '%-44s killed by %s\n' "$name" "$killer"
  else
    survivors=$((survivors + 1))
    printf '%-44s SURVIVES %s\n' "$name" "$*"
  fi
}

all_mutants() {
bounds=kernels/error_bound.hpp
# ---- Bounds set to zero
for name in quadratic quadratic_sum cubic linear cubic_on_interval quadratic_on_interval linear_on_interval \
            edge_function edge_function_sum area monotone_piece; do
  mutant "$name = 0" $bounds "s/(double $name\\(\\)(?: const)?\\s*\\{)\\s*return /\$1 return 0 * /" error_bounds_test
done
mutant 'quadratic_bound = 0' kernels/magnitudes.hpp 's/(\(2 \* bounds\.rho \+ 9 \+ ErrorBounds::slack\)) \* ErrorBounds::u/$1 * 0/' error_bounds_test
mutant 'cubic_bound = 0' kernels/magnitudes.hpp 's/(\(3 \* bounds\.rho \+ 18 \+ ErrorBounds::slack\)) \* ErrorBounds::u/$1 * 0/' error_bounds_test
mutant 'underflow_share = 0' kernels/magnitudes.hpp 's/underflow_share = 0x1p-40/underflow_share = 0/' error_bounds_test
mutant 'length_floor = 0' $bounds 's/length_floor = 0x1p-266/length_floor = 0/' error_bounds_test
mutant 'smallest_volume = 0' $bounds 's/smallest_volume = 0x1p-300/smallest_volume = 0/' same_bits_test certificates_test truth_test stress
mutant 'single: cubic = 0' $bounds 's/\(54 \+ 114 \+ slack\) \* single_u/0.0/' error_bounds_test
mutant 'single: quadratic = 0' $bounds 's/\(8 \+ 12 \+ slack\) \* single_u/0.0/' error_bounds_test
mutant 'single: quadratic_sum = 0' $bounds 's/\(24 \+ 56 \+ slack\) \* single_u/0.0/' error_bounds_test
mutant 'single: gap = 0' $bounds 's/\(2 \+ 2 \+ slack\) \* single_u;/0.0;/' error_bounds_test
mutant 'single: halves, cubic = 0' $bounds 's/\(216 \+ 588 \+ slack\) \* single_u/0.0/' error_bounds_test
mutant 'single: halves, quadratic = 0' $bounds 's/\(16 \+ 36 \+ slack\) \* single_u/0.0/' certificates_test wide_lane_test
mutant 'single: halves, quadratic_sum = 0' $bounds 's/\(48 \+ 148 \+ slack\) \* single_u/0.0/' certificates_test wide_lane_test
mutant 'single: part, cubic = 0' $bounds 's/\(54 \* end_rho \+ 114 \+ slack\) \* single_u/0.0/' certificates_test
mutant 'single: part, quadratic = 0' $bounds 's/\(8 \* end_rho \+ 12 \+ slack\) \* single_u/0.0/' certificates_test
mutant 'single: part, quadratic_sum = 0' $bounds 's/\(24 \* end_rho \+ 56 \+ slack\) \* single_u/0.0/' certificates_test
mutant 'single: floor as in double' $bounds 's/single_length_floor = 0x1p-40/single_length_floor = 0/' error_bounds_test
mutant 'single: the other part of a batch' simd/screened_parts.hpp 's/coordinates\(parts\.at\[k\]\), t_max/coordinates(parts.at[0]), t_max/' wide_lane_test
mutant 'random pairs: those read next queued' simd/pipeline.hpp 's/source_, examined, first/source_, parts, first/' wide_lane_test same_bits_test
mutant 'lanes without largest extent' $bounds 's/t_max == 1\.0 \? largest_extent : 0\.25 \* largest_extent \* t_max/1e308/' certificates_test same_bits_test truth_test stress
mutant 'rho of shorter steps = 1' $bounds 's/t_max == 1\.0 \? 1\.0 : 10\.0/1.0/' error_bounds_test
mutant 'hull_deviation = 0' $bounds 's/hull_deviation = 4\.0/hull_deviation = 0/' error_bounds_test

# ---- Margins of the lanes dropped
mutant 'no margin on intervals' $bounds 's/cubic_on_interval\(\) \+ \(2 \* cubic_blossom_levels \+ slack\) \* u/cubic_on_interval()/' error_bounds_test
mutant 'no margin of terms' kernels/magnitudes.hpp 's/3 \* bounds\.rho \+ 36 \+ 2 \* ErrorBounds::slack/3 * bounds.rho + 18 + ErrorBounds::slack/' error_bounds_test
mutant 'no margin of edge functions' $bounds 's/4 \* rho \+ 16 \+ 2 \* \(4 \* rho \+ 18 \+ slack\)/4 * rho + 16/' error_bounds_test
mutant 'no margin of sums of edge functions' $bounds 's/12 \* rho \+ 58 \+ 8 \* \(4 \* rho \+ 18 \+ slack\)/12 * rho + 58/' error_bounds_test
mutant 'no margin of the cubic on a part' $bounds 's/ \+ 3 \* 2 \* cubic_on_interval\(\)//' error_bounds_test
mutant 'no margin of edge functions on a part' $bounds 's/ \+ 2 \* 2 \* quadratic_on_interval\(\)//' error_bounds_test
mutant 'no margin of sums on a part' $bounds 's/ \+ 2 \* 2 \* 4 \* quadratic_on_interval\(\)//' error_bounds_test
mutant 'no margin of gaps on a part' $bounds 's/3 \* linear_on_interval\(\)/linear_on_interval()/' error_bounds_test
mutant 'no margin of the halved cubic' $bounds 's/ \+ 12 \* \(2 \* cubic_on_interval\(\)\)//' error_bounds_test
mutant 'no margin of halved edge functions' $bounds 's/ \+ 4 \* \(2 \* quadratic_on_interval\(\)\)//' error_bounds_test
mutant 'no margin of halved sums' $bounds 's/ \+ 4 \* \(2 \* 4 \* quadratic_on_interval\(\)\)//' error_bounds_test
mutant 'change of edge functions = 0' kernels/projected_inclusion.hpp 's/broadcast<L>\(8\.0 \* \(1\.0 \+ 0x1p-50\)\)/broadcast<L>(0.0)/' certificates_test same_bits_test truth_test

# ---- Certificates of the whole interval loosened
certificates=kernels/certificates.hpp
mutant 'cubic certificate by sign alone' $certificates 's/broadcast<L>\(bounds\.cubic\) \* volume/broadcast<L>(0.0) * volume/' certificates_test truth_test
mutant 'cubic certificate: one coefficient not asked' $certificates 's/f\.thrice_third, f\.end\)/f.thrice_third, f.thrice_third)/' certificates_test truth_test
mutant 'signs not compared' $certificates 's/times_sign\(others, first\)/abs(others)/' certificates_test truth_test
mutant 'one of several values not compared' $certificates 's/return min\(min\(a, b\), smallest_of/return min(a, smallest_of/' certificates_test truth_test
mutant 'lanes: NaN in range' $certificates 's/less_equal\(sum, sum\) & //' api_test
mutant 'quadratic certificate by sign alone' $certificates 's/broadcast<L>\(bounds\.quadratic\) \* area/broadcast<L>(0.0) * area/' certificates_test truth_test
mutant 'sum of edge functions by sign alone' $certificates 's/broadcast<L>\(bounds\.quadratic_sum\) \* area/broadcast<L>(0.0) * area/' certificates_test truth_test stress
mutant 'linear certificate by sign alone' $certificates 's/broadcast<L>\(bounds\.linear\) \* max/broadcast<L>(0.0) * max/' certificates_test truth_test stress
mutant 'linear certificate at one end' $certificates 's/less\(bound, min\(start\.above, end\.above\)\)/less(bound, max(start.above, end.above))/' certificates_test
mutant 'touching counts as apart' $certificates 's/less\(bound, min\(start\.above, end\.above\)\)/(!less(min(start.above, end.above), bound))/' certificates_test
mutant 'outside one side is outside (vertex-face)' $certificates 's/(max\(smallest\(p\), smallest\(q\), smallest\(t\)\)\)) &/$1 |/' certificates_test
mutant 'one end point on one side (edge-edge)' $certificates 's/one_sign\(bound, p\.a, p\.b, p\.c, t\.a, t\.b, t\.c\)/one_sign(bound, p.a, p.b, p.c)/' certificates_test
mutant 'one end point on one side of the other edge' $certificates 's/one_sign\(bound_sum, q\.a, q\.b, q\.c, s\.a, s\.b, s\.c\)/one_sign(bound_sum, q.a, q.b, q.c)/' certificates_test

halves=kernels/halves_certificate.hpp
mutant 'apart on one half is apart' simd/pipeline.hpp 's/apart\.first & apart\.second/apart.first | apart.second/' same_bits_test
mutant 'times of the tile before stay' simd/lane_results.hpp 's/scratch\.reported\[i \/ 64\] != 0\) clear/scratch.reported[i \/ 64] == 1) clear/' same_bits_test api_test
mutant 'times never looked at are not cleared' simd/lane_results.hpp 's/if \(scratch\.cleared < count\) \{\s*clear\(/if (scratch.cleared < count) {\n        clear(count - count % 64 + 0 * /' same_bits_test api_test
mutant 'roots of half a word not seen' simd/lane_results.hpp 's/for \(const std::uint64_t word : words\) any \|= word;/for (int k = 0; k < 4; ++k) any |= words[k];/' same_bits_test api_test
mutant 'pairs that wait are not kept' simd/strided_pairs.hpp 's/if \(from == to\) continue;/if (from != nullptr) continue;/' wide_lane_test
mutant 'interleaved: past the last whole block in place' simd/packed_pairs.hpp 's/if \(i >= whole_blocks\(\)\)/if (i > size_)/' wide_lane_test
mutant 'interleaved: the first past the last whole block for all' simd/packed_pairs.hpp 's/pair\(rest_, i - whole_blocks\(\)\)/pair(rest_, 0)/' array_ends_test
mutant 'floats: a block for both parts of a batch' simd/packed_pairs.hpp 's/load_halves\(first \+ row, second \+ row\)/load_halves(first + row, first + row)/' wide_lane_test
mutant 'interleaved floats: the first part for both' simd/packed_pairs.hpp 's/second \+ \(lane - half\)/first + (lane - half)/' wide_lane_test
mutant 'floats: the end of the motion not moved' simd/screened_parts.hpp 's/if \(t_max == 1\.0\) return relative_motion_of<S>/if (t_max > 0.0) return relative_motion_of<S>/' wide_lane_test same_bits_test
mutant 'strided: the pair after the last stands for it' simd/strided_pairs.hpp 's/lane < count \? lane : count - 1\) \* stride/lane) * stride/' array_ends_test
mutant 'indexed: a pair looked up again by another number' simd/indexed_pairs.hpp 's/pairs_ \+ 2 \* number, lane, scratch_/pairs_ + 2 * (number ^ 1), lane, scratch_/' indexed_test
mutant 'halves exchanged' $halves 's/return \{first, second\}/return {second, first}/' certificates_test
mutant 'halved cubic by sign alone' $halves 's/broadcast<L>\(bounds\.cubic\) \* scale\.volume/broadcast<L>(0.0) * scale.volume/' certificates_test same_bits_test truth_test
mutant 'halved edge functions by sign alone' $halves 's/broadcast<L>\(bounds\.quadratic\) \* area,/broadcast<L>(0.0) * area,/' certificates_test same_bits_test truth_test
mutant 'halved sums by sign alone' $halves 's/broadcast<L>\(bounds\.quadratic_sum\) \* area/broadcast<L>(0.0) * area/' certificates_test same_bits_test truth_test stress
mutant 'halved cubic without the middle' $halves 's/\{f\.start, a, a \+ b, middle\}/{f.start, a, a, a}/' certificates_test same_bits_test
mutant 'halved quadratic without the middle' $halves 's/return \{start, first, first \+ second, second, end\}/return {start, first, first, second, end}/' certificates_test same_bits_test

quarters=kernels/part_certificates.hpp
mutant 'quarters: the last one not asked' $quarters 's/k < 4 && lanes/k < 3 \&\& lanes/' certificates_test same_bits_test
mutant 'quarters: of the first half' $quarters 's/less_equal\(high, start\)/less_equal(broadcast<L>(0.5), start)/' certificates_test same_bits_test
mutant 'quarters of wide leaves' simd/root_stages.hpp 's/parameters_\.leaf_width > 0\.25/parameters_.leaf_width > 2/' certificates_test
mutant 'gaps on a part by sign alone' $quarters 's/gap_bound\(bounds, extent\)/broadcast<L>(0.0)/' certificates_test

# ---- The certified search loosened
search=kernels/search_coefficients.hpp intervals=kernels/interval_certificates.hpp
mutant 'search: cubic by sign alone' $intervals 's/in_lanes<L>\(pair\.cubic_bound\);(\s*return less\(bound, smallest)/broadcast<L>(0.0);$1/' certificates_test
mutant 'search: edge functions by sign alone' $intervals 's/in_lanes<L>\(e\.bound\)/broadcast<L>(0.0)/' certificates_test
mutant 'search: axis gaps by sign alone' $search 's/per_extent = broadcast<L>\(bounds\.linear_on_interval\(\)\)/per_extent = broadcast<L>(0.0)/' certificates_test truth_test stress
mutant 'search: inclusion by two of three' $intervals 's/p\.positive & q\.positive & t\.positive/p.positive & q.positive/' truth_test nothing_invented_test same_bits_test stress
mutant 'search: proof by sign alone' $intervals 's/in_lanes<L>\(pair\.cubic_bound\);(\s*return \(less\(bound, f\.c0\))/broadcast<L>(0.0);$1/' certificates_test truth_test nothing_invented_test same_bits_test stress
mutant 'search: first leaf not refined' scalar/leaf_search.hpp 's/if \(leaf\.a > 0\.0 && pair/if (leaf.a >= 0.0 \&\& pair/' never_zero_test
mutant 'search: coarse next to time 0' kernels/touching.hpp 's/finest_at_zero = 0x1p-100/finest_at_zero = 0x1p-36/' never_zero_test
mutant 'search: nothing in doubt' scalar/certified_search.cpp 's/&& leaves\.in_doubt\(first\)/\&\& false/' nothing_invented_test never_zero_test
mutant 'search: shapes not in doubt' scalar/leaf_search.hpp 's/ \|\| !pair_\.has_area\(s\)//' nothing_invented_test never_zero_test
mutant 'search: proven nearby not in doubt' scalar/certified_search.cpp 's/result\.proof != Proof::leaf &&/result.proof == Proof::none \&\&/' ordered_search_test
mutant 'search: nothing skipped' scalar/leaf_search.hpp 's/\|\| !directions_help_ \|\|/|| directions_help_ ||/' bounded_test
mutant 'search: eq. 7 of leaves alone' scalar/leaf_search.hpp 's/stack_, laborious_ >= laborious_leaves, limit/stack_, false, limit/' bounded_test
mutant 'search: parts before where directions end again' scalar/leaf_search.hpp 's/if \(leaf\.a < skipped_to_\) stack[^;]*;//' nothing_invented_test
mutant 'search: as many looks as it takes to skip' scalar/separation_search.cpp 's/if \(most < most_looks && most <= pair\.looks\) return[^;]*;//' ordered_search_test
mutant 'search: after most looks, the time of the next' scalar/separation_search.cpp 's/return \{\.toi = pair\.time, \.intervals = looks\};(\s*\}\s*\})/return {.toi = pair.at, .intervals = looks};$1/' ordered_search_test
mutant 'search: the leaf that ends with a skip dropped' scalar/interval_stack.hpp 's/peek\(0\)\.b < time/peek(0).b <= time/' ordered_search_test
mutant 'search: more skipped than directions prove' scalar/leaf_search.hpp 's/skip_to\(time,/skip_to(time + 64 * parameters_.leaf_width,/' truth_test stress
mutant 'search: doubts in the units of each axis' kernels/no_distance.hpp 's/broadcast<L>\(0\.5\) \/ power_of_two\(extent\)/broadcast<L>(1.0)/' same_bits_test
mutant 'search: near misses not halved' scalar/ordered_search.hpp 's/intervals > limit \|\| narrowest\(i\)/by_area || intervals > limit || narrowest(i)/' truth_test nothing_invented_test
mutant 'search: no area certificate' scalar/ordered_search.hpp 's/ \|\| \(by_area && apart_by_area_on<kind>\(pair_, i\.a, i\.b\)\.value\)//' ordered_search_test
mutant 'several: answers for other intervals' scalar/ordered_search.hpp 's/if \(!\(questions\.at\(k\) == i\)\) continue;//' ordered_search_test
mutant 'several: the way taken whatever the answers' scalar/ordered_search.hpp 's/if \(\(\(answers \^ apart\)[^;]*;//' ordered_search_test
mutant 'several: beyond the cap' scalar/ordered_search.hpp 's/intervals \+ kernel_\.lanes <= limit/intervals <= limit/' ordered_search_test
mutant 'several: what lies beside the way forgotten' scalar/ordered_search.hpp 's/stack\.push\(beside\[k\]\)/static_cast<void>(beside[k])/' ordered_search_test
mutant 'several: narrow intervals halved' scalar/ordered_search.hpp 's/meet_at\(target\);\s*if \(narrowest\(way\)\) return way;/meet_at(target);/' ordered_search_test
mutant 'beside the way: narrow intervals halved' scalar/ordered_search.hpp 's/(intervals \+= ways \+ questions\.size;)\s*if \(narrowest\(way\)\) return way;/$1/' ordered_search_test
mutant 'beside the way: whatever the answers' scalar/ordered_search.hpp 's/if \(questions\.size != 0 && [^{]*\{/if (ask(questions, false) > 1u << most_lanes) {/' ordered_search_test
mutant 'beside the way: beyond the cap' scalar/ordered_search.hpp 's/ \|\| intervals \+ most_beside_way > limit//' ordered_search_test
mutant 'beside the way: what lies to the right forgotten' scalar/ordered_search.hpp 's/stack\.drop\(unsigned\{turns_right\}\)/stack.drop(1)/' ordered_search_test
meeting=kernels/meeting.hpp
mutant 'meeting whatever the cubic' $meeting 's/meets = may_be_coplanar\(pair, s\)/meets = less_equal(s, s)/' ordered_search_test
mutant 'meeting whatever the edge functions' $meeting 's/ & may_touch_along<kind>\(pair, axis, s\)//' ordered_search_test
mutant 'meeting whatever the gaps' $meeting 's/ & may_overlap_along<kind>\(pair, axis, s\)//' ordered_search_test
mutant 'value margin of cubics = 0' $meeting 's/\(2 \* 7\.5 \+ 1\.2\) \* ErrorBounds::u/0x1p-200/' error_bounds_test
mutant 'value margin of quadratics = 0' $meeting 's/\(2 \* 5\.0 \+ 1\.2\) \* ErrorBounds::u/0x1p-200/' error_bounds_test
mutant 'value margin of gaps = 0' $meeting 's/\(2 \* 2\.5 \+ 1\.2\) \* ErrorBounds::u/0x1p-200/' error_bounds_test

# ---- Contact that nothing proves, at a side, an end, or next to a leaf's end
# Not among them: that eq. 7 does not keep the pair apart, in a leaf or at time 0, as halving would hardly ever come to another verdict; that
# edges without an area lie on one line, as no two were found that meet where gaps end and do not; that undecided pairs are not asked
# about, which saves time alone; and how close vertices have to be to be shared, a choice.
touching=kernels/touching.hpp in_leaves=simd/touching_pairs.hpp
mutant 'touch: whether they meet or not' $touching 's/present = present & meets_at<kind>\(leaf, likely\.time\)/static_cast<void>(0)/' touching_test truth_test
mutant 'touch: not certain to be apart before' $touching 's/present = present & \(less_equal\(likely\.before, zero\) \| apart_on<kind>\(leaf, zero, likely\.before\)\)/static_cast<void>(0)/' touching_test truth_test stress
mutant 'touch: of any shape' $touching 's/present = counts_as_contact_at<kind>\(pair, time, until, bounds, present\)/static_cast<void>(0)/' truth_test touching_test nothing_invented_test
mutant 'touch: half a leaf before' $touching 's/ & less\(time - within, broadcast<L>\(0\.5\)\)//' touching_test
mutant 'touch: area of edges by their sum' $touching 's/area = area - value/area = area + value/' touching_test
mutant 'touch: certificates not looked at' $touching 's/look_at\(likely, true\);//' touching_test
mutant 'touch: contact at the start whatever the certificates' $touching 's/present = present & !apart_on<kind>\(pair, zero, zero\)/static_cast<void>(0)/' touching_test ordered_search_test truth_test
mutant 'touch: lanes, apart throughout' $in_leaves 's/open = unscaled & !apart;/open = unscaled;/' same_bits_test touching_test
mutant 'touch: lanes, axes that are scaled' $in_leaves 's/open = unscaled & !apart;/open = !apart;/' same_bits_test touching_test extreme_range_test stress
mutant 'touch: lanes, leaves apart without a look' $in_leaves 's/apart = asked & apart_on<kind>\(leaf, all\)/apart = asked/' touching_test same_bits_test
mutant 'touch: lanes, proven nearby forgotten' $in_leaves 's/ \| contact_proven_near<kind>\(pair, touch\.time\)//' touching_test
mutant 'touch: lanes, apart before not asked (root)' simd/root_stages.hpp 's/leaf\.inner & bracket\.certain & apart_before/leaf.inner & bracket.certain/' same_bits_test touching_test stress
mutant 'touch: lanes, apart before not asked (certificates)' $in_leaves 's/open = open & apart_on<kind>\(sure, time, end\)/static_cast<void>(0)/' touching_test
mutant 'touch: lanes, certificates without margins' $in_leaves 's/set_bounds<kind>\(sure, pair, 1\.0\)/set_bounds<kind>(sure, pair, 0.0)/' touching_test
mutant 'touch: lanes, certificates with gaps between them' $in_leaves 's/time = select<L>\(open, left, time\)/time = select<L>(open, end, time)/' touching_test
mutant 'touch: lanes, at the start whatever the shape' $in_leaves 's/counts_as_contact_at_start<kind>\(pair, parameters\.bounds, at_start\)/at_start/' touching_test same_bits_test
mutant 'touch: thin pairs, whatever eq. 7 says' $touching 's/thin = thin & !apart_by_area_on<kind>\(pair, s, s\)/static_cast<void>(0)/' touching_test nothing_invented_test
mutant 'touch: thin pairs, whatever directions say' $touching 's/thin = thin & no_distance_at<kind>\(motion_of<L>\(pair\), time, bounds\)/static_cast<void>(0)/' touching_test nothing_invented_test truth_test
mutant 'touch: thin pairs, where certificates end not asked' $touching 's/\{s, before\}/{s}/' nothing_invented_test
mutant 'touch: thin pairs, in units that they are not in' kernels/no_distance.hpp 's/RelativeMotion<L> normalized = with_normalized_extents\(r\)/RelativeMotion<L> normalized = r/' touching_test same_bits_test
mutant 'touch: thin pairs, however close at time 0' kernels/no_distance.hpp 's/less_equal\(s, broadcast<L>\(0\.0\)\) \| //' touching_test never_zero_test
mutant 'touch: thin pairs at the start, whatever directions say' $touching 's/\(thin & no_distance_at<kind>\(motion_of<L>\(pair\), zero, bounds\)\)/thin/' touching_test never_zero_test nothing_invented_test
mutant 'touch: at the start in line by bounds' $touching 's/well_shaped_at<kind>\(pair, zero, zero\)/well_shaped_at<kind>(pair, zero, broadcast<L>(1.0))/' touching_test
mutant 'touch: shapes at the start not looked at' scalar/leaf_search.hpp 's/if \(pair_\.counts_as_contact_at_start\(parameters_\.bounds\)\) touch_/touch_/' never_zero_test nothing_invented_test touching_test
mutant 'touch: lanes, on where only one leaf is apart' $in_leaves 's/\(found\.apart & !in_next\) \| there\.apart/found.apart/' touching_test
mutant 'touch: certificates that do not hold' $touching 's/open = open & apart_on<kind>\(leaf, found\.end, end\)/static_cast<void>(0)/' touching_test truth_test stress nothing_invented_test
mutant 'touch: apart where certificates end' $touching 's/found\.apart = asked & less_equal\(one, until\.end\)/found.apart = asked/' touching_test truth_test
mutant 'touch: at time 0' $touching 's/likely\.expected & less\(zero, until\)/likely.expected/' never_zero_test touching_test ordered_search_test
mutant 'touch: rounding on parts forgotten' kernels/restriction.hpp 's/\(2\.5 \* levels \+ 0\.2\) \* ErrorBounds::u/(0.5 * levels) * ErrorBounds::u/' error_bounds_test
mutant 'touch: times rounded to nearest' kernels/restriction.hpp 's/broadcast<L>\(1\.0 - 2 \* ErrorBounds::u\)/broadcast<L>(1.0)/' error_bounds_test
mutant 'touch: the first leaf by its own polynomials' scalar/leaf_search.hpp 's/is_first = leaf\.a == 0\.0/is_first = leaf.a < 0.0/' ordered_search_test
mutant 'touch: lanes, whether the search comes to the leaf' $in_leaves 's/present = touch\.present & comes_here/present = touch.present/' touching_test same_bits_test stress
mutant 'touch: lanes, wider intervals by the bounds' $in_leaves 's/set_bounds<kind>\(leaf, pair, -1\.0\)/set_bounds<kind>(leaf, pair, 0.0)/' touching_test same_bits_test stress
mutant 'touch: lanes, wider intervals not asked' $in_leaves 's/asked = asked & !apart_on<kind>\(pair, start, [^;]*;//' touching_test same_bits_test stress
ends=kernels/last_certificate.hpp
mutant 'ends of certificates: cubics above lines to their last coefficient' $ends 's/min\(down_at\(c0, 0\.0, c3, 1\.0, e\), [^;]*;/down_at(c0, 0.0, c3, 1.0, e));/' touching_test
mutant 'ends of certificates: cubics where their Taylor polynomial leads' $ends 's/select<L>\(less\(zero, there\), step, safe\)/step/' touching_test
mutant 'ends of certificates: cubics whatever the third coefficient' $ends 's/one\), above_until\(Quadratic<L>\{c0, c1, c2\}, e\)\)/one), one)/' touching_test
mutant 'ends of certificates: cubics by their hull' $ends 's/steps_beyond_hull = 3/steps_beyond_hull = 0/' touching_test
mutant 'touch: lanes, intervals passed unasked' $in_leaves 's/passed = lanes & apart_on<kind>\(pair, time, end\)/passed = lanes/' touching_test same_bits_test
mutant 'touch: lanes, no interval passed' $in_leaves 's/if \(k != 0\) time = apart_by_intervals/if (k > 9) time = apart_by_intervals/' touching_test
mutant 'touch: lanes, the first leaf by its start' $in_leaves 's/asked & certain & less\(broadcast<L>\(0\.0\), left\)/asked \& certain/' touching_test same_bits_test
mutant 'touch: lanes, the first leaf without its proof' $in_leaves 's/present & \(certain \| /present \& (/' touching_test
mutant 'touch: lanes, the last note counts' simd/lane_results.hpp 's/if \(is_first\) scratch/scratch/' same_bits_test touching_test stress
mutant 'touch: whatever contact is before' scheduler/touching_blocks.cpp 's/if \(!\(scratch\.time\[i\] < scratch\.touch_time\[i\]\)\) \(scratch/(scratch/' same_bits_test touching_test stress
mutant 'time not rounded down' kernels/search_parameters.hpp 's/product \* \(1\.0 - 0x1p-52\)/product/' error_bounds_test
mutant 'small axes not scaled' scalar/scaling.cpp 's/smallest_unscaled = 0x1p-100/smallest_unscaled = 0/' truth_test same_bits_test certificates_test
mutant 'large axes not scaled' scalar/scaling.cpp 's/largest_unscaled = largest_extent/largest_unscaled = 1e308/' truth_test same_bits_test certificates_test
mutant 'range: axes that lanes take scaled down' scalar/scaling.cpp 's/: largest < std::ilogb\(largest_unscaled\) \? 0 : -largest/: -largest/' same_bits_test
mutant 'range: pairs beyond it left there' scalar/scaling.cpp 's/all_fit \? -\(\(largest \+ smallest\) \/ 2\)/all_fit ? 0/' truth_test same_bits_test
mutant 'range: small axes as they are' scalar/scaling.cpp 's/smallest_exponent = -95/smallest_exponent = -1000/' truth_test same_bits_test certificates_test extreme_range_test
mutant 'each axis scaled by itself' scalar/scaling.cpp 's/exponent \+ common < smallest_exponent \? -exponent : common/-exponent/' same_bits_test
mutant 'range: gaps along subnormal axes without a floor' kernels/certificates.hpp 's/max\(extent, broadcast<L>\(extent_floor\(Lane<L>::is_single\)\)\)/extent/' extreme_range_test
mutant 'range: short steps scaled as if they were whole' scalar/scaling.cpp 's/within_range\(step\) && within_range\(searched\)/within_range(step)/' extreme_range_test
mutant 'range: both ends halved' scalar/scaling.cpp 's/coordinate > 0x1p1021 \? 4 : 0/4/' extreme_range_test
mutant 'range: subnormal times rounded up' kernels/search_parameters.hpp 's/product - 0x1p-1073 : 0\.0/product : 0.0/' extreme_range_test
mutant 'range: ties of subnormal times left out' scheduler/shared_best.hpp 's/memory_order_relaxed\) \+ 0x1p-1072/memory_order_relaxed)/' collision_free_step_test
mutant 'roots: sign after a cluster from far away' scalar/contact_roots.hpp 's/if \(open_\) look_behind_cluster\(i\);//' root_counts_test
mutant 'roots: sign before a cluster from far away' scalar/contact_roots.hpp 's/look_ahead_of_cluster\(i\.a\);//' root_counts_test
mutant 'roots: a tangential one beside a triple one' scalar/contact_roots.hpp 's/tangential_here_ && !changes_here_/tangential_here_/' root_counts_test
mutant 'roots: one bound is certain by far' scalar/contact_roots.hpp 's/3\.0 \* pair_\.cubic_bound\(\)/pair_.cubic_bound()/' root_counts_test
mutant 'roots: nothing is certain by far' scalar/contact_roots.hpp 's/> 3\.0 \* pair_\.cubic_bound\(\)/> 1e300/' root_counts_test
mutant 'roots: clusters add up' scalar/contact_roots.hpp 's/tangential_here_ = true;/odd_ += 2;/' root_counts_test
mutant 'range: roots as coarse as times' scalar/contact_roots.hpp 's/widest_leaf = 0x1p-30/widest_leaf = 1/' extreme_range_test

# ---- Area inclusion loosened
# Not among them, because nothing observable changes: the term delta^2 C2^2 / 2: C1 bounds the edges at every time of the
# interval, so delta C1 C2 alone bounds the change.
area=kernels/area_inclusion.hpp
mutant 'area: no rounding' $area 's/less\(change \+ rounding, excess\)/less(change, excess)/' error_bounds_test certificates_test
mutant 'area: no change' $area 's/less\(change \+ rounding, excess\)/less(rounding, excess)/' error_bounds_test certificates_test
mutant 'area: edges at the start only' $area 's/max\(largest_square\(r\.start\[0\], r\.start\[1\], r\.start\[2\]\),\s*largest_square\(r\.end\[0\], r\.end\[1\], r\.end\[2\]\)\)/largest_square(r.start[0], r.start[1], r.start[2])/' error_bounds_test
mutant 'area: speed too small' $area 's/sqrt\(largest_square\(subtract/broadcast<L>(0.5) * sqrt(largest_square(subtract/' error_bounds_test

# ---- Decisions of the lanes loosened
# Not among them, because others imply it: that the values at the ends of a bracket are beyond the threshold. On the quick
# bracket a cubic that changes sign is beyond it; on the fine one `crosses` asks for strict signs up to the same ends. Nor that
# a leaf decided quickly lies within its piece, which the proof needs: otherwise the change of sign might be the next piece's. In
# 7 million roots of random cubics, made to have extrema within a leaf of the root, it never was.
pipeline=simd/pipeline.hpp
roots=simd/root_stages.hpp
mutant 'lanes: uncertain pieces decided' $roots 's/bits\(pieces\.certain & less/bits(less/' certificates_test same_bits_test
mutant 'lanes: pieces by sign alone' kernels/sign_change.hpp 's/less\(threshold, closest\)/less(broadcast<L>(0.0), closest)/' certificates_test same_bits_test stress
mutant 'lanes: the other half looked at' simd/records.hpp 's/return \{select<L>\(first, half/return {select<L>(less(between, fraction), half/' same_bits_test
mutant 'lanes: bracket not certain' $roots 's/beyond & opposite_signs\(at_low, at_high\)/beyond/' certificates_test same_bits_test
mutant 'lanes: dismissed without a bracket' $roots 's/bracket\.certain & inclusion\.absent/inclusion.absent/' certificates_test same_bits_test
mutant 'lanes: first leaf decided quickly' $roots 's/leaf\.inner & less_equal\(root/less_equal(root/' never_zero_test same_bits_test
mutant 'lanes: first leaf decided' $roots 's/leaf\.inner & bracket\.certain/bracket.certain/' never_zero_test same_bits_test
mutant 'lanes: crossing not asked for quickly' $roots 's/in_leaf & around\.present/around.present/' certificates_test same_bits_test
mutant 'lanes: crossing not asked for' $roots 's/crossing & Lane<L>::bits\(inclusion\.present\)/lanes & Lane<L>::bits(inclusion.present)/' certificates_test same_bits_test
mutant 'lanes: crossing by sign alone, quickly' $roots 's/less\(root\.threshold, min\(abs\(at_left\), abs\(at_right\)\)\) & //' certificates_test same_bits_test wide_lane_test stress
mutant 'lanes: crossing by sign alone' $roots 's/cubic_bound_lanes\(root\.r, root\.scale\.volume, parameters_\.bounds\)/broadcast<L>(0.0)/' certificates_test same_bits_test wide_lane_test stress
mutant 'lanes: present by sign alone' kernels/projected_inclusion.hpp 's/less\(bound, low\) \| less\(high, negated\(bound\)\)/less(broadcast<L>(0.0), low) | less(high, broadcast<L>(0.0))/' certificates_test same_bits_test
mutant 'lanes: across one line of two' kernels/projected_inclusion.hpp 's/(one_sign\(bound, pk, negated\(tk\)\)) &/$1 |/' certificates_test same_bits_test
mutant 'lanes: aside taken for across' kernels/projected_inclusion.hpp 's/one_sign\(bound, pk, negated\(tk\)\)/one_sign(bound, pk, tk)/' certificates_test same_bits_test
mutant 'lanes: roots after a contact not counted' $roots 's/parameters_\.count_roots \? 0 : contact/contact/' same_bits_test
mutant 'lanes: later roots not sought' $roots 's/parameters_\.count_roots \? 0 : contact/parameters_.count_roots ? 0 : ~0u/' same_bits_test
mutant 'lanes: second root sought in the first piece' $roots 's/select<L>\(decided, second_low, root\.low\)/root.low/' same_bits_test certificates_test
mutant 'lanes: second root beside an undecided first lost' $roots 's/both = undecided & second;/both = 0;/' same_bits_test certificates_test wide_lane_test stress
mutant 'lanes: third root sought in the second piece' $roots 's/later_high\[i\]\);(\s+root\.high = Lane<L>::load\(&scratch_\.search\.end)/later_low[i]);$1/' same_bits_test certificates_test
mutant 'lanes: early cutoff too early' $pipeline 's/\(cutoff_ \+ 2 \* parameters_\.leaf_width\) \* \(1\.0 \+ 0x1p-22\)/0.5 * cutoff_/' indexed_test same_bits_test

# ---- Minimum separation
separation=kernels/separation_bound.hpp
mutant 'separation: height = 0' $separation 's/vertex_face \? rho \+ 3 : 2 \* rho \+ 8\) \+ slack/vertex_face ? 0 : 0)/' error_bounds_test separation_test
mutant 'separation: height between = 0' $separation 's/vertex_face \? rho \+ 7 : 2 \* rho \+ 16\) \+ slack/vertex_face ? 0 : 0)/' error_bounds_test separation_test
mutant 'separation: axis = 0' $separation 's/\(2 \* rho \+ 2 \+ slack\) \* u/0.0/' error_bounds_test separation_test
mutant 'separation: distance = 0' $separation 's/\(4 \* rho \+ 33 \+ slack\) \* u/0.0/' error_bounds_test separation_test
mutant 'separation: unit vectors taken as such' $separation 's/threshold\{d \* \(1\.0 \+ 0x1p-49\)\}/threshold{d * (1.0 - 0x1p-49)}/' error_bounds_test separation_test
steps=kernels/separation_certificate.hpp
mutant 'separation: heights without d' $steps 's/\(broadcast<L>\(parameters\.threshold\) \+ broadcast/(broadcast<L>(0.0) + broadcast/' separation_test
mutant 'separation: axis without d' kernels/certificates.hpp 's/\(broadcast<L>\(bounds\.distance\) \+/(broadcast<L>(0.0) +/' error_bounds_test separation_test
mutant 'separation: turning, middle not asked' $steps 's/ & less\(from \+ to, c\.middle_n \+ c\.middle_m\)//' error_bounds_test separation_test
walk=kernels/separation_steps.hpp
mutant 'separation: start not looked at' $walk 's/here & certified_at\(seen, pair\.at\)/here/' separation_test separation_bits_test
mutant 'separation: first half taken for the whole' $walk 's/select<L>\(farther\.first, half, zero\)/select<L>(farther.first, one, zero)/' separation_test
mutant 'separation: second half taken for the first' $walk 's/select<L>\(apart_from_half, half, seen\.low\)/select<L>(apart_from_half, zero, seen.low)/' separation_test
mutant 'separation: too far taken for farther' $walk 's/by_volume = ahead & farther_between/by_volume = ahead | farther_between/' separation_test separation_bits_test
farther=kernels/farther_certificates.hpp
mutant 'farther: volume on the whole without d' $farther 's/3\.0 \* areas \* bounds\.distance/0.0 * areas * bounds.distance/' error_bounds_test separation_bits_test
mutant 'farther: volume on halves without d' $farther 's/12\.0 \* bounds\.distance/0.0 * bounds.distance/' error_bounds_test separation_test
mutant 'farther: edge functions without d' $farther 's/4\.0 \* bounds\.distance/0.0 * bounds.distance/' error_bounds_test separation_test
mutant 'farther: sides as short as their ends' $farther 's/of_difference = of_r1 \+ of_r1/of_difference = of_r1/' error_bounds_test
mutant 'farther: other multiples of cubics' $farther 's/broadcast<L>\(12\.0\), middle/broadcast<L>(24.0), middle/' error_bounds_test
mutant 'farther: other multiples of edge functions' $farther 's/four = broadcast<L>\(4\.0\)/four = broadcast<L>(8.0)/' error_bounds_test
mutant 'farther: normal at the ends alone' $farther 's/max\(max\(largest\(n\.start\), largest\(n\.end\)\), .*?\);/max(largest(n.start), largest(n.end));/s' error_bounds_test
mutant 'farther: between, at the ends alone' $farther 's/ & beyond\(f\.thrice_second.*?& beyond/ & beyond/s' error_bounds_test
mutant 'farther: between, without d' $farther 's/less\(d \* lengths \+ bound/less(bound/' error_bounds_test separation_test
mutant 'farther: single precision without margins' $separation 's/\(54 \+ 114 \+ slack\) \* single_u/114 * u/; s/\(21 \+ 49 \+ slack\) \* single_u/0.0/; s/\{\(216 \+ 642 \+ slack\) \* single_u, \(16 \+ 36 \+ slack\) \* single_u, \(48 \+ 148 \+ slack\) \* single_u/{0.0, 0.0, 0.0/' error_bounds_test separation_bits_test
mutant 'farther: bounds = 0' $separation 's/\(162 \* rho \+ 435 \+ 2 \* slack\) \* u/0.0/; s/\(21 \* rho \+ 49 \+ slack\) \* u/0.0/; s/\{\(216 \* rho \+ 642 \+ slack\) \* u, \(16 \* rho \+ 36 \+ slack\) \* u, \(48 \* rho \+ 148 \+ slack\) \* u/{0.0, 0.0, 0.0/' error_bounds_test
mutant 'farther: bounds between = 0' $separation 's/\(216 \* \(rho \+ 3\) \+ 600 \+ slack\) \* u/0.0/; s/\(84 \* \(rho \+ 3\) \+ 195 \+ slack\) \* u/0.0/' error_bounds_test
mutant 'separation: guesses not looked at' kernels/contact_guess.hpp 's/ahead = less_equal\(pair\.looks, one\) & /ahead = no_lanes<L>() & /' separation_test
mutant 'separation: back to the start after a wrong guess' kernels/separation_steps.hpp 's/pair\.high = pair\.time;/pair.high = zero;/' separation_test
mutant 'separation: guesses where the planes are close already' kernels/contact_guess.hpp 's/const LaneMask<L> closing = .*?;/const LaneMask<L> closing = all_lanes<L>();/' separation_test
mutant 'separation: guesses without room for the bound' kernels/contact_guess.hpp 's/2\.0 \* bound/0.0 * bound/' separation_test
mutant 'separation: guesses for a distance of 0' kernels/contact_guess.hpp 's/planes\.aim/broadcast<L>(0.0)/g' separation_test
mutant 'separation: guesses of lanes that are not new' kernels/contact_guess.hpp 's/less_equal\(pair\.looks, one\) & //' separation_bits_test
mutant 'separation: pairs beyond single precision dropped' simd/separation_pipeline.hpp 's/push\(scratch_\.candidates, decidable, record\);//' wide_lane_test

# ---- Totals
tile=scheduler/tile_runner.cpp
mutant 'totals: first contact of the lanes not seen' simd/lane_results.hpp 's/scratch\.earliest = lanes\[0\]/scratch.earliest = __builtin_inf()/' api_test same_bits_test
mutant 'totals: first separation of the lanes not seen' simd/separation_pipeline.hpp 's/if \(times\[lane\] < scratch_\.earliest\) scratch_\.earliest = times\[lane\];//' api_test separation_bits_test
mutant 'totals: first contact of the search not seen' $tile 's/earliest = std::min\(earliest, toi\);//' api_test same_bits_test
mutant 'totals: invalid pairs are contacts' $tile 's/reported - invalid/reported/' api_test
mutant 'totals: at the start without a separation' scheduler/tile_runner.hpp 's/job\.parameters\.separation\.distance > 0\.0 && //' api_test
mutant 'totals: contacts of a search for the earliest' scheduler/fastccd.cpp 's/totals\.contacts = totals\.proven = totals\.at_start = 0;//' api_test
mutant 'totals: invalid pairs are searched' $tile 's/\+\+\(std::isnan\(toi\) \? invalid : totals\.scalar_pairs\);/invalid += std::isnan(toi) ? 1 : 0; ++totals.scalar_pairs;/' api_test
mutant 'single pairs: by the instruction set asked for' scheduler/single_pair.cpp 's/search_alone\.isa = Isa::scalar;//' single_pair_test
mutant 'exact: by lanes where reference is asked for' $tile 's/if \(options\.reference\) kernels = nullptr;/if (options.reference \&\& !options.exact) kernels = nullptr;/' exact_test
mutant 'totals: invalid pairs are proven' $tile 's/proven - invalid/proven/' api_test

# ---- The exact verdict
mutant 'exact: 0 within the first leaf' scalar/exact_contact.cpp 's/return std::ldexp\(1\.0, -static_cast<int>\(finer\)\)/return 0.0/' exact_test
mutant 'exact: roots in the middle left out' scalar/binary_form.cpp 's/mpz_odd_p\(part\.index\.get_mpz_t\(\)\) != 0 && //; s/here\.at_start\(\) == 0\) found/part.depth > 64 \&\& here.at_start() == 0) found/' exact_test
mutant 'exact: second halves first' scalar/binary_form.cpp 's/(waiting\.push_back\(second_half\(part\)\);)\s*(waiting\.push_back\(first_half\(part\)\);)/$2 $1/' exact_test

# ---- The caller's floating-point environment
mutant 'environment: as the caller left it' scheduler/guarded.hpp 's/const DefaultFloatingPoint defaults;//' floating_point_environment_test
mutant 'environment: threads as the arena left it' scheduler/parallel_ranges.hpp 's/isolated, fp_settings/isolated, default_traits/' floating_point_environment_test
mutant 'environment: not given back' scheduler/default_floating_point.cpp 's/(~DefaultFloatingPoint\(\)\s*\{\s*)set\(before_\);/$1/' floating_point_environment_test
mutant 'environment: the arena made in the library'\''s' scheduler/parallel_ranges.cpp 's/const CallersFloatingPoint callers;//' floating_point_environment_test

mutant 'tasks: those of the program begun while indices are checked' scheduler/parallel_ranges.hpp 's/tbb::this_task_arena::isolate\(\[&\] \{ (return tbb::parallel_reduce\(.*?\);) \}\);/[\&] { $1 }();/' host_tasks_test
mutant 'tasks: those of the program begun meanwhile' scheduler/parallel_ranges.hpp 's/tbb::this_task_arena::isolate\(\[&\] \{ (tbb::parallel_for\(.*?\);) \}\);/$1/' host_tasks_test

mutant 'adapters: separation to the default tolerance' kernels/include/fastccd/adapters/distance_tolerance.hpp 's/options\.distance_tolerance = std::min\(.*?;/;/' adapters_test
mutant 'lists: invalid pairs find no room' scheduler/fastccd.cpp 's/if \(invalid != nullptr\) reserve_more\(\*invalid, totals\.invalid\);//' out_of_memory_test
mutant 'allocations: one for each pair that is searched' scheduler/tile_runner.cpp 's/(double search_pair\([^{]*\{)/$1 static thread_local std::vector<double, tbb::cache_aligned_allocator<double>> kept; kept = std::vector<double, tbb::cache_aligned_allocator<double>>(1024);/; s/#include <limits>/#include <limits>\n#include <vector>\n#include <tbb\/cache_aligned_allocator.h>/' bounded_test
mutant 'lists grow by what is needed alone' scheduler/fastccd.cpp 's/std::max\(needed, 2 \* list\.capacity\(\)\)/needed/' api_test

# ---- The cap on intervals
leaves=scalar/leaf_search.hpp
mutant 'cap: much more' $leaves 's/unsigned limit = most_;/unsigned limit = most_ + 100000;/' cap_test
mutant 'cap: nothing where it ends' $leaves 's/is_wide \? std::max\(found->a, skipped_to_\)/is_wide ? none/' cap_test
mutant 'cap: no more for what is wide' scalar/certified_search.hpp 's/most_extensions = 16/most_extensions = 0/' cap_test
mutant 'cap: more for what is wide, almost without end' $leaves 's/is_wide && extensions_ < most_extensions/is_wide \&\& extensions_ < 1000/' cap_test
mutant 'cap: not for the parts of a leaf' $leaves 's/std::min\(search_\.intervals \+ most_parts, most_\);/search_.intervals + most_parts;/' cap_test

following=scalar/following_direction.hpp
mutant 'separation: heights while following = 0' $separation 's/vertex_face \? rho \+ 8 : 2 \* rho \+ 18\) \+ slack/vertex_face ? 0 : 0)/' error_bounds_test
mutant 'separation: nothing follows' scalar/separation_search.cpp 's/outcome\.left\.value && follow/false \&\& follow/' separation_test separation_bits_test
mutant 'separation: lanes follow nothing' kernels/separation_steps.hpp 's/most_lane_looks = 64/most_lane_looks = 1e9/' separation_test separation_bits_test
mutant 'separation: lanes keep what is to be followed' simd/separation_pipeline.hpp 's/if \(left != 0\) leave_undecided\(scratch_, record\.pair, left\);//' separation_bits_test
mutant 'separation: following, middle not asked' $following 's/k < 5; \+\+k\) all/k < 5; k += 2) all/' error_bounds_test
mutant 'separation: following, d not asked for' $following 's/parameters\.threshold \* length \+/0.0 * length +/' error_bounds_test
mutant 'separation: following goes over the window' scalar/separation_search.cpp 's/time = past_window\(pair, end\)/time = past_window(pair, end + stretch)/' separation_test
mutant 'separation: normals that vanish' kernels/separating_direction.hpp 's/less\(broadcast<L>\(smallest_square\), normal_square\) &\s*//' error_bounds_test
mutant 'separation: corners from the far end' kernels/separating_direction.hpp 's/less\(squares\[j\], squares\[i\]\)/less(squares[i], squares[j])/' error_bounds_test

# ---- Directions of all features, and where they lead
features=kernels/feature_directions.hpp along=kernels/meeting_along_directions.hpp
mutant 'features: no sides of a face' $features 's/consider\(perpendicular_to\(side\[i\], r\[i\]\)\);//' error_bounds_test
mutant 'features: no side along the second edge' $features 's/consider\(perpendicular_to\(second, r\[1\]\)\);//' error_bounds_test
mutant 'features: the plane from one side' $features 's/consider\(\{negated[^;]*;//' error_bounds_test
mutant 'features: perpendicular but for rounding' $features 's/return subtract\(once, [^;]*;/return once;/' error_bounds_test
mutant 'features: normals as they are' $features 's/cross\(first, perpendicular_to\(first, second\)\)/cross(first, second)/' error_bounds_test
mutant 'features: not asked' $features 's/less_equal\(seen\.gap, needed\)/no_lanes<L>()/' error_bounds_test
mutant 'features: lanes do not ask' simd/separation_pipeline.hpp 's/k < open; \+\+k/k < 0 * open; ++k/' separation_bits_test
mutant 'features: lanes ask for the last batch alone' simd/separation_pipeline.hpp 's/looks\.open\[open\] = i;/looks.open[0] = i;/' separation_bits_test
mutant 'along: meets, whatever certificates say' $along 's/found\.present & meets_at<kind>[^;]*;/found.present;/' nothing_invented_test touching_test
mutant 'along: meets, whatever eq. 7 says' $along 's/found\.present & !apart_by_area_on[^;]*;/found.present;/' nothing_invented_test ordered_search_test
mutant 'along: apart to the end of a direction' $along 's/less\(one, seen\.until\)/less(broadcast<L>(0.5), seen.until)/' truth_test same_bits_test
mutant 'along: lanes answer where directions go on' simd/touching_pairs.hpp 's/along\.asked & !\(along\.goes_on \| along\.apart\)/along.asked/' touching_test same_bits_test
mutant 'along: lanes ask in leaves that eq. 7 clears' simd/touching_pairs.hpp 's/unanswered & !apart_by_area_on[^;]*;/unanswered;/' touching_test same_bits_test
# Not that the search asks once, nor that it does not in a leaf that eq. 7 clears: so that it asks where lanes do. Without the one, and without
# the other, it still says what scalar lanes do of 9.7 million pairs of all families and thin ones (as touching_test compares them, of fewer).
mutant 'along: not on beyond the leaf' scalar/leaf_search.hpp 's/go_on_at\(time\);\s*if \(leaf\.b <= time\) return none;//' nothing_invented_test
mutant 'along: distances do not double' scalar/separation_search.cpp 's/looks_to_double = 16/looks_to_double = 1e9/' bounded_test
mutant 'separation: what is shown does not count as close' kernels/separation_steps.hpp 's/\(less_equal\(distance, close\) \| less_equal\(gap, shown\)\)/less_equal(distance, close)/' bounded_test
mutant 'along: distances double with a separation' scalar/separation_search.cpp 's/what == AskedFor::contact/true/' separation_test separation_bits_test

# ---- Boxes of indexed pairs
boxes=scheduler/mesh_boxes.cpp
mutant 'boxes: highest is the lower line' $boxes 's/-1 - (start|end)/-$1/g' boxes_test
mutant 'boxes: separation rounded down' $boxes 's/std::ceil\(/std::floor(/' boxes_test
mutant 'boxes: short axes count' kernels/grid_box.hpp 's/shortest_axis = 0x1p-20/shortest_axis = 0/' boxes_test
mutant 'boxes: large separations wrap' $boxes 's/cells < beyond_grid \? static_cast<std::int16_t>\(cells\) : beyond_grid/static_cast<std::int16_t>(static_cast<std::int64_t>(std::min(cells, 1e15)))/' boxes_test
mutant 'boxes: of coordinates that are not finite' $boxes 's/if \(bounds\.not_finite != 0\.0\) return set\.release\(\);//' boxes_test
mutant 'boxes: not finite in one part alone' $boxes 's/not_finite \+= other\.not_finite;//' boxes_test
mutant 'boxes: lowest of one part alone' $boxes 's/low\[k\] = std::min\(low\[k\], other\.low\[k\]\);//' boxes_test
mutant 'boxes: highest of one part alone' $boxes 's/high\[k\] = std::max\(high\[k\], other\.high\[k\]\);//' boxes_test
mutant 'boxes: no memory for them is an error' $boxes 's/try \{\s*(set = make\(kind, source\);)\s*\} catch \(\.\.\.\) \{.*?\}/$1/s' out_of_memory_test
mutant 'boxes: made without memory' $boxes 's/if \(set->memory == nullptr \|\| \(!faces && vertices_of_edges == nullptr\)\) return nullptr;//' out_of_memory_test
mutant 'boxes: a mesh without a place for them' scheduler/moving_mesh.cpp 's/records_ == nullptr \|\| boxes_ == nullptr \?/records_ == nullptr ?/' out_of_memory_test
mutant 'boxes: third corner left out' $boxes 's/faces \? join\(two, corner\(2\)\) : two/two/' boxes_test
mutant 'boxes: apart at one end' kernels/lane.hpp 's/(first\.start\[k\] < second\.start\[k\]\)) &/$1 |/' boxes_test
mutant 'boxes: touching is apart' kernels/lane.hpp 's/first\.(start|end)\[k\] < second/first.$1\[k] <= second/g' boxes_test
mutant 'boxes: wrong pair listed' simd/indexed_pairs.hpp 's/listed\[size\] = static_cast<std::uint16_t>\(i\);\s*size \+=/listed[size] = static_cast<std::uint16_t>(i ^ 1);\n            size +=/' boxes_test
}

all_mutants  # that each of them still changes something
if $check_only; then
  echo "$mutants mutants"
  exit 0
fi
configure
dry=false
for test in "${!killers[@]}"; do  # what fails by itself would kill everything
  passes "$test" || { echo "mutation.sh: $test fails without any mutation" >&2; exit 2; }
done
mutants=0
all_mutants
echo
echo "$mutants mutants, $survivors survive"
[ "$survivors" -eq 0 ]
