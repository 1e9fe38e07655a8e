#!/bin/sh
# GIMP and Krita open the pictures of retex-combine, PNG of 8 and 16 bits, TIFF of 16 bits and EXR, with the values that
# are in them, in the precision of the file: what they save again is compared. GIMP saves all in one run. Both need a
# screen.
set -u
. tests/lib/tap.sh
cd "$work" || exit 1
HOME=$work
export HOME
retex-render -q -t Floor --size 96x72 --spp 16 "$scenes/cornell-box/cornell-box.pov" -o room.exr
for ending in png tif exr; do
    retex-combine -q room.exr --texture Floor="$scenes/textures/terrazzo.jpg" -o p.$ending
done
retex-combine -q room.exr --texture Floor="$scenes/textures/terrazzo.jpg" --depth 16 -o fine.png
# on_screen FILE COMMAND…: runs it until FILE is there, up to three times: virtual screens fail to start now and then.
on_screen() {
    for try in 1 2 3; do
        [ -e "$1" ] || (shift; timeout 120 xvfb-run -a "$@") >"log" 2>&1 || sed "s/^/# $try: /" log
    done
}
# opened PROGRAM FILE SAVED TYPE [DIFFERENCE]: the colours of both are the same, and the saved one is of that type.
opened() {
    oiiotool "$2" --ch R,G,B "$3" --ch R,G,B --fail "${5:-1e-7}" --warn "${5:-1e-7}" --diff >log 2>&1
    differ=$?
    type=$(oiiotool --info "$3" 2>&1 | sed -n 's/.*channel, \([a-z0-9]*\).*/\1/p')
    echo "# $2 in $1: $type, $(tail -n 1 log)"
    result "$([ "$differ" = 0 ] && [ "$type" = "$4" ] && echo 1)" "$1 opens $2"
}
script='(let ((again (lambda (from to)
    (let* ((image (car (gimp-file-load RUN-NONINTERACTIVE from from)))
           (layer (car (gimp-image-get-active-layer image))))
        (gimp-file-save RUN-NONINTERACTIVE image layer to to)))))
    (again "p.png" "gimp.png") (again "fine.png" "gimp-fine.png")
    (again "p.tif" "gimp.tif") (again "p.exr" "gimp.exr"))'
if command -v gimp-console >/dev/null && command -v xvfb-run >/dev/null; then
    on_screen gimp.exr gimp-console -idf -b "$script" -b '(gimp-quit 1)'
    opened GIMP p.png gimp.png uint8
    opened GIMP fine.png gimp-fine.png uint16
    opened GIMP p.tif gimp.tif uint16
    opened GIMP p.exr gimp.exr float
else
    skip "pictures in GIMP" "GIMP or xvfb-run is not installed"
fi
if command -v krita >/dev/null && command -v xvfb-run >/dev/null; then
    for ending in png tif exr; do
        on_screen krita.$ending krita --nosplash --export --export-filename krita.$ending p.$ending
    done
    on_screen krita-fine.png krita --nosplash --export --export-filename krita-fine.png fine.png
    opened Krita p.png krita.png uint8
    opened Krita fine.png krita-fine.png uint16 1.3e-4 # which it converts from one sRGB to another, with 16 bits
    opened Krita p.tif krita.tif uint16
    opened Krita p.exr krita.exr half
else
    skip "pictures in Krita" "Krita or xvfb-run is not installed"
fi
finish
