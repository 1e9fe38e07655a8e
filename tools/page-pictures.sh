#!/bin/sh
# The pictures of pages in docs/ that explain: page-pictures.sh BUILD [PAGE...], by default all of tutorial, own, how and
# faq. Part of make pictures. Sets are kept in BUILD/pictures/pages.
set -eu
here=$(pwd)
case $1 in /*) build=$1 ;; *) build=$here/$1 ;; esac
shift
[ $# != 0 ] || set -- tutorial own how faq
PATH=$build/bin:$PATH
out=$here/docs/pictures
sets=$build/pictures/pages
tiles=scenes/glass-caustics/textures/marble-tiles.jpg glass=scenes/glass-caustics/glass-caustics.pov
mkdir -p "$sets"

# jpeg FROM NAME: a picture for people, as small as it may be.
jpeg() { oiiotool --nosoftwareattrib "$1" --ch R,G,B --eraseattrib ".*" --compression jpeg:88 -o "$out/$2.jpg"; }

# Those that its commands make, as they are written there.
tutorial() {
    rm -rf "$sets/tutorial"
    BUILD=$build TUTORIAL_AS_WRITTEN=1 TUTORIAL_FOLDER=$sets/tutorial sh tests/docs/tutorial.sh
    for name in noisy room walnut blue marble damask small-damask; do
        jpeg "$sets/tutorial/my-room/$name.jpg" "tutorial-$name"
    done
}

# The converter of own-renderer.md: its picture, the scene rendered again, and their difference.
own() {
    box=scenes/cornell-box/cornell-box.pov terrazzo=scenes/textures/terrazzo.jpg
    retex-render -q --plain --size 768x768 --spp 16 --aov albedo,uv,object,irradiance $box -o "$sets/aovs.exr"
    /usr/bin/python3 docs/aovs_to_set.py --target Floor --object 1 --samples 4 "$sets/aovs.exr" "$sets/own.exr"
    retex-combine -q "$sets/own.exr" --texture Floor=$terrazzo -o "$sets/own-retextured.exr"
    retex-render -q --plain --size 192x192 --spp 256 --replace Floor=$terrazzo $box -o "$sets/own-again.exr"
    oiiotool "$sets/own-retextured.exr" "$sets/own-again.exr" --sub --mulc 4 --addc 0.2 -o "$sets/own-difference.exr"
    for name in own-retextured own-again own-difference; do
        oiiotool "$sets/$name.exr" --ch R,G,B --tocolorspace sRGB -d uint8 -o "$sets/$name.png"
        jpeg "$sets/$name.png" "$name"
    done
}

figure() { /usr/bin/python3 -B tools/page_pictures.py "$@"; }
# part FROM X,Y,W,H NAME: a part of a picture, twice as large.
part() {
    place=${2%,*,*} size=${2#*,*,}
    oiiotool "$1" --ch R,G,B --cut "${size%,*}x${size#*,}+${place%,*}+${place#*,}" -o "$sets/part.png"
    oiiotool "$sets/part.png" --resize:filter=box "$((${size%,*} * 2))x$((${size#*,} * 2))" -o "$sets/part2.png"
    jpeg "$sets/part2.png" "$3"
}

# Light, places, one pixel and denoising, in the scene of glass.
how() {
    [ -e "$sets/glass.exr" ] || retex-render -q --size 480x360 --spp 64 -t Floor --aov uv $glass -o "$sets/glass.exr"
    [ -e "$sets/glass-denoised.exr" ] || retex-denoise -q "$sets/glass.exr" -o "$sets/glass-denoised.exr"
    retex-combine -q "$sets/glass-denoised.exr" -o "$sets/scene.png"
    jpeg "$sets/scene.png" how-scene
    figure light "$sets/light.png" "$sets/glass-denoised.exr"
    oiiotool "$sets/light.png" --resize 1400x0 -o "$sets/light.png"
    jpeg "$sets/light.png" how-light
    figure places "$sets/places.png" "$sets/glass.exr"
    jpeg "$sets/places.png" how-places
    for sample in $(seq 10 39); do
        [ -s "$sets/path-$sample" ] || retex-render --trace-pixel "245,89,$sample" --size 480x360 -t Floor $glass \
            >"$sets/path-$sample"
    done
    figure pixel "$out/how-pixel.svg" "$sets/glass.exr" 245 89 "$sets"/path-??
    retex-render -q --size 480x360 --crop 30,80,180,130 --spp 16 -t Floor $glass -o "$sets/crop.exr"
    retex-denoise -q "$sets/crop.exr" -o "$sets/crop-denoised.exr"
    retex-combine -q "$sets/crop-denoised.exr" --texture Floor=scenes/textures/fans.jpg -o "$sets/crop.png"
    figure denoise "$sets/denoise.png" "$sets/crop.exr" "$sets/crop-denoised.exr" "$sets/crop.png"
    oiiotool "$sets/denoise.png" --resize:filter=box 1092x0 -o "$sets/denoise.png"
    jpeg "$sets/denoise.png" how-denoise
}

# What the method does not do, and what a UV pass does not.
faq() {
    limits="--size 480x270 --spp 32 docs/limits.pov"
    edits="--texture Floor=$tiles --texture Ball=$tiles"
    # shellcheck disable=SC2086 # words wanted
    {
        [ -e "$sets/limits.exr" ] ||
            retex-render -q -t Floor -t Ball --aov uv,object,irradiance $limits -o "$sets/limits.exr"
        [ -e "$sets/limits-denoised.exr" ] || retex-denoise -q "$sets/limits.exr" -o "$sets/limits-denoised.exr"
        [ -e "$sets/again.png" ] || retex-render -q --denoise --replace Floor=$tiles --replace Ball=$tiles $limits \
            -o "$sets/again.png"
        retex-combine -q "$sets/limits-denoised.exr" $edits -o "$sets/retextured.png"
        for which in retextured again; do
            jpeg "$sets/$which.png" faq-$which
            part "$sets/$which.png" 0,100,165,110 faq-rough-$which
        done
        figure stmap "$sets/stmap.png" "$sets/limits.exr" $tiles
        retex-combine -q "$sets/limits.exr" $edits -o "$sets/noisy.png"
        part "$sets/stmap.png" 192,70,136,120 faq-stmap
        part "$sets/noisy.png" 192,70,136,120 faq-stmap-retex
        for quality in 90 30; do
            retex-pack -q --quality $quality "$sets/limits-denoised.exr" -o "$sets/$quality.retex"
            retex-combine -q "$sets/$quality.retex" $edits -o "$sets/$quality.png"
            part "$sets/$quality.png" 150,110,110,80 faq-pack-$quality
        done
        part "$sets/retextured.png" 150,110,110,80 faq-pack-set
    }
    crop="--size 480x360 --crop 240,10,140,120 --spp 64"
    # shellcheck disable=SC2086 # words wanted
    for clusters in 2 4+2 4+2+8; do
        [ -e "$sets/clusters-$clusters.exr" ] ||
            retex-render -q $crop --clusters $clusters -t Floor $glass -o "$sets/clusters-$clusters.exr"
        retex-combine -q "$sets/clusters-$clusters.exr" --texture Floor=scenes/textures/fans.jpg -o "$sets/c.png"
        part "$sets/c.png" 0,0,140,120 faq-clusters-$clusters
    done
    # shellcheck disable=SC2086 # words wanted
    retex-render -q $crop --replace Floor=scenes/textures/fans.jpg $glass -o "$sets/c.png"
    part "$sets/c.png" 0,0,140,120 faq-clusters-again
}

for page; do "$page"; done
