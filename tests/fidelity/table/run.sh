#!/bin/sh
# How near retextures come to rendering again: seven scenes times eight textures, against converged pictures.
#
#   make fidelity            all of it, some hours on two cores, into docs/fidelity.csv and docs/fidelity.md
#
# For each scene and texture (of two targets both change: the second takes the texture three further down the list) a
# converged picture is rendered, then at 128 and at 1024 samples and another seed: the picture rendered again, and sets
# of both layouts, retextured. The figure is PSNR against the converged picture (retex-diff: sRGB-encoded, clipped).
# In two scenes textures are also turned by 30 degrees. Everything is kept in $BUILD/fidelity and not made twice: what is
# there from an earlier run counts.
#
# FIDELITY_SCENES, FIDELITY_SPP, FIDELITY_SIZE and FIDELITY_TRUTH_SPP choose less, or more; then docs/ is left alone.
set -eu
build=${BUILD:-build} here=tests/fidelity
size=${FIDELITY_SIZE:-128x96} truth_spp=${FIDELITY_TRUTH_SPP:-8192} samples=${FIDELITY_SPP-128 1024}
scenes=${FIDELITY_SCENES:-cornell-box glass-caustics living-room kitchen globe glossy-pair horizon}
textures='checker wood grout text saturated constant dark photo'
turned='wood-turned text-turned' # checked in:
turned_scenes='cornell-box horizon'
sets='footprints footprints-8 paper'
methods='footprints footprints-8 paper paper-cross-2 paper-cross-0'
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

target_flags() { for target in $(targets_of "$1"); do printf ' -t %s' "$target"; done; }

# The cell of a table: the texture for the first target, or the one three further on for the second.
cell() { # TEXTURE NUMBER
    case $1 in
    *-turned)
        set -- "${1%-turned}" "$2"
        printf ':rotate=30 '
        ;;
    esac
    set -- "$(echo "$textures $textures" | tr ' ' '\n' | awk -v n="$1" -v k="$2" \
        '{ name[NR] = $0 } END { for (i = 1; name[i] != n; i++); print name[i + 3 * (k - 1)] }')"
    ls "$images/$1".*
}

# One row a texture: where its picture goes, and what lies on each target.
batch() { # SCENE PREFIX SUFFIX TEXTURE…
    scene=$1 prefix=$2 suffix=$3
    shift 3
    echo "output $(targets_of "$scene")" | tr ' ' ','
    for texture; do
        row=$prefix$scene-$texture$suffix.exr number=0
        for target in $(targets_of "$scene"); do
            number=$((number + 1)) row=$row,$(cell "$texture" $number)
        done
        echo "$row"
    done
}


# Rendered along the same paths, all textures at once: rendered SCENE FOLDER SUFFIX SPP SEED TEXTURE…
rendered() {
    scene=$1 folder=$2 suffix=$3 spp=$4 seed=$5
    shift 5
    for last; do :; done
    [ ! -e "$folder/$scene-$last$suffix.exr" ] || return 0
    batch "$scene" "$folder/" "$suffix" "$@" >"$work/batch.csv"
    # shellcheck disable=SC2046 # words wanted
    retex-render -q --size "$size" --spp "$spp" --seed "$seed" $(target_flags "$scene") --variants "$work/batch.csv" \
        "$(scene_file "$scene")"
}

make_set() { # SCENE SPP NAME
    [ ! -e "$work/sets/$1-$2-$3.exr" ] || return 0
    case $3 in
    footprints-8) set -- "$1" "$2" "$3" --clusters 8 ;;
    paper) set -- "$1" "$2" "$3" --layout paper ;;
    esac
    scene=$1 spp=$2 name=$3
    shift 3
    # shellcheck disable=SC2046
    retex-render -q --size "$size" --spp "$spp" --seed 1 $(target_flags "$scene") "$@" "$(scene_file "$scene")" \
        -o "$work/sets/$scene-$spp-$name.exr"
}

retextured() { # SCENE SPP METHOD TEXTURE…
    scene=$1 spp=$2 method=$3
    shift 3
    for last; do :; done
    [ ! -e "$work/retextured/$scene-$last-$spp-$method.exr" ] || return 0
    batch "$scene" "$work/retextured/" "-$spp-$method" "$@" >"$work/batch.csv"
    case $method in
    paper-cross-*) retex-combine -q --cross "${method##*-}" "$work/sets/$scene-$spp-paper.exr" --batch "$work/batch.csv" ;;
    *) retex-combine -q "$work/sets/$scene-$spp-$method.exr" --batch "$work/batch.csv" ;;
    esac
}

score() { # SCENE TEXTURE SPP METHOD FILE
    # shellcheck disable=SC2020 # characters wanted
    retex-diff --json "$work/truth/$1-$2.exr" "$5" | tr ',{}' '\n\n\n' |
        awk -F: -v s="$1" -v t="$2" -v n="$3" -v m="$4" '
            $1 ~ /"psnr"/ { printf "%s,%s,%s,%s,%.2f\n", s, t, n, m, $2; found = 1 }
            END { exit !found }'
}

run() { # SCENE TEXTURE…: everything about some textures in a scene
    place=$1
    shift
    rendered "$place" "$work/truth" '' "$truth_spp" 1000 "$@"
    for count in $samples; do
        rendered "$place" "$work/again" "-$count" "$count" 1 "$@"
        for name in $sets; do make_set "$place" "$count" "$name"; done
        for name in $methods; do retextured "$place" "$count" "$name" "$@"; done
        for picture; do
            score "$place" "$picture" "$count" again "$work/again/$place-$picture-$count.exr"
            for name in $methods; do
                score "$place" "$picture" "$count" "$name" "$work/retextured/$place-$picture-$count-$name.exr"
            done
        done
    done
}

table=$work/fidelity.csv
{
    echo 'scene,texture,samples,method,psnr'
    for each in $scenes; do
        echo "fidelity: $each" >&2
        # shellcheck disable=SC2086
        run "$each" $textures
        case " $turned_scenes " in
        *" $each "*)
            # shellcheck disable=SC2086
            run "$each" $turned
            ;;
        esac
    done
} >"$table.new"
mv "$table.new" "$table"
if [ -z "${FIDELITY_SCENES:-}${FIDELITY_SPP:-}${FIDELITY_SIZE:-}${FIDELITY_TRUTH_SPP:-}" ]; then
    cp "$table" docs/fidelity.csv
    awk -f "$here/table/report.awk" -v size="$size" -v truth="$truth_spp" "$table" >docs/fidelity.md
fi
