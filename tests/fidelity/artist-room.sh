#!/bin/sh
# A scene that was not made for this project: a furnished room of meshes, an artist's, in scenes/living-room-bitterli of
# $RETEX_SHARED or ../shared; it is not in the repository, and this test is skipped where it is absent.
#
# - it stands the right way round and is as bright as in POV-Ray: mean radiance, clipped to 0..1, of four regions of
#   `povray scene.pov +W320 +H180 Declare=Radiosity=1` (3.7.0.10), within 20%, for radiosity is an estimate too;
# - retextured with constants, one target or all, the picture is --replace's at the same seed, to 60 dB and relMSE 1e-5;
#   the set keeps all bits, for others are rounded to a fraction of their noise, which at 16 samples is large.
set -u
. tests/lib/tap.sh
scene=${RETEX_SHARED:-../shared}/scenes/living-room-bitterli/scene.pov
if [ ! -e "$scene" ]; then
    skip "the artist's room" "there is no $scene"
    finish
    exit
fi
render() { retex-render -q --threads 2 "$@"; }

# x0-x1,y0-y1 of 320x180, then red, green, blue.
regions='
wall    225-255,70-100  0.1515 0.1237 0.0845
ceiling 120-220,5-25    0.2397 0.1683 0.1201
floor   30-80,140-170   0.1184 0.0497 0.0201
sofa    265-315,125-150 0.1478 0.0858 0.0421'

mean() { # FILE WIDTH HEIGHT
    pixels=$(awk -v w="$2" -v h="$3" 'BEGIN { for (; y < h; y++) for (x = 0; x < w; x++) print x "," y + 0 }')
    # shellcheck disable=SC2086 # words wanted
    make_values "$1" $pixels |
        awk '{ for (c = 1; c <= 3; c++) sum[c] += $c < 0 ? 0 : $c > 1 ? 1 : $c }
            END { if (NR) print sum[1] / NR, sum[2] / NR, sum[3] / NR; else print 0, 0, 0 }'
}
echo "$regions" | sed 1d >"$work/regions"
while read -r name place red green blue; do
    # shellcheck disable=SC2046
    set -- $(echo "$place" | tr ',-' '  ')
    width=$(($2 - $1)) height=$(($4 - $3))
    render --size 320x180 --spp 64 --crop "$1,$3,$width,$height" "$scene" -o "$work/region.exr"
    found=$(mean "$work/region.exr" $width $height)
    echo "# $name: $found, in POV-Ray $red $green $blue"
    near=$(echo "$found $red $green $blue" | awk '{
        for (c = 1; c <= 3; c++) near += $c > 0.8 * $(c + 3) && $c < 1.2 * $(c + 3)
        print near == 3 }')
    result "$near" "the $name is as bright as in POV-Ray"
done <"$work/regions"

small() { render --size 96x54 --spp 16 --seed 3 "$@"; }
targets='Floor Painting TableWood'
small --full-precision -t Floor -t Painting -t TableWood "$scene" -o "$work/set.exr"
for choice in $targets all; do
    case $choice in all) colors='near-black=0.01,0.01,0.01 white=1,1,1 red=0.8,0.02,0.02' ;; *) colors=white=1,1,1 ;; esac
    for color in $colors; do
        textures= replacements=
        for target in $targets; do
            case $choice in all | "$target") ;; *) continue ;; esac
            value="$target=rgb(${color#*=})"
            textures="$textures --texture $value" replacements="$replacements --replace $value"
        done
        # shellcheck disable=SC2086 # words wanted
        retex-combine -q "$work/set.exr" $textures -o "$work/retextured.exr"
        # shellcheck disable=SC2086
        small --plain $replacements "$scene" -o "$work/truth.exr"
        same "$work/retextured.exr" "$work/truth.exr" 60 "$choice ${color%%=*}" 1e-5
    done
done
finish
