#!/usr/bin/env bash
# Installs missing Debian 12 packages, builds the program, runs the paper's study and prints the result. Can be run
# repeatedly and from any folder.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
source experiments/debian-packages.sh

pkm_install_missing "${pkm_build_packages[@]}"

build=build/quickstart
cmake --preset quickstart --log-level=WARNING
cmake --build --preset quickstart --parallel "$(nproc)"

study=$build/paper-problem.h5
"$build/bin/pkmopt" run experiments/4ppa-2par/paper-problem.toml --output "$study" --force

echo
printf 'Show the result again with:  %q show %q\n' "$PWD/$build/bin/pkmopt" "$PWD/$study"
printf 'Use it from Python with:     PYTHONPATH=%q python3 -c "import pkmopt"\n' "$PWD/bindings/python"
