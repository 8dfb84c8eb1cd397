#!/usr/bin/env bash
# Builds the packages in packages/: one for Debian 12, an archive for other distributions that includes the required
# libraries, and a wheel of the Python package with these libraries. All are without MPI; for a cluster, build from
# source. Two builds of one commit give the same bytes: all times are that of the commit, or SOURCE_DATE_EPOCH.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source experiments/debian-packages.sh
source experiments/repack.sh

pkm_install_missing "${pkm_build_packages[@]}" dpkg-dev file python3

export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}
build=build/package
rm -f packages/pkmopt[-_]*
for bundle in OFF ON; do
  cmake --preset package --log-level=WARNING -DPKM_BUNDLE=$bundle
  cmake --build --preset package --parallel "$(nproc)"
  if [[ $bundle == OFF ]]; then cpack --config $build/CPackConfig.cmake -B packages; fi
done
rm -rf packages/_CPack_Packages
pkm_repack_deb packages/*.deb

version=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")/\1/p' $build/CPackConfig.cmake)
tree=$build/pkmopt-$version-Linux
rm -rf "$tree"
cmake --install $build --prefix "$tree" --strip > $build/install.log
python3 experiments/sbom.py "$tree" "$version"
pkm_pack_tree "$tree" "packages/pkmopt-$version-Linux.tar.gz"
python3 bindings/python/make_wheel.py "$tree" "$version" packages
rm -rf "$tree"
ls -l packages
