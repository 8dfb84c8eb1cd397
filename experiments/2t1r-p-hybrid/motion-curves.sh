#!/bin/sh
# Writes the curves of the hybrid robot's paper along its sample motion (its figures 4 and 5) as a CSV file: the pose,
# the drives s1 to s4 with their speeds and accelerations, the auxiliary chain's input theta and output gamma, and the
# output shaft's absolute angular velocity omega and acceleration alpha. SI units and radians.
# Usage: motion-curves.sh [FOLDER]     default: the current folder. PKMOPT names the program, default: pkmopt.
set -eu
folder=${1:-.}
mkdir -p "$folder"
"${PKMOPT:-pkmopt}" trajectory 2t1r-p-hybrid --motion "$(dirname "$0")/motions/paper.toml" --samples 501 \
  --csv "$folder/paper-motion.csv"
