#!/usr/bin/env bash
# Builds the packages in packages/: one for Debian 12, and an archive for other distributions that includes the required
# libraries. Both are without MPI; for a cluster, build from source.
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
