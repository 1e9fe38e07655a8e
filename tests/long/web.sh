#!/bin/sh
# The player of retex-pack --web in headless Chromium: its canvas against retex-combine, all controls by mouse, touch and
# keyboard, broken folders, no WebGL 2. RETEX_WEB_SHOTS=DIR keeps screenshots.
set -u
. tests/lib/tap.sh
if ! tools/setup.sh web >&2 2>&1; then
    skip "the player in a browser" "chromium or python3-websocket is not installed"
    finish
    exit
fi
retex-render -q --size 192x108 --spp 64 --denoise -t Floor -t Wall "$scenes/living-room/living-room.pov" -o "$work/room.exr"
retex-pack -q "$work/room.exr" --web "$work/room"
cp -r "$scenes/textures" "$work/textures"
oiiotool "$scenes/textures/terrazzo.jpg" --resize 4096x4096 -o "$work/large.jpg"
offers="textures/brick.jpg textures/damask.jpg textures/fans.jpg"
sed "s|src=\".\"|src=\"room/\" textures=\"$offers\"|; s|src=\"retex-room.js|src=\"room/retex-room.js|" \
    "$work/room/index.html" >"$work/page.html"
timeout 900 /usr/bin/python3 -B tests/web/check.py "$scenes" "$work"
