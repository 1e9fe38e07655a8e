#!/bin/sh
# The same model in Blender and through retex-import: normals of a normal map on UV of all kinds, and where the pictures of a
# sky lie. Blender's are from Cycles: its pass of normals, and a picture.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null || ! command -v retex-import >/dev/null; then
    skip "imported models in Blender" "Blender is not installed"
    finish
    exit
fi
script=$(pwd)/tests/long/import-in-blender.py
cd "$work" || exit 2
/usr/bin/python3 "$script" models || exit 2
blender -b --factory-startup -noaudio --python "$script" -- blender >log 2>&1
[ -s normal_blender.exr ] && [ -s sky_blender.exr ] || sed 's/^/# /' log
retex-import -q bumps.gltf -o bumps && retex-import -q --sky sky.hdr sky.gltf -o sky
retex-render -q --plain --spp 4 --size 160x120 --aov normal bumps/bumps.pov -o normal.exr
retex-render -q --plain --spp 64 --size 160x120 sky/sky.pov -o sky.exr
said=$(/usr/bin/python3 "$script" compare)
echo "$said" | sed 's/^/# /'
# key LIMIT NAME: what the script found, at most that.
key() { result "$(at_most "$(echo "$said" | awk -v key="$1" '$1 == key { print $2 }' | grep . || echo 1e9)" "$2")" "$3"; }
# Degrees; Blender's are means of a pixel.
key plain 1 "a card"
key mirrored 1 "a card with mirrored UV"
key sheared 1 "a card with sheared UV"
key globe 1 "a globe"
key turned 1 "a card that is turned"
# Of the mean.
key sky 0.05 "the sky, a mirror and a matte globe below it"
finish
