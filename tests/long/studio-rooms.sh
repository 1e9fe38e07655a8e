#!/bin/sh
# Rooms of other people in retex studio, in headless Chromium, from the file to a page with another floor and wall. The
# models are not in the repository: they are those of tests/fidelity/table/models.csv, in $RETEX_MODELS or ../shared/models,
# and scenes/living-room-bitterli in $RETEX_SHARED or ../shared. RETEX_WEB_SHOTS=DIR keeps screenshots; ROOMS chooses some.
set -u
. tests/web/room.sh
needs_browser "rooms of other people in the page of retex studio"
RETEX_SHARED=${RETEX_SHARED:-../shared}
export RETEX_SHARED
timeout 7200 /usr/bin/python3 -B tests/studio/rooms.py "${RETEX_MODELS:-$RETEX_SHARED/models}"
