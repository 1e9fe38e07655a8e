#!/bin/sh
# The page of retex studio in headless Chromium, shortly; long/studio walks all of its road.
set -u
. tests/web/room.sh
needs_browser "the page of retex studio in a browser"
timeout 200 /usr/bin/python3 -B tests/studio/short.py
