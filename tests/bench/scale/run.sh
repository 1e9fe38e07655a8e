#!/bin/sh
# What a path costs, in processor time, as scenes and pictures grow: make bench-scale. Prints a page, which is also
# $BUILD/bench/scale.md, with its figures in scale.csv and, where python3-matplotlib is installed, plotted in scale.png;
# with BENCH_DOCS=1 they go to docs/ and docs/pictures/ too.
#
# A room of scenes.py is rendered with more and more triangles, lights, targets and pixels, plain and as a set, in turn.
# Reading the scene is not in the cost. Last, the peak memory of a large set.
#
# As it stands it takes about three quarters of an hour on two cores. BENCH_MAX=7 goes to ten million triangles (else a
# million, 6; takes some minutes and 3 GB more); BENCH_TURNS, BENCH_SPP, BENCH_SIZE, BENCH_SERIES='triangles lights
# points targets resolution', BENCH_SIZES, BENCH_SIZES_SPP (samples there) and BENCH_LARGE (size of the large set, or
# `no') choose less.
set -eu
export LC_ALL=C
. tests/figures/head.sh
build=${BUILD:-build} here=tests/bench/scale
case $build in /*) ;; *) build=$PWD/$build ;; esac
PATH=$build/bin:$PATH
work=$build/bench/scale records=$build/bench/scale/runs out=$build/bench
turns=${BENCH_TURNS:-3} spp=${BENCH_SPP:-64} size=${BENCH_SIZE:-320x180} most=${BENCH_MAX:-6}
sizes=${BENCH_SIZES:-160x90 320x180 640x360 1280x720 1920x1080 3840x2160} sizes_spp=${BENCH_SIZES_SPP:-8}
large=${BENCH_LARGE:-3840x2160}
series=${BENCH_SERIES-triangles lights points targets resolution}
python=${PYTHON:-/usr/bin/python3}
if ! "$python" -c 'import numpy' 2>/dev/null; then
    echo "bench-scale: $python needs numpy (python3-numpy)" >&2
    exit 2
fi
mkdir -p "$work"
: >"$records"

scene() { # KIND COUNT: its file, made once
    [ -e "$work/$1-$2.pov" ] || "$python" $here/scenes.py "$1" "$2" "$work/part.pov" >&2
    [ -e "$work/$1-$2.pov" ] || mv "$work/part.pov" "$work/$1-$2.pov"
    echo "$work/$1-$2.pov"
}
run() { # SERIES AT RENDER TURN SCENE OPTION...
    key="series=$1 at=$2 render=$3 turn=$4" file=$5
    shift 5
    # shellcheck disable=SC2086
    "$python" tests/bench/overhead/measure.py "$records" $key -- retex-render "$@" -o "$work/out.exr" "$file"
}
both() { # SERIES AT TURN SCENE SIZE SPP: plain and as a set of one target, by turns
    set -- "series=$1 at=$2 turn=$3" "$4" "--size $5 --spp $6"
    # shellcheck disable=SC2086
    "$python" tests/bench/overhead/measure.py "$records" $1 \
        -- render=plain retex-render --plain $3 -o "$work/plain.exr" "$2" \
        -- render=set retex-render -t Back $3 -o "$work/out.exr" "$2"
}
targets() { # TURN
    file=$(scene triangles 100000)
    run targets 0 plain "$1" "$file" --plain --size "$size" --spp "$spp"
    options='' count=0
    for target in Back Floor Ball Left Right Ceiling Table Front; do
        options="$options -t $target" count=$((count + 1))
        # shellcheck disable=SC2086
        case $count in 5 | 7) ;; *) run targets $count set "$1" "$file" $options --size "$size" --spp "$spp" ;; esac
    done
}

rm -f "$work"/*.pov
for turn in $(seq "$turns"); do
    for one in $series; do
        case $one in
        triangles)
            for power in $(seq 3 "$most"); do
                count=$(printf '1%0*d' "$power" 0)
                both triangles "$count" "$turn" "$(scene triangles "$count")" "$size" "$spp"
            done ;;
        lights | points)
            for count in 1 10 100 1000 10000; do
                both "$one" $count "$turn" "$(scene "$one" $count)" "$size" "$spp"
            done ;;
        targets) targets "$turn" ;;
        resolution)
            for wide in $sizes; do
                both resolution "$wide" "$turn" "$(scene triangles 100000)" "$wide" "$sizes_spp"
            done ;;
        esac
    done
done
# Four samples, which suffice for every pixel to fill its clusters where it sees the target.
[ "$large" = no ] || run large "$large" set 1 scenes/living-room/living-room.pov -t Floor --clusters 8 --size "$large" \
    --spp 4 || echo "bench-scale: the large set was not rendered" >&2

rm -f "$work"/*.exr "$work"/*.pov
"$python" $here/page.py "$records" "$out/scale.csv" "$(figures_head bench-scale)" "$size" "$spp" "$sizes_spp" | tee "$out/scale.md"
if "$python" -c 'import matplotlib' 2>/dev/null; then
    "$python" $here/plot.py "$out/scale.csv" "$out/scale.png"
else
    echo "bench-scale: no figure, for $python has no matplotlib (python3-matplotlib)" >&2
    rm -f "$out/scale.png"
fi
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "$out/scale.csv" "$out/scale.md" docs/
    [ ! -e "$out/scale.png" ] || cp "$out/scale.png" docs/pictures/
fi
