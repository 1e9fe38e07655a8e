#!/bin/sh
# make demo: renders the living room once, denoises the set, and makes pictures with other floors and walls from it, in
# pipes. demo.sh BUILD writes the pictures to BUILD/demo/. Lower DEMO_SPP and DEMO_SIZE make it faster.
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

retexture() { # NAME=FILE, the set on standard input
    retex-sample -q - --texture "${1%%=*}=$textures/${1#*=}" -o - | retex-combine -q - -o "$demo/$(picture "$1")"
}
picture() { echo "${1%.jpg}.png" | tr 'A-Z=' 'a-z-'; }

first=Floor=walnut-herringbone.jpg
say "Render the living room, denoise it and put a new floor in; tee keeps the set:"
say "    retex-render living-room.pov -t Floor -t Wall -o - | retex-denoise - -o - | tee living-room.exr |"
say "        retex-sample - --texture $first -o - | retex-combine - -o $(picture $first)"
start=$(seconds)
retex-render -t Floor -t Wall --spp "${DEMO_SPP:-64}" ${DEMO_SIZE:+--size "$DEMO_SIZE"} "$scene" -o - |
    retex-denoise -q - -o - | tee "$demo/living-room.exr" | retexture $first
say "    $(since "$start")"

say "Other floors and walls from that set, without rendering:"
for edit in Floor=terrazzo.jpg Wall=damask.jpg Wall=brick.jpg; do
    say "    retex-sample living-room.exr --texture $edit -o - | retex-combine - -o $(picture $edit)"
    start=$(seconds)
    retexture $edit <"$demo/living-room.exr"
    say "    $(since "$start")"
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
