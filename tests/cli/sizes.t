# Parts of pictures and smaller ones: means of the pixels that they cover.
$ cp "$TESTS/finishes.pov" room.pov
$ retex-render -q --size 96x60 --spp 8 -t Wall -t Floor room.pov -o set.exr
% combine() { retex-combine -q set.exr --texture Floor=tan "$@"; }
% near() { retex-diff "$1" "$2" --fail-psnr 80 -q || echo "$1 $2"; }
$ combine -o full.exr

# A smaller one; one side gives the other.
$ combine --size 48x30 -o a.exr
$ oiiotool full.exr --resize:filter=box 48x30 -o b.exr
$ near a.exr b.exr
$ for s in 48x x30; do
+     combine --size $s -o c.exr
+     cmp a.exr c.exr
+ done

# A part, a smaller one of a part, and one of another shape: the middle of it.
$ combine --crop 8,20,40,24 -o a.exr
$ oiiotool full.exr --cut 40x24+8+20 -o b.exr
$ near a.exr b.exr
$ combine --crop 8,20,40,24 --size 10x6 -o a.exr
$ oiiotool b.exr --resize:filter=box 10x6 -o c.exr
$ near a.exr c.exr
$ combine --size 30x30 -o a.exr
$ oiiotool full.exr --cut 60x60+18+0 --resize:filter=box 30x30 -o b.exr
$ near a.exr b.exr
$ combine --size 96x60 -o a.exr
$ cmp a.exr full.exr
# More rows than are made at a time.
$ retex-render -q --size 20x300 --spp 1 -t Floor room.pov -o tall.exr
$ retex-combine -q tall.exr --texture Floor=tan -o full.exr
$ retex-combine -q tall.exr --texture Floor=tan --size 10x150 -o a.exr
$ oiiotool full.exr --resize:filter=box 10x150 -o b.exr
$ near a.exr b.exr
$ combine -o full.exr
$ retex-combine set.exr --texture Wall=tan --texture Floor=rgb\(.5,.5,.5\) -o a.png 2>&1 | sed 's/[0-9.]* s$/T s/'
> retex-combine: a.png: Wall <- rgb(0.6444797,0.45641103,0.26225066), Floor <- rgb(0.5,0.5,0.5), 96 x 60, T s
$ retex-sample -q set.exr --texture Floor=rgb\(.5,.5,.5\) -o floor.exr
$ retex-combine set.exr floor.exr --texture Wall=tan -o a.png 2>&1 | sed 's/[0-9.]* s$/T s/'
> retex-combine: a.png: Wall <- rgb(0.6444797,0.45641103,0.26225066), Floor <- rgb(0.5,0.5,0.5), 96 x 60, T s
$ retex-combine set.exr --texture Floor=rgb\(.5,.5,.5\) --size 24x -o a.png 2>&1 | sed 's/[0-9.]* s$/T s/'
> retex-combine: a.png: Floor <- rgb(0.5,0.5,0.5), 24 x 15, T s
$ oiiotool --info a.png
> a.png                :   24 x   15, 3 channel, uint8 png

# The expected error is the mean of that of the pixels; its number is of the picture that is made.
$ cp "$SCENES/textures/brick.jpg" .
$ retex-combine -q set.exr --texture Floor=brick.jpg --error e.exr -o full.exr
$ retex-combine -q set.exr --texture Floor=brick.jpg --error f.exr --crop 8,20,40,24 --size 10x -o a.exr
$ oiiotool e.exr --cut 40x24+8+20 --resize:filter=box 10x6 -o b.exr
$ near f.exr b.exr

# In tables, of frames, and from streams; another size is another table.
$ cat >t.csv <<'END'
+ output,Floor
+ t.exr,tan
+ t.jpg,brick.jpg
+ END
$ retex-combine -q set.exr --batch t.csv --size 48x
$ combine --size 48x -o a.exr
$ cmp a.exr t.exr
$ oiiotool --info t.jpg
> t.jpg                :   48 x   30, 3 channel, uint8 jpeg
$ for s in 48 24; do
+     retex-combine -q set.exr --batch t.csv --size ${s}x --manifest m.csv --resume
+     oiiotool --info t.jpg
+ done
> t.jpg                :   48 x   30, 3 channel, uint8 jpeg
> t.jpg                :   24 x   15, 3 channel, uint8 jpeg
$ retex-sample -q set.exr --texture Floor=tan | retex-combine -q - --size 48x -o b.exr
$ cmp a.exr b.exr
$ cp set.exr s.0003.exr
$ retex-combine -q s.%04d.exr --frames 3 --texture Floor=tan --size 48x -o f.%04d.exr
$ cmp a.exr f.0003.exr

# What is refused.
$ for s in 0x5 x 5 5x5x -1x5 ax5 70000x; do combine --size $s -o x.exr; done
! retex-combine: error: --size: expected WxH in pixels, or Wx or xH to keep the aspect, not '0x5'
! retex-combine: error: --size: expected WxH in pixels, or Wx or xH to keep the aspect, not 'x'
! retex-combine: error: --size: expected WxH in pixels, or Wx or xH to keep the aspect, not '5'
! retex-combine: error: --size: expected WxH in pixels, or Wx or xH to keep the aspect, not '5x5x'
! retex-combine: error: --size: expected WxH in pixels, or Wx or xH to keep the aspect, not '-1x5'
! retex-combine: error: --size: expected WxH in pixels, or Wx or xH to keep the aspect, not 'ax5'
! retex-combine: error: --size: expected WxH in pixels, or Wx or xH to keep the aspect, not '70000x'
= 2
$ combine --size 97x -o x.exr
! retex-combine: error: the picture, or this part of it, has 96x60 pixels; it is not enlarged
= 2
$ combine --crop 90,0,10,5 -o x.exr
! retex-combine: error: the crop 90,0,10,5 is not within the picture's 96x60 pixels
= 2
$ for c in 1,2,3 -1,0,5,5 0,-1,5,5 0,0,0,5 0,0,5,0 70000,0,5,5 0,70000,5,5 0,0,70000,5 0,0,5,70000 0,0,5,5x; do combine --crop $c -o x.exr; done
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '1,2,3'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '-1,0,5,5'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '0,-1,5,5'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '0,0,0,5'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '0,0,5,0'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '70000,0,5,5'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '0,70000,5,5'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '0,0,70000,5'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '0,0,5,70000'
! retex-combine: error: --crop: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '0,0,5,5x'
= 2
$ retex-combine -q set.exr --solve full.exr --free Floor --size 5x
! retex-combine: error: --solve excludes --size and --crop; --region says which part counts
= 2
$ test -e x.exr
= 1

# A picture a third as large as a set of a million pixels, or smaller, is told to want a level; no other is.
$ echo 'camera { look_at z } plane { z, 1 pigment { rgb 1 } finish { emission 1 } }' >wall.pov
$ for s in 1024x1024 1023x1024; do retex-render -q --spp 1 --size $s -t 'W=#1' wall.pov -o $s.exr; done
$ for s in 341x341 341x342 342x341; do
+     for of in 1024x1024 1023x1024; do
+         retex-combine $of.exr --size $s -o x.exr 2>&1 | grep ' made of all ' | sed "s/^/$s /"
+     done
+ done
> 341x341 retex-combine: 1024x1024.exr: made of all 1024 x 1024 pixels: no level of it serves, see retex-pack --levels
