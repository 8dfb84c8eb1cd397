#!/usr/bin/env bash
# Runs all campaigns at full length, which takes hours. Each prints a table. Exit code 1 if any campaign finds a fault.
#   run.sh [EXECUTIONS]  executions of each fuzzer (default 1000000)
set -uo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")"

root=$(cd ../.. && pwd) program=$root/build/ci/bin/pkmopt disk=$root/build/ci/tests/campaigns/libpkm_unreliable_disk.so
[[ -f $root/build/ci/build.ninja ]] || (cd "$root" && cmake --preset ci --log-level=WARNING) || exit
(cd "$root" && cmake --build --preset ci --parallel "$(nproc)" --target pkmopt_app pkmopt_check_proof pkm_unreliable_disk \
  pkm_ranks_tests pkm_rank_program pkm_mpfi_tests pkm_tests pkm_cli_tests) || exit
found=0
step() {
  echo "== $*"
  "$@" || found=1
}
step cmake --build "$root/build/ci" --target pkm_headers_alone
step ./kills.py "$program" "$disk" --kills 1000
step ./interrupts.py "$program" --interrupts 200 --bound 0.2
step env PKM_RANK_KILLS=10 "$root/build/ci/tests/ranks/pkm_ranks_tests" --gtest_filter='*Killed*'
step env PKM_INTERVAL_OPERATIONS=1000000 "$root/build/ci/tests/mpfi/pkm_mpfi_tests"
step env PKM_BOUNDED_DESIGNS=1000 "$root/build/ci/tests/pkm_tests" --gtest_filter='*BoundedColumns*'
step env PKM_SLOPE_DESIGNS=1000 "$root/build/ci/tests/pkm_tests" --gtest_filter='*DerivativeContract*'
step env PKM_EVERY_MESSAGE=1 "$root/build/ci/tests/cli/pkm_cli_tests" --gtest_filter='CliMessages*'
step env PKM_RANDOM_SLOPES=2000 "$root/build/ci/tests/pkm_tests" --gtest_filter='*RandomSlopes*'
step env PKM_COMPONENT_DESIGNS=200 "$root/build/ci/tests/pkm_tests" --gtest_filter='Components.OfRandomDesigns*'
step env PKM_POWER_STATES=10000 "$root/build/ci/tests/pkm_tests" --gtest_filter='*PowerOfTheDrives*'
step ./disk.py "$program" "$disk"
step ./soak.py "$program" --evaluations 10000000 --runs 200
step ./tolerances.py "$program" --robots 100000 --poses 1000
step ./proofs.py "$program" "$root/build/ci/bin/pkmopt-check-proof" --mutations 100000
step ./fuzz.sh --runs "${1:-1000000}"
exit $found
