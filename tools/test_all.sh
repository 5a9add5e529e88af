# Sourced by test.sh --all: what needs builds of its own, in folders next to the ordinary one.

lacks_avx512() { [[ $("$build/tests/fastccd_digest" 1 2>&1) == *'lacks avx512'* ]]; }

# All at once, and first: what runs beside a build (below) cannot ask for a password.
install_for_all() {
  local packages=(clang libclang-rt-dev clang-19)
  if [ "$(uname -m)" = x86_64 ]; then
    [[ $(dpkg --print-foreign-architectures) == *arm64* ]] || as_root dpkg --add-architecture arm64
    packages+=(qemu-user-static g++-aarch64-linux-gnu libtbb-dev:arm64 libxsimd-dev:arm64 libgmp-dev:arm64 libgtest-dev:arm64)
    if lacks_avx512; then packages+=("${emulator_packages[@]}"); fi
  fi
  install_packages "${packages[@]}"
}

# For the sanitized build, whose kernel for AVX-512 takes longest of all to compile; without AVX-512 only the ordinary one is run, emulated.
avx512_if_here() { lacks_avx512 && echo OFF || echo ON; }

# AddressSanitizer and UndefinedBehaviorSanitizer on most tests (tests/CMakeLists.txt and tools.cmake say on which not), and some seconds of fuzzing in
# the same build.
test_sanitized_and_fuzz() {
  local seconds=${FASTCCD_FUZZ_SECONDS:-20} sanitized=$build-sanitized avx512
  avx512=$(avx512_if_here)
  CC=clang CXX=clang++ build=$sanitized configure_and_build -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DFASTCCD_SANITIZE=address,undefined \
    -DFASTCCD_FUZZERS=ON -DFASTCCD_AVX512=$avx512 -DFASTCCD_TOOLS=ON -DFASTCCD_TESTS=ON -DFASTCCD_BENCHMARKS=OFF -DFASTCCD_WERROR=ON
  say "testing with sanitizers"
  ctest --test-dir "$sanitized" --output-on-failure --parallel "$(nproc)"

  say "fuzzing, $seconds s each, two at a time"
  local beside
  fuzz npy "$seconds" npy &
  beside=$!
  fuzz csv "$seconds" csv
  wait "$beside"
  fuzz mesh "$seconds" ply obj &
  beside=$!
  fuzz pairs "$seconds" pairs
  wait "$beside"
}

# fuzz NAME SECONDS CORPUS...: on a copy of the corpora; stops at the first input that fails, and keeps it.
fuzz() {
  local fuzzer=$build-sanitized/tests/fuzz/${1}_fuzzer work=$build-sanitized/fuzz/$1 log=$build-sanitized/fuzz/$1.log seconds=$2 corpus
  shift 2
  rm -rf "$work"
  mkdir -p "$work"
  for corpus in "$@"; do cp "$root/tests/fuzz/corpus/$corpus/"* "$work"; done
  if ! "$fuzzer" "$work" -max_total_time="$seconds" -artifact_prefix="$work-failed-" >"$log" 2>&1 || ! grep -q DONE "$log"; then
    tail -n 40 "$log" >&2
    echo "the input that failed is $(ls "$work"-failed-* 2>/dev/null)" >&2
    return 1
  fi
  printf '%s: %s\n' "$(basename "$fuzzer")" "$(grep DONE "$log")"
}

# beside NAME COMMAND...: runs it while the next builds go on, since by itself it would leave a core idle; finish_beside says how it went.
besides=() beside_jobs=()
beside() {
  local name=$1
  shift
  say "$name, begun"
  set -m  # a process group of its own, to stop all of it
  "$@" >"$build/beside-${#besides[@]}.txt" 2>&1 &
  set +m
  besides+=("$name") beside_jobs+=($!)
}
trap 'for job in "${beside_jobs[@]}"; do kill -- "-$job" 2>/dev/null || true; done' EXIT

finish_beside() {
  local i failed=0
  for i in "${!besides[@]}"; do
    say "${besides[i]}"
    wait "${beside_jobs[i]}" || { failed=1; echo "failed:"; } >&2
    cat "$build/beside-$i.txt"
  done
  beside_jobs=()
  return $failed
}

