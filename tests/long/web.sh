#!/bin/sh
# The player of retex-pack --web in headless Chromium: its canvas against retex-combine, all controls by mouse, touch and
# keyboard, broken folders, no WebGL 2. RETEX_WEB_SHOTS=DIR keeps screenshots.
# RETEX_WEB_ROOM='480x270 64' renders another size, with so many samples, to measure: the test of a device that takes
# small textures only is for the small room.
set -u
. tests/web/room.sh
needs_browser "the player in a browser"
# shellcheck disable=SC2086 # two words
living_room ${RETEX_WEB_ROOM:-192x108 64}
oiiotool "$scenes/textures/terrazzo.jpg" --resize 4096x4096 -o "$work/large.jpg"
offers="textures/brick.jpg textures/damask.jpg textures/fans.jpg"
sed "s|src=\".\"|src=\"room/\" textures=\"$offers\"|; s|src=\"retex-room.js|src=\"room/retex-room.js|" \
    "$work/room/index.html" >"$work/page.html"
timeout 1800 /usr/bin/python3 -B tests/web/check.py "$scenes" "$work"
