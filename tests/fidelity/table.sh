#!/bin/sh
# How near retextures come to rendering again: seven scenes times eight textures, against converged pictures.
#
#   make fidelity            all of it, about an hour on two cores, into docs/fidelity.csv and docs/fidelity.md
#
# For each scene and texture (of two targets both change: the second takes the texture three further down the list) a
# converged picture is rendered, then at 128 and at 1024 samples and another seed: the picture rendered again, and sets
# of both layouts, retextured. The figure is PSNR against the converged picture (retex-diff: sRGB-encoded, clipped).
# Everything is kept in $BUILD/fidelity and not made twice: what is there from an earlier run counts.
#
# FIDELITY_SCENES, FIDELITY_SPP, FIDELITY_SIZE and FIDELITY_TRUTH_SPP choose less, or more.
set -eu
build=${BUILD:-build} here=tests/fidelity
size=${FIDELITY_SIZE:-128x96} truth_spp=${FIDELITY_TRUTH_SPP:-8192} samples=${FIDELITY_SPP:-128 1024}
scenes=${FIDELITY_SCENES:-cornell-box glass-caustics living-room kitchen globe glossy-pair horizon}
textures='checker wood grout text saturated constant dark photo'
work=$build/fidelity images=$build/fidelity/textures
PATH=$build/bin:$PATH
mkdir -p "$work/truth" "$work/again" "$work/sets" "$work/retextured"

scene_file() {
    case $1 in
    globe | glossy-pair | horizon) echo "$here/scenes/$1.pov" ;;
    *) echo "scenes/$1/$1.pov" ;;
    esac
}

targets_of() {
    case $1 in
    living-room | kitchen) echo 'Floor Wall' ;;
    globe) echo Globe ;;
    glossy-pair) echo 'Left Right' ;;
    horizon) echo Ground ;;
    *) echo Floor ;;
    esac
}

image() { # the texture's file, for the first or the second target
    set -- "$1" "$2" "$(echo "$textures $textures" | tr ' ' '\n' | awk -v n="$1" -v k="$2" \
        '{ name[NR] = $0 } END { for (i = 1; name[i] != n; i++); print name[i + 3 * (k - 1)] }')"
    ls "$images/$3".*
}

# One row a texture: where its picture goes, and what lies on each target.
batch() { # SCENE PREFIX SUFFIX
    echo "output $(targets_of "$1")" | tr ' ' ','
    for texture in $textures; do
        row=$2$1-$texture$3.exr number=0
        for target in $(targets_of "$1"); do
            number=$((number + 1)) row=$row,$(image "$texture" $number)
        done
        echo "$row"
    done
}

flags() { for target in $(targets_of "$1"); do printf ' -t %s' "$target"; done; }

# All eight textures rendered along the same paths: rendered SCENE FOLDER SUFFIX SPP SEED
rendered() {
    [ ! -e "$2/$1-photo$3.exr" ] || return 0
    batch "$1" "$2/" "$3" >"$work/batch.csv"
    # shellcheck disable=SC2046 # words wanted
    retex-render -q --size "$size" --spp "$4" --seed "$5" $(flags "$1") --variants "$work/batch.csv" "$(scene_file "$1")"
}

# A set, retextured eight times: retextured SCENE METHOD SPP "FLAGS OF RENDER" "FLAGS OF COMBINE" SET
retextured() {
    [ ! -e "$work/retextured/$1-photo-$3-$2.exr" ] || return 0
    set_file=$work/sets/$1-$3-$6.exr
    # shellcheck disable=SC2046,SC2086
    [ -e "$set_file" ] ||
        retex-render -q --size "$size" --spp "$3" --seed 1 $(flags "$1") $4 "$(scene_file "$1")" -o "$set_file"
    batch "$1" "$work/retextured/" "-$3-$2" >"$work/batch.csv"
    # shellcheck disable=SC2086
    retex-combine -q $5 "$set_file" --batch "$work/batch.csv"
}

# Decibels of one picture; an absurdly good picture is no news.
score() { # SCENE TEXTURE SPP METHOD FILE
    retex-diff --json "$work/truth/$1-$2.exr" "$5" | tr ',{}' '\n\n\n' |
        awk -F: -v OFS=, -v s="$1" -v t="$2" -v n="$3" -v m="$4" '$1 ~ /"psnr"/ { print s, t, n, m, sprintf("%.2f", $2) }'
}

table=$work/fidelity.csv
echo 'scene,texture,samples,method,psnr' >"$table.new"
for scene in $scenes; do
    echo "fidelity: $scene" >&2
    rendered "$scene" "$work/truth" '' "$truth_spp" 1000
    for spp in $samples; do
        rendered "$scene" "$work/again" "-$spp" "$spp" 1
        retextured "$scene" footprints "$spp" '' '' footprints
        retextured "$scene" footprints-8 "$spp" '--clusters 8' '' footprints-8
        retextured "$scene" paper "$spp" '--layout paper' '' paper
        retextured "$scene" paper-cross-2 "$spp" '--layout paper' '--cross 2' paper
        retextured "$scene" paper-cross-0 "$spp" '--layout paper' '--cross 0' paper
        for texture in $textures; do
            score "$scene" "$texture" "$spp" again "$work/again/$scene-$texture-$spp.exr"
            for method in footprints footprints-8 paper paper-cross-2 paper-cross-0; do
                score "$scene" "$texture" "$spp" $method "$work/retextured/$scene-$texture-$spp-$method.exr"
            done
        done >>"$table.new"
    done
done
mv "$table.new" "$table"
