#!/usr/bin/env bash
# slurm.sh PROGRAM FOLDER: the scripts of experiments/slurm under a Slurm of this host alone, with rank_program's slow
# designs. A study that comes to its job's time limit is requeued and ends as the one that nobody disturbed; so do seeds
# in jobs of their own. Exit code 77: there is no Slurm, or not root.
set -euo pipefail
program=$(realpath "$1") folder=$2
tests=$(realpath "$(dirname -- "${BASH_SOURCE[0]}")/..") scripts=$(realpath "$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/slurm")
for tool in slurmctld slurmd munged sbatch; do
  PATH=$PATH:/usr/sbin command -v "$tool" > /dev/null || { echo "skipped: there is no $tool"; exit 77; }
done
((EUID == 0)) || { echo "skipped: Slurm's daemons are started by root"; exit 77; }
export PATH=$PATH:/usr/sbin
fail() { printf '%s\n' "$*" >&2; tail -n 20 "$folder"/log/*.log "$folder"/*.out >&2 || true; exit 1; }

rm -rf "$folder" && mkdir -p "$folder"/{state,spool,log} && cd "$folder"
folder=$PWD
pids=()
end() {
  scancel --quiet --user root 2> /dev/null || true
  for file in slurmd ctld munged; do [ ! -s $file.pid ] || pids+=("$(cat $file.pid)"); done
  ((${#pids[@]} == 0)) || kill "${pids[@]}" 2> /dev/null || true
}
trap end EXIT

# A key and a socket of our own. munged insists on folders that only its user can write.
mkdir -m 755 munge
dd if=/dev/urandom of=munge/key bs=128 count=1 status=none && chmod 600 munge/key
munged --force --key-file "$folder/munge/key" --socket "$folder/munge/socket" --pid-file "$folder/munged.pid" \
  --log-file "$folder/log/munged.log" --seed-file "$folder/munge/seed"
host=$(hostname)
cat > slurm.conf <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket,cred_expire=10
CredType=cred/munge
MpiDefault=pmix
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/ctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/ctld.log
SlurmdLogFile=$folder/log/slurmd.log
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmctldPort=16817
SlurmdPort=16818
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$folder/slurm.conf PKMOPT=$program
slurmctld && slurmd
for ((i = 0; i < 100; ++i)); do
  [[ $(sinfo --noheader --format %T 2> /dev/null) == idle ]] && break
  sleep 0.2
done
[[ $(sinfo --noheader --format %T) == idle ]] || fail "the node does not become idle"

cat > study.toml <<STUDY
mechanism = { type = "4ppa-2par" }
variables = { a = { min = 0.15, max = 0.95 }, b = { min = 0.35, max = 1.55 } }
objective = [{ type = "slow" }]
stage = [{ optimiser = "ga", population = 40, generations = 500 }]
STUDY

# The time limit is a minute, Slurm's least; the signal comes so long before it that the job is stopped after seconds, the
# first time: then the limit is raised. A requeued job waits until its credential has expired.
job=$(sbatch --parsable --ntasks-per-node 2 --cpus-per-task 1 --time 1 --signal TERM@57 --output job.out "$scripts/study.sbatch" study.toml --quiet)
raised=
for ((i = 0; i < 1200; ++i)); do
  [ -n "$(squeue --noheader --name pkmopt)" ] || break
  if [[ -z $raised ]] && grep -qs "goes on from its checkpoint" job.out; then
    scontrol update JobId="$job" TimeLimit=10 && raised=yes
  fi
  sleep 0.25
done
grep -q "stopped by SIGTERM" job.out || fail "the time limit stopped nothing"
grep -q "goes on from its checkpoint (restart 1)" job.out || fail "the job did not go on"
"$program" run study.toml --output straight.h5 --quiet --threads 8
PYTHONPATH=$tests/campaigns /usr/bin/python3 - <<'PY' || fail "the study by Slurm and the straight one differ"
from campaign import digest, state
assert state("study.h5") == "finished" and digest("study.h5") == digest("straight.h5")
PY
echo "a study in several jobs ended as the one in one"

# An array of jobs, one for each seed, and what tells of all.
sed 's/generations = 500/generations = 5/' study.toml > short.toml
sbatch --quiet --wait --array 1-2 --cpus-per-task 1 --time 10 --output seeds.out "$scripts/seeds.sbatch" short.toml --quiet ||
  fail "the jobs of the seeds failed"
"$program" run short.toml --seeds 2 --seed 1 --resume > spread.out || fail "the seeds cannot be read"
grep -q ", 2 of 2 seeds" spread.out || fail "not all seeds have ended"
"$program" run short.toml --seeds 2 --seed 1 --output alone.h5 --quiet
PYTHONPATH=$tests/campaigns /usr/bin/python3 - <<'PY' || fail "seeds by jobs and by one process differ"
from campaign import digest
for seed in "12":
    assert digest(f"short-seed-{seed}.h5") == digest(f"alone-seed-{seed}.h5"), seed
PY
echo "two seeds in jobs of their own ended as by one process"
