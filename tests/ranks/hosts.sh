#!/usr/bin/env bash
# hosts.sh RANK_PROGRAM FOLDER: tests ranks on two hosts, simulated by two network namespaces with different host names,
# connected by a veth pair. Checks the messages, a study of designs with uneven evaluation times (claimed dynamically)
# and a multistart solver stage; the files must equal those of one process. Exit code 77 (skipped): not root, or
# namespaces are not permitted.
set -euo pipefail
program=$(realpath "$1") folder=$2
tests=$(realpath "$(dirname -- "${BASH_SOURCE[0]}")/..")
for tool in mpirun ip unshare nsenter; do
  PATH=$PATH:/usr/sbin command -v "$tool" > /dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
export PATH=$PATH:/usr/sbin
unshare --net --uts true 2> /dev/null || { echo "skipped: this user cannot create namespaces"; exit 77; }
fail() { printf '%s\n' "$*" >&2; exit 1; }

rm -rf "$folder" && mkdir -p "$folder" && cd "$folder"
declare -A holder
trap 'kill "${holder[@]}"' EXIT
for host in pkm-one pkm-two; do
  unshare --net --uts sh -c "hostname $host && exec sleep 600" & # keeps the namespaces until it is killed
  holder[$host]=$!
done
on() { nsenter --target "${holder[$1]}" --net --uts -- "${@:2}"; }
for host in pkm-one pkm-two; do
  until [[ $(on $host hostname) == "$host" ]]; do sleep 0.05; done
done
on pkm-one ip link add pkm0 type veth peer name pkm0 netns "${holder[pkm-two]}"
on pkm-one ip address add 10.77.0.1/24 dev pkm0
on pkm-two ip address add 10.77.0.2/24 dev pkm0
for host in pkm-one pkm-two; do
  on $host ip link set lo up
  on $host ip link set pkm0 up
done

# Replaces ssh, by which mpirun starts its daemon on the other host.
cat > agent <<AGENT
#!/usr/bin/env bash
while [[ \$1 == -* ]]; do shift; done
[[ \$1 == pkm-two ]] || exit 1
exec nsenter --target ${holder[pkm-two]} --net --uts -- bash -c "\${*:2}"
AGENT
chmod +x agent
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
on_two_hosts() {
  on pkm-one mpirun --host pkm-one:1,pkm-two:1 -n 2 --bind-to none --mca plm_rsh_agent "$folder/agent" \
    --mca oob_tcp_if_include pkm0 --mca btl_tcp_if_include pkm0 "$@"
}
folder=$PWD

on_two_hosts "$program" --exchange
cat > slow.toml <<STUDY
mechanism = { type = "4ppa-2par" }
variables = { a = { min = 0.15, max = 0.95 }, b = { min = 0.35, max = 1.55 } }
objective = [{ type = "slow" }]
stage = [{ optimiser = "ga", population = 40, generations = 10 }]
STUDY
cat > starts.toml <<STUDY
mechanism = { type = "4ppa-2par" }
variables = { a = { min = 0.15, max = 0.95 }, b = { min = 0.35, max = 1.55 } }
workspace = { method = "columns" }
objective = [{ type = "workspace-ratio" }]
stage = [{ optimiser = "nlopt", start = "none", multistart = 6 }]
STUDY
for study in slow starts; do
  "$program" run $study.toml --output $study-straight.h5 --quiet --threads 1
  on_two_hosts "$program" run $study.toml --output $study.h5 --threads 1 > $study.out
  grep -q "on pkm-one, pkm-two: parallel" $study.out || fail "$study: did not run on two hosts"
done
PYTHONPATH=$tests/campaigns /usr/bin/python3 - <<'PY' || fail "the files of two hosts and of one process differ"
from campaign import digest, state
for name in ("slow", "starts"):
    assert state(name + ".h5") == "finished" and digest(name + ".h5") == digest(name + "-straight.h5"), name
PY
echo "two hosts wrote the same files as one process"
