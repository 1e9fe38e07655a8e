#!/bin/sh
# make demo: renders the living room once, denoises the set, and makes pictures with other floors and walls from it. The
# set goes to a file: there it is compressed, in pipes it is not. demo.sh BUILD writes the pictures to BUILD/demo/. Lower
# DEMO_SPP and DEMO_SIZE make it faster.
set -eu
here=$(pwd)
case $1 in /*) build=$1 ;; *) build=$here/$1 ;; esac
PATH=$build/bin:$PATH
demo=$build/demo
scene=$here/scenes/living-room/living-room.pov
textures=$here/scenes/textures
mkdir -p "$demo"

say() { printf '%s\n' "$*" >&2; }
seconds() { date +%s.%N; }
since() { awk -v a="$1" -v b="$(seconds)" 'BEGIN { printf "%.2f s", b - a }'; }

retexture() { # NAME=FILE
    say "    retex-sample living-room.exr --texture $1 -o - | retex-combine - -o $(picture "$1")"
    start=$(seconds)
    retex-sample -q "$demo/living-room.exr" --texture "${1%%=*}=$textures/${1#*=}" -o - |
        retex-combine -q - -o "$demo/$(picture "$1")"
    say "    $(since "$start")"
}
picture() { echo "${1%.jpg}.png" | tr 'A-Z=' 'a-z-'; }

say "Render the living room and denoise it:"
say "    retex-render living-room.pov -t Floor -t Wall -o - | retex-denoise - -o living-room.exr"
start=$(seconds)
retex-render -t Floor -t Wall --spp "${DEMO_SPP:-64}" ${DEMO_SIZE:+--size "$DEMO_SIZE"} "$scene" -o - |
    retex-denoise -q - -o "$demo/living-room.exr"
say "    $(since "$start")"

say "Floors and walls from that set, without rendering:"
for edit in Floor=walnut-herringbone.jpg Floor=terrazzo.jpg Wall=damask.jpg Wall=brick.jpg; do
    retexture $edit
done
retex-combine -q "$demo/living-room.exr" -o "$demo/original.png"
say "A new floor and new walls together."
retex-combine -q "$demo/living-room.exr" --texture "Floor=$textures/walnut-herringbone.jpg" \
    --texture "Wall=$textures/damask.jpg" -o "$demo/floor-and-wall.png"
say "The pictures are in:"
ls "$demo"/*.png
from=${build#"$here"/}
say "To put a photograph of yours on the floor, 1.5 metres wide:"
say "    $from/bin/retex-combine $from/demo/living-room.exr --texture:width=1.5 Floor=PHOTOGRAPH.jpg -o mine.png"
