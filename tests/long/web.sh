#!/bin/sh
# The player of retex-pack --web in headless Chromium: its canvas against retex-combine, all controls by mouse, touch and
# keyboard, broken folders, no WebGL 2. RETEX_WEB_SHOTS=DIR keeps screenshots.
set -u
. tests/web/room.sh
needs_browser "the player in a browser"
living_room 192x108 64
oiiotool "$scenes/textures/terrazzo.jpg" --resize 4096x4096 -o "$work/large.jpg"
offers="textures/brick.jpg textures/damask.jpg textures/fans.jpg"
sed "s|src=\".\"|src=\"room/\" textures=\"$offers\"|; s|src=\"retex-room.js|src=\"room/retex-room.js|" \
    "$work/room/index.html" >"$work/page.html"
timeout 1800 /usr/bin/python3 -B tests/web/check.py "$scenes" "$work"
