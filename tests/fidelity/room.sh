#!/bin/sh
# Saturated constants on several targets of tests/golden/room.pov, in both layouts, against --replace at the same seed.
# Every term of the polynomial has a colour of its own, so a factor at the wrong hit, or of the wrong target, is far off.
# At least 50 dB; where eight targets are all that light meets, much of it has more hits than sets keep apart, and these
# take mixtures of textures: measured 34.2 dB and, in layout paper, 42.2 dB.
set -u
. tests/lib/tap.sh
room=$here/tests/golden/room.pov

# check NAME DECIBELS DECIBELS OPTIONS TARGET=COLOUR…: at least so many in layout footprints and in layout paper. A+B is
# one target of both.
check() {
    name=$1 footprints=$2 paper=$3 options=$4
    shift 4
    targets= textures= replacements=
    for each; do
        target=$(echo "${each%%=*}" | tr -d +)
        targets="$targets -t $target=$(echo "${each%%=*}" | tr + ,)"
        textures="$textures --texture $target=rgb(${each#*=})"
        for ident in $(echo "${each%%=*}" | tr + ' '); do
            replacements="$replacements --replace $ident=rgb(${each#*=})"
        done
    done
    # shellcheck disable=SC2086 # words wanted
    retex-render -q --threads 2 --plain --size 48x48 --spp 32 $options $replacements "$room" -o "$work/truth.exr"
    for layout in footprints paper; do
        # shellcheck disable=SC2086
        retex-render -q --threads 2 --size 48x48 --spp 32 --layout $layout $options $targets "$room" -o "$work/set.exr"
        # shellcheck disable=SC2086
        retex-combine -q "$work/set.exr" $textures -o "$work/retextured.exr"
        least=$footprints
        [ $layout = footprints ] || least=$paper
        found=$(figure "$work/retextured.exr" "$work/truth.exr" psnr)
        echo "# $name, $layout: $found dB"
        result "$(at_least "${found:-0}" "$least")" "$name, $layout: at least $least dB"
    done
}

red=0.9,0.1,0.05 cyan=0.1,0.8,0.9 yellow=0.9,0.8,0.05 blue=0.1,0.15,0.9 green=0.2,0.9,0.2 violet=0.8,0.1,0.8
check "glossy floor" 50 50 "-D Gloss=0.25" Floor=$red
check "half metal" 50 50 "-D Gloss=0.25 -D Metal=0.5" Floor=$red Ball=$cyan
check "one target of all that is glossy or metal" 50 50 "-D Gloss=0.3 -D Metal=0.5" Floor+Ceiling+Ball+Block=$red
check "facing targets" 50 50 "" Floor=$red Ceiling=$cyan
check "glass, a mirror and three lights" 50 50 "-D Glass=1 -D Lamps=1" Floor=$red Back=$cyan
check "eight targets" 33.5 41.5 "-D Lamps=1 -D Metal=0.5" Floor=$red Ceiling=$cyan Left=$yellow Right=$blue Back=$green \
    Ball=$violet Block=$yellow Lid=$cyan
finish
