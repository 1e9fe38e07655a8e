#!/bin/sh
# The three-stage pipe on a scene of POV-Ray's own, as Debian's povray-examples has it: radiosity/cornell.pov, whose
# white surfaces are the target.
#
# It is a hard case for a limited number of hits: a box, nearly all of it target, originally of albedo 1 (diffuse 0.75),
# so that 0.7% of the light met it more than 6 times and keeps the original's albedo from the seventh hit on. The
# bound is therefore 55 dB, not exactness: colours between black and white have 60 or more, white itself 86, near-black 94.
set -u
. tests/lib/tap.sh
scene=/usr/share/povray-3.7/scenes/radiosity/cornell.pov
if [ ! -e "$scene" ]; then
    skip "cornell.pov of povray-examples" "Debian's povray-examples is not installed"
    finish
    exit
fi
render() { retex-render -q --size 100x100 --spp 32 --seed 3 "$@" "$scene"; }

for color in 0.01,0.01,0.01 1,1,1 0.8,0.6,0.4 0.8,0.02,0.02 0.9,0.9,0.9; do
    render -t White -o - | retex-sample -q - --texture "White=rgb($color)" -o - |
        retex-combine -q - -o "$work/retextured.exr"
    render --plain --replace "White=rgb($color)" -o "$work/truth.exr"
    same "$work/retextured.exr" "$work/truth.exr" 55 "White as $color"
done
finish
