#!/bin/sh
# The add-on for Blender: a room with all kinds of lights, a world, a shifted lens and modifiers, exported and rendered, has
# the brightness that Cycles gives it, region by region, and its floor can be given another texture.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null; then
    skip "a room from Blender" "Blender is not installed"
    finish
    exit
fi
# in_blender LOG ARGUMENTS: Blender without a window; its log is printed if it fails.
in_blender() {
    log=$work/$1
    shift
    blender -b --factory-startup -noaudio "$@" >"$log" 2>&1 || sed 's/^/# /' "$log"
}
# regions A B: the largest difference of the means of 6 x 6 regions, of those that are not black.
regions() {
    /usr/bin/python3 - "$1" "$2" <<'EOF'
import sys
import OpenImageIO as oiio
a, b = (oiio.ImageBuf(name).get_pixels(oiio.FLOAT)[:, :, :3] for name in sys.argv[1:])
means = [[p[y:y + 12, x:x + 16].mean() for y in range(0, 72, 12) for x in range(0, 96, 16)] for p in (a, b)]
print(max(abs(y / x - 1) for x, y in zip(*means) if x > .02) if a.shape == b.shape else a.shape + b.shape)
EOF
}
in_blender build.log --python tests/long/blender-export.py -- "$work"
in_blender export.log "$work/room.blend" --python tools/blender/retex_export.py -- -o "$work/room" -t 'floor 1' \
    --render --spp 256 --keep-glb
result "$([ -s "$work/room/room.exr" ] && echo 1)" "the add-on makes a scene and a set"
[ -s "$work/room/room.exr" ] || sed 's/^/# /' "$work/export.log"
retex-combine -q "$work/room/room.exr" -o "$work/plain.exr"
most=$(regions "$work/cycles.exr" "$work/plain.exr")
echo "# largest difference of a region from Cycles: $most"
result "$(at_most "${most:-1}" 0.05)" "regions within 5 % of Cycles"
result "$(grep -c 'clearcoat 0.25 ' "$work/room/room.pov")" "a coat of Blender 3 is a quarter of a coat"
result "$(retex-info "$work/room/room.exr" | grep -c 'floor 1' | awk '{ print ($1 > 0) }')" "the ticked material is the target"
retex-combine -q "$work/room/room.exr" --texture 'floor 1=rgb(0.7,0.1,0.1)' -o "$work/red.exr"
retex-render -q --plain --spp 256 --size 96x72 -t 'floor 1' --replace 'floor 1=rgb(0.7,0.1,0.1)' "$work/room/room.pov" \
    -o "$work/truth.exr"
same "$work/red.exr" "$work/truth.exr" 45 "a red floor is what rendering again gives"
# What was changed for the export is changed back.
cat >"$work/after.py" <<'EOF'
import os, sys, bpy
sys.path.insert(0, "tools/blender")
import retex_export
retex_export.register()
before = [(o.name, o.hide_render, len(o.keys())) for o in bpy.data.objects]
nodes = [len(m.node_tree.nodes) for m in bpy.data.materials]
bpy.data.materials["floor 1"].retex_target = True
bpy.ops.export_scene.retex(filepath=sys.argv[-1])
after = [(o.name, o.hide_render, len(o.keys())) for o in bpy.data.objects]
print("UNCHANGED", before == after and nodes == [len(m.node_tree.nodes) for m in bpy.data.materials]
      and len(bpy.data.scenes) == 1)
EOF
in_blender operator.log "$work/room.blend" --python "$work/after.py" -- "$work/again"
result "$(grep -c 'UNCHANGED True' "$work/operator.log")" "the operator leaves the file as it was"
result "$([ -s "$work/again/again.pov" ] && echo 1)" "the operator writes the scene"
in_blender wrong.log "$work/room.blend" --python tools/blender/retex_export.py -- -o "$work/wrong" -t nothing
result "$(grep -c 'error: -t nothing: there is no material of that name' "$work/wrong.log")" "a wrong name is told"
finish
