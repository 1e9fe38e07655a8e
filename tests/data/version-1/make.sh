#!/bin/sh
# Makes the files of this folder anew. They are of version 1 of the formats and must stay readable as they are. Run it in
# this folder, with retex in PATH.
set -eu
render() { retex-render -q -t Floor -t Wall room.pov "$@"; }
edits='--texture:width=40cm:grout=1cm Floor=tan --texture Wall=rgb(.2,.3,.6)'

# What sets may keep: lamps, finishes, the unit; normals; layout paper.
render --size 16x12 --spp 8 --lamps each --finish Floor=original,polished --unit 50cm --aov depth,normal,uv -o lamps.exr
render --size 16x12 --spp 8 --finish Wall=normals -o normals.exr
render --size 16x12 --spp 8 --layout paper -o paper.exr
retex-denoise -q lamps.exr -o denoised.exr

# Packs: with losses, lossless, with levels; streams and samples.
retex-pack -q lamps.exr -o lamps.retex
retex-pack -q normals.exr -o normals.retex
retex-pack -q --lossless paper.exr -o paper.retex
render --size 480x12 --spp 2 -o wide.exr
retex-pack -q --levels --quality 70 wide.exr -o levels.retex
rm wide.exr
# shellcheck disable=SC2086 # words wanted
retex-sample -q lamps.exr $edits -o - >lamps.stream
retex-sample -q normals.exr --texture:normal=map.ppm Wall=map.ppm -o normals-samples.exr
# shellcheck disable=SC2086 # words wanted
retex-sample -q paper.exr $edits -o paper-samples.exr

lit='--light Lamp=2*2700K --light Sun=0.5 --finish Floor=polished'
for file in lamps.exr lamps.retex denoised.exr; do
    # shellcheck disable=SC2086 # words wanted
    retex-combine -q $file $edits $lit -o "picture-$file.exr"
done
mv picture-lamps.exr.exr picture-lamps-laid.exr
retex-combine -q lamps.exr --texture:finish=map.ppm Floor=tan -o picture-map.exr
for file in normals.exr normals.retex; do
    retex-combine -q $file --texture:normal=map.ppm Wall=map.ppm -o "picture-$file.exr"
done
# shellcheck disable=SC2086 # words wanted
retex-combine -q paper.exr $edits -o picture-paper.exr.exr
retex-combine -q levels.retex --texture Floor=tan --size 160x -o picture-levels.exr
