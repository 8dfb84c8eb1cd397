# What tests/run.sh and tests/sanitizers.sh share: steps with their times. To be sourced at the root of the repository.
source experiments/debian-packages.sh
# The tests need some 400 packages. Without a synchronisation of the disk after each file, they are unpacked sooner.
pkm_apt_options=(-o Dpkg::Options::=--force-unsafe-io)

summary=()
step() {  # step NAME COMMAND...: runs the command and records its time
  local name=$1 begin=$SECONDS
  shift
  echo "== $name"
  "$@"
  summary+=("$(printf '%5d s  %s' $((SECONDS - begin)) "$name")")
}
build() {  # build PRESET
  cmake --preset "$1" --log-level=WARNING
  cmake --build --preset "$1" --parallel "$(nproc)"
}
print_summary() {
  printf '== so far\n'
  printf '%s\n' "${summary[@]}"
}
