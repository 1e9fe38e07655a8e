#!/bin/sh
# Catalogues in parts, by the recipes of tools/cluster: GNU parallel and Slurm for real, on this machine, and the commands
# of the Kubernetes file. The results are the bits of one process.
# CLUSTER_TESTS='by_parallel catalogue' chooses. CLUSTER_VIEWS and CLUSTER_ROWS give the size of the catalogue that is planned, resumed and verified at the end.
set -u
. tests/lib/tap.sh
recipes=$here/tools/cluster
cd "$work" || exit 2
cp -r "$scenes/cornell-box" "$scenes/textures" .
mv cornell-box/cornell-box.pov cornell-box/room.pov

retex-render -q -t floor --size 64x512 --spp 24 cornell-box/room.pov -o one.exr
for number in $(seq 40); do
    echo "out/$number.png,\"rgb(0.$number,0.3,0.2)\""
done | (echo output,floor && cat) >table.csv
mkdir one && (cd one && retex-combine -q ../one.exr --batch ../table.csv --mkdir)

# are_same FOLDER NAME
are_same() { result "$(diff -r "$1" one/out >&2 && echo 1)" "$2"; }

# ---- GNU parallel ----

by_parallel() {
    if ! command -v parallel >/dev/null; then
        skip "GNU parallel" "parallel is not installed"
        return
    fi
    mkdir p && (cd p && "$recipes/catalogue-parallel.sh" 5 ../one.exr ../table.csv manifest >verdict)
    are_same p/out "parallel: 5 parts are one catalogue"
    result "$([ "$(cat p/verdict)" = "40 of 40 pictures good" ] && echo 1)" "parallel: and verified"
    rm p/out/7.png && sed -i 's/^9\.png/8.png/' table.csv
    (cd p && "$recipes/catalogue-parallel.sh" 3 ../one.exr ../table.csv manifest >verdict)
    result "$([ "$(wc -l <p/manifest)" = 41 ] && echo 1)" "parallel: in other parts, only the missing picture is made"
}

# ---- Kubernetes: the commands of the manifests, with the environment that an index gets ----

by_kubernetes() {
    if ! /usr/bin/python3 -c 'import yaml' 2>/dev/null; then
        skip "Kubernetes" "python3-yaml is not installed"
        return
    fi
    cd cornell-box || return
    retex-pack -q ../one.exr -o room.retex
    cp ../table.csv rooms.csv
    result "$(/usr/bin/python3 -B "$here/tests/long/cluster-jobs.py" "$recipes/catalogue.yaml" >&2 && echo 1)" \
        "Kubernetes: the catalogue's job is sound and runs"
    verdict=$(retex-combine room.retex --batch rooms.csv --manifest rooms.json --verify)
    cd ..
    result "$([ "$verdict" = "40 of 40 pictures good" ] && echo 1)" "Kubernetes: 100 indices are one catalogue"
}

# ---- Slurm, with a controller and one node on this machine ----

stop_slurm() {
    for name in slurmd slurmctld munged; do
        [ ! -s "slurm/$name.pid" ] || kill "$(cat "slurm/$name.pid")" 2>/dev/null
    done
    [ -z "${slurm_pids-}" ] || { sleep 1; kill -KILL $slurm_pids; wait $slurm_pids; } 2>/dev/null
}

