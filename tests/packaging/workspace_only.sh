#!/usr/bin/env bash
# workspace_only.sh CMAKE SOURCE BUILD FILE.toml OPTION...: checks that programs can use the components core and
# mechanisms alone. Builds the project with the given options while CMake is not allowed to find what other components
# need, checks that the programs load none of these libraries, and runs the programs; FILE.toml is a mechanism file.
# With the option PKMOPT_SOURCE, only the list of commands is checked, because compiling the library takes minutes.
set -euo pipefail
cmake=$1 source=$2 build=$3 file=$4
shift 4
others='hdf5|nlopt|ipopt|mumps|xxhash|libmpi|libz\.'
fail() { printf '%s\n' "$*" >&2; exit 1; }

disabled=()
for package in HDF5 NLopt MPI ZLIB PkgConfig; do disabled+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON"); done
rm -rf "$build"
"$cmake" -S "$source" -B "$build" -G Ninja "$@" "${disabled[@]}" --no-warn-unused-cli
for program in arm file_workspace whole_core whole_mechanisms; do
  command=$(ninja -C "$build" -t commands "$program" | tail -1)
  grep -q -- "-o $program .*libpkmopt_core\.a" <<<"$command" || fail "$program does not link pkmopt::core: $command"
  ! grep -Ei -- "$others|pkmopt_(io|optimisers)" <<<"$command" || fail "$program links too much"
done
if [[ " $* " == *" -DPKMOPT_SOURCE="* ]]; then
  echo "only core and mechanisms"
  exit
fi

"$cmake" --build "$build"
for program in arm file_workspace whole_core whole_mechanisms; do
  ! ldd "$build/$program" | grep -Ei "$others" || fail "$program loads a library that only other components need"
done
! ldd "$build/arm" | grep -i toml || fail "arm loads toml++, which it does not need"
"$build/arm" || fail "arm ended with exit code $?"
"$build/file_workspace" "$file" || fail "file_workspace ended with exit code $?"
echo "only core and mechanisms"
