#!/bin/sh
# How much denoising a set gains: retextures of sets as rendered and denoised, against the scene rendered again, with
# four times as many samples too, and rendered again and denoised by the same filter, its fair rival.
#
#   make fidelity-denoise    into $BUILD/fidelity; with BENCH_DOCS=1 page, figures and pictures go to docs/ and
#                            docs/pictures/ too
#
# Seven scenes times eight textures: the pictures, sets and truths of run.sh, and more. Sets of layout footprints at 128
# samples have seeds 1, 2 and so on; all else, and 1024 samples and layout paper, has one. The figures are PSNR of the whole
# picture and of its regions (regions.py), and FLIP. What is in $BUILD/fidelity from an earlier run counts, and is not
# made twice. DENOISE_FRESH=1 makes anew what the filter has touched.
#
# FIDELITY_SCENES, FIDELITY_PART, FIDELITY_TRUTH_SPP and DENOISE_SEEDS choose less, or more. DENOISE_FLAGS are options of
# retex-denoise for sets, to try them out; the rival does not have them.
set -eu
. tests/fidelity/table/lib.sh
scenes=${FIDELITY_SCENES:-$all_scenes} seeds=${DENOISE_SEEDS:-1 2 3 4 5}
few=128 more=512 many=1024 # samples: of what is compared, four times as many, and where there is little noise
guide_spp=256              # of the light that regions are found from
parts_of_pictures fidelity-denoise
mkdir -p "$work/guides" "$work/scores"
if [ -n "${DENOISE_FRESH:-}" ]; then
    for scene in $scenes; do
        rm -f "$work/sets/$scene"-*denoised*.exr "$work/retextured/$scene"-*denoised*.exr \
            "$work/again/$scene"-*-rival.exr
    done
fi

# What regions are found from: the first hits and, with grey targets, all light that arrives there and the direct.
guides() { # SCENE
    [ ! -e "$work/guides/$1.exr" ] || return 0
    scene=$1
    set --
    for target in $(targets_of "$scene"); do set -- "$@" --replace "$target=rgb(.5,.5,.5)"; done
    # shellcheck disable=SC2046 # words wanted
    retex-render -q --plain $(view "$scene") --spp "$guide_spp" --seed 2000 --max-depth 2 --aov irradiance "$@" \
        "$(scene_file "$scene")" -o "$work/guides/$scene-direct.exr"
    # shellcheck disable=SC2046
    retex-render -q --plain $(view "$scene") --spp "$guide_spp" --seed 2000 \
        --aov irradiance,normal,position,depth,object,roughness "$@" \
        "$(scene_file "$scene")" -o "$work/guides/$scene.exr"
}

# Rendered again with one texture, and denoised.
rival() { # SCENE SPP TEXTURE
    result=$work/again/$1-$3-$2-rival.exr
    [ ! -e "$result" ] || return 0
    scene=$1 spp=$2 texture=$3 number=0
    set --
    for target in $(targets_of "$scene"); do
        number=$((number + 1))
        set -- "$@" --replace "$target=$(cell "$texture" $number)"
    done
    # shellcheck disable=SC2046
    retex-render -q --plain --denoise $(view "$scene") --spp "$spp" --seed 1 "$@" "$(scene_file "$scene")" -o "$result"
}

denoised_set() { # SCENE SPP FROM TO
    [ ! -e "$work/sets/$1-$2-$4.exr" ] || return 0
    # shellcheck disable=SC2086 # words wanted
    retex-denoise -q ${DENOISE_FLAGS:-} "$work/sets/$1-$2-$3.exr" -o "$work/sets/$1-$2-$4.exr"
}

# What to score, a line each: method, samples, seed, and what its files' names have after scene and texture.
scored() { # SCENE SPP METHOD SEED SET-NAME
    # shellcheck disable=SC2086
    retextured "$1" "$2" "$5" $textures
    echo "$3 $2 $4 retextured -$2-$5"
}

run() { # SCENE
    place=$1
    # shellcheck disable=SC2086
    {
        guides "$place"
        truths "$place" "$truth_spp" $textures
        rendered "$place" "$work/again" "-$few" "$few" 1 $textures
        rendered "$place" "$work/again" "-$more" "$more" 1 $textures
        for picture in $textures; do rival "$place" "$few" "$picture"; done
    } >&2
    for count in $few $many; do
        for number_of_seed in $seeds; do
            [ "$count" = "$few" ] || [ "$number_of_seed" = "${seeds%% *}" ] || continue
            of_seed=-seed$number_of_seed
            [ "$number_of_seed" != 1 ] || of_seed=''
            make_set "$place" "$count" "footprints$of_seed"
            denoised_set "$place" "$count" "footprints$of_seed" "denoised$of_seed"
            scored "$place" "$count" set "$number_of_seed" "footprints$of_seed"
            scored "$place" "$count" denoised "$number_of_seed" "denoised$of_seed"
        done
    done
    make_set "$place" "$few" paper
    denoised_set "$place" "$few" paper paper-denoised
    scored "$place" "$few" paper 1 paper
    scored "$place" "$few" paper-denoised 1 paper-denoised
    echo "again $few 1 again -$few"
    echo "again $more 1 again -$more"
    echo "rival $few 1 again -$few-rival"
}

tables=
for each in $scenes; do
    echo "fidelity-denoise: $each" >&2
    run "$each" >"$work/scores/$each.list"
    # shellcheck disable=SC2086
    "$python" "$here/table/score.py" "$work" "$each" $textures <"$work/scores/$each.list" >"$work/scores/$each.new"
    mv "$work/scores/$each.new" "$work/scores/$each.csv"
    tables="$tables $work/scores/$each.csv"
done
# shellcheck disable=SC2086
awk 'NR == 1 || FNR > 1' $tables >"$work/denoise.csv"
"$python" "$here/table/denoise-report.py" "$work" "$(figures_head fidelity-denoise)" "$part" "$truth_spp" \
    "$here/table/denoise-notes.md" "$here/table/denoise-tried.md" \
    >"$work/denoise.new"
mv "$work/denoise.new" "$work/denoise.md"
if [ "${BENCH_DOCS:-}" = 1 ]; then
    mkdir -p docs/pictures
    cp "$work/denoise.csv" "$work/denoise.md" docs/
    cp "$work"/pictures/denoise-*.jpg docs/pictures/
fi
