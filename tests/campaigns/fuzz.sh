#!/usr/bin/env bash
# fuzz.sh [--built FOLDER] [SECONDS | --runs N]: builds all fuzzers, unless FOLDER contains them, and runs each of them for
# SECONDS (default 60) or for N inputs. With --built, which is meant for short runs, the shipped mechanism files are not
# among the first inputs, because to read them all takes a minute under sanitizers. Inputs that reach new code are added to build/fuzz/corpus/TARGET for later runs;
# inputs that crash, hang or violate an expectation are saved in build/fuzz/crashes. Prints a table; exit code 1 if there
# were any. TARGETS="formula motion" selects fuzzers.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."

root=$PWD build=$PWD/build/fuzz is_built=
if [[ ${1-} == --built ]]; then
  build=$2 is_built=1
  shift 2
else
  [[ -f $build/build.ninja ]] || cmake --preset fuzz --log-level=WARNING
  cmake --build --preset fuzz --parallel "$(nproc)"
fi
by=max_total_time amount=${1:-60}
[[ ${1-} == --runs ]] && by=runs amount=$2
export LSAN_OPTIONS="suppressions=$root/tests/leaks.txt:print_suppressions=0"
mkdir -p "$build/crashes" "$build/empty"
cd "$build/empty"  # so that files named in the inputs do not exist

declare -A max_len=([study_toml]=8192 [mechanism_file]=8192 [motion]=2048 [formula]=512 [quantity]=128 [command_line]=512 [study_file]=262144)
faults=0
rows=$(printf '%-14s%14s%10s%10s' target executions seconds crashes)
for target in ${TARGETS:-study_toml mechanism_file motion formula quantity command_line study_file}; do
  seeds=("$root/tests/campaigns/corpus/$target")
  [[ $target == study_toml || $target == motion ]] && seeds+=("$root/experiments")
  [[ $target == mechanism_file && ! $is_built ]] && seeds+=("$root/experiments/mechanisms")
  [[ $target == study_file ]] && seeds+=("$root/tests/data")  # older schemas
  mkdir -p "$build/corpus/$target"
  # Leak detection after each input gives false alarms for HDF5 and doubles the time; it is done at the end only.
  leaks=1
  [[ $target == study_file ]] && leaks=0
  executed=0 crashes=0 begin=$SECONDS left=$amount
  while ((left > 0)); do  # a crash ends the fuzzer: it is restarted for the remaining time or inputs
    log=$build/$target.log code=0
    "$build/bin/fuzz_$target" "-$by=$left" -detect_leaks=$leaks -timeout=60 "-max_len=${max_len[$target]}" -print_final_stats=1 -close_fd_mask=1 \
      -verbosity=1 "-artifact_prefix=$build/crashes/$target-" "$build/corpus/$target" "${seeds[@]}" >"$log" 2>&1 || code=$?
    now=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    executed=$((executed + ${now:-0}))
    ((code)) || break
    crashes=$((crashes + 1))
    cp "$log" "$build/crashes/$target-$crashes.log"
    grep -m1 -A20 -E 'expected: |ERROR: |runtime error: ' "$log" || tail -n 20 "$log"
    ((crashes < 20)) || break
    if [[ $by == runs ]]; then left=$((amount - executed)); else left=$((amount - SECONDS + begin)); fi
  done
  faults=$((faults + crashes))
  rows+=$'\n'$(printf '%-14s%14d%10d%10d' "$target" "$executed" $((SECONDS - begin)) "$crashes")
  printf '%s\n' "${rows##*$'\n'}"
done
printf '\n%s\n' "$rows"
((faults == 0))
