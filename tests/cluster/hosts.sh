#!/bin/sh
# hosts.sh N [--rate RATE] COMMAND...: runs COMMAND on the first of N hosts (1 to 254) that this machine plays, and that live as
# long as it.
#
# A host is a network and a name of its own (h1 is 10.77.0.1, and so on) and a cable to a switch that all share; RATE (100mbit, say)
# limits each cable in both directions. Files and cores are the same on all hosts. Needs root, ip and unshare; where it
# cannot run it says why and exits with 77, else with COMMAND's status. For COMMAND, Open MPI is set up so that
#     mpirun -n 4 PROGRAM                           deals the ranks out to the hosts in turn,
#     mpirun --host h1:2,h2:2 -n 4 PROGRAM          does what it says,
# DUITE_HOSTS is N, and in its PATH are
#     on h2 COMMAND...        runs COMMAND on that host
#     unplug h2 ; plug h2     pulls the host's cable, and puts it back
#     limit h2 100mbit        limits the host's cable from now on; limit h2 none
#     traffic h2              prints what crossed the cable: bytes and packets received, bytes and packets sent
#     pids h2 NAME            prints the host's processes of that name
#
# It leaves nothing behind, however it ends: all of it lives in namespaces without a name, and its processes in a PID namespace,
# which the kernel ends with its first process; and that one is killed when this script dies.
set -u
case $PATH in *sbin*) ;; *) PATH=$PATH:/usr/sbin:/sbin ;; esac # root has none after su
self=$0

cannot() {
    echo "hosts.sh: $*" >&2
    exit 77
}

usage() {
    echo "usage: hosts.sh N [--rate RATE] COMMAND..., N from 1 to 254" >&2
    exit 2
}

# ---- Outside ----

outside() { # N RATE COMMAND...
    test "$(id -u)" = 0 || cannot "only root may make network namespaces"
    for tool in ip unshare nsenter setpriv mount; do
        command -v $tool > /dev/null || cannot "$tool is missing (packages iproute2, util-linux, mount)"
    done
    test "$2" = none || command -v tc > /dev/null || cannot "tc is missing (package iproute2)"
    is_openmpi || cannot "only Open MPI's mpirun knows how to reach the hosts"
    namespaces="--net --uts --ipc --mount --pid --fork --kill-child --mount-proc"
    # shellcheck disable=SC2086 # a list of options
    why=$(unshare $namespaces true 2>&1) || cannot "no namespaces here: $why"
    # shellcheck disable=SC2086
    setpriv --pdeathsig KILL unshare $namespaces /bin/sh "$self" --inside "$@" <&0 &
    first=$!
    trap 'kill -KILL $first' HUP INT TERM
    wait $first
}

# ---- Inside: process 1, on the switch ----

# The commands, in $dir/bin; a host's network is found through its first process.
commands() {
    here="dir=$dir; process() { cat \"\$dir/\$1\" || exit 2; }"
    tool on 'host=$1; shift; exec nsenter --target "$(process "$host")" --net --uts "$@"'
    # The stand-in for ssh: a host, and a line for its shell. No status comes through a cable that is unplugged.
    tool agent 'host=$1
        shift
        on "$host" sh -c "$*"
        status=$?
        while on "$host" ip -o link show e0 | grep -q NO-CARRIER; do sleep 1; done
        exit $status'
    tool unplug 'exec nsenter --target 1 --net ip link set "p${1#h}" down'
    tool plug 'exec nsenter --target 1 --net ip link set "p${1#h}" up'
    tool traffic 'on "$1" cat /proc/net/dev | awk "\$1 == \"e0:\" { print \$2, \$3, \$10, \$11 }"'
    tool limit 'end() {
            case $rate in
                none) nsenter --target "$1" --net tc qdisc del dev "$2" root 2> /dev/null; true ;;
                *) nsenter --target "$1" --net tc qdisc replace dev "$2" root tbf rate "$rate" burst 32kb limit 4mb ;;
            esac
        }
        rate=$2
        end 1 "p${1#h}" && end "$(process "$1")" e0'
    tool pids 'net=$(readlink "/proc/$(process "$1")/ns/net")
        for process in /proc/[0-9]*; do
            test "$(cat "$process/comm" 2> /dev/null)" = "$2" || continue
            test "$(readlink "$process/ns/net")" != "$net" || echo "${process#/proc/}"
        done'
}

tool() { # NAME TEXT
    printf '#!/bin/sh\n%s\n%s\n' "$here" "$2" > "$dir/bin/$1"
    chmod +x "$dir/bin/$1"
}

silence() { # no packets but those of programs
    test ! -e /proc/sys/net/ipv6 || echo 1 > /proc/sys/net/ipv6/conf/all/disable_ipv6
}

socket() { # NUMBER: the host's end of its cable, where this runs
    silence
    ip link set lo up && ip link set e0 up && ip addr add "10.77.0.$1/24" dev e0
}

host() { # NUMBER
    unshare --net --uts sh -c "echo h$1 > /proc/sys/kernel/hostname && : > $dir/h$1.there && exec sleep infinity" &
    pid=$!
    until test -e "$dir/h$1.there"; do
        kill -0 $pid 2> /dev/null || return
        sleep 0.01
    done
    echo $pid > "$dir/h$1"
    echo "h$1 slots=1" >> "$dir/hosts"
    ip link add "p$1" type veth peer name e0 netns $pid && nsenter --target $pid --net /bin/sh "$self" --socket "$1" &&
        ip link set "p$1" master br0 up && { test "$rate" = none || limit "h$1" "$rate"; }
}

inside() { # N RATE COMMAND...
    hosts=$1 rate=$2
    shift 2
    # A file system that goes away with the last process, and keeps what ranks share in memory apart from others'.
    dir=/dev/shm/hosts
    mount -t tmpfs tmpfs /dev/shm && mkdir -p "$dir/bin" "$dir/tmp" || cannot "no file system of its own"
    PATH=$dir/bin:$PATH
    commands
    silence
    { ip link set lo up && ip link add br0 type bridge && ip link set br0 up; } || cannot "the kernel has no bridges"
    for i in $(seq "$hosts"); do host "$i" || cannot "cannot make host h$i"; done
    export DUITE_HOSTS="$hosts" TMPDIR="$dir/tmp" PATH
    export OMPI_MCA_plm_rsh_agent="$dir/bin/agent" OMPI_MCA_orte_default_hostfile="$dir/hosts" OMPI_MCA_rmaps_base_mapping_policy=node
    on h1 "$@"
}

case ${1:-} in
    --inside)
        shift
        inside "$@"
        ;;
    --socket) socket "$2" ;;
    *)
        hosts=${1:-} rate=none
        case $hosts in '' | *[!0-9]* | ????*) usage ;; esac
        test "$hosts" -ge 1 && test "$hosts" -le 254 || usage
        shift
        if test "${1:-}" = --rate; then
            test $# -ge 2 || usage
            rate=$2
            shift 2
        fi
        test $# -ge 1 || usage
        . "${0%/*}/../support/mpi.sh"
        outside "$hosts" "$rate" "$@"
        ;;
esac
