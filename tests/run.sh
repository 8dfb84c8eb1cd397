#!/usr/bin/env bash
# Installs what is missing (Debian 12 packages), checks the formatting, builds the release by GCC with warnings as errors,
# and runs every test; the last lines are CTest's. tests/sanitizers.sh repeats tests under sanitizers.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source tests/steps.sh

check_format() {
  find engine objectives constraints experiments bindings tests benchmarks -name '*.[ch]pp' -print0 |
    xargs -0 clang-format-14 --dry-run --Werror
}

step "packages" pkm_install_missing "${pkm_build_packages[@]}" "${pkm_test_packages[@]}"
step "formatting" check_format
step "release build" build ci
print_summary
echo "== tests of the release build"
ctest --preset ci
