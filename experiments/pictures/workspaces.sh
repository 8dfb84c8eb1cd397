#!/usr/bin/env bash
# Draws the nominal workspaces of the four mechanisms side by side, as docs/theory/papers.md shows them: workspaces.png beside this
# script. Needs the program and of Debian python3-vtk9, python3-h5py, xvfb and libgl1-mesa-dri.
#   experiments/pictures/workspaces.sh [PROGRAM]     default: build/quickstart/bin/pkmopt
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
program=${1:-$here/../../build/quickstart/bin/pkmopt}
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT

"$program" workspace 4ppa-2par --cells x=96,z=96,theta=96 --vtk "$folder/1.vtkhdf" >/dev/null
"$program" workspace "$here/../3crr-r-cru/rod-lengths.toml" --fixed phi=30deg --cells x=96,y=96,z=96 \
  --vtk "$folder/2.vtkhdf" >/dev/null
"$program" workspace "$here/../quadrupteron/coupling.toml" --fixed phi=30deg --cells x=96,y=96,z=96 \
  --vtk "$folder/3.vtkhdf" >/dev/null
"$program" workspace 2t1r-p-hybrid --cells x=96,z=96,beta=96 --vtk "$folder/4.vtkhdf" >/dev/null
xvfb-run --auto-servernum /usr/bin/python3 "$here/workspaces.py" "$here/workspaces.png" \
  "4PPa-2PaR:coupling index:dci_worst:$folder/1.vtkhdf" \
  "(3CRR/R)&CRU, phi = 30 deg:coupling index:dci_worst:$folder/2.vtkhdf" \
  "Quadrupteron, phi = 30 deg:coupling index:dci_worst:$folder/3.vtkhdf" \
  "2T1R+P hybrid:conditioning:conditioning:$folder/4.vtkhdf"
