#!/bin/sh
# retex-serve as programs see it: images of IIIF, ten thousand malformed requests, 200 uploads made to hurt, 64 clients
# of wrk for two minutes (SERVE_SECONDS), a full queue, kills, processor time beside --batch, and nginx with
# tools/serve/nginx.conf.
# SERVE_PARTS='iiif abuse strangers load nginx unit' selects.
set -u
. tests/lib/tap.sh
if ! tools/setup.sh serve >&2 2>&1; then
    skip "retex-serve with wrk and nginx" "wrk or nginx is not installed"
    finish
    exit
fi
mkdir "$work/rooms"
for room in 'small 480x270 32' 'large 1920x1080 4'; do
    # shellcheck disable=SC2086 # words wanted
    set -- $room
    nice retex-render -q --size "$2" --spp "$3" --denoise -t Floor -t Wall "$scenes/living-room/living-room.pov" \
        -o "$work/$1.exr" && retex-pack -q "$work/$1.exr" -o "$work/rooms/$1.retex" && rm "$work/$1.exr"
done
retex-combine -q "$work/rooms/small.retex" --texture Floor="$scenes/textures/brick.jpg" -o "$work/reference.png"
# shellcheck disable=SC2086 # words wanted
timeout 1800 /usr/bin/python3 -B tests/serve/check.py "$work/rooms" "$scenes/textures" "$work/reference.png" "$work" \
    "${SERVE_SECONDS:-120}" ${SERVE_PARTS:-iiif abuse strangers load nginx unit}