# ThreadSanitizer on the scheduler, with a stand-in for oneTBB (tests/thread_sanitizer/tbb/workers.h says why). By g++, because clang 14
# leaves out loads and stores of 32 and 64 bytes, and most of those of the wide kernels are such. Without AVX-512, which takes minutes more to
# compile: all lanes are one text, so those of AVX2 share with other threads what its would.
test_races() {
  local races=$build-races fixed_addresses=(setarch --addr-no-randomize)
  CXX=g++ build=$races configure_and_build -DCMAKE_CXX_FLAGS_RELEASE=-O1 -DFASTCCD_SANITIZE=thread -DFASTCCD_AVX512=OFF \
    -DFASTCCD_TOOLS=OFF -DFASTCCD_TESTS=ON -DFASTCCD_BENCHMARKS=OFF -DFASTCCD_WERROR=ON -- race_test
  # Newer kernels scatter addresses more widely than the ThreadSanitizer of g++ 12 expects; some containers cannot switch that off.
  "${fixed_addresses[@]}" true 2>/dev/null || fixed_addresses=()
  beside "looking for races" env TSAN_OPTIONS="halt_on_error=1 history_size=7" "${fixed_addresses[@]}" \
    "$races/tests/thread_sanitizer/race_test" --gtest_brief=1
}

# The same answers, bit by bit, as on this machine: without AVX (the wide kernels must not even be touched), with AVX-512 if this one has
# none, and from NEON lanes.
test_other_machines() {
  local here=$build/digest-here.txt pairs=60 arm64=$build-arm64
  if [ "$(uname -m)" != x86_64 ]; then
    say "emulated machines: only from x86-64"
    return 0
  fi
  "$build/tests/fastccd_digest" $pairs >"$here"
  beside "emulated x86-64 without AVX" emulate_x86_without_avx
  if lacks_avx512; then beside "emulated x86-64 with AVX-512" emulate_avx512; fi

  build=$arm64 configure_and_build "-DCMAKE_TOOLCHAIN_FILE=$root/tools/arm64.cmake" -DFASTCCD_TOOLS=OFF -DFASTCCD_TESTS=ON \
    -DFASTCCD_BENCHMARKS=OFF -DFASTCCD_WERROR=ON -- fastccd_digest api_test boxes_test c_interface_test \
    floating_point_environment_test separation_bits_test
  beside "emulated arm64" emulate_arm64
  "$root/tests/exported_symbols_test.sh" "$arm64/libfastccd.so" "$root/tests/exported_symbols.txt"
}

emulate_x86_without_avx() {
  qemu-x86_64-static -cpu Nehalem "$build/tests/fastccd_digest" $pairs | cmp - "$here"
  qemu-x86_64-static -cpu Nehalem "$build/tests/api_test" --gtest_brief=1
}

emulate_arm64() {
  qemu-aarch64-static "$arm64/tests/fastccd_digest" $pairs | cmp - "$here"
  qemu-aarch64-static "$arm64/tests/api_test" --gtest_brief=1
  qemu-aarch64-static "$arm64/tests/boxes_test" --gtest_brief=1
  qemu-aarch64-static "$arm64/tests/separation_bits_test" --gtest_brief=1 --gtest_filter='SeparationBits.IsasOnMadePairs'
  qemu-aarch64-static "$arm64/tests/c_interface_test"
  qemu-aarch64-static "$arm64/tests/floating_point_environment_test" --gtest_brief=1 --gtest_filter='*OfFewPairs'
}

# Two to three minutes on one core, hence few pairs: the lanes' and the intervals' kernels, those with a separation, boxes, a small stack.
emulate_avx512() {
  local few=$build/digest-few.txt
  "$build/tests/fastccd_digest" 6 >"$few"
  exec "$root/tests/emulated_avx512.sh" "$build-avx512" "$build/tests" "$few" <<'EOF'
fastccd_digest 6 | cmp - digest-few.txt
separation_bits_test --gtest_brief=1 --gtest_filter=*AnyLane*:*PowerOfTwo*:*Layouts*
boxes_test --gtest_brief=1 --gtest_filter=*NotFinite*
small_stack_test --gtest_brief=1 --gtest_filter=*HardToTell*
EOF
}

# The newest compiler of Debian 12 besides g++ 12, and clang 14 that test_sanitized_and_fuzz uses: the library, and the same answers.
test_other_compiler() {
  local here=$build/digest-of-gcc.txt pairs=60 clang19=$build-clang19
  "$build/tests/fastccd_digest" $pairs >"$here"
  CC=clang-19 CXX=clang++-19 build=$clang19 configure_and_build -DFASTCCD_TOOLS=OFF -DFASTCCD_TESTS=ON -DFASTCCD_BENCHMARKS=OFF \
    -DFASTCCD_WERROR=ON -- fastccd_digest api_test c_interface_test adapters_test fast_math_test
  say "clang 19"
  "$clang19/tests/fastccd_digest" $pairs | cmp - "$here"
  ctest --test-dir "$clang19" --output-on-failure --tests-regex '^(api_test|c_interface_test|adapters_test|fast_math_test)$'
}
