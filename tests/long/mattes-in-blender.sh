#!/bin/sh
# Blender reads the file of retex-render --mattes: its Cryptomatte node gives the mattes of names, also through glass, and a
# mask is a layer like any other. They are compared with what mattes.py decodes by the specification.
set -u
. tests/lib/tap.sh
if ! command -v blender >/dev/null; then
    skip "Cryptomatte in Blender" "Blender is not installed"
    finish
    exit
fi
need_pictures "Cryptomatte in Blender"
retex-render -q --size 96x72 --spp 16 -t Floor -t Wall tests/cli/mattes.pov --mattes "$work/mattes.exr" -o "$work/set.exr"
layers="CryptoObject/Cut CryptoObject/#7 CryptoMaterial/Shell CryptoMaterial/Rust CryptoThroughObject/Ground
    CryptoThroughMaterial/Wall mask_Floor mask_Floor_transmitted mask_Wall_reflected"
n=0
set --
for layer in $layers; do
    n=$((n + 1))
    set -- "$@" "$layer=matte$n-"
done
blender -b --factory-startup -noaudio --python tests/long/mattes-in-blender.py -- "$work" "$@" >"$work/log" 2>&1
grep -q '^MATTE done' "$work/log" || sed 's/^/# /' "$work/log"
n=0
for layer in $layers; do
    n=$((n + 1))
    said=$(/usr/bin/python3 tests/cli/mattes.py same "$work/mattes.exr" "$work/matte$n-0001.exr" 100 "$layer" 2>&1)
    [ "$said" = "$layer same" ] || echo "$said" | sed 's/^/# /'
    result "$([ "$said" = "$layer same" ] && echo 1)" "Blender has $layer"
done
finish
