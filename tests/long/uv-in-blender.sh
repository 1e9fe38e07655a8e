#!/bin/sh
# Blender takes the AOV uv for a UV pass: in its compositor the part gives u and v, and Map UV lays an image with them. The
# image holds u in red and v in green, so that what Map UV makes of it is the pass again.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null; then
    skip "the AOV uv in Blender" "Blender is not installed"
    finish
    exit
fi
retex-render -q --plain --size 64x64 --spp 1 --aov uv,depth "$scenes/cornell-box/cornell-box.pov" -o "$work/room.exr"
retex-render -q --size 64x64 --spp 1 --aov uv,depth --aov-dir "$work/aov" "$scenes/cornell-box/cornell-box.pov" \
    -o "$work/room.exr"
blender -b --factory-startup -noaudio --python tests/long/uv-in-blender.py -- "$work" >"$work/log" 2>&1
said=$(sed -n 's/^UV //p' "$work/log")
[ -n "$said" ] || sed 's/^/# /' "$work/log"
echo "$said" | sed 's/^/# /'
# key LIMIT NAME: what the script found, at most that.
key() { result "$(at_most "$(echo "$said" | awk -v key="$1" '$1 == key { print $2 }' | grep . || echo 1e9)" "$2")" "$3"; }
key pass 1e-6 "the part uv gives u, v and 1 where something is hit"
key depth 1e-5 "the part depth gives the distance"
key map 1e-3 "Map UV finds the places"
key file 1e-3 "uv.exr gives u and v as red and green"
finish
