#!/usr/bin/env bash
# own_program.sh PROGRAM FOLDER PAGE: runs the commands of a user's program with each of its own mechanisms. Output
# files are written to FOLDER; PAGE is 1 if the program can write HTML reports.
set -euo pipefail
program=$1 folder=$2 page=$3
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder"

fail() { printf '%s\n' "$*" >&2; exit 1; }
# expect PATTERN COMMAND ARGUMENT...: requires exit code 0 and a line of the output that matches the pattern.
expect() {
  local pattern=$1; shift
  "$program" "$@" > output.txt 2> errors.txt || fail "exit code $? of: $*" "$(cat errors.txt)"
  grep -Eq -- "$pattern" output.txt || fail "no line matches '$pattern' in what this printed: $*" "$(cat output.txt)"
}

# try NAME PARAMETER CELLS POSE JOINT UNIT: runs the commands with mechanism NAME.
#   PARAMETER  a variable of the study, "name = { min = .., max = .. }"
#   CELLS      number of voxels along the swept coordinates
#   POSE       a feasible pose
#   JOINT      a joint coordinate, and the UNIT in which it is printed
try() {
  local name=$1 variable=$2 cells=$3 pose=$4 joint=$5 unit=$6 values
  values=$(sed 's/=/ = /g; s/,/, /g; s/\([0-9]\)deg/"\1 deg"/g' <<< "$pose")
  cat > "$name.toml" <<STUDY
mechanism = { type = "$name" }
variables = { $variable }
workspace = { method = "voxels", cells = { $cells } }
objective = [{ type = "workspace-volume" }]
stage = [{ optimiser = "ga", population = 6, generations = 3 }]
[[motion]]
name = "sway"
type = "formulas"
duration = 1
$(tr ',' '\n' <<< "$values" | sed '1s/= *\(.*\)/= "\1 + 0.01*sin(2*pi*t)"/')
STUDY
  expect "^ *$name " list mechanisms
  expect "$joint" list mechanisms "$name"
  expect "workspace-volume: maximise" check "$name.toml"
  expect "finished, 24 evaluations" run "$name.toml" --output "$name.h5"
  expect "^ *$joint +-?[0-9.e-]+ $unit\$" pose "$name" --at "$pose"
  expect "feasible +yes" trajectory "$name.toml" --motion sway --samples 11 --csv "$name.csv"
  grep -q ",$joint," "$name.csv" || fail "$name.csv has no column $joint"
  expect "feasible cells +[1-9]" workspace "$name" --cells "${cells// /}" --vtk "$name.vtkhdf" --csv "$name-cells.csv"
  grep -q "$joint" "$name-cells.csv" || fail "$name-cells.csv has no column $joint"
  expect "wrote .*best.csv" export "$name.h5" --csv "$name-tables" --vtk "$name-best.vtkhdf"
  expect "workspace-volume" show "$name.h5"
  [ "$page" = 1 ] || return 0
  expect "$name.html" report "$name.h5"
  grep -q "$name" "$name.html" || fail "$name.html does not name its mechanism"
}

try five-bar "l_1 = { min = 0.2, max = 0.4 }" "x = 12, y = 12" x=0.02,y=0.35 q1 deg
try rotary-delta "l_1 = { min = 0.1, max = 0.3 }" "x = 8, y = 8, z = 8" x=0.02,y=0.01,z=-0.4 q3 deg
try gough "r = { min = 0.2, max = 0.4 }" "x = 8, y = 8, z = 8" x=0,y=0.02,z=0.8,alpha=0,beta=0.1,gamma=0.1 l6 mm
try scara "l_1 = { min = 0.2, max = 0.4 }" "x = 10, y = 10, z = 2" x=0.2,y=0.1,z=0.1,phi=0.5 q4 deg

# Point-to-point motions, with angles in degrees.
cat > points.toml <<MOTION
type = "points"
points = [{ x = 0, y = 0, z = 0.8, alpha = 0, beta = 0, gamma = 0 }, { beta = "5 deg" }, { x = 0.05, gamma = "-10 deg" }]
time = "200 ms"
MOTION
expect "feasible +yes" trajectory gough --motion points.toml
cat > points.toml <<MOTION
type = "points"
points = [{ x = -0.05, y = 0.3 }, { x = 0.05 }, { y = 0.4 }]
acceleration = 2
back = true
MOTION
expect "peak speed \[rad/s\]" trajectory five-bar --motion points.toml
expect "^ *23\.8[0-9]* mm +347\.7[0-9]* mm " forward five-bar --joints q1=136deg,q2=0.6
expect "^ *other_sweeps +19 sweeps of 3 coordinates, 15 of 2 coordinates, 6 of 1 coordinate; " list mechanisms gough
expect "^ *q1 .* rad/s +.* rad/s\^2" pose five-bar --at x=2cm,y=350mm --velocity x=1
echo "all commands work with all mechanisms"
