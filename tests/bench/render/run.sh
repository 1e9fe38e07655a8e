#!/bin/sh
# How fast retex renders: make bench-render. Prints tables, also to $BUILD/bench/render.txt, with figures in render.csv.
# With BENCH_DOCS=1 they become docs/speed.md and docs/speed.csv.
#
# Two scenes of scenes.py, a Cornell box with a glass ball and an interior of 300,000 triangles, are rendered in turn by
# retex-render and, where there is a blender, by Cycles, with two threads; and embree_rays traces rays in them with
# Embree alone. Ratios are of the same turn: absolute times of a busy hour cannot be compared. Then pictures of the
# Cornell box with equal samples are compared with converged ones, and these with each other: fails where they differ.
#
# Converged pictures, and those of Cycles, stay in $BUILD/bench/render as long as what they are made of does not change;
# the first run takes a quarter of an hour more. BENCH_TURNS, BENCH_SIZE, BENCH_SPP, BENCH_INTERIOR_SPP and
# BENCH_REFERENCE_SPP choose less, or more.
set -eu
export LC_ALL=C
. tests/figures/head.sh
build=${BUILD:-build} here=tests/bench/render
case $build in /*) ;; *) build=$PWD/$build ;; esac
PATH=$build/bin:$PATH
work=$build/bench/render out=$build/bench/render.txt
turns=${BENCH_TURNS:-3} size=${BENCH_SIZE:-512} reference_spp=${BENCH_REFERENCE_SPP:-2048}
spp=${BENCH_SPP:-128} interior_spp=${BENCH_INTERIOR_SPP:-16}
error_size=256
python=${PYTHON:-/usr/bin/python3}
if ! "$python" -c 'import numpy, OpenImageIO' 2>/dev/null; then
    echo "bench-render: $python needs numpy and OpenImageIO (python3-numpy, python3-openimageio)" >&2
    exit 2
fi
cycles=$(command -v blender || true)
mkdir -p "$work"

retex() { # SCENE SIZE SPP SEED OUT
    "$python" $here/time_retex.py "$work/$1.pov" "$2" "$3" "$4" "$5"
}
cycles() { # SCENE SIZE SPP SEED OUT
    "$cycles" -b --factory-startup -P $here/cycles_render.py -- "$work/$1.npz" "$2" "$3" "$4" "$5" \
        >"$work/blender.log" 2>&1 || true
    sed -n 's/^RESULT //p' "$work/blender.log" | grep . || { cat "$work/blender.log" >&2; return 1; }
}

turn() { # SCENE SPP SEED: a line each into $work/runs
    for renderer in embree retex ${cycles:+cycles}; do
        case $renderer in
        embree) figures=$("$build/tests/bench/embree_rays" "$work/$1.pov") ;;
        *) figures=$($renderer "$1" "$size" "$2" "$3" "$work/$1-$renderer.exr") ;;
        esac
        echo "$1 $size $renderer $figures" >>"$work/runs"
    done
}

# What the pictures depend on besides the renderer: those of an older scene are made anew.
key=$("$python" $here/scenes.py "$work" >"$work/scenes.log" &&
    { cat "$work/cornell.pov" "$work/checker.png" $here/cycles_render.py; grep '^FLAGS' $here/time_retex.py; } |
    sha256sum | cut -c1-12)

# Once: a picture of the Cornell box.
kept() { # RENDERER SPP SEED FILE
    [ ! -e "$4" ] || return 0
    "$1" cornell $error_size "$2" "$3" "${4%.exr}-part.exr" >/dev/null
    mv "${4%.exr}-part.exr" "$4"
}

measure() {
    echo "machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores, load" \
        "$(cut -d' ' -f1 /proc/loadavg); two threads; $(tr '\n' ',' <"$work/scenes.log" | sed 's/,$//; s/,/, /g')"
    [ -n "$cycles" ] || echo "no blender here: Cycles is left out"
    : >"$work/runs"
    for n in $(seq "$turns"); do
        turn cornell "$spp" "$n"
        turn interior "$interior_spp" "$n"
    done
    "$python" $here/speed.py "$work/runs" "${out%.txt}.csv"

    pictures=$work/pictures-$spp-$key
    mkdir -p "$pictures"
    rm -f "$pictures"/retex-*
    set -- "$pictures" "$work/runs" "$spp"
    for renderer in retex ${cycles:+cycles}; do
        reference=$work/reference-$renderer-$reference_spp-$key.exr
        kept "$renderer" "$reference_spp" 1000 "$reference"
        for n in $(seq "$turns"); do
            kept "$renderer" "$spp" "$n" "$pictures/$renderer-$n.exr"
        done
        set -- "$@" "$renderer=$reference"
    done
    rm -f "$pictures"/*.json
    "$python" $here/error.py "$@"
}

rm -f "$work/done"
{ measure; touch "$work/done"; } | tee "$out"
[ -e "$work/done" ]
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "${out%.txt}.csv" docs/speed.csv
    {
        sed "s|@head@|$(figures_head bench-render)|" $here/page.md
        printf '\n```\n'
        cat "$out"
        printf '```\n'
    } >docs/speed.md
fi
