#!/bin/sh
# Rooms of other people, made scenes by retex-import: retextured against rendered again, and beside Cycles' picture.
#
#   make fidelity-rooms      into $BUILD/fidelity-rooms; with BENCH_DOCS=1 the page and its figures go to docs/ too
#
# The rooms are not in the repository. $RETEX_ROOMS, or ../shared/scenes/rooms, is a folder with rooms.txt, a line a room:
#   NAME | MODEL | options of retex-import | source and licence
# with MODEL a glTF or OBJ file; beside it may be NAME-world.exr, NAME-camera.inc, which replaces the camera, and
# NAME.blend, which Cycles renders. The targets are Floor and Wall. Two retextures: the floor in walnut, and the floor in
# terrazzo with the wall in damask.
#
# A set and ROOMS_PICTURES pictures of both textures are rendered, each with ROOMS_SPP samples and a seed of its own. The
# pictures are references of each other and of the retexture (imported-rooms.py). What is there is not made again.
# ROOMS, ROOMS_SIZE, ROOMS_SPP and ROOMS_PICTURES choose less, or more.
set -eu
. tests/figures/head.sh
build=${BUILD:-build}
PATH=$(cd "$build" && pwd)/bin:$PATH
from=${RETEX_ROOMS:-${RETEX_SHARED:-../shared}/scenes/rooms} work=$(cd "$build" && pwd)/fidelity-rooms
size=${ROOMS_SIZE:-320x240} spp=${ROOMS_SPP:-128} pictures=${ROOMS_PICTURES:-32} threads=${ROOMS_THREADS:-0}
if [ ! -e "$from/rooms.txt" ]; then
    echo "fidelity-rooms: there is no $from/rooms.txt: skipped" >&2
    exit
fi
mkdir -p "$work"
here=$(pwd)

import() { # NAME MODEL OPTIONS…
    [ ! -e "$work/$1/$1.pov" ] || return 0
    room=$1 model=$2
    shift 2
    [ ! -e "$from/$room-world.exr" ] || set -- "$@" --sky "$from/$room-world.exr"
    retex-import -q --force --partial "$@" -o "$work/$room" "$from/$model"
    [ ! -e "$from/$room-camera.inc" ] || cat "$from/$room-camera.inc" >>"$work/$room/$room.pov"
}

render() { retex-render -q --threads "$threads" --size "$size" --spp "$spp" "$@"; }

again() { # NAME NUMBER: both textures, with a seed of its own
    [ ! -e "$work/$1/again-$2-damask.exr" ] || return 0
    printf 'output,Floor,Wall\n%s,%s,\n%s,%s,%s\n' "again-$2-walnut.exr" "$here/scenes/textures/walnut-herringbone.jpg" \
        "again-$2-damask.exr" "$here/scenes/textures/terrazzo.jpg" "$here/scenes/textures/damask.jpg" >"$work/$1/$2.csv"
    render --seed "$2" --variants "$work/$1/$2.csv" --batch-root "$work/$1" "$work/$1/$1.pov"
}

retextured() { # NAME
    set="$work/$1/set.exr"
    [ -e "$set" ] || render --seed 1 -t Floor -t Wall "$work/$1/$1.pov" -o "$set"
    retex-combine -q "$set" -o "$work/$1/plain.exr"
    retex-combine -q "$set" --texture Floor=scenes/textures/walnut-herringbone.jpg -o "$work/$1/retextured-walnut.exr"
    retex-combine -q "$set" --texture Floor=scenes/textures/terrazzo.jpg --texture Wall=scenes/textures/damask.jpg \
        -o "$work/$1/retextured-damask.exr"
}

cycles() { # NAME
    if [ ! -e "$from/$1.blend" ] || [ -e "$work/$1/cycles.exr" ] || ! command -v blender >/dev/null; then
        return 0
    fi
    blender -b --factory-startup -noaudio "$from/$1.blend" --python tests/fidelity/table/cycles-room.py \
        -- "$size" "$spp" "$threads" "$work/$1/cycles.exr" >"$work/$1/cycles.log" 2>&1
}

grep -v '^#' "$from/rooms.txt" | while IFS='|' read -r name model options source; do
    name=$(echo "$name" | tr -d ' ') model=$(echo "$model" | tr -d ' ')
    case " ${ROOMS:-$name} " in *" $name "*) ;; *) continue ;; esac
    echo "fidelity-rooms: $name" >&2
    # shellcheck disable=SC2086 # words wanted
    import "$name" "$model" $options
    retextured "$name"
    number=2
    while [ "$number" -lt $((pictures + 2)) ]; do
        again "$name" "$number"
        number=$((number + 1))
    done
    cycles "$name"
done
/usr/bin/python3 tests/fidelity/table/imported-rooms.py "$work" "$from/rooms.txt" "$(figures_head fidelity-rooms)" "$size" \
    "$spp"
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "$work/imported-rooms.md" "$work/imported-rooms.csv" docs/
    for picture in "$work"/rooms-*.jpg; do
        oiiotool --nosoftwareattrib "$picture" --eraseattrib '.*' --quality 88 -o "docs/pictures/${picture##*/}"
    done
fi
