#!/usr/bin/env bash
# Installs the peers (Debian 12 packages) and the dependencies of pkmopt, builds it, and compares pkmopt with the peers
# on the paper's problem and the wide-bounds problem. Takes some minutes after the build, during which the machine
# should be idle.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
source experiments/debian-packages.sh

pkm_install_missing "${pkm_build_packages[@]}" libbenchmark-dev libgtest-dev libgmock-dev libfcl-dev \
  libpagmo-dev libboost-serialization-dev libtbb-dev octave octave-ga \
  python3 python3-deap python3-scipy python3-numba python3-h5py time

build=build/release
cmake --preset release --log-level=WARNING
cmake --build --preset release --parallel "$(nproc)" --target pkmopt_app pkm_peer_pagmo pkm_peer_pagmo_columns

mkdir -p "$build/peers"
export PYTHONPYCACHEPREFIX=$PWD/$build/peers NUMBA_CACHE_DIR=$PWD/$build/peers
# Debian's Python, for which the packages are installed.
/usr/bin/python3 benchmarks/peers/compare.py "$build/bin/pkmopt" "$build/benchmarks/pkm_peer_pagmo" \
  "$build/benchmarks/pkm_peer_pagmo_columns" "$build/peers"
