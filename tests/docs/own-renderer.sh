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

again() { # IMAGE OUT
    retex-render -q --size 96x96 --spp 256 --seed 1 --replace "Floor=$1" scenes/cornell-box/cornell-box.pov -o "$2"
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
finish
