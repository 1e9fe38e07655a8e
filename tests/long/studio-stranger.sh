#!/bin/sh
# Projects of strangers in the page of retex studio, in headless Chromium. STUDIO='options asks' chooses checks.
set -u
. tests/web/room.sh
needs_browser "projects of strangers in the page of retex studio"
timeout 600 /usr/bin/python3 -B tests/studio/stranger.py ${STUDIO:-}
