#!/bin/sh
# Scenes of retex-import in POV-Ray itself: the same surfaces in the same places, with the same colours. POV-Ray's
# picture has colours without light by +Q1; its background is black without the sky.
set -u
. tests/lib/tap.sh
if ! command -v povray >/dev/null || ! command -v retex-import >/dev/null; then
    skip "imported models in POV-Ray" "povray is not on this machine"
    finish
    exit
fi
cd "$work" || exit 2
/usr/bin/python3 "$here/tests/cli/import_models.py" || exit 2
for model in card.glb second.gltf turned.gltf tinted.gltf screen.gltf bumpy.gltf varying.gltf card.obj card.dae card.stl; do
    name=$(echo $model | tr . _)
    retex-import -q $model -o $name
    cd $name || exit 2
    sed -i '/^sky_sphere/d' $name.pov
    retex-render -q --plain --spp 1 --size 97x73 --aov albedo $name.pov -o all.exr 2>/dev/null
    oiiotool -q all.exr --subimage albedo -o albedo.exr
    nice povray $name.pov +W97 +H73 -D +FN -A +Q1 +Opov.png >log 2>&1 || grep -A 3 Error log | sed 's/^/# /'
    psnr=$(figure pov.png albedo.exr psnr)
    echo "# $model: $psnr dB"
    result "$(at_least "${psnr:-0}" 55)" "$model"
    cd ..
done
finish
