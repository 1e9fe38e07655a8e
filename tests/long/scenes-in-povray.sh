#!/bin/sh
# The scenes of the house are POV-Ray scenes: POV-Ray itself reads and renders them, small and without radiosity.
set -u
. tests/lib/tap.sh
if ! command -v povray >/dev/null; then
    skip "the scenes in POV-Ray" "povray is not on this machine"
    finish
    exit
fi
for scene in "$scenes"/*/*.pov; do
    name=$(basename "$scene" .pov)
    # POV-Ray looks for included files and pictures in the current folder. Its radiosity is taken out in a copy.
    cp -r "$(dirname "$scene")" "$work/$name"
    cd "$work/$name" || exit 1
    awk '/^ *radiosity *[{].*[}] *$/ { next } { print }' "$scene" >"$name.pov"
    grep -q 'radiosity *{' "$name.pov" && echo "# $name: radiosity is still there"
    nice povray "$name.pov" +W64 +H48 -D +FN +O"$work/$name.png" >"$work/log" 2>&1
    status=$?
    [ "$status" = 0 ] || grep -A 3 Error "$work/log" | sed 's/^/# /'
    result "$([ "$status" = 0 ] && [ -s "$work/$name.png" ] && echo 1)" "$name renders in POV-Ray"
    cd "$here" || exit 1
done
finish
