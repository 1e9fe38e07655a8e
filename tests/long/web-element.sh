#!/bin/sh
# <retex-room> in other pages, in headless Chromium: its methods and events, its sizes, files dropped on it, and what people
# get who use a keyboard, a screen reader, or need contrast or calm. RETEX_WEB_SHOTS=DIR keeps screenshots.
set -u
. tests/lib/tap.sh
if ! tools/setup.sh web >&2 2>&1; then
    skip "the element in a browser" "chromium or python3-websocket is not installed"
    finish
    exit
fi
retex-render -q --size 160x90 --spp 16 --denoise -t Floor -t Wall "$scenes/living-room/living-room.pov" -o "$work/room.exr"
retex-pack -q "$work/room.exr" --web "$work/room"
cp -r "$scenes/textures" "$work/textures"
timeout 600 /usr/bin/python3 -B tests/web/element.py "$work"
