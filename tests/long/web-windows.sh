#!/bin/sh
# A room's page in windows of many sizes, in headless Chromium: with a long list of textures no page is larger than its window,
# nor an element than its place; and the surface that is pointed at, pressed and shown is the one that textures go to, on a
# floor that reflects walls, while the room loads, with links, other rooms and several rooms in a page.
set -u
. tests/web/room.sh
needs_browser "a room's page in windows"
cat >"$work/hall.pov" <<'END'
#version 3.7;
global_settings { assumed_gamma 1 }
#default { finish { ambient 0 diffuse 1 } }
camera { location <0, 1.5, -3.8> look_at <0, .8, 0> right 16 / 9 * x }
#declare Floor = texture { pigment { rgb .3 } finish { diffuse .8 reflection { .02, .3 fresnel off } } }
#declare Wall = texture { pigment { rgb .7 } }
#declare Side = texture { pigment { rgb .6 } }
box { <-2, -.1, -4>, <2, 0, 4> texture { Floor } }
box { <-2, 0, 2>, <2, 3, 2.1> texture { Wall } }
box { <-2.1, 0, -4>, <-2, 3, 4> texture { Side } }
box { <2, 0, -4>, <2.1, 3, 4> texture { Side } }
#declare Lamp = light_source { <0, 2.5, -1> rgb 1 }
light_source { Lamp }
sky_sphere { pigment { rgb .3 } }
END
retex-render -q --size 160x90 --spp 16 -t Floor -t Wall -t Side --lamps each "$work/hall.pov" -o "$work/hall.exr"
retex-pack -q "$work/hall.exr" --web "$work/hall"
retex-render -q --plain --size 160x90 --spp 1 --aov object "$work/hall.pov" -o "$work/object.exr"
retex-render -q --size 64x96 --spp 4 -t Floor "$work/hall.pov" -o "$work/one.exr"
retex-pack -q "$work/one.exr" --web "$work/one"
cp -r "$scenes/textures" "$work/textures"
timeout 900 /usr/bin/python3 -B tests/web/windows.py "$work"
