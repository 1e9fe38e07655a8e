# retex-import: a first look at the scene chooses its exposure, and adds light where the model has too little.
% look() { /usr/bin/python3 $TESTS/import_look.py "$@"; }
% import() {
%     m=$1; shift; retex-import $m.gltf "$@" -o $m 2>&1 |
%         grep -o -e 'exposure of [+-]' -e 'warning.*' -e 'soft sky' -e '^.*light is added' -e 'no sky' -e 'error.*' ||
%         true
% }
% render() { retex-render -q --plain --spp 64 --size 160x120 $1/$1.pov -o $1.exr && echo $1: $(look $1.exr); }
$ look

# By numpy, what the lamp lights is a middle grey, whatever its unit; what is about right stays as it is.
$ for m in lamp dim bright panel label; do import $m; render $m; done
$ grep -c 'retex_exposure *+0.00' panel/panel.pov label/label.pov

# So does what a user says.
$ import lamp -f --exposure -3
$ grep -o 'retex_exposure *[-+0-9.]*' lamp/lamp.pov
$ import lamp -f --exposure dark

# Light that is next to none gets some beside it, which can be turned off again; a sky is light, too.
$ for m in speck out; do
+     import $m; render $m
+     sed -i '/Added_light =/s/= .*;/= 0;/' $m/$m.pov; render $m
+ done
$ cp "$SCENES/textures/brick.jpg" sky.jpg
$ for m in speck out; do import $m -f --sky sky.jpg; render $m; done

# Things that no camera of the model shows are not before black.
$ import framed

# Without retex-render beside it, the scene is as the model has it.
$ mkdir alone && cp "$(command -v retex-import)" alone
$ alone/retex-import dim.gltf -f -o dim 2>&1 | grep look
$ render dim
