#!/bin/sh
# Scenes that other programs wrote: each is read, has the silhouette and about the colours that POV-Ray gives it, has at
# least three targets, though most declare nothing, and a retexture of the largest of them is what rendering again gives.
set -u
. tests/lib/tap.sh
# Of openbabel and polymake, whose scenes include files of theirs.
includes="/usr/share/openbabel/3.1.1 /usr/share/polymake/resources/povray"
options="" libraries=""
for folder in $includes; do
    [ ! -d "$folder" ] || { options="$options -I $folder" libraries="$libraries +L$folder"; }
done

mkdir "${work:?}/aovs"

# silhouettes SCENE: the share of pixels where one picture shows an object and the other does not.
silhouettes() {
    # shellcheck disable=SC2086 # words wanted
    retex-render -q --plain --size 160x120 --spp 1 --aov object --aov-dir "$work/aovs" $options "$1" -o "$work/o.exr" \
        2>"$work/log" || return
    # Alpha of a background of five components is 1.
    sed '/^background *{.*}/d' "$1" >"$work/scene.pov"
    # shellcheck disable=SC2086
    nice povray "$work/scene.pov" +W160 +H120 -D -A +UA +FN $libraries +O"$work/p.png" >"$work/povray.log" 2>&1 || return
    oiiotool "$work/aovs/object.exr" --ch 0 --clamp:min=0:max=1 "$work/p.png" --ch A --absdiff -o "$work/d.exr" &&
        oiiotool --stats "$work/d.exr" | sed -n 's/.*Stats Avg: \([0-9.e-]*\).*/\1/p'
}

# colors SCENE: the mean difference of the shaded colours, encoded as sRGB, from POV-Ray's, in pixels that show nothing but
# objects in the picture of silhouettes.
colors() {
    # shellcheck disable=SC2086
    {
        retex-render -q --plain --size 160x120 --spp 16 $options "$1" -o "$work/ours.png" 2>/dev/null
        nice povray "$1" +W160 +H120 -D +A0.1 $libraries +O"$work/theirs.png" >"$work/povray.log" 2>&1
    } || return
    oiiotool "$work/p.png" --ch A,A,A --erode 3x3 --dup -o "$work/mask.exr" "$work/ours.png" --ch R,G,B \
        "$work/theirs.png" --ch R,G,B --absdiff --mul -o "$work/d.exr"
    for file in d mask; do
        oiiotool --stats "$work/$file.exr" | sed -n 's/.*Stats Avg: //p'
    done | awk '{ sum[NR] = $1 + $2 + $3 } END { if (sum[2] > 0) printf "%.3f\n", sum[1] / sum[2] }'
}

for scene in tests/data/exporters/*.pov "${RETEX_SHARED:-../shared}"/pov/exporters/*.pov; do
    name=$(basename "$(dirname "$(dirname "$scene")")")/$(basename "$scene" .pov)
    if [ ! -f "$scene" ]; then
        skip "scenes beside the repository" "${scene%/*} is not there"
        continue
    fi
    needs=$(sed -n 's/^#include "\(.*\)"/\1/p' "$scene" | while read -r file; do
        found=
        for folder in /usr/share/povray*/include $includes; do
            case $file in
            /*) [ ! -f "$file" ] || found=1 ;;
            *) [ ! -f "$folder/$file" ] || found=1 ;;
            esac
        done
        [ -n "$found" ] || echo "$file"
    done)
    if [ -n "$needs" ] || ! command -v povray >/dev/null; then
        skip "$name" "${needs:-povray} is not on this machine"
        continue
    fi
    differ=$(silhouettes "$scene")
    [ -n "$differ" ] || grep -h -i -A 3 error "$work/log" "$work/povray.log" | sed 's/^/# /'
    echo "# $name: silhouettes differ in ${differ:-all} of the pixels"
    result "$(at_most "${differ:-1}" 0.01)" "$name is read, and shows what POV-Ray shows"
    # Without assumed_gamma POV-Ray adds up light in the numbers of the display, and much of it is brighter there.
    most=0.1
    case $name in */jmol | */bare) most=0.16 ;; esac
    differ=$(colors "$scene")
    echo "# $name: colours differ by ${differ:-all}"
    result "$(at_most "${differ:-1}" $most)" "$name has about POV-Ray's colours"
    # shellcheck disable=SC2086
    retex-render -v --list-targets --size 160x120 $options "$scene" 2>/dev/null |
        awk '{ print $2 }' >"$work/targets"
    result "$(at_least "$(wc -l <"$work/targets")" 3)" "$name has targets"
    target=$(grep '^[#~*]' "$work/targets" | head -1)
    # shellcheck disable=SC2086
    {
        retex-render -q --size 64x48 --spp 32 $options -t "A=$target" "$scene" -o "$work/set.exr"
        retex-render -q --size 64x48 --spp 32 $options -t "A=$target" --replace 'A=rgb(.2,.6,.3)' "$scene" \
            -o "$work/again.exr"
        retex-combine -q "$work/set.exr" --texture 'A=rgb(.2,.6,.3)' -o "$work/new.exr"
    } 2>&1 | grep -v warning: | sed 's/^/# /'
    same "$work/new.exr" "$work/again.exr" 50 "$name: $target retextured"
done
finish
