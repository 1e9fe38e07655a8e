#!/bin/sh
# How much denoising a set gains: retextures of sets as rendered and denoised, against the scene rendered again, with
# four times as many samples too, and rendered again and denoised by the same filter, its fair rival.
#
#   make fidelity-denoise    some hours on two cores, into $BUILD/fidelity-denoise; with BENCH_DOCS=1 page, figures and
#                            pictures go to docs/ and docs/pictures/ too
#
# Seven scenes times eight textures, as in run.sh, but what denoising can do depends on how many pixels an edge or a
# shadow has: so these are parts, 144x112 pixels, of pictures of 512x384. Sets of layout footprints at 128 samples have
# five seeds; all else, and 1024 samples and layout paper, has one. The figures are PSNR of the whole picture and of its regions
# (regions.py), and FLIP. Everything is kept in $BUILD/fidelity-denoise and not made twice: what is there from an
# earlier run, or was copied there, counts. DENOISE_FRESH=1 makes anew what the filter has touched.
#
# DENOISE_SCENES, DENOISE_SIZE (of whole pictures), DENOISE_TRUTH_SPP and DENOISE_SEEDS choose less, or more.
# DENOISE_FLAGS are options of retex-denoise for sets, to try them out; the rival does not have them.
set -eu
. tests/fidelity/table/lib.sh
size=${DENOISE_SIZE:-512x384} truth_spp=${DENOISE_TRUTH_SPP:-4096} seeds=${DENOISE_SEEDS:-1 2 3 4 5}
scenes=${DENOISE_SCENES:-$all_scenes}
few=128 more=512 many=1024 # samples: of what is compared, four times as many, and where there is little noise
guide_spp=256              # of the light that regions are found from
work=$build/fidelity-denoise
figures_python fidelity-denoise
# The part of a scene's picture.
view() {
    echo "--size $size"
    [ -z "${DENOISE_SIZE:-}" ] || return 0
    case $1 in
    glass-caustics) echo '--crop 120,160,144,112' ;; # ball, caustic, brass, mirror
    kitchen) echo '--crop 120,200,144,112' ;;        # cabinets, island, sun on the floor
    globe) echo '--crop 230,130,144,112' ;;          # globe, rings, mirror, steel ball
    glossy-pair) echo '--crop 190,190,144,112' ;;    # both panels, ball
    horizon) echo '--crop 200,170,144,112' ;;        # cone, mirror ball, shadow
    *) echo '--crop 160,160,144,112' ;;              # boxes and shadow; sofa, table with glass, rug
    esac
}

mkdir -p "$work/truth" "$work/guides" "$work/again" "$work/sets" "$work/retextured" "$work/scores"

settings="$size $truth_spp"
figures_settings fidelity-denoise "$work" "$settings"
if [ -n "${DENOISE_FRESH:-}" ]; then
    for scene in $scenes; do
        rm -f "$work/sets/$scene"-*denoised-seed*.exr "$work/retextured/$scene"-*denoised-seed*.exr \
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
        truth "$place" "$truth_spp" $textures
        rendered "$place" "$work/again" "-$few" "$few" 1 $textures
        rendered "$place" "$work/again" "-$more" "$more" 1 $textures
        for picture in $textures; do rival "$place" "$few" "$picture"; done
    } >&2
    echo "again $few 1 again -$few"
    echo "again $more 1 again -$more"
    echo "rival $few 1 again -$few-rival"
    for count in $few $many; do
        for number_of_seed in $seeds; do
            [ "$count" = "$few" ] || [ "$number_of_seed" = "${seeds%% *}" ] || continue
            make_set "$place" "$count" "footprints-seed$number_of_seed"
            denoised_set "$place" "$count" "footprints-seed$number_of_seed" "denoised-seed$number_of_seed"
            scored "$place" "$count" set "$number_of_seed" "footprints-seed$number_of_seed"
            scored "$place" "$count" denoised "$number_of_seed" "denoised-seed$number_of_seed"
        done
    done
    make_set "$place" "$few" paper-seed1
    denoised_set "$place" "$few" paper-seed1 paper-denoised-seed1
    scored "$place" "$few" paper 1 paper-seed1
    scored "$place" "$few" paper-denoised 1 paper-denoised-seed1
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
shown="parts of 144x112 pixels of pictures of $size"
[ -z "${DENOISE_SIZE:-}" ] || shown="$size pixels"
"$python" "$here/table/denoise-report.py" "$work" "$(figures_head fidelity-denoise)" "$shown" "$truth_spp" \
    "$here/table/denoise-notes.md" "$here/table/denoise-tried.md" \
    >"$work/denoise.new"
mv "$work/denoise.new" "$work/denoise.md"
if [ "${BENCH_DOCS:-}" = 1 ]; then
    mkdir -p docs/pictures
    cp "$work/denoise.csv" "$work/denoise.md" docs/
    cp "$work"/pictures/denoise-*.jpg docs/pictures/
fi
