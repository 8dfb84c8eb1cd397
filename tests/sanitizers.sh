#!/usr/bin/env bash
# Installs what is missing (Debian 12 packages), builds by Clang with address and undefined-behaviour sanitizers and with
# warnings as errors, and runs the tests that tests/sanitizers.cmake does not leave to the release build. A thread
# sanitizer watches the thread team. The last lines are CTest's.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source tests/steps.sh

step "packages" pkm_install_missing "${pkm_build_packages[@]}" "${pkm_test_packages[@]}"
step "build with address and undefined-behaviour sanitizers" build asan
print_summary
echo "== tests under sanitizers"
ctest --preset asan
