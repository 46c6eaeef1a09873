#!/bin/sh
# A Slurm of one node, and docs/farm/slurm.sbatch on it as it stands: an array of four tasks over a sequence. One task is
# killed (kill -9), one is requeued by hand; both go on where they stopped. The outputs are those of a single run.
#
#   slurm.sh PROGRAM       as root; Debian's slurmctld, slurmd, slurm-client and munge, installed if missing
#
# The daemons have ports, keys and folders of their own, so a Slurm that already runs here is not touched.
set -eu
# shellcheck source-path=SCRIPTDIR source=common.sh
. "$(dirname "$0")/common.sh"
[ $# -eq 1 ] || { echo "usage: $0 PROGRAM" >&2; exit 2; }
program=$(program_of "$1")
template=$(cd "$(dirname "$0")/../../docs/farm" && pwd)/slurm.sbatch
[ "$(id -u)" -eq 0 ] || skip "needs root: slurmd starts tasks as any user"
PATH=$PATH:/usr/sbin:/sbin
if ! { command -v slurmctld && command -v slurmd && command -v munged && command -v sbatch; } >/dev/null; then
    say "installing slurmctld, slurmd, slurm-client, munge"
    export DEBIAN_FRONTEND=noninteractive
    apt-get -qq update
    apt-get -qq install -y --no-install-recommends slurmctld slurmd slurm-client munge >/dev/null 2>&1 ||
        skip "apt-get cannot install Slurm"
fi
needs oiiotool openimageio-tools

dir=$(mktemp -d)
chmod 755 "$dir"
# Ends the daemons that this script started, and the tasks first.
stop() {
    trap - EXIT INT TERM
    for daemon in slurmctld slurmd munged; do
        if [ "$daemon" = slurmctld ] && [ -s "$dir/slurmctld.pid" ]; then
            timeout 10 scancel --user=root --quiet || true
            timeout 20 sh -c "while [ -n \"\$(squeue -h 2>/dev/null)\" ]; do sleep 0.2; done" || true
        fi
        if [ -s "$dir/$daemon.pid" ]; then
            pid=$(cat "$dir/$daemon.pid")
            kill "$pid" 2>/dev/null || true
            timeout 10 sh -c "while kill -0 $pid 2>/dev/null; do sleep 0.1; done" || kill -9 "$pid" || true
        fi
    done
    rm -rf "$dir"
}
trap stop EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

say "starting munged, slurmctld and slurmd"
mkdir "$dir/munge" "$dir/state" "$dir/spool"
dd if=/dev/urandom of="$dir/munge/key" bs=1024 count=1 2>/dev/null
chmod 400 "$dir/munge/key"
munged --force --key-file="$dir/munge/key" --socket="$dir/munge/socket" --pid-file="$dir/munged.pid" \
    --log-file="$dir/munge/log" --seed-file="$dir/munge/seed" --num-threads=2 >/dev/null 2>&1 || fail "munged does not start"
node=$(hostname -s)
port=$((20000 + $$ % 20000))
cat >"$dir/slurm.conf" <<CONF
ClusterName=clshade
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
# A requeued task waits for cred_expire; five seconds are too few for Slurm.
AuthInfo=socket=$dir/munge/socket,cred_expire=6
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
SwitchType=switch/none
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerParameters=defer_batch,sched_interval=1,bf_interval=1
ReturnToService=2
KillWait=5
# Four tasks side by side on any machine.
SlurmdParameters=config_overrides
NodeName=$node NodeAddr=127.0.0.1 CPUs=4 RealMemory=4096
PartitionName=farm Nodes=$node Default=YES State=UP MaxTime=30
CONF
export SLURM_CONF="$dir/slurm.conf"
slurmctld -c -f "$SLURM_CONF" || fail "slurmctld does not start: $(tail -n 3 "$dir/slurmctld.log")"
slurmd -f "$SLURM_CONF" || fail "slurmd does not start: $(tail -n 3 "$dir/slurmd.log")"
tries=0
until [ "$(timeout 5 sinfo -h -o %T 2>/dev/null)" = idle ]; do
    tries=$((tries + 1))
    [ "$tries" -lt 150 ] || fail "the node does not come up: $(tail -n 3 "$dir/slurmctld.log" "$dir/slurmd.log")"
    sleep 0.2
done

export XDG_CACHE_HOME="$dir/cache" POCL_CACHE_DIR="$dir/cache/pocl"
mkdir -p "$XDG_CACHE_HOME" "$POCL_CACHE_DIR" "$dir/single" "$dir/work"
frames=48
say "$frames frames in a single run"
make_sequence "$program" "$dir" "$frames" 960x540
"$program" shade "$dir/in.####.exr" -o "$dir/single/out.####.exr" --scene "$dir/scene.toml" --compression zip:9 -q ||
    fail "the single run"
[ "$(find "$dir/single" -name '*.exr' | wc -l)" -eq "$frames" ] || fail "the single run wrote too little"

cd "$dir/work"
# submit ARRAY FRAMES: the number of the job.
submit() {
    INPUT="$dir/in.####.exr" OUTPUT="$dir/array/out.####.exr" SCENE="$dir/scene.toml" FRAMES=$2 CLSHADE=$program \
        CACHE="$dir/cache" REPORTS="$dir/reports" ARGS="--compression zip:9" \
        sbatch --parsable --array="$1" --cpus-per-task=1 --mem=1000 "$template"
}

# process_of CHUNK: id of the clshade that works at it; empty when there is none.
process_of() {
    pgrep -f "shade $dir/in.*--chunk $1/4" || true
}

# wait_for_output FRAME: the task that shades it is in the midst.
wait_for_output() {
    tries=0
    until [ -e "$dir/array/out.$1.exr" ]; do
        tries=$((tries + 1))
        [ "$tries" -lt 3000 ] || fail "frame $1 does not appear: $(tail -n 5 "$dir"/work/*.log)"
        sleep 0.01
    done
}

# wait_for_job JOB: until Slurm has nothing left to do with it; every task must have ended well.
wait_for_job() {
    tries=0
    while [ -n "$(squeue -h -j "$1" 2>/dev/null)" ]; do
        tries=$((tries + 1))
        [ "$tries" -lt 600 ] || fail "job $1 does not end: $(squeue -j "$1")"
        sleep 0.2
    done
    scontrol show job -o "$1" >"$dir/states"
    [ "$(grep -c 'JobState=COMPLETED .*ExitCode=0:0' "$dir/states")" -eq 4 ] ||
        fail "not every task ended well: $(cat "$dir/states" "$dir"/work/*.log)"
}

job=$(submit 1-4 "1-$frames")
say "array of four tasks (job $job): kill -9 for the second, requeue for the third"
wait_for_output 0013
victim=$(process_of 2)
[ -n "$victim" ] || fail "the second task ended before it could be killed"
kill -9 "$victim"
wait_for_output 0025
[ -n "$(process_of 3)" ] || fail "the third task ended before it could be requeued"
scontrol requeue "${job}_3"
wait_for_job "$job"
log="$dir/work/clshade-${job}_2.log"
grep -q 'exit code 137' "$log" || fail "the second task was not killed: $(cat "$log")"
for task in 2 3; do
    log="$dir/work/clshade-${job}_$task.log"
    grep -q "task ${job}_$task, start 1," "$log" || fail "task $task was not started again: $(cat "$log")"
    grep -q 'skipped' "$log" || fail "task $task did not go on where it stopped: $(cat "$log")"
done
same_images "$dir/single" "$dir/array"
readable "$dir/array"
say "outputs complete, identical to the single run: $(find "$dir/array" -name '*.exr' | wc -l) frames"

find "$dir/array" -name '*.exr' -printf '%p %T@\n' | sort >"$dir/before"
rm "$dir/array/out.0030.exr"
job=$(submit 10-40:10 "1-20,21-$frames")
say "the whole array again (job $job, --array=10-40:10), one output removed"
wait_for_job "$job"
find "$dir/array" -name '*.exr' -printf '%p %T@\n' | sort >"$dir/after"
[ "$(diff "$dir/before" "$dir/after" | grep -c '^>')" -eq 1 ] || fail "more than the one frame was shaded again"
same_images "$dir/single" "$dir/array"
[ "$(cat "$dir"/reports/clshade-"$job"_*.json | grep -c '"status": "skipped"')" -eq $((frames - 1)) ] ||
    fail "the reports do not name $((frames - 1)) skipped frames"
say "passed"
