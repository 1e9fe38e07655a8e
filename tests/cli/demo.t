# make demo, small: what it makes is denoised, and the command that it ends with works.
$ mkdir b
$ ln -s "$(dirname "$(command -v retex-render)")" b/bin
% b=$PWD/b
$ cd "$SCENES/.." && DEMO_SPP=4 DEMO_SIZE=64x36 tools/demo.sh "$b" 2>"$b/said" | sed 's/.*demo/demo/'
> demo/floor-and-wall.png
> demo/floor-terrazzo.png
> demo/floor-walnut-herringbone.png
> demo/original.png
> demo/wall-brick.png
> demo/wall-damask.png
$ tail -2 "$b/said" | sed 's/ [^ ]*b\//  b\//g'
> To put a photograph of yours on the floor, 1.5 metres wide:
>      b/bin/retex-combine  b/demo/living-room.exr --texture:width=1.5 Floor=PHOTOGRAPH.jpg -o mine.png
$ retex-info b/demo/living-room.exr | grep denoise
> denoised       yes
# The set in it is smaller than one in a pipe, which is compressed fast.
$ test $(stat -Lc %s b/demo/living-room.exr) \
+     -lt $(retex-render -q -t Floor -t Wall --spp 4 --size 64x36 "$SCENES/living-room/living-room.pov" | wc -c) &&
+     echo small
> small
$ cp "$SCENES/textures/brick.jpg" PHOTOGRAPH.jpg
$ sh -c "$(tail -1 b/said)" 2>/dev/null
$ retex-combine -q b/demo/living-room.exr -o original.png
$ retex-diff -q b/demo/original.png original.png
$ retex-diff -q mine.png original.png --fail-psnr 40
= 1
