#!/bin/sh
# Makes the files of this folder anew. They are of version 1 of the formats and must stay readable as they are: they are
# made anew only where version 1 was wrong before the first release. Run it in this folder, with retex in PATH.
set -eu
red='Floor=rgb(.9,.2,.1)'
for layout in footprints paper; do
    retex-render -q --size 16x12 --spp 8 -t Floor -t Wall --layout $layout --aov depth,normal,uv room.pov -o $layout.exr
done
retex-pack -q footprints.exr -o footprints.retex
retex-pack -q --lossless paper.exr -o paper.retex
retex-sample -q footprints.exr --texture "$red" -o - >footprints.stream
retex-sample -q paper.exr --texture "$red" -o paper-samples.exr
for file in footprints.exr paper.exr footprints.retex; do
    retex-combine -q $file --texture "$red" -o "picture-$file.exr"
done