start_slurm() {
    mkdir -p slurm/state slurm/spool
    chmod 700 slurm slurm/state slurm/spool
    head -c 64 /dev/urandom >slurm/key && chmod 400 slurm/key
    # shellcheck disable=SC2046 # two words wanted
    set -- $(/usr/bin/python3 -c 'import socket
s = [socket.socket() for _ in range(2)]
for k in s: k.bind(("127.0.0.1", 0))
print(*(k.getsockname()[1] for k in s))')
    host=$(hostname -s)
    cat >slurm/slurm.conf <<END
ClusterName=retex
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$1
SlurmdPort=$2
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/slurm/munge.socket,cred_expire=5
CryptoType=crypto/munge
StateSaveLocation=$work/slurm/state
SlurmdSpoolDir=$work/slurm/spool
SlurmctldPidFile=$work/slurm/slurmctld.pid
SlurmdPidFile=$work/slurm/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
ReturnToService=2
KillWait=2
MinJobAge=36000
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
    export SLURM_CONF="$work/slurm/slurm.conf"
    munged --force --foreground --key-file="$work/slurm/key" --socket="$work/slurm/munge.socket" \
        --pid-file="$work/slurm/munged.pid" --log-file="$work/slurm/munged.log" --seed-file="$work/slurm/seed" 2>/dev/null &
    slurm_pids=$!
    sleep 1
    slurmctld -D -i >slurm/slurmctld.log 2>&1 &
    slurm_pids="$slurm_pids $!"
    slurmd -D >slurm/slurmd.log 2>&1 &
    slurm_pids="$slurm_pids $!"
    for _ in $(seq 60); do
        [ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && return 0
        sleep 1
    done
    return 1
}

by_slurm() {
    if ! command -v slurmctld >/dev/null || ! command -v slurmd >/dev/null || ! command -v munged >/dev/null; then
        skip "Slurm" "slurm-wlm or munge is not installed"
        return
    fi
    trap 'cd "$work"; stop_slurm; rm -rf "$work"' EXIT
    if ! start_slurm; then
        tail -n 3 slurm/*.log >&2
        result 0 "Slurm: a controller and a node start"
        return
    fi
    mkdir s
    (cd s && SHARDS=4 sbatch --parsable --wait --array=1-4 "$recipes/catalogue.sbatch" ../one.exr ../table.csv manifest >/dev/null)
    are_same s/out "Slurm: an array of 4 parts is one catalogue"
    stop_slurm
    trap 'rm -rf "$work"' EXIT
}

# ---- a catalogue of several views: planned, made in parts, resumed, verified ----

catalogue() {
    views=${CLUSTER_VIEWS:-4} rows=${CLUSTER_ROWS:-300} total=$((${CLUSTER_VIEWS:-4} * ${CLUSTER_ROWS:-300}))
    for v in $(seq "$views"); do
        make_set "view$v.exr" 64 48 "$v"
        /usr/bin/python3 -c "print('output,floor,wall')
for k in range($rows): print(f'view$v/{k // 100}/{k}.jpg,:scale={1 + k % 7} textures/{(\"brick\", \"fans\", \"damask\", \"walnut-herringbone\")[k * 4 // $rows]}.jpg,\"rgb(0.{k % 10},0.5,{k / $rows})\"')" >"view$v.csv"
    done
    each() { for v in $(seq "$views"); do retex-combine "view$v.exr" --batch "view$v.csv" --manifest catalogue "$@" || return; done; }
    result "$([ "$(each --plan --mkdir | grep -c "^rows 1 to $rows of $rows: $rows to make")" = "$views" ] && echo 1)" "catalogue: planned"
    for part in 1 2 3; do each -q --mkdir --shard $part/3 & done
    wait
    result "$([ "$(wc -l <catalogue)" = "$total" ] && echo 1)" "catalogue: $total pictures in 3 processes, each once"
    result "$([ "$(each --verify | grep -c "^$rows of $rows pictures good$")" = "$views" ] && echo 1)" "catalogue: all are good"
    find view1 -name '*7.jpg' | head -n 20 >gone && xargs rm <gone
    each -q --resume --mkdir
    result "$([ "$(wc -l <catalogue)" = $((total + $(wc -l <gone))) ] && echo 1)" "catalogue: resumed, only the missing ones are made"
    peak=$(make_peak peak retex-combine view1.exr --batch view1.csv --manifest catalogue --verify >/dev/null && cut -d' ' -f1 peak)
    echo "# peak memory of --verify: $peak MB"
    result "$(at_most "${peak:-1000}" 100)" "catalogue: little memory"
}

for what in ${CLUSTER_TESTS:-by_parallel by_kubernetes by_slurm catalogue}; do
    $what
done
finish
