#!/bin/sh
# Runs the commands of docs/glb-to-floor.md, with a room of its own. Its pictures are smaller than the page's, unless
# TUTORIAL_AS_WRITTEN=1.
set -u
. tests/lib/tap.sh
. tests/lib/page_blocks.sh
scenes=$here/scenes
smaller='s/retex try /&--size 160x120 --spp 8 /; s/retex-render /&--size 160x120 --spp 8 /; s/@320:400/@80:100/'
[ -z "${TUTORIAL_AS_WRITTEN:-}" ] || smaller=
mkdir "$work/folder"
(cd "$work/folder" && /usr/bin/python3 "$here/tests/docs/make_flat.py" && cp "$scenes"/textures/*.jpg .)
run_blocks "$here/docs/glb-to-floor.md" "$work/folder" "$smaller"

# The floors differ, and only they; the page is there.
cd "$work/folder" || exit 1
retex-combine -q flat.exr --auto-exposure -o as-is.png
differ=1
for picture in travertine walnut terrazzo; do
    retex-diff -q --fail-psnr 30 as-is.png $picture.png && differ=
done
result "${differ:-0}" "three other floors"
result "$([ -s first/index.html ] && grep -c 'Floor=.*Wall=' first/look.json)" "a page by one command, with floor and wall"
result "$([ -s page/index.html ] && [ -s flat/targets.png ] && echo 1)" "a page, and a picture of the targets"
result "$(retex-info flat.exr | grep -c 'level')" "the target is the faces on one level"
finish
