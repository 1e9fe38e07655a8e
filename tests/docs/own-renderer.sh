#!/bin/sh
# The commands of docs/own-renderer.md, and its converter: the set is accepted by all tools, and its pictures are near
# those of rendering again. Light that the floor throws on other things keeps
# its colour in such a set, so the floor alone is nearer.
set -u
. tests/lib/tap.sh
page=$here/docs/own-renderer.md
mkdir "$work/here"
cd "$work/here" || exit 1
ln -s "$here/scenes" scenes
ln -s "$here/docs" docs
awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$page" >"$work/commands"
sh -e "$work/commands" >"$work/out" 2>&1 </dev/null
status=$?
[ $status = 0 ] || sed 's/^/# /' "$work/out"
result "$([ $status = 0 ] && [ -s own.png ] && echo 1)" "the commands of the page work"

again() { # IMAGE OUT [SCENE]
    retex-render -q --size 96x96 --spp 256 --seed 1 --replace "Floor=$1" "${3:-scenes/cornell-box/cornell-box.pov}" -o "$2"
}
crop() { oiiotool "$1" --ch R,G,B --cut 60x8+18+87 -o "$2"; } # shows nothing but the floor
for texture in textures/terrazzo glass-caustics/textures/marble-tiles; do
    name=${texture##*/}
    again "scenes/$texture.jpg" "$name-again.exr"
    retex-combine -q own.exr --texture "Floor=scenes/$texture.jpg" -o "$name.exr"
    same "$name.exr" "$name-again.exr" 34 "$name, whole picture" 1
    crop "$name.exr" a.exr
    crop "$name-again.exr" b.exr
    same a.exr b.exr 40 "$name, floor" 1
done

# The manifest on the page has the keys of the program's.
retex-info --json own.exr >manifest.json
keys() { tr ',{' '\n\n' | sed -n 's/^ *"\([a-z_0-9]*\)":.*/\1/p' | sort -u; }
awk '/^```json$/ { on = 1; next } /^```/ { on = 0 } on' "$page" | keys >page-keys
/usr/bin/python3 - >file-keys <<'END'
import OpenImageIO as oiio
print(oiio.ImageInput.open("own.exr").spec().getattribute("retex"))
END
keys <file-keys | cmp -s - page-keys
result "$([ $? = 0 ] && echo 1)" "the page's manifest has the keys of the file's"

# Other tools take it; a damaged one is noticed.
retex-pack -q own.exr -o own.retex && retex-combine -q own.retex -o packed.exr && retex-combine -q own.exr -o plain.exr
same packed.exr plain.exr 30 "as a pack" 1
size=$(wc -c <own.exr)
printf '\377\377' | dd of=own.exr bs=1 seek=$((size - 40)) conv=notrunc 2>/dev/null
retex-info --check own.exr >/dev/null 2>&1
result "$([ $? = 1 ] && echo 1)" "damage is noticed"
/usr/bin/python3 docs/aovs_to_set.py --target Floor --object 99 aovs.exr none.exr 2>message
result "$([ $? = 1 ] && [ "$(cat message)" = 'aovs_to_set.py: no sample sees Floor' ] && [ ! -e none.exr ] && echo 1)" \
    "an object that is not seen is said"

# Of a floor that gives back 0.9 of its colour, black in places, the light is that of rendering again, not 1.11 times as
# much.
cat >matt.pov <<'END'
#version 3.7;
global_settings { assumed_gamma 1 radiosity {} }
#default { finish { ambient 0 diffuse 0.9 } }
camera { location <0, 2, -3> look_at <0, 0, 0.5> right x up y angle 50 }
#declare Floor = texture { pigment { checker rgb 0, rgb <0.8, 0.6, 0.4> scale 0.5 } }
plane { y, 0 texture { Floor } }
light_source { <2, 4, -3> rgb 0.7 }
sky_sphere { pigment { rgb 0.2 } }
END
eval "$(sed -n '/--aov/,/retex-info/p' "$work/commands" | sed 's|scenes/cornell-box/cornell-box.pov|matt.pov|; /retex-info/d')"
retex-combine -q own.exr --texture 'Floor=rgb(0.5,0.4,0.3)' -o matt.exr
again 'rgb(0.5,0.4,0.3)' matt-again.exr matt.pov
oiiotool matt.exr --ch R,G,B --cut 96x40+0+56 -o a.exr
oiiotool matt-again.exr --ch R,G,B --cut 96x40+0+56 -o b.exr
brighter=$(oiiotool --info --stats a.exr b.exr | awk '/Stats Avg/ { mean[++n] = $3 } END { print mean[1] / mean[2] }')
echo "# the floor by the example over that of rendering again: $brighter"
result "$([ "$(at_least "$brighter" 0.99)$(at_most "$brighter" 1.01)" = 11 ] && echo 1)" "the finish's share of light counts"
finish
