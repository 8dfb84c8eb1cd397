#!/usr/bin/env bash
# Installs what is missing (Debian 12 packages), builds everything and runs every test; the last lines are CTest's.
# In this order: formatting; a Clang build with address and undefined-behaviour sanitizers, in which headers without a
# source are compiled on their own, too, and a thread sanitizer watches the team; the release build by GCC. Warnings are
# errors in both builds.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source experiments/debian-packages.sh

summary=()
step() {  # step NAME COMMAND...: runs the command, remembers its time
  local name=$1 begin=$SECONDS
  shift
  echo "== $name"
  "$@"
  summary+=("$(printf '%5d s  %s' $((SECONDS - begin)) "$name")")
}
build() {  # build PRESET
  cmake --preset "$1" --log-level=WARNING
  cmake --build --preset "$1" --parallel "$(nproc)"
}
check_format() {
  find engine objectives constraints experiments tests benchmarks -name '*.[ch]pp' -print0 |
    xargs -0 clang-format-14 --dry-run --Werror
}

step "packages" pkm_install_missing "${pkm_build_packages[@]}" "${pkm_test_packages[@]}"
step "formatting" check_format
step "build with address and undefined-behaviour sanitizers" build asan
step "its tests" ctest --preset asan
step "release build" build ci

printf '== so far\n'
printf '%s\n' "${summary[@]}"
echo "== tests of the release build"
ctest --preset ci
