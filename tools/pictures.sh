#!/bin/sh
# make pictures: makes the pictures of the README in docs/pictures. Usage: pictures.sh BUILD. Takes some minutes per
# scene. PICTURES_SPP (default 192) sets the samples per pixel.
set -eu
here=$(pwd)
case $1 in /*) build=$1 ;; *) build=$here/$1 ;; esac
PATH=$build/bin:$PATH
out=$here/docs/pictures
sets=$build/pictures
spp=${PICTURES_SPP:-192}
textures=$here/scenes/textures
mkdir -p "$out" "$sets"

# set_of NAME SCENE SIZE TARGET…: render the set once.
set_of() {
    name=$1 scene=$2 size=$3
    shift 3
    flags=
    for target; do flags="$flags -t $target"; done
    # shellcheck disable=SC2086 # words wanted
    [ -e "$sets/$name.exr" ] || retex-render --size "$size" --spp "$spp" $flags "$scene" -o "$sets/$name.exr"
}
# picture SET NAME [--texture …]: make one picture of a set.
picture() {
    from=$sets/$1.exr to=$out/$2.jpg
    shift 2
    retex-combine -q "$from" "$@" -o "$to"
}

# again NAME OPTION…: $out/NAME.jpg, the scene of glass rendered again with a new floor; kept, as sets are.
again() {
    kept=$sets/$1.jpg to=$out/$1.jpg
    shift
    [ -e "$kept" ] || retex-render --spp "$spp" "$@" --replace "Floor=$textures/fans.jpg" \
        scenes/glass-caustics/glass-caustics.pov -o "$kept"
    cp "$kept" "$to"
}

set_of living-room scenes/living-room/living-room.pov 640x360 Floor Wall
picture living-room living-room
picture living-room living-room-walnut --texture "Floor=$textures/walnut-herringbone.jpg"
picture living-room living-room-terrazzo-brick --texture "Floor=$textures/terrazzo.jpg" --texture "Wall=$textures/brick.jpg"
picture living-room living-room-damask --texture "Wall=$textures/damask.jpg"

# The page of retex-pack --web in a browser.
if command -v chromium >/dev/null && /usr/bin/python3 -c 'import websocket' 2>/dev/null; then
    site=$sets/web
    mkdir -p "$site"
    [ -e "$site/room.exr" ] || retex-render --size 1600x900 --spp 16 --denoise -t Floor -t Wall \
        scenes/living-room/living-room.pov -o "$site/room.exr"
    retex-pack -q "$site/room.exr" --web "$site/room"
    ln -sfn "$textures" "$site/textures"
    offers=$(cd "$site" && echo textures/*.jpg)
    sed "s|src=\".\"|src=\"room/\" textures=\"$offers\"|; s|src=\"retex-room.js|src=\"room/retex-room.js|" \
        "$site/room/index.html" >"$site/page.html"
    (cd tests/web && /usr/bin/python3 -B shots.py "$site" page.html "$site")
    for name in desktop phone compare; do
        oiiotool --nosoftwareattrib "$site/web-$name.png" --eraseattrib ".*" --ch R,G,B --compression jpeg:88 -o "$out/web-$name.jpg"
    done
else
    echo "there is no chromium or no python3-websocket: pictures of the page are unchanged" >&2
fi

# A set of few samples, as rendered and denoised.
[ -e "$sets/living-room-64.exr" ] || retex-render --size 640x480 --spp 64 -t Floor -t Wall \
    scenes/living-room/living-room.pov -o "$sets/living-room-64.exr"
retex-denoise -q "$sets/living-room-64.exr" -o "$sets/living-room-64-denoised.exr"
for set in living-room-64 living-room-64-denoised; do
    picture "$set" "$set" --quality 97 --texture "Floor=$textures/walnut-herringbone.jpg" \
        --texture:scale=2 "Wall=$textures/damask.jpg"
done

# A picture from a denoised set, and from its pack.
retex-denoise -q "$sets/living-room.exr" -o "$sets/living-room-denoised.exr"
retex-pack -q "$sets/living-room-denoised.exr" -o "$sets/living-room-denoised.retex"
for from in exr retex; do
    retex-combine -q "$sets/living-room-denoised.$from" --quality 97 --texture "Floor=$textures/terrazzo.jpg" \
        --texture "Wall=$textures/fans.jpg" -o "$out/living-room-from-$from.jpg"
done

set_of kitchen scenes/kitchen/kitchen.pov 640x480 Floor Wall
picture kitchen kitchen
picture kitchen kitchen-terrazzo --texture "Floor=$textures/terrazzo.jpg"
picture kitchen kitchen-travertine-fans --texture "Floor=$textures/travertine.jpg" --texture "Wall=$textures/fans.jpg"

set_of glass-caustics scenes/glass-caustics/glass-caustics.pov 640x480 Floor
picture glass-caustics glass-caustics
picture glass-caustics glass-caustics-fans --texture "Floor=$textures/fans.jpg"
again glass-caustics-fans-truth --size 640x480

# A part at four times the size, without smoothing: the floor through the glass ball and in the mirror.
crop='--size 1280x960 --crop 130,150,420,330'
# shellcheck disable=SC2086
[ -e "$sets/glass-crop.exr" ] ||
    retex-render $crop --spp "$spp" -t Floor scenes/glass-caustics/glass-caustics.pov -o "$sets/glass-crop.exr"
picture glass-crop glass-crop --quality 97 --texture "Floor=$textures/fans.jpg"
# shellcheck disable=SC2086
again glass-crop-truth $crop --seed 1

set_of cornell-box scenes/cornell-box/cornell-box.pov 400x400 Floor
picture cornell-box cornell-box
picture cornell-box cornell-box-red --texture 'Floor=rgb(0.8,0.02,0.02)'
picture cornell-box cornell-box-terrazzo --texture "Floor=$textures/terrazzo.jpg"

# An unchanged sample scene of POV-Ray, from Debian's package povray-examples.
sample=/usr/share/povray-3.7/scenes/radiosity/cornell.pov
if [ -e "$sample" ]; then
    set_of povray-cornell "$sample" 400x300 White
    picture povray-cornell povray-cornell
    picture povray-cornell povray-cornell-terrazzo --texture:scale=0.018 "White=$textures/terrazzo.jpg"
else
    echo "$sample does not exist (package povray-examples): its pictures are unchanged" >&2
fi

# Samples of POV-Ray in the order of samples.txt, two in a row: POV-Ray's picture, ours, a target retextured, and the
# scene rendered again with that texture.
examples=/usr/share/doc/povray/examples
if [ -d "$examples" ] && command -v povray >/dev/null; then
    rows=
    while read -r what scene target texture _; do
        # the blocks are white in white light, which POV-Ray's radiosity of one recursion sends once
        case $what in '#'*) continue ;; text) depth=2 ;; *) depth=16 ;; esac
        base=$sets/sample-$what
        sample() { retex-render -q --lenient --size 240x180 --spp "$spp" --max-depth $depth "$@" --denoise "$examples/$scene.pov"; }
        [ -e "$base.exr" ] || sample -t "$target" -o "$base.exr"
        [ -e "$base-again.png" ] || sample --plain --seed 1 --replace "$target=$textures/$texture" -o "$base-again.png"
        (cd "$(dirname "$examples/$scene")" &&
            povray "${scene##*/}.pov" -D +A0.1 +W240 +H180 "+O$base-povray.png" >/dev/null 2>&1 </dev/null)
        retex-combine -q "$base.exr" -o "$base.png"
        retex-combine -q "$base.exr" --texture "$target=$textures/$texture" -o "$base-retextured.png"
        rows="$rows $base-povray.png $base.png $base-retextured.png $base-again.png"
    done <tests/long/samples.txt
    # shellcheck disable=SC2086 # words wanted
    oiiotool --nosoftwareattrib $rows --mosaic:pad=4 8x6 --eraseattrib ".*" --compression jpeg:88 -o "$out/povray-samples.jpg"
else
    echo "there is no povray or no $examples: povray-samples.jpg is unchanged" >&2
fi
ls -l "$out"
