#!/usr/bin/env bash
# octave.sh PREFIX OCTAVE FOLDER: compiles the MEX file of the installed functions for MATLAB and Octave into a folder,
# and uses it in a session of its own.
set -euo pipefail
prefix=$1 octave=$2 folder=$3
rm -rf "$folder" && mkdir -p "$folder"
library=$(echo "$prefix"/lib*/*/libpkmopt.so "$prefix"/lib*/libpkmopt.so | tr ' ' '\n' | grep -v '\*' | head -n 1)
export PKG_CONFIG_PATH=${library%/*}/pkgconfig OCTAVE_HISTFILE=/dev/null
run() { "$octave" --no-init-file --quiet --eval "$1"; }
functions="addpath('$prefix/share/pkmopt/matlab');"
run "$functions try, pkmopt.version(); catch e, assert(e.identifier, 'pkmopt:notBuilt'), end"
run "$functions try, pkmopt.build('/proc'); catch e, disp(e.message), end"
run "$functions pkmopt.build('$folder/mex')"
run "addpath('$folder/mex'); $functions  % the order does not matter
  delta = pkmopt.Mechanism('$prefix/share/pkmopt/experiments/mechanisms/rotary-delta.toml');
  [volume, ~, ~, unit] = delta.design().volume();
  printf('Octave %s %.6g %s\n', pkmopt.version(), volume, unit)"
