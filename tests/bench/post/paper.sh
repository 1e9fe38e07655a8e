#!/bin/sh
# Sizes of what is stored, in the paper's own form and in ours, as in its tables 4 and 5: make bench-paper. Prints a page,
# which is also $BUILD/bench/paper-sizes.md, with its figures in paper-sizes.csv and a picture in paper-jpeg.jpg; with
# BENCH_DOCS=1 they go to docs/ and docs/pictures/ too.
#
# The paper's form is the 33 AOVs of `--layout paper --strict-paper --no-denoise-data`, in EXR with zip; and the same with
# each radiance image as a JPEG. What the JPEGs lose is the difference of retextured pictures from those of the EXR file.
# Sets are kept in $BUILD/bench/paper. BENCH_SIZE (1920x1080), BENCH_SPP (128), BENCH_SCENES and BENCH_QUALITIES (of JPEG)
# choose less. As it stands it takes some three hours on two cores.
set -eu
bench='bench-paper'
. tests/bench/post/lib.sh
work=$out/paper
size=${BENCH_SIZE:-1920x1080} spp=${BENCH_SPP:-128} qualities=${BENCH_QUALITIES:-75 90 98}
scenes=${BENCH_SCENES:-living-room artist kitchen cornell-box glass-caustics}
records=$work/runs shown=living-room
mkdir -p "$work"
if ! "$python" -c 'import numpy, OpenImageIO' 2>/dev/null; then
    echo "$bench: $python needs numpy and OpenImageIO (python3-numpy, python3-openimageio)" >&2
    exit 2
fi
: >"$records"

targets_of() { # SCENE EDIT, or nothing
    case $1-$2 in
    *-one) echo Floor ;;
    living-room-two | kitchen-two) echo Floor Wall ;;
    artist-two) echo Floor Painting ;;
    esac
}
rendered() { # FILE OPTION...: once
    file=$1
    shift
    [ -e "$file" ] || retex-render -q --size "$size" --spp "$spp" "$@" "$(scene_file "$scene")" -o "$file"
}
record() { # WHAT PSNR: with the sizes in $work/sizes.json
    printf '{"scene": "%s", "targets": "%s", "what": "%s", "psnr": %s, "stored": %s}\n' "$scene" "$targets" "$1" "$2" \
        "$(cat "$work/sizes.json")" >>"$records"
    echo "$bench: $scene, $targets: $1" >&2
}
psnr() { # A B
    # shellcheck disable=SC2020 # characters wanted
    { retex-diff --json "$1" "$2" || [ $? = 1 ]; } | tr ',{}' '\n\n\n' | awk -F: '$1 ~ /"psnr"/ { print $2 }'
}
retextured() { # SET PICTURE
    # shellcheck disable=SC2046,SC2086 # words wanted
    retex-combine -q "$1" $(texture_options --texture $targets) -o "$2"
}
stored() { # WHAT FILE [SET]: of the parts of the set, where the file can no longer be read as one
    "$python" $here/stored.py "$2" "${3:-$2}" >"$work/sizes.json"
    record "$1" null
}

for scene in $scenes; do
    scene_is_there "$scene" || continue
    for edit in one two; do
        targets=$(targets_of "$scene" $edit)
        [ -n "$targets" ] || continue
        chosen=$(for t in $targets; do printf ' -t %s' "$t"; done)
        name=$work/$scene-$edit-$size-$spp
        # shellcheck disable=SC2086
        rendered "$name-strict.exr" $chosen --layout paper --strict-paper --no-denoise-data
        stored strict "$name-strict.exr"
        oiiotool --nosoftwareattrib -a "$name-strict.exr" -d half --compression zip -o "$work/half.exr"
        stored strict-half "$work/half.exr" "$name-strict.exr"
        rm "$work/half.exr"
        retextured "$name-strict.exr" "$work/exr.exr"
        for quality in $qualities; do
            "$python" $here/coded.py "$name-strict.exr" "$work/coded.exr" jpeg "$quality" >"$work/sizes.json"
            retextured "$work/coded.exr" "$work/jpeg.exr"
            record "jpeg-$quality" "$(psnr "$work/exr.exr" "$work/jpeg.exr")"
            if [ "$scene-$edit-$quality" = $shown-one-90 ]; then
                cp "$work/exr.exr" "$work/shown-exr.exr"
                cp "$work/jpeg.exr" "$work/shown-jpeg.exr"
            fi
        done
        # shellcheck disable=SC2086
        rendered "$name-set.exr" $chosen
        stored set "$name-set.exr"
        retex-pack -q "$name-set.exr" -o "$work/made.retex"
        stored pack "$work/made.retex"
        retextured "$name-set.exr" "$work/exr.exr"
        retextured "$work/made.retex" "$work/pack.exr"
        record pack-loss "$(psnr "$work/exr.exr" "$work/pack.exr")"
        [ -e "$name-denoised.exr" ] || retex-denoise -q "$name-set.exr" -o "$name-denoised.exr"
        stored denoised "$name-denoised.exr"
        retex-pack -q "$name-denoised.exr" -o "$work/made.retex"
        stored denoised-pack "$work/made.retex"
        rm -f "$work/made.retex" "$work/coded.exr"
    done
    targets=none
    for mode in biased unbiased; do
        rendered "$work/$scene-$mode-$size-$spp.exr" --plain --control-data $mode
        printf '{"bytes": %s, "uses": {}}\n' "$(stat -c %s "$work/$scene-$mode-$size-$spp.exr")" >"$work/sizes.json"
        record "control-$mode" null
    done
done
"$python" $here/paper_page.py "$records" "$out/paper-sizes.csv" "$(figures_head bench-paper)" "$size" "$spp" |
    tee "$out/paper-sizes.md"
is_shown=
if [ -e "$work/shown-exr.exr" ]; then
    is_shown=1
    "$python" $here/paper_jpeg.py "$work/shown-exr.exr" "$work/shown-jpeg.exr" "$out/paper-jpeg.jpg"
fi
if [ "${BENCH_DOCS:-}" = 1 ]; then
    cp "$out/paper-sizes.csv" "$out/paper-sizes.md" docs/
    [ -z "$is_shown" ] || cp "$out/paper-jpeg.jpg" docs/pictures/
fi
