#!/usr/bin/env bash
# Installs what is missing (Debian 12 packages), checks the formatting, builds the release by GCC with warnings as errors,
# and runs every test; the last lines are CTest's. tests/sanitizers.sh repeats tests under sanitizers.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source tests/steps.sh

wait_for_packages() {  # wait_for_packages PROCESS LOG
  wait "$1" || { cat "$2"; return 1; }
  rm -- "$2"
}
check_format() {
  find engine objectives constraints experiments bindings tests benchmarks -name '*.[ch]pp' -print0 |
    xargs -0 -n 50 -P "$(nproc)" clang-format-14 --dry-run --Werror
}

# What only running tests need (a browser, Octave, Sphinx, a scheduler) is installed while the build runs.
step "packages for the build" pkm_install_missing "${pkm_build_packages[@]}" "${pkm_test_libraries[@]}"
step "formatting" check_format
log=$(mktemp)
pkm_install_missing "${pkm_test_packages[@]}" >"$log" 2>&1 &
step "release build" build ci
step "other packages for the tests" wait_for_packages $! "$log"
step "release build of what these packages add" build ci
print_summary
echo "== tests of the release build"
ctest --preset ci
