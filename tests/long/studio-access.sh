#!/bin/sh
# The page of retex studio by the keyboard alone, under axe-core, and what it costs, in headless Chromium. axe-core is an npm
# package; it is installed below $BUILD/axe. RETEX_WEB_SHOTS=DIR keeps screenshots; STUDIO='axe keyboard' chooses checks.
set -u
. tests/web/room.sh
needs_browser "the page of retex studio by the keyboard, and under axe"
axe=4.10.3
[ -d "$BUILD/axe/node_modules/axe-core" ] ||
    { mkdir -p "$BUILD/axe" && (cd "$BUILD/axe" && npm install --silent --no-save "axe-core@$axe" >&2); }
AXE=$BUILD/axe/node_modules/axe-core/axe.min.js
export AXE
timeout 1200 /usr/bin/python3 -B tests/studio/access.py ${STUDIO:-}
