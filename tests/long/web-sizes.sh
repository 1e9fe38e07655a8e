#!/bin/sh
# Smaller rooms of a folder in headless Chromium: which one <retex-room> loads by its size, with how many bytes, and how it
# comes to a larger one.
set -u
. tests/web/room.sh
needs_browser "sizes of rooms in a browser"
living_room 640x360 4
retex-pack -q "$work/room.exr" --web "$work/many" --web-smaller 2,4
timeout 600 /usr/bin/python3 -B tests/web/sizes.py "$work"
