#!/bin/sh
# What goes wrong while one works in the page of retex studio, in headless Chromium. RETEX_WEB_SHOTS=DIR keeps screenshots;
# STUDIO='full_disk closed_tab' chooses checks.
set -u
. tests/web/room.sh
needs_browser "trouble in the page of retex studio"
timeout 1200 /usr/bin/python3 -B tests/studio/trouble.py ${STUDIO:-}
