#!/bin/sh
# The add-on for Blender: bumps are those of Cycles, within its noise; what is left out is told, and nothing else is printed.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null; then
    skip "scenes from Blender" "Blender is not installed"
    finish
    exit
fi
# in_blender LOG ARGUMENTS: Blender without a window.
in_blender() {
    log=$work/$1
    shift
    blender -b --factory-startup -noaudio "$@" >"$log" 2>&1
}
addon=tools/blender/retex_export.py

in_blender build.log --python tests/long/blender-scenes.py -- bumps "$work"
[ -s "$work/flat.exr" ] || sed 's/^/# /' "$work/build.log"
in_blender export.log "$work/bumps.blend" --python $addon -- -o "$work/bumps"
retex-render -q --plain --spp 256 --size 160x120 "$work/bumps/bumps.pov" -o "$work/bumps.exr"
noise=$(figure "$work/a.exr" "$work/b.exr" psnr) ours=$(figure "$work/a.exr" "$work/bumps.exr" psnr)
echo "# 8 paths: Cycles with another seed ${noise:-none} dB, retex ${ours:-none} dB"
result "$(at_least "${ours:-0}" "${noise:-99}")" "bumps by heights are within the noise of Cycles"
ours=$(figure "$work/cycles.exr" "$work/bumps.exr" psnr) flat=$(figure "$work/cycles.exr" "$work/flat.exr" psnr)
echo "# 256 paths: retex ${ours:-none} dB, Cycles without bumps ${flat:-none} dB"
result "$(at_least "${ours:-0}" "${flat:-99} + 4")" "and nearer to its picture than one without bumps"
result "$(grep -c 'retex_height_map.*strength' "$work/bumps/bumps.pov" | awk '{ print ($1 == 2) }')" "both images are heights"
result "$(grep -v -e '^Blender' -e '^Read blend' -e '^retex-import: ' -e '^$' "$work/export.log" | wc -l |
    awk '{ print ($1 == 0) }')" "nothing else is printed"
in_blender export.log "$work/bumps.blend" --python $addon -- -o "$work/bumps" -v
result "$(grep -c 'glTF 2.0 export' "$work/export.log" | awk '{ print ($1 > 0) }')" "with -v what the exporter prints"

in_blender export.log "$work/bumps.blend" --python $addon -- -o "$work/named" -t 'Wand grün' --render --spp 1
result "$(retex-combine -q "$work/named/named.exr" --texture 'Wand grün=rgb(.1,.2,.3)' -o "$work/named.png" && echo 1)" \
    "a material's name is that of its target"

in_blender build.log --python tests/long/blender-scenes.py -- left-out "$work"
in_blender told.log "$work/left-out.blend" --python $addon -- -o "$work/left-out"
grep '^warning: ' "$work/told.log" | sort >"$work/told"
sort >"$work/expected" <<'END'
warning: camera 'pano': it is panoramic: it is left out
warning: light 'window': its spread is left out
warning: light 'window': of its nodes, Light Falloff is left out
warning: material 'colored': its Normal is made by Image Texture: it is left out
warning: material 'plain': Base Color: ColorRamp is left out, the image is taken as it is
warning: material 'plain': Roughness comes from nodes without an image; glTF takes none of it
warning: material 'plain': Specular comes from nodes; glTF takes none of it
warning: material 'plain': anisotropy is left out
warning: material 'plain': its bumps are made by Noise Texture, not by an image alone: they are left out
warning: material 'plain': its volume is left out
warning: material 'plain': roughness of transmission is left out
warning: material 'plain': sheen is left out
warning: material 'plain': subsurface scattering is left out
warning: material 'plain': the image 'checks.png' lies on UV, not by projection Box
warning: material 'plain': the image 'checks.png' lies on UV, not on coordinates Generated
warning: motion blur is left out
warning: object 'Cube': its instances on vertices or faces are left out
warning: object 'Plane': it is no shadow catcher but an ordinary surface
warning: object 'Plane': its hair 'grass' is left out
warning: object 'Plane': its particles 'dust' are left out
warning: object 'Plane': mirrors see it too
warning: object 'cloud': it is a volume: it is left out
warning: the exposure of the film is left out
warning: the transparency of the film is left out
warning: the view transform Filmic is left out: the picture is plain sRGB
END
if cmp -s "$work/told" "$work/expected"; then result 1 "a line for each thing that is left out"
else
    diff "$work/expected" "$work/told" | sed 's/^/# /'
    result 0 "a line for each thing that is left out"
fi
result "$(grep -c '^polygon\|^disc' "$work/left-out/left-out.pov" | awk '{ print ($1 == 1) }')" "a portal gives no light"
result "$(grep -c retex_normal_map "$work/left-out/left-out.pov" | awk '{ print ($1 == 0) }')" "no colour is a normal map"
finish
