#!/bin/sh
# What a set costs over the plain picture, as in tables 1 to 3 of the paper: make bench-overhead. Prints a page, which
# is also $BUILD/bench/overhead.md, with the figures in overhead.csv; with BENCH_DOCS=1 both go to docs/ too.
#
# In the living room the floor, the wall and both are changed, and in an artist's living room, where it is there, floor,
# painting and both. For each, whole processes that write to the disk are measured: the plain picture, sets, and what
# the method of Rousselle and others needs, twice. All renders of one edit are under way at once and go on by turns, a
# tenth of a second each, so that a machine that gets slower or faster favours none; the plain picture is there twice,
# which tells how well that goes.
#
# As it stands it takes about three hours a scene on two cores. BENCH_ROUNDS, BENCH_SIZE, BENCH_SPP, BENCH_MEMORY_SIZE,
# BENCH_SCENES='living-room artist' and BENCH_ROWS (some of the rows below, without `plain`) choose less;
# BENCH_ARTIST_ROWS does for the artist's room alone.
set -eu
export LC_ALL=C
. tests/figures/head.sh
build=${BUILD:-build} here=tests/bench/overhead
case $build in /*) ;; *) build=$PWD/$build ;; esac
PATH=$build/bin:$PATH
work=$build/bench/overhead records=$build/bench/overhead/runs
rounds=${BENCH_ROUNDS:-5} size=${BENCH_SIZE:-640x360} spp=${BENCH_SPP:-128} memory_size=${BENCH_MEMORY_SIZE:-1920x1080}
scenes=${BENCH_SCENES:-living-room artist}
python=${PYTHON:-/usr/bin/python3}
artist=${RETEX_SHARED:-../shared}/scenes/living-room-bitterli/scene.pov
mkdir -p "$work"
: >"$records"

file() { # SCENE: where it is
    case $1 in artist) echo "$artist" ;; *) echo "scenes/$1/$1.pov" ;; esac
}
options() { # ROW TARGET...: of retex-render, one a line
    row=$1
    shift
    case $row in
    plain | initial-*) echo --plain ;;
    again*) for t in "$@"; do printf '%s\n' --replace "$t=scenes/textures/$(texture "$t")"; done ;;
    *) for t in "$@"; do printf '%s\n' --target "$t"; done ;;
    esac
    case $row in paper*) printf '%s\n' --layout paper ;; esac
    case $row in
    *-bare) echo --no-denoise-data ;;
    initial-*) printf '%s\n' --control-data "${row#initial-}" ;;
    again-biased) printf '%s\n' --control "$work/initial-biased.exr" --control-mode biased ;;
    again-unbiased) printf '%s\n' --control "$work/initial-unbiased.exr" --control-mode halves ;;
    esac
}
texture() { # TARGET
    case $1 in Floor) echo walnut-herringbone.jpg ;; Wall) echo damask.jpg ;; *) echo fans.jpg ;; esac
}
# One word a line, for no option has blanks in it unless a folder does.
render() { # NUMBER SCENE SIZE SPP ROW TARGET...
    number=$1 scene=$2 wide=$3 samples=$4 row=$5
    shift 5
    printf '%s\n' -- "row=$row" retex-render
    options "$row" "$@"
    printf '%s\n' --size "$wide" --spp "$samples" -o "$work/out-$number.exr" "$(file "$scene")"
}
measure() { # PART SCENE ROUND SIZE SPP 'ROW...' TARGET...
    part=$1 scene=$2 round=$3 wide=$4 samples=$5 rows=$6
    shift 6
    edit=$(echo "$*" | tr ' ' '+')
    number=0
    given=$(for row in $rows; do
        number=$((number + 1))
        render $number "$scene" "$wide" "$samples" "$row" "$@"
    done)
    IFS='
'
    # shellcheck disable=SC2086
    set -- $given
    unset IFS
    "$python" $here/measure.py "$records" "part=$part" "scene=$scene" "edit=$edit" "round=$round" "$@"
}

rows="plain ${BENCH_ROWS:-footprints paper footprints-bare paper-bare initial-biased again-biased initial-unbiased
    again-unbiased again} plain"
artist_rows=$rows
[ -z "${BENCH_ARTIST_ROWS:-}" ] || artist_rows="plain $BENCH_ARTIST_ROWS plain"
for scene in $scenes; do
    if [ ! -e "$(file "$scene")" ]; then
        echo "bench-overhead: no $(file "$scene"): $scene is left out" >&2
        continue
    fi
    other=Wall rows_here=$rows
    [ "$scene" != artist ] || other=Painting rows_here=$artist_rows
    for control in biased unbiased; do
        case $rows_here in
        *again-$control*) retex-render -q --plain --control-data $control --size "$size" --spp "$spp" \
            -o "$work/initial-$control.exr" "$(file "$scene")" ;;
        esac
    done
    for round in $(seq "$rounds"); do
        for targets in Floor $other "Floor $other"; do
            # shellcheck disable=SC2086
            measure time "$scene" "$round" "$size" "$spp" "$rows_here" $targets
        done
    done
done
# Two samples are the fewest that denoising data are of.
measure memory living-room 1 "$memory_size" 2 plain Floor
for row in footprints paper; do
    measure memory living-room 1 "$memory_size" 2 $row Floor
    measure memory living-room 1 "$memory_size" 2 $row Floor Wall
done
rm -f "$work"/*.exr
"$python" $here/table.py "$records" "$build/bench/overhead.csv" "$(figures_head bench-overhead)" "$size" "$spp" "$memory_size" |
    tee "$build/bench/overhead.md"
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "$build/bench/overhead.md" "$build/bench/overhead.csv" docs/
fi
