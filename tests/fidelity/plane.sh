#!/bin/sh
# A checker on a plane, directly seen and lit evenly, against its exact picture, the integral over each pixel: what sharp
# edges lose by footprints alone. A set keeps quarters of parallelograms, a pack whole ones.
#
# The limits are about one decibel below what sets have.
set -u
. tests/lib/tap.sh

need_pictures "a checker on a plane"
plane() { /usr/bin/python3 -B tests/fidelity/plane.py "$@"; }

for texels in 64 256; do plane texture "$work/$texels.png" $texels; done
cat >"$work/plane.pov" <<POV
#version 3.7;
global_settings { assumed_gamma 1 }
camera { perspective location <0, 1, 0> direction z right 4/3*x up y angle 40 look_at <0, 1 - tan(pi / 6), 1> }
light_source { <3, 10, -2>, 1 parallel point_at 0 }
#declare Floor = plane { y, 0 pigment { image_map { png "64.png" } rotate 90*x rotate 17*y } finish { diffuse 1 ambient 0 } }
object { Floor }
POV
retex-render -q --size 128x96 --spp 64 --seed 2 -t Floor "$work/plane.pov" -o "$work/plane.exr"
retex-pack -q "$work/plane.exr" -o "$work/plane.retex"
retex-combine -q "$work/plane.exr" --texture 'Floor=rgb(1,1,1)' -o "$work/white.exr"
light=$(make_values "$work/white.exr" mean | awk '{ print $1 }')
for texels in 64 256; do
    plane picture "$work/exact.exr" 128 96 $texels "$light"
    for set in exr retex; do
        retex-combine -q "$work/plane.$set" --texture "Floor=$work/$texels.png" -o "$work/new.exr"
        case $set-$texels in exr-64) least=64 ;; exr-256) least=60 ;; retex-64) least=54 ;; *) least=50.5 ;; esac
        same "$work/new.exr" "$work/exact.exr" $least "plane.$set, $texels texels"
    done
done
finish
