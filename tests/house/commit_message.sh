#!/usr/bin/env bash
# Checks .githooks/commit-msg: which commit messages it accepts and which it refuses.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
file=$(mktemp)
trap 'rm -f -- "$file"' EXIT
failed=0

expect() {  # accepted|refused MESSAGE
  printf '%b' "$2" >"$file"
  local found=accepted
  .githooks/commit-msg "$file" 2>/dev/null || found=refused
  [[ $found == "$1" ]] && return
  printf 'expected to be %s: %s\n' "$1" "$2" >&2
  failed=1
}

expect accepted 'columns: bracket critical values by extrapolation\n\nBisection took 60 steps.\n'
expect accepted 'tests: add study files of version 7\n'
expect accepted 'app, report: pass the working mode\n# a comment of git\n'
expect accepted 'bounds: process boxes in batches\n'
expect accepted 'Merge branch "main"\n'
expect refused ''
expect refused 'Breaks of columns are followed by what vanishes there\n'
expect refused 'columns: bisected critical values\n'
expect refused 'columns: adds a test\n'
expect refused 'columns: adding a test\n'
expect refused 'columns: add a test.\n'
expect refused 'columns: Add a test\n'
expect refused 'columns: add a test\nwithout an empty line\n'
expect refused 'columns: add a test whose subject is so long that no log shows it in one line\n'
exit $failed
