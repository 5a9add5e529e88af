#!/usr/bin/env bash
# Sets everything up, builds fastccd, makes a sample and runs the main job on it.
source "$(dirname "$0")/setup.sh"
install_packages "${library_packages[@]}" "${tool_packages[@]}"
configure_and_build -DFASTCCD_TESTS=OFF -DFASTCCD_BENCHMARKS=OFF -- fastccd_command

fastccd=$build/fastccd
sample=$(mktemp -d)
trap 'rm -rf "$sample"' EXIT

say "instruction sets"
"$fastccd" isa
say "10 million random vertex-face pairs (the paper's test), contacts at odd and even numbers of roots"
"$fastccd" random --kind vf --pairs 10000000 --seed 1 --parity
say "a file of edge-edge pairs: written, read back memory-mapped, contacts listed"
"$fastccd" random --kind ee --pairs 200000 --seed 2 --save "$sample/pairs.npy" --quiet
"$fastccd" run "$sample/pairs.npy" --kind ee --hits "$sample/hits.csv"
say "the first contacts of $(($(wc -l <"$sample/hits.csv") - 1)) in hits.csv"
head -n 6 "$sample/hits.csv"
