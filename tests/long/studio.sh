#!/bin/sh
# The page of retex studio in headless Chromium, by clicks and keys, from a model to a picture. RETEX_WEB_SHOTS=DIR keeps
# screenshots.
set -u
. tests/web/room.sh
needs_browser "the page of retex studio in a browser"
timeout 600 /usr/bin/python3 -B tests/studio/page.py
