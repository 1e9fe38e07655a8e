# retex-import: a first look at the scene chooses its exposure, and adds light where the model has too little.
% look() { /usr/bin/python3 $TESTS/import_exposure.py "$@"; }
% import() {
%     m=$1; shift; retex-import $m.gltf "$@" -o $m 2>&1 |
%         grep -o -e 'exposure of [+-]' -e 'warning.*' -e 'soft sky' -e '^.*light is added' -e 'no sky' -e 'error.*' ||
%         true
% }
% render() { retex-render -q --plain --spp 64 --size 160x120 $1/$1.pov -o $1.exr && echo $1: $(look $1.exr); }
$ look

# By numpy, what the lamp lights is between a dark grey and its reflectance, .48, whatever its unit; what is about right stays as it is.
$ for m in lamp dim bright panel label; do import $m; render $m; done
> exposure of -
> lamp: as a floor
> exposure of +
> dim: as a floor
> exposure of -
> bright: as a floor
> panel: light
> soft sky
> label: as a floor
$ grep -c 'retex_exposure *+0.00' panel/panel.pov label/label.pov
> panel/panel.pov:1
> label/label.pov:1

# What is less than 1.5 stops too bright gets an exposure if a tenth of it is white.
$ import pale; render pale
> exposure of -
> pale: as a floor

# Where most of what is seen is dark, light is added; a camera that looks away is not taken.
$ import spot
> retex-import: the light of the model reaches 0 % of what is seen: light is added
$ retex-import blind.gltf -o blind 2>&1 | grep -o 'the camera .* sees nothing'
> the camera Camera_nodes_2 sees nothing

# What a user says stays.
$ import lamp -f --exposure -3
$ grep -o 'retex_exposure *[-+0-9.]*' lamp/lamp.pov
> retex_exposure   -3.00
$ import lamp -f --exposure dark
> error: --exposure: expected a number from -30 to 30, not 'dark'

# Light that is next to none gets some beside it, which can be turned off again; a sky is light, too.
$ for m in speck out; do
+     import $m; render $m
+     sed -i '/Added_[a-z]* =/s/= .*;/= 0;/' $m/$m.pov; render $m
+ done
> retex-import: the light of the model reaches 0 % of what is seen: light is added
> speck: as a floor
> speck: black
> retex-import: the light of the model reaches 0 % of what is seen: light is added
> out: as a floor
> out: black
! retex-render: out/out.pov: warning: its light sources are black, nothing shines and there is no sky: the picture will be black
$ cp "$SCENES/textures/brick.jpg" sky.jpg
$ for m in speck out; do import $m -f --sky sky.jpg; render $m; done
> exposure of +
> speck: as a floor
> exposure of +
> out: as a floor

# Things that no camera of the model shows are not before black.
$ import framed
> no sky
> exposure of -

# The sky in a window is not white before a room that it lights: a lamp is lit, which can be turned off.
$ retex-import room.gltf -o room 2>&1 | grep -o 'a lamp is lit, Added_lamp'
> a lamp is lit, Added_lamp
$ render room >/dev/null && look range room.exr
> within the range
$ sed -i 's/Added_lamp = *[0-9.]*/Added_lamp = 0/; s/retex_exposure *[-+0-9.]*/retex_exposure 3/' room/room.pov
$ render room >/dev/null && look range room.exr
> 8 tenths within the range

# Before a bright sky of the user's, the exposure gives way to it somewhat.
$ retex-import -q --sky "$SCENES/textures/damask.jpg" stage.gltf -o stage
$ render stage >/dev/null && look range stage.exr
> 8 tenths within the range

# Before the soft sky that is added, dark things are dark, and it is not white.
$ retex-import -q dark_stage.gltf -o dark_stage
$ render dark_stage >/dev/null && look range dark_stage.exr
> 10 tenths within the range

# Without retex-render beside it, the scene is as the model has it.
$ mkdir alone && cp "$(command -v retex-import)" alone
$ alone/retex-import dim.gltf -f -o dim 2>&1 | grep look
> retex-import: warning: no look at the scene: there is no retex-render beside retex-import
$ render dim
> dim: black

# It renders with the limits of the import, and leaves decoding of pictures to a process without rights.
$ printf '%s\n' '#!/bin/sh' 'echo "$@" | sed "s,/[^ ]*/,,g" >seen.txt; exit 1' >alone/retex-render && chmod +x alone/retex-render
$ alone/retex-import --max-memory 3G --max-time 20 dim.gltf -f -o dim 2>&1 | grep look
> retex-import: warning: no look at the scene: its scene cannot be rendered
$ cat seen.txt
> --safe --accept-damaged -q --size 96x72 --spp 8 --aov depth,reflectance -o .look.exr --max-time 20.000 --max-memory 3072M --max-pixels 268435456 -- dim.pov

# It is at small copies of large pictures, by which no more than time is lost; the scene gets them as they are.
$ cp "$SCENES/textures/damask.jpg" large.jpg && printf 'newmtl m\nmap_Kd large.jpg\n' >pictured.mtl
$ printf '%s\n' 'mtllib pictured.mtl' 'v 0 0 0' 'v 1 0 0' 'v 0 1 0' 'vt 0 0' 'vt 1 0' 'vt 0 1' 'usemtl m' 'f 1/1 2/2 3/3' >pictured.obj
$ printf '%s\n' '#!/bin/sh' 'exec >seen.txt; for scene; do :; done; cd "${scene%/*}"; ls -A . textures' \
+     "/usr/bin/python3 '$TESTS/import_exposure.py' size textures/Large.jpg" >alone/retex-render
$ alone/retex-import -q pictured.obj -o pictured 2>&1 | grep -o 'no look'; cat seen.txt; ls -A pictured
> no look
> .:
> pictured-meshes.inc
> pictured.pov
> textures
>
> textures:
> Large.jpg
> 128 pixels wide
> pictured-meshes.inc
> pictured.pov
> textures
$ cmp large.jpg pictured/textures/Large.jpg
