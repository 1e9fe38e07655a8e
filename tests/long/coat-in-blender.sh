#!/bin/sh
# A clear coat beside Cycles' mix of the same base with a glossy lobe: means of rings of a sphere under a white sky, and beside
# a square that shines.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null; then
    skip "coats in Blender" "Blender is not installed"
    finish
    exit
fi
script=$(pwd)/tests/long/coat-in-blender.py
cd "$work" || exit 2
/usr/bin/python3 "$script" scenes || exit 2
blender -b --factory-startup -noaudio --python "$script" -- blender >log 2>&1
[ -s smooth.exr ] && [ -s rough-lit.exr ] || sed 's/^/# /' log
for scene in *.pov; do
    retex-render -q --plain --spp 256 --size 96x96 "$scene" -o "${scene%.pov}-r.exr"
done
said=$(/usr/bin/python3 "$script" compare)
echo "$said" | sed 's/^/# /'
for scene in *.pov; do
    name=${scene%.pov}
    worst=$(echo "$said" | awk -v name="$name" '$1 == name { print $2 }' | grep . || echo 1e9)
    result "$(at_most "$worst" 0.03)" "coat, $name"
done
finish
