#!/usr/bin/env bash
# add_subdirectory.sh CMAKE SOURCE BUILD OPTION...: checks that a user's project can use pkmopt by add_subdirectory().
# Configures the project with the given options, compiles its own source file, the file that depends on MPI and the
# version file (compiling the whole library would take minutes), and checks in Ninja's list of commands that the library
# and the program would be built, but none of pkmopt's tests, benchmarks and programs.
set -euo pipefail
cmake=$1 source=$2 build=$3
shift 3
"$cmake" -S "$source" -B "$build" -G Ninja "$@"
"$cmake" --build "$build" --target CMakeFiles/scara.dir/scara.cpp.o pkm_ranks pkmopt_version
commands=$(ninja -C "$build" -t commands scara)
for library in core mechanisms optimisers io; do
  grep -q -- "-o pkmopt/CMakeFiles/pkmopt_$library.dir/" <<<"$commands"
done
grep -q -- '-o scara ' <<<"$commands"
if grep -E -- '-o (pkmopt/(tests|benchmarks)/|pkmopt/bin)' <<<"$commands"; then exit 1; fi
