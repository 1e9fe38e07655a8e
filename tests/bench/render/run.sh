#!/bin/sh
# How fast retex renders: make bench-render. Prints tables, also to $BUILD/bench/render.txt, with figures in render.csv.
# With BENCH_DOCS=1 they become docs/speed.md and docs/speed.csv.
#
# Three scenes of scenes.py, a Cornell box with a glass ball, an interior of 300,000 triangles, and the artist's room,
# which the sky lights, are rendered in turn by retex-render and, where there is a blender, by Cycles, with two threads;
# and embree_rays traces rays in those with a lamp with Embree alone. Ratios are of the same turn: absolute times of a
# busy hour cannot be compared. Then pictures with equal samples are compared with converged ones, and these with each
# other: fails where they differ. The artist's room is in $RETEX_SHARED or ../shared, and left out where it is absent.
#
# Converged pictures, and those of Cycles, stay in $BUILD/bench/render as long as what they are made of does not change;
# the first run takes half an hour more. BENCH_SCENES, BENCH_TURNS, BENCH_SIZE, BENCH_SPP (of the Cornell box),
# BENCH_INTERIOR_SPP, BENCH_ARTIST_SPP, BENCH_ERROR_SIZE and BENCH_REFERENCE_SPP choose less, or more.
set -eu
export LC_ALL=C PYTHONDONTWRITEBYTECODE=1
. tests/figures/head.sh
build=${BUILD:-build} here=tests/bench/render
case $build in /*) absolute=$build ;; *) absolute=$PWD/$build ;; esac
PATH=$absolute/bin:$PATH
work=$build/bench/render out=$build/bench/render.txt
turns=${BENCH_TURNS:-5} size=${BENCH_SIZE:-512}
error_size=${BENCH_ERROR_SIZE:-256}
artist=${RETEX_SHARED:-../shared}/scenes/living-room-bitterli
scenes=${BENCH_SCENES:-cornell interior artists-room} left_out=''
figures_python bench-render
cycles=$(command -v blender || true)
[ -n "$cycles" ] || left_out='no blender here: Cycles is left out'
[ -e "$artist/scene.pov" ] || {
    artist='' scenes=$(echo "$scenes" | sed 's/artists-room//')
    left_out="$left_out${left_out:+; }the artist's room is not here, and left out"
}
mkdir -p "$work"

spp() { # SCENE
    case $1 in
    cornell) echo "${BENCH_SPP:-128}" ;;
    interior) echo "${BENCH_INTERIOR_SPP:-16}" ;;
    artists-room) echo "${BENCH_ARTIST_SPP:-16}" ;;
    *)
        echo "bench-render: there is no scene $1" >&2
        return 2
        ;;
    esac
}

# Of converged pictures: at least 16 times those of the pictures that are compared with them.
reference_spp() { # SCENE
    case $1 in
    cornell) echo "${BENCH_REFERENCE_SPP:-2048}" ;;
    *) echo "${BENCH_REFERENCE_SPP:-1024}" ;;
    esac
}

retex() { # SCENE SIZE SPP SEED OUT
    "$python" $here/time_retex.py "$work/$1.pov" "$2" "$3" "$4" "$5"
}
cycles() { # SCENE SIZE SPP SEED OUT
    "$cycles" -b --factory-startup -P $here/cycles_render.py -- "$work/$1.npz" "$2" "$3" "$4" "$5" \
        >"$work/blender.log" 2>&1 || true
    sed -n 's/^RESULT //p' "$work/blender.log" | grep . || { cat "$work/blender.log" >&2; return 1; }
}

turn() { # SCENE SEED: a line each into $work/runs
    samples=$(spp "$1")
    for renderer in embree retex ${cycles:+cycles}; do
        case $renderer:$1 in
        embree:artists-room) continue ;; # its rays to light go to lamps, and the sky is none
        embree:*) figures=$("$build/tests/bench/embree_rays" "$work/$1.pov") ;;
        *) figures=$($renderer "$1" "$size" "$samples" "$2" "$work/$1-$renderer.exr") ;;
        esac
        echo "$1 $size $renderer $figures" >>"$work/runs"
    done
}

# What the pictures depend on besides the renderer: those of an older scene are made anew.
key() { # SCENE
    {
        cat "$work/$1.pov" $here/cycles_render.py
        grep '^FLAGS' $here/time_retex.py
        for name in $(sed -n 's/.*image_map { [a-z]* "\([^"]*\)".*/\1/p' "$work/$1.pov"); do cat "$work/$name"; done
        echo "$error_size"
    } | sha256sum | cut -c1-12
}

# Once: a picture.
kept() { # RENDERER SCENE SPP SEED FILE
    [ ! -e "$5" ] || return 0
    "$1" "$2" "$error_size" "$3" "$4" "${5%.exr}-part.exr" >/dev/null
    mv "${5%.exr}-part.exr" "$5"
}

error() { # SCENE: pictures, then the words for error.py in $compared
    scene=$1 samples=$(spp "$1") reference_spp=$(reference_spp "$1") key=$(key "$1")
    pictures=$work/pictures-$scene-$samples-$key
    mkdir -p "$pictures"
    rm -f "$pictures"/retex-*
    compared="$scene $pictures $work/runs $samples $reference_spp"
    for renderer in retex ${cycles:+cycles}; do
        reference=$work/reference-$scene-$renderer-$reference_spp-$key.exr
        kept "$renderer" "$scene" "$reference_spp" 1000 "$reference"
        for n in $(seq "$turns"); do
            kept "$renderer" "$scene" "$samples" "$n" "$pictures/$renderer-$n.exr"
        done
        compared="$compared $renderer=$reference"
    done
    rm -f "$pictures"/*.json
}

measure() {
    echo "machine: $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores, load" \
        "$(cut -d' ' -f1 /proc/loadavg); two threads; $(tr '\n' ',' <"$work/scenes.log" | sed 's/,$//; s/,/, /g')"
    [ -z "$left_out" ] || echo "$left_out"
    : >"$work/runs"
    for n in $(seq "$turns"); do
        for scene in $scenes; do turn "$scene" "$n"; done
    done
    "$python" $here/speed.py "$work/runs" "${out%.txt}.csv"
    agree=yes
    for scene in $scenes; do
        error "$scene"
        # shellcheck disable=SC2086 # its words
        "$python" $here/error.py $compared || agree=no
    done
    [ $agree = yes ]
}

# shellcheck disable=SC2086 # no folder, or one
"$python" $here/scenes.py "$work" $artist >"$work/scenes.log"
rm -f "$work/done"
{ measure; touch "$work/done"; } | tee "$out"
[ -e "$work/done" ]
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "${out%.txt}.csv" docs/speed.csv
    flags=$(sed -n 's/^FLAGS = \[\(.*\)\]/\1/p' $here/time_retex.py | tr -d '",')
    {
        sed "s|@head@|$(figures_head bench-render)|; s|@flags@|$flags|" $here/page.md
        printf '\n```\n'
        cat "$out"
        printf '```\n'
    } >docs/speed.md
fi
