#!/bin/sh
# <retex-room> in other pages, in headless Chromium: its methods and events, its sizes, files dropped on it, what people get
# who use a keyboard, a screen reader, or need contrast or calm, and what goes wrong for visitors: odd pictures, bad
# connections, links, odd rooms. RETEX_WEB_SHOTS=DIR keeps screenshots.
set -u
. tests/web/room.sh
needs_browser "the element in a browser"
living_room 160x90 16
view='camera { location <0, 1, -5> look_at 0 } light_source { <-2, 4, -3> rgb 1 }'
grey='texture { pigment { rgb .5 } }'
floor="#declare A = $grey plane { y, -1 texture { A } }"
echo "$view $floor" | small_room one 64x48 -t A
echo "$view $floor #declare B = $grey sphere { <0, 0, -99>, 1 texture { B } }" | small_room unseen 64x48 -t A -t B
echo "$view $floor" | small_room pixel 1x1 -t A
echo "$view $floor" | small_room wide 4000x40 -t A
for t in B C D E F G H; do
    floor="$floor #declare $t = $grey sphere { <$((place = ${place:--4} + 1)), 0, 0>, .4 texture { $t } }"
done
echo "$view $floor" | small_room eight 64x48 -t A -t B -t C -t D -t E -t F -t G -t H
timeout 1800 /usr/bin/python3 -B tests/web/element.py "$work"
