#!/bin/sh
# Targets that blend in a texture_map, and a target that is a filter layer over another one, in both layouts: identity,
# and what --replace renders from the same samples.
set -u
. tests/lib/tap.sh
scene=$here/tests/data/layers.pov
floor=$scenes/living-room/textures/oak-planks.jpg

render() { retex-render -q --full-precision --threads 2 --size 48x36 --spp 64 "$@" "$scene"; }

# compare NAME DECIBELS RELMSE NAME=TEXTURE…
compare() {
    name=$1 wanted=$2 relmse=$3; shift 3
    textures= replacements=
    for texture; do textures="$textures --texture $texture"; replacements="$replacements --replace $texture"; done
    # shellcheck disable=SC2086 # words wanted
    retex-combine -q "$work/set.exr" $textures -o "$work/new.exr"
    # shellcheck disable=SC2086
    render --plain $replacements -o "$work/wanted.exr"
    same "$work/new.exr" "$work/wanted.exr" "$wanted" "$layout: $name" "$relmse"
}

render --plain -o "$work/plain.exr"
for layout in footprints paper; do
    render --layout $layout -t Lower -t Upper -t Glaze -o "$work/set.exr"
    same "$work/set.exr" "$work/plain.exr" 80 "$layout: the set's picture is the plain one"
    retex-combine -q "$work/set.exr" -o "$work/same.exr"
    same "$work/same.exr" "$work/set.exr" 60 "$layout: all originals"
    compare 'one of two in a blend' 60 1e-4 'Upper=rgb(.2,.7,.4)'
    compare 'both in a blend' 50 1e-4 'Lower=rgb(.2,.7,.4)' 'Upper=rgb(.9,.3,.6)'
    compare 'a filter layer' 60 1e-4 'Glaze=rgb(.2,.7,.9)'
    compare 'a filter layer and what is below' 50 1e-4 'Lower=rgb(.6,.7,.4)' 'Glaze=rgb(.9,.6,.3)'
    compare 'all' 55 1e-4 'Lower=rgb(.6,.7,.4)' 'Glaze=rgb(.9,.6,.3)' 'Upper=rgb(.3,.2,.9)'
    compare 'a picture in a blend and below a layer' "$([ $layout = paper ] && echo 30 || echo 40)" 1e-2 "Lower=$floor"
done

# --replace is the scene that its author would edit: another colour, as opaque as before
sed '/declare Glaze/s/rgbf <[^>]*>/rgbf <0.2, 0.7, 0.9, 0.6>/; /declare Glaze/s/rgbft <[^>]*>/rgbft <0.2, 0.7, 0.9, 0.5, 0.2>/' \
    "$scene" >"$work/edited.pov"
render --plain --replace 'Glaze=rgb(.2,.7,.9)' -o "$work/new.exr"
scene=$work/edited.pov
render --plain -o "$work/wanted.exr"
same "$work/new.exr" "$work/wanted.exr" 80 'the picture with a layer replaced is that of the edited scene'
scene=$here/tests/data/layers.pov

# shares of the picture: what is seen of each
retex-render --list-targets --size 48x36 "$scene" >"$work/shares"
result "$(awk '$2 == "Glaze" { glaze = $1 + 0 } $2 == "Lower" { lower = $1 + 0 } $2 == "Upper" { upper = $1 + 0 }
    END { print (glaze > 5 && glaze < 20 && upper > 20 && upper < 40 && lower > upper && lower < 65) }' "$work/shares")" \
    'shares of layers and of blends'
finish
