#!/usr/bin/env bash
# Makes packages/: one for Debian 12, and an archive for other distributions that brings the libraries it needs. Both are
# without MPI: who has a cluster builds from source.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source experiments/debian-packages.sh

pkm_install_missing "${pkm_build_packages[@]}" dpkg-dev file

build=build/package
for bundle in OFF ON; do
  cmake --preset package --log-level=WARNING -DPKM_BUNDLE=$bundle
  cmake --build --preset package --parallel "$(nproc)"
  cpack --config $build/CPackConfig.cmake -B packages
done
rm -rf packages/_CPack_Packages
ls -l packages
