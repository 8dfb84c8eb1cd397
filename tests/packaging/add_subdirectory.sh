#!/usr/bin/env bash
# A user's project with our sources as a subfolder is configured, by options of its own; its own file, the one file that
# stands for MPI and the program's version compile; the rest is known to Ninja, with nothing that the user did not ask for.
#   add_subdirectory.sh CMAKE SOURCE BUILD OPTION...
set -euo pipefail
cmake=$1 source=$2 build=$3
shift 3
"$cmake" -S "$source" -B "$build" -G Ninja "$@"
"$cmake" --build "$build" --target CMakeFiles/scara.dir/scara.cpp.o pkm_ranks pkmopt_version
commands=$(ninja -C "$build" -t commands scara)
grep -q -- '-o pkmopt/CMakeFiles/pkmopt.dir/' <<<"$commands"
grep -q -- '-o scara ' <<<"$commands"
if grep -E -- '-o (pkmopt/(tests|benchmarks)/|pkmopt/bin)' <<<"$commands"; then exit 1; fi
