#!/bin/sh
# The commands of docs/cluster.md for Slurm, on two hosts with a Slurm of their own; a rank that is killed ends the step.
. "${srcdir:-.}/tests/support/tap.sh"
. "$srcdir/tests/cluster/cluster.sh"
for tool in slurmctld slurmd munged srun; do
    command -v $tool > /dev/null || skip_all "$tool is missing (packages slurm-wlm, munge)"
done
on_hosts 2

slurm=$scratch/slurm
daemons() { # munge's socket wants folders that all may enter
    chmod 755 "$scratch" "$(dirname "$scratch")" && mkdir "$slurm" && cd "$slurm" && mkdir state munge tmp.h1 tmp.h2 spool.h1 spool.h2 || return
    chmod 755 . munge
    head -c 1024 /dev/urandom > key && chmod 400 key
    cat > slurm.conf << END
ClusterName=test
SlurmctldHost=h1(10.77.0.1)
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$slurm/munge/socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
TmpFS=$slurm/tmp.%n
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/spool.%n
SlurmctldPidFile=$slurm/ctld.pid
SlurmdPidFile=$slurm/d.%n.pid
SlurmctldLogFile=$slurm/ctld.log
SlurmdLogFile=$slurm/d.%n.log
NodeName=h1 NodeAddr=10.77.0.1 CPUs=2
NodeName=h2 NodeAddr=10.77.0.2 CPUs=2
PartitionName=all Nodes=h1,h2 Default=YES State=UP
END
    munged --force --key-file="$slurm/key" --socket="$slurm/munge/socket" --pid-file="$slurm/munge/pid" \
        --log-file="$slurm/munge/log" --seed-file="$slurm/munge/seed" && slurmctld -c && sleep 1 && slurmd -N h1 && on h2 slurmd -N h2 || return
    for wait in $(seq 100); do
        sinfo -h -o %T%D | grep -cx idle2 && return 0
        sleep 0.1
    done
    sinfo
    return 1
}
# Each job of an array has one worker, since it has one core of the two that it may use: nothing is bound here.
array_shares() {
    for i in 0 1 2 3; do
        file=$scratch/array.$i.json
        echo "$(report threads "$file") threads, $(report cores "$file") cores, $(report cores_from "$file")"
        test "$(report threads "$file")" = 1 && test "$(report cores "$file")" = 1 || return
        case $(report cores_from "$file") in SLURM_CPUS_*=1) ;; *) return 1 ;; esac
    done
    test "$(for i in 0 1 2 3; do report state_hash "$scratch/array.$i.json"; done | sort -u | wc -l)" = 4
}
# The job as it is, of a run of some seconds; Slurm's signal comes when the first frames are there, not hours later. A run that goes on writes
# the second checkpoint; one that begins anew would write the first one again. It ends with the state of a run that was never stopped.
job_state() { scontrol show job "$1" | sed -n 's/^ *JobState=\([A-Z]*\).*/\1/p'; }
requeued() {
    cd "$scratch" && job=$(sbatch --parsable requeue.sbatch) && echo "job $job" || return
    for wait in $(seq 600); do
        test -s frames/frames.csv && test "$(wc -l < frames/frames.csv)" -gt 2 && break
        sleep 0.1
    done
    scancel --signal=USR1 "$job" || return
    for wait in $(seq 3000); do
        case $(job_state "$job") in
            # Slurm lets it wait for two minutes, since the first one's processes end meanwhile; here these are looked for.
            PENDING) test -n "$(for host in h1 h2; do pids $host srun; pids $host slurmstepd; done)" || scontrol update "JobId=$job" StartTime=now ;;
            COMPLETED | FAILED | CANCELLED | TIMEOUT) break ;;
        esac
        sleep 0.1
    done
    scontrol show job "$job" | grep -E 'JobState|Restarts' && cat requeue.log
    test "$(job_state "$job")" = COMPLETED && scontrol show job "$job" | grep -c ' Restarts=1 ' &&
        test "$(cd frames/checkpoints && echo *)" = "000001.checkpoint 000002.checkpoint"
}
same_state() {
    cd "$scratch" && limited duite-cloth sheet.yaml --quiet --report alone.json && test -n "$(report state_hash alone.json)" &&
        test "$(report state_hash alone.json)" = "$(report state_hash requeue.json)"
}
killed() { # the other one gets SIGTERM, which asks for the end of its step, and finds that its peer is lost
    (sleep 3 && kill -KILL "$(pids h2 duite-cloth)") &
    timeout 20 srun -K -N 2 -n 2 --mpi=pmix "$DUITE_CLOTH" "$srcdir/cloth/scenes/sheet.yaml" --quiet
}

plan_later
SLURM_CONF=$slurm/slurm.conf PATH=$(dirname "$DUITE_CLOTH"):$PATH
export SLURM_CONF PATH
ok "Slurm starts" daemons
sed 's/nx: [0-9]*/nx: 40/; s/ny: [0-9]*/ny: 40/; s/^name: .*/&\ngrain: 200/; s/ end: 0.48,/ end: 3,/' "$srcdir/cloth/scenes/sheet.yaml" > "$scratch/sheet.yaml"
cp "$srcdir"/docs/*.sbatch "$scratch"
grep -E '^(srun|sbatch|salloc) ' "$srcdir/docs/cluster.md" | grep -v requeue > "$scratch/commands"
ok "there are commands" test -s "$scratch/commands"
while IFS= read -r command; do ok "$command" limited sh -c "cd $scratch && $command"; done < "$scratch/commands"
ok "the batch job ran on two ranks" test "$(report ranks "$scratch/sheet.json")" = 2
all_cores() { # two of each host
    scontrol show job | awk '/JobName=/ { sheet = /JobName=sheet$/ } sheet && /NumCPUs=/ { print; right = /NumCPUs=4 / } END { exit !right }'
}
ok "the batch job had all cores of both hosts" all_cores
ok "jobs of an array keep to their cores" array_shares
ok "a job that is stopped by a signal queues itself again, and goes on" requeued
ok "... to the state of one run" same_state
exits 137 "a rank is killed" killed
