#!/usr/bin/env bash
# Sets everything up, builds fastccd, makes a scene and finds all contacts in it: the main job.
source "$(dirname "$0")/setup.sh"
install_packages "${library_packages[@]}" "${tool_packages[@]}"
configure_and_build -DFASTCCD_TOOLS=ON -DFASTCCD_TESTS=OFF -DFASTCCD_BENCHMARKS=OFF -- fastccd_command

fastccd=$build/fastccd
sample=$(mktemp -d)
trap 'rm -rf "$sample"' EXIT

say "instruction sets"
"$fastccd" isa
say "a scene: a cloth falls on a ball and folds"
"$fastccd" make-scene cloth-ball --size 300 --frames 12 "$sample/cloth"
say "all contacts between its frames"
"$fastccd" scene "$sample"/cloth/frame_*.ply --hits "$sample/contacts.csv"
say "the first of $(($(wc -l <"$sample/contacts.csv") - 1)) contacts in contacts.csv"
head -n 6 "$sample/contacts.csv"
say "a million random vertex-face pairs (the paper's test), contacts at odd and even numbers of roots"
"$fastccd" random --kind vf --pairs 1000000 --seed 1 --parity
