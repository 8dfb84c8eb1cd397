#!/usr/bin/env bash
# Builds the packages in packages/: one for Debian 12, an archive for other distributions that includes the required
# libraries, and a wheel of the Python package with these libraries. All are without MPI; for a cluster, build from
# source.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source experiments/debian-packages.sh

pkm_install_missing "${pkm_build_packages[@]}" dpkg-dev file python3

build=build/package
for bundle in OFF ON; do
  cmake --preset package --log-level=WARNING -DPKM_BUNDLE=$bundle
  cmake --build --preset package --parallel "$(nproc)"
  cpack --config $build/CPackConfig.cmake -B packages
done
cmake --install $build --prefix $build/tree > $build/install.log  # that of the archive
version=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")/\1/p' $build/CPackConfig.cmake)
python3 bindings/python/make_wheel.py $build/tree "$version" packages
rm -rf packages/_CPack_Packages $build/tree
ls -l packages
