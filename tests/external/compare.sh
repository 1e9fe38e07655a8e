#!/bin/sh
# How well another method retextures our scenes: make compare-external DIR=FOLDER.
#
# FOLDER holds pictures SCENE-TEXTURE.png (.jpg, .tif, .exr) that it made. Each is compared with the truth of that name
# in $FIDELITY/truth, beside our own retexture in $FIDELITY/retextured, all clipped to 0..1 as a PNG is. Prints a table;
# writes it to $OUT/scores.csv, and to $OUT/SCENE-TEXTURE.png what is seen: theirs, ours, the truth; below, how theirs
# and ours differ from it, in the sum of the three channels twice over.
#
# FIDELITY and OUT are fidelity and external in $BUILD unless they are set. Ours is SCENE-TEXTURE.exr or, as make
# fidelity names it, SCENE-TEXTURE-$OURS.exr, where OURS is 1024-footprints unless it is set. Exit 2 where there is
# nothing to compare.
set -u
export LC_ALL=C
BUILD=${BUILD:-build}
case $BUILD in /*) ;; *) BUILD=$(pwd)/$BUILD ;; esac
PATH=$BUILD/bin:$PATH
fidelity=${FIDELITY:-$BUILD/fidelity} out=${OUT:-$BUILD/external}
fail() { echo "compare-external: $*" >&2; exit 2; }

[ $# = 1 ] && [ -n "$1" ] || fail "which folder? make compare-external DIR=FOLDER"
[ -d "$1" ] || fail "$1 is no folder"
ls "$fidelity"/truth/*.exr >/dev/null 2>&1 ||
    fail "there are no truths in $fidelity/truth: \`make fidelity\` makes them"
command -v oiiotool >/dev/null || fail "it needs oiiotool (openimageio-tools)"
mkdir -p "$out" || exit 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# PSNR, FLIP and mean absolute error of a picture against the truth, or nothing where its size is another.
scores() { # PICTURE TRUTH
    clipped "$1" "$work/scored.exr"
    retex-diff --json "$work/scored.exr" "$2" 2>/dev/null | tr ',{}' '\n\n\n' | awk -F': *' '
        { gsub(/["\t ]/, "", $1); value[$1] = $2 }
        END { if (value["psnr"] ~ /[0-9]/) print value["psnr"], value["flip_mean"], value["mae"] }'
}

# Scene-linear, what is brighter than a PNG can be clipped as it is there.
clipped() { # PICTURE EXR
    case $1 in
    *.exr) oiiotool "$1" --ch R,G,B --clamp:min=0:max=1 -d float -o "$2" ;;
    *) oiiotool "$1" --ch 0,1,2 --chnames R,G,B --colorconvert sRGB linear -d float -o "$2" ;;
    esac
}

# As it is seen: 8 bits, sRGB.
shown() { # PICTURE PNG
    case $1 in
    *.exr) oiiotool "$1" --ch R,G,B --colorconvert linear sRGB --clamp:min=0:max=1 -d uint8 -o "$2" ;;
    *) oiiotool "$1" --ch 0,1,2 -d uint8 -o "$2" ;;
    esac
}

difference() { # PNG TRUTH PNG
    oiiotool "$1" "$2" --absdiff --chsum:weight=1,1,1 --mulc 2 --clamp:min=0:max=1 --colormap magma -d uint8 -o "$3"
}

sheet() { # NAME THEIRS OURS TRUTH
    shown "$2" "$work/theirs.png" && shown "$4" "$work/truth.png" &&
        difference "$work/theirs.png" "$work/truth.png" "$work/theirs-off.png" || return
    if [ -e "$3" ]; then
        shown "$3" "$work/ours.png" && difference "$work/ours.png" "$work/truth.png" "$work/ours-off.png" || return
    else
        oiiotool "$work/truth.png" --mulc 0 -d uint8 -o "$work/ours.png" && cp "$work/ours.png" "$work/ours-off.png"
    fi
    oiiotool "$work/truth.png" --mulc 0 -d uint8 -o "$work/nothing.png"
    oiiotool "$work/theirs.png" "$work/ours.png" "$work/truth.png" "$work/theirs-off.png" "$work/ours-off.png" \
        "$work/nothing.png" --mosaic:pad=4 3x2 -d uint8 -o "$out/$1.png"
}

: >"$work/rows"
for picture in "$1"/*.png "$1"/*.jpg "$1"/*.tif "$1"/*.exr; do
    [ -e "$picture" ] || continue
    name=$(basename "$picture")
    name=${name%.*}
    truth=$fidelity/truth/$name.exr ours=$fidelity/retextured/$name.exr
    [ -e "$ours" ] || ours=$fidelity/retextured/$name-${OURS:-1024-footprints}.exr
    if [ ! -e "$truth" ]; then
        echo "compare-external: $picture: there is no $truth" >&2
        continue
    fi
    clipped "$truth" "$work/truth.exr"
    theirs=$(scores "$picture" "$work/truth.exr") our=
    if [ -z "$theirs" ]; then
        echo "compare-external: $picture: cannot be compared with $truth:" \
            "$(retex-diff "$picture" "$truth" 2>&1 | head -n 1)" >&2
        continue
    fi
    [ ! -e "$ours" ] || our=$(scores "$ours" "$work/truth.exr")
    echo "$name $theirs ${our:-- - -}" >>"$work/rows"
    sheet "$name" "$picture" "$ours" "$truth"
done
[ -s "$work/rows" ] || fail "$1 has no picture SCENE-TEXTURE.png with a truth in $fidelity/truth"

awk 'BEGIN { print "picture,psnr,flip,mae,our_psnr,our_flip,our_mae" }
    { line = $1; for (k = 2; k <= 7; k++) line = line "," ($k == "-" ? "" : $k); print line }' \
    "$work/rows" >"$out/scores.csv"
awk '
    function cell(text, format) { return text == "-" ? sprintf("%8s", "-") : sprintf(format, text) }
    function row(name, v) {
        printf "%-32s %s %s %s   %s %s %s\n", name, cell(v[1], "%8.2f"), cell(v[2], "%8.4f"), cell(v[3], "%8.4f"),
            cell(v[4], "%8.2f"), cell(v[5], "%8.4f"), cell(v[6], "%8.4f")
    }
    BEGIN {
        printf "%-32s %26s   %26s\n", "", "theirs                  ", "ours                    "
        printf "%-32s %8s %8s %8s   %8s %8s %8s\n", "", "PSNR", "FLIP", "MAE", "PSNR", "FLIP", "MAE"
    }
    {
        for (k = 1; k <= 6; k++) v[k] = $(k + 1)
        row($1, v)
        both = v[4] != "-"
        count[both]++
        for (k = 1; k <= 6; k++) sum[both, k] += v[k]
    }
    END {
        both = count[1] > 0 # the mean is of what can be compared
        for (k = 1; k <= 6; k++) v[k] = both || k < 4 ? sum[both, k] / count[both] : "-"
        row(both && count[0] ? "mean of those with both" : "mean", v)
    }' "$work/rows"
echo "sheets: $out"
