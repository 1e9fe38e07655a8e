#!/bin/sh
# Renders and catalogues in parts, by the recipes of tools/cluster: GNU parallel and Slurm for real, on this machine, and
# the commands of the Kubernetes files. The results are the bits of one process, also after processes were killed.
# CLUSTER_TESTS='by_parallel catalogue' chooses. CLUSTER_VIEWS and CLUSTER_ROWS give the size of the catalogue that is planned, resumed and verified at the end.
set -u
. tests/lib/tap.sh
recipes=$here/tools/cluster
cd "$work" || exit 2
cp -r "$scenes/cornell-box" "$scenes/textures" .
mv cornell-box/cornell-box.pov cornell-box/room.pov
scene=cornell-box/room.pov
view="-t floor --size 64x512 --spp 24" long_view="-t floor --size 64x512 --spp 400"

# shellcheck disable=SC2086 # words wanted
retex-render -q $view $scene -o one.exr
for number in $(seq 40); do
    echo "out/$number.png,\"rgb(0.$number,0.3,0.2)\""
done | (echo output,floor && cat) >table.csv
mkdir one && (cd one && retex-combine -q ../one.exr --batch ../table.csv --mkdir)

# is_same FILE NAME [REFERENCE]: the file has the bits of the one that one process made.
is_same() { result "$(cmp "$1" "${3:-one.exr}" >&2 && echo 1)" "$2"; }
# are_same FOLDER NAME
are_same() { result "$(diff -r "$1" one/out >&2 && echo 1)" "$2"; }
# has_rows FILE BYTES: a checkpoint that has more than one finished band, as one takes fewer bytes.
has_rows() { [ "$(stat -c %s "$1" 2>/dev/null || echo 0)" -gt "$2" ]; }

# ---- GNU parallel ----

by_parallel() {
    if ! command -v parallel >/dev/null; then
        skip "GNU parallel" "parallel is not installed"
        return
    fi
    # shellcheck disable=SC2086
    "$recipes/render-parallel.sh" 8 parallel.exr $scene $view
    is_same parallel.exr "parallel: 8 shards are one render"

    # Shard 3 is killed in the middle, as often as it is tried.
    mkdir bin
    cat >bin/retex-render <<'END'
#!/bin/sh
case "$*" in *'--shard 3/8'*)
    if [ "$(cat kills 2>/dev/null | wc -l)" -lt 3 ]; then
        "$REAL" "$@" &
        until [ "$(stat -c %s killed.exr.shards/3.partial 2>/dev/null || echo 0)" -gt 3000 ]; do sleep .01; done
        kill -KILL $!
        echo >>kills
        exit 137
    fi ;;
esac
echo "$*" >>runs
exec "$REAL" "$@"
END
    chmod +x bin/retex-render
    # shellcheck disable=SC2086
    PATH=$work/bin:$PATH REAL=$BUILD/bin/retex-render "$recipes/render-parallel.sh" 8 killed.exr $scene $view 2>/dev/null
    status=$?
    result "$([ $status != 0 ] && [ "$(wc -l <kills)" = 3 ] && [ ! -e killed.exr ] && echo 1)" \
        "parallel: a shard that is killed three times ends the run"
    result "$(has_rows killed.exr.shards/3.partial 3000 && echo 1)" "parallel: its finished rows are kept"
    # shellcheck disable=SC2086
    PATH=$work/bin:$PATH REAL=$BUILD/bin/retex-render "$recipes/render-parallel.sh" 8 killed.exr $scene $view
    is_same killed.exr "parallel: run again, it is one render"
    result "$([ "$(grep -c -e --shard runs)" = 8 ] && echo 1)" "parallel: each shard is finished once"

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
    run_jobs() { /usr/bin/python3 -B "$here/tests/long/cluster-jobs.py" "$@" >&2 && echo 1; }
    result "$(run_jobs "$recipes/render.yaml" "-t Floor --size 1920x1080 --spp 256" "$view")" \
        "Kubernetes: the render's jobs are sound and run"
    result "$(run_jobs "$recipes/catalogue.yaml" '' '')" "Kubernetes: the catalogue's job is sound and runs"
    verdict=$(retex-combine room.retex --batch rooms.csv --manifest rooms.json --verify)
    cd ..
    is_same cornell-box/room.exr "Kubernetes: 8 indices are one render"
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

# wait_for SECONDS CONDITION
wait_for() {
    for _ in $(seq "$(($1 * 10))"); do
        eval "$2" && return 0
        sleep .1
    done
    return 1
}

# is_in_state JOB STATE: a job, or a task of an array.
is_in_state() { scontrol -o show job "$1" 2>/dev/null | grep -q "JobState=$2"; }

# are_completed ARRAY TASK…
are_completed() {
    of=$1
    shift
    for task; do is_in_state "${of}_$task" COMPLETED || return; done
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
    # shellcheck disable=SC2086
    set -- $("$recipes/render-slurm.sh" 8 slurm.exr $scene $view)
    wait_for 600 '[ -e slurm.exr ]'
    is_same slurm.exr "Slurm: an array of 8 shards and its merge are one render"

    # In the middle of their rows, task 3 is requeued, as after the death of its node, and task 5 cancelled.
    # shellcheck disable=SC2086
    retex-render -q $long_view $scene -o long.exr
    # shellcheck disable=SC2086
    set -- $("$recipes/render-slurm.sh" 8 again.exr $scene $long_view)
    array=$1
    wait_for 600 'has_rows again.exr.shards/3.partial 400000' && scontrol requeue "${array}_3"
    wait_for 600 'has_rows again.exr.shards/5.partial 400000' && scancel "${array}_5"
    wait_for 600 'is_in_state "${array}_5" CANCELLED && are_completed "$array" 1 2 3 4 6 7 8'
    result "$([ -e again.exr.shards/3 ] && [ ! -e again.exr.shards/5 ] && [ -e again.exr.shards/5.partial ] &&
        [ ! -e again.exr ] && echo 1)" "Slurm: a task that is cancelled costs its shard only"
    # The merge would wait for ever. The task goes on, and is followed by a new merge.
    scancel "$2"
    # shellcheck disable=SC2086
    set -- "$(SHARDS=8 sbatch --parsable --array=5 "$recipes/render.sbatch" again.exr $scene $long_view)"
    # shellcheck disable=SC2086
    SHARDS=8 sbatch --dependency="afterok:$1" "$recipes/merge.sbatch" again.exr $scene $long_view >/dev/null
    wait_for 600 '[ -e again.exr ]'
    is_same again.exr "Slurm: the same bits after that" long.exr

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
