#!/bin/sh
# Writes the force curves of the dynamics paper (figures 10, 12, 13) as CSV files: its oscillation, the quintic moves of
# table 2 along x, y, z at 3, 7 and 11 m/s^2, the diagonal at several yaws; and the other motions of this folder.
# Usage: force-curves.sh [FOLDER]     default: the current folder. PKMOPT names the program, default: pkmopt.
set -eu
motions=$(dirname "$0")/motions
folder=${1:-.}
mkdir -p "$folder"
for motion in "$motions"/*.toml; do
  name=$(basename "$motion" .toml)
  "${PKMOPT:-pkmopt}" trajectory 3crr-r-cru --motion "$motion" --csv "$folder/$name.csv" > "$folder/$name.txt"
  printf '%s: ' "$name"
  grep 'peak force' "$folder/$name.txt"
done
