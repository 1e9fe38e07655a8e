#!/bin/sh
# Sets as they are rendered by default, with their numbers rounded, and the targets in constant colours: retextured they
# are what --replace renders from the same samples, to 55 dB, each target alone and all of them. Few samples are the
# hard case: numbers are rounded by their noise. In the kitchen oiiotool must add up the same picture from a set.
set -u
. tests/lib/tap.sh

render() { retex-render -q --threads 2 --size 128x72 --spp 16 --seed 3 "$@"; }

# Rows `NAME KEYS TEXTURES` of edits, a texture or - for each target.
edits() {
    for color in 'white rgb(1,1,1)' 'near-black rgb(0.01,0.01,0.01)' 'red rgb(0.8,0.02,0.02)'; do
        name=${color% *} value=${color#* }
        [ $# = 1 ] && echo "$name-$1 $value" && continue
        echo "$name-$1 $value -"
        echo "$name-$2 - $value"
        echo "$name-all $value $value"
    done
}

check_scene() { # SCENE TARGET…
    scene=$1; shift
    file=$scenes/$scene/$scene.pov flags=
    for target; do flags="$flags -t $target"; done
    edits "$@" >"$work/edits"
    { echo "output $*" | tr ' ' ,
      sed "s|rgb([^)]*)|\"&\"|g; s| -|,|g; s| |,|g; s|^\([^,]*\)|$work/\1.exr|" "$work/edits"; } >"$work/table.csv"
    # shellcheck disable=SC2086 # words wanted
    render $flags "$file" -o "$work/$scene.exr" || { result 0 "$scene renders"; return; }
    # shellcheck disable=SC2086
    render --plain $flags --variants "$work/table.csv" "$file"
    while read -r name first second; do
        textures=
        [ "$first" = - ] || textures="--texture $1=$first"
        case $second in - | '') ;; *) textures="$textures --texture $2=$second" ;; esac
        # shellcheck disable=SC2086
        retex-combine -q "$work/$scene.exr" $textures -o "$work/retextured.exr"
        same "$work/retextured.exr" "$work/$name.exr" 55 "$scene: $name"
    done <"$work/edits"
}

# oiiotool SET TEXTURE…: it and retex-combine give the same picture.
check_oiiotool() {
    set=$1; shift
    if ! command -v oiiotool >/dev/null; then
        skip "oiiotool computes the same: $*" 'there is no oiiotool'
        return
    fi
    options=
    for texture; do options="$options --texture $texture"; done
    # shellcheck disable=SC2086
    retex-combine -q "$set" $options -o "$work/retextured.exr"
    # shellcheck disable=SC2086
    retex-sample -q "$set" $options -o "$work/samples.exr"
    python3 tests/bench/post/oiio_chain.py "$set" "$work/samples.exr" "$work/chain.exr" | tr '\n' '\0' |
        xargs -0 sh -c '"$@"' _
    same "$work/chain.exr" "$work/retextured.exr" 100 "oiiotool computes the same: $*"
}

check_scene cornell-box Floor
check_scene glass-caustics Floor
check_scene living-room Floor Wall
check_scene kitchen Floor Wall
for floor in "Floor=$scenes/textures/terrazzo.jpg" 'Floor=rgb(0.8,0.02,0.02)'; do
    check_oiiotool "$work/kitchen.exr" "$floor"
    check_oiiotool "$work/kitchen.exr" "$floor" "Wall=$scenes/textures/fans.jpg"
done
finish
