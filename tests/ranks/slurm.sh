#!/usr/bin/env bash
# slurm.sh PROGRAM FOLDER: tests the scripts of experiments/slurm with a Slurm that runs on this host only, and the slow
# objective of rank_program. A study whose job reaches its time limit is requeued, and its file must equal that of an
# uninterrupted run; so must the files of seeds that run in separate jobs. Exit code 77 (skipped): Slurm is not
# installed, or not root.
set -euo pipefail
program=$(realpath "$1") folder=$2
tests=$(realpath "$(dirname -- "${BASH_SOURCE[0]}")/..") scripts=$(realpath "$(dirname -- "${BASH_SOURCE[0]}")/../../experiments/slurm")
for tool in slurmctld slurmd munged sbatch; do
  PATH=$PATH:/usr/sbin command -v "$tool" > /dev/null || { echo "skipped: $tool is not installed"; exit 77; }
done
((EUID == 0)) || { echo "skipped: only root can start the Slurm daemons"; exit 77; }
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

# A separate key and socket. munged requires folders that only its user can write.
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
[[ $(sinfo --noheader --format %T) == idle ]] || fail "the Slurm node did not become idle"

cat > study.toml <<STUDY
mechanism = { type = "4ppa-2par" }
variables = { a = { min = 0.15, max = 0.95 }, b = { min = 0.35, max = 1.55 } }
objective = [{ type = "slow" }]
stage = [{ optimiser = "ga", population = 40, generations = 500 }]
STUDY

# The time limit is one minute, the minimum of Slurm. SIGTERM is sent 57 s before it, so that the first job stops after
# seconds; then the limit is raised. A requeued job waits until its credential has expired.
job=$(sbatch --parsable --ntasks-per-node 2 --cpus-per-task 1 --time 1 --signal TERM@57 --output job.out "$scripts/study.sbatch" study.toml --quiet)
raised=
for ((i = 0; i < 1200; ++i)); do
  [ -n "$(squeue --noheader --name pkmopt)" ] || break
  if [[ -z $raised ]] && grep -qs "goes on from its checkpoint" job.out; then
    scontrol update JobId="$job" TimeLimit=10 && raised=yes
  fi
  sleep 0.25
done
grep -q "stopped by SIGTERM" job.out || fail "the time limit did not stop the job"
grep -q "goes on from its checkpoint (restart 1)" job.out || fail "the job did not resume the study"
"$program" run study.toml --output straight.h5 --quiet --threads 8
PYTHONPATH=$tests/campaigns /usr/bin/python3 - <<'PY' || fail "the file of the Slurm job and of the uninterrupted run differ"
from campaign import digest, state
assert state("study.h5") == "finished" and digest("study.h5") == digest("straight.h5")
PY
echo "a study in several jobs wrote the same file as an uninterrupted run"

# A job array with one job per seed, and the summary of all seeds.
sed 's/generations = 500/generations = 5/' study.toml > short.toml
sbatch --quiet --wait --array 1-2 --cpus-per-task 1 --time 10 --output seeds.out "$scripts/seeds.sbatch" short.toml --quiet ||
  fail "the jobs of the seeds failed"
"$program" run short.toml --seeds 2 --seed 1 --resume > spread.out || fail "the summary of the seeds failed"
grep -q ", 2 of 2 seeds" spread.out || fail "not all seeds have finished"
"$program" run short.toml --seeds 2 --seed 1 --output alone.h5 --quiet
PYTHONPATH=$tests/campaigns /usr/bin/python3 - <<'PY' || fail "the files of seeds in jobs and in one process differ"
from campaign import digest
for seed in "12":
    assert digest(f"short-seed-{seed}.h5") == digest(f"alone-seed-{seed}.h5"), seed
PY
echo "two seeds in separate jobs wrote the same files as one process"
