#!/bin/sh
# Writes the maps of the coupling indices over the plane z = 260 mm (figures 14 and 16 of the dynamics paper) as CSV
# files, of (3CRR/R)&CRU and of the Quadrupteron, for several yaws; and the statistics of both over the central region.
# Usage: coupling-maps.sh [FOLDER]    default: the current folder. PKMOPT names the program, default: pkmopt.
set -eu
folder=${1:-.}
mkdir -p "$folder"
for mechanism in 3crr-r-cru quadrupteron; do
  for phi in 0 30 60; do
    "${PKMOPT:-pkmopt}" coupling "$mechanism" --box x=60mm:240mm,y=110mm:290mm,z=259.9mm:260.1mm \
      --cells x=90,y=90,z=1 --phi "${phi}deg" --csv "$folder/$mechanism-z260-phi$phi.csv" --force > /dev/null
  done
  "${PKMOPT:-pkmopt}" coupling "$mechanism" --box x=60mm:240mm,y=110mm:290mm,z=150mm:270mm \
    --cells x=36,y=36,z=24 --phi 0,15deg,30deg,45deg,60deg > "$folder/$mechanism-region.txt"
  echo "$folder/$mechanism-z260-phi{0,30,60}.csv, $folder/$mechanism-region.txt"
done
