# How textures are adjusted and laid, in all the forms in which an edit comes.
$ oiiotool "$SCENES/textures/brick.jpg" --resize 128x128 -o brick.jpg
$ oiiotool "$SCENES/textures/damask.jpg" --resize 32x16 -o tile.png
% render() { retex-render -q --size 64x48 --spp 16 "$TESTS/finishes.pov" -t Floor -t Wall "$@"; }
$ render -o set.exr
% near() { retex-diff "$1" "$2" --fail-psnr "$3" -q || echo "$1 $2 $3"; }

# An adjustment is that of the image, made beforehand; a picture in which colours are lost stands for another.
$ oiiotool brick.jpg --colorconvert sRGB linear --mulc .8,.5,.3 -d half -o gain.exr
$ oiiotool brick.jpg --colorconvert sRGB linear --powc .5 -d half -o gamma.exr
$ oiiotool brick.jpg --invert -o invert.png
$ for a in gain=.8,.5,.3:gain.exr gamma=2:gamma.exr invert=yes:invert.png 'tint=rgb(.8,.5,.3):gain.exr'; do
+     retex-combine -q set.exr --texture:scale=2:${a%:*} Floor=brick.jpg -o a.exr
+     retex-combine -q set.exr --texture:scale=2 Floor=${a##*:} -o b.exr
+     near a.exr b.exr 60
+ done
$ near a.exr set.exr 40
> a.exr set.exr 40
$ retex-combine set.exr --texture:colorize=#602010 Floor=brick.jpg -o a.exr 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: a.exr: Floor <- brick.jpg, 64 x 48
$ retex-combine -q set.exr --texture:colorize=#ffe0c0 Floor=brick.jpg -o a.exr 2>&1 | sed 's/of [0-9].*[0-9] /of N /'
> retex-combine: warning: the mean colour differs from that of colorize= by a delta E of N (CIEDE2000)
$ retex-combine -q set.exr --texture:colorize=red Floor=tan -o a.exr
$ retex-combine -q set.exr --texture Floor=red -o b.exr
$ cmp a.exr b.exr

# The order counts, and the last one of a name.
$ retex-combine -q set.exr --texture:gain=.5:gamma=2 Floor=brick.jpg -o a.exr
$ retex-combine -q set.exr --texture:gamma=2:gain=.5 Floor=brick.jpg -o b.exr
$ near a.exr b.exr 40
> a.exr b.exr 40
$ retex-combine -q set.exr --texture:gamma=9:gain=.5:gamma=2 Floor=brick.jpg -o b.exr
$ cmp a.exr b.exr

# Everything is the same by option, table, samples, in packs, in the name of a picture, and along the same paths.
% laid=:width=.5,.25:repeat=herringbone:grout=.02:groutcolor=#222:vary=turn,flip,3
% laid=$laid:tiles=tile.png:at=.1,.2:hue=40:contrast=1.2
$ retex-combine -q set.exr --texture$laid Floor=brick.jpg -o a.exr
$ cat >t.csv <<END
+ output,Floor
+ b.exr,"$laid brick.jpg"
+ b2.exr,":width=.6,.25:repeat=herringbone:grout=.02 brick.jpg"
+ b3.exr,":width=.5,.25:repeat=herringbone:grout=.02 brick.jpg"
+ b4.exr,:width=.5:hue=10 brick.jpg
+ b5.exr,:width=.5:hue=20 brick.jpg
+ END
$ retex-combine -q set.exr --batch t.csv
$ cmp a.exr b.exr
$ retex-combine -q set.exr --texture:width=.5,.25:repeat=herringbone:grout=.02 Floor=brick.jpg -o c.exr
$ cmp c.exr b3.exr
$ retex-combine -q set.exr --texture:width=.5:hue=20 Floor=brick.jpg -o c.exr
$ cmp c.exr b5.exr
$ retex-sample -q set.exr --texture$laid Floor=brick.jpg | retex-combine -q - -o b.exr
$ cmp a.exr b.exr
$ retex-pack -q set.exr --lossless -o set.retex
$ retex-combine -q set.retex --texture$laid Floor=brick.jpg -o b.exr
$ cmp a.exr b.exr
$ render --replace$laid Floor=brick.jpg -o p.exr
$ near a.exr p.exr 28
$ render --replace:width=.5,.25 Floor=brick.jpg -o q.exr
$ near a.exr q.exr 26
> a.exr q.exr 26

# Grout makes joints in colours too; a joint of no width is none; the middle of an image lies where it is told.
$ retex-combine -q set.exr --texture:width=.4:grout=.1:groutcolor=white Floor=red -o a.exr
$ retex-combine -q set.exr --texture Floor=red -o b.exr
$ near a.exr b.exr 30
> a.exr b.exr 30
$ retex-combine -q set.exr --texture:width=.4:grout=0 Floor=red -o a.exr
$ cmp a.exr b.exr
$ retex-combine -q set.exr --texture:width=.5:at=.25,.25 Floor=tile.png -o a.exr
$ retex-combine -q set.exr --texture:width=.5:offset=0,.0 Floor=tile.png -o b.exr
$ near a.exr b.exr 90
> a.exr b.exr 90
$ retex-combine -q set.exr --texture:width=.5,.5:at=.25,.25 Floor=tile.png -o a.exr
$ retex-combine -q set.exr --texture:width=.5,.5 Floor=tile.png -o b.exr
$ near a.exr b.exr 90

# Layers lie on a texture, or on the original: by options, tables, texts, samples, packs, and along the same paths.
$ oiiotool --create 40x20 4 --fill:color=1,.1,.1,1 40x20 --fill:color=0,0,0,0 10x10+20+5 -d uint8 -o logo.png
% one=':at=.5,-.5:width=.5:rotate=20' two=':at=-.4,-.6:width=.4:hue=120'
% layers="--texture:over$one Floor=logo.png --texture:over$two Floor=logo.png"
% below='--texture:width=.6:repeat=brick:grout=.02 Floor=brick.jpg'
$ retex-combine -q set.exr $below $layers -o a.exr
$ retex-combine -q set.exr $layers $below -o b.exr
$ cmp a.exr b.exr
$ retex-combine -q set.exr $below -o n.exr
$ near a.exr n.exr 30
> a.exr n.exr 30
$ cat >t.csv <<END
+ output,Floor
+ b.exr,":width=.6:repeat=brick:grout=.02 brick.jpg + $one logo.png + $two logo.png"
+ n.exr,:width=.6:repeat=brick:grout=.02 brick.jpg
+ c.exr,"+ $one logo.png + $two logo.png"
+ END
$ retex-combine -q set.exr --batch t.csv
$ cmp a.exr b.exr
$ retex-combine -q set.exr $layers -o b.exr
$ cmp c.exr b.exr
$ near c.exr set.exr 30
> c.exr set.exr 30
$ retex-sample -q set.exr $layers | retex-combine -q - -o b.exr
$ cmp c.exr b.exr
$ retex-pack -q set.exr --lossless -o set.retex
$ retex-combine -q set.retex $layers -o b.exr
$ cmp c.exr b.exr
$ render --replace:over$one Floor=logo.png --replace:over$two Floor=logo.png -o p.exr
$ near c.exr p.exr 36
$ retex-combine -q set.exr --texture over:Floor=logo.png --texture over2:Floor=tile.png -o a.exr
$ retex-combine -q set.exr --texture:over Floor=logo.png --texture:over Floor=tile.png -o b.exr
$ cmp a.exr b.exr
$ retex-combine -q set.exr --texture:width=.5 Floor=brick.jpg --texture:over:width=.2 Floor=logo.png -o b.exr \
+     --error e.exr
$ oiiotool --stats e.exr | awk '/Max:/ { print ($3 > .001 ? "an error" : $0) }'
> an error
$ cp logo.png logo.0007.png
$ retex-combine -q set.exr --frames 7 --texture:over Floor=logo.%04d.png -o f.%04d.exr
$ retex-combine -q set.exr --texture:over Floor=logo.png -o b.exr
$ cmp b.exr f.0007.exr

# What layers cannot be.
$ for o in :over:wrap=clamp :over:grout=.1 :over:finish=tile.png; do
+     retex-combine set.exr --texture$o Floor=logo.png -o x.exr
+ done
! retex-combine: error: a layer on Floor lies there once: it has no wrap, repeat, grout, vary, tiles, finish or normal
! retex-combine: error: a layer on Floor lies there once: it has no wrap, repeat, grout, vary, tiles, finish or normal
! retex-combine: error: a layer on Floor lies there once: it has no wrap, repeat, grout, vary, tiles, finish or normal
= 2
$ retex-combine set.exr --texture:over Floor=red -o x.exr
! retex-combine: error: a layer on Floor must be an image, not a colour
= 2
$ retex-combine set.exr --texture:over Floor=gone.png -o x.exr
! retex-combine: error: cannot read gone.png: No such file or directory
= 2
$ for k in 1 2 3 4 5; do printf -- '--texture:over Floor=logo.png '; done >five
$ retex-combine set.exr $(cat five) -o x.exr
! retex-combine: error: target Floor is given more than 4 layers
= 2
$ retex-combine set.exr --texture:over Floor=logo.png -o logo.png
! retex-combine: error: logo.png: the output would replace the texture
= 2
$ cat >t.csv <<'END'
+ output,Floor
+ x.exr,tile.png + gone.png
+ y.exr,tile.png + :scale=2
+ END
$ retex-combine set.exr --batch t.csv
! retex-combine: error: t.csv:2: cannot read gone.png: No such file or directory
! retex-combine: error: t.csv:3: options without an image; expected `:scale=2 IMAGE`
= 2
$ test -e x.exr
= 1

# What is refused.
$ for o in grout=.1 repeat=hexagon width=1:grout=.1:wrap=clamp width=1:grout=.1:repeat=mirror vary=spin tiles=a,,b \
+     width=.1:grout=.2 hue=red tiles=gone.png blur=.5 width=1,.001:repeat=basket; do
+     retex-combine set.exr --texture:$o Floor=brick.jpg -o x.exr
+ done
! retex-combine: error: texture options: grout needs width=, the size of a repeat
! retex-combine: error: texture options: repeat=hexagon needs width=, the size of a repeat
! retex-combine: error: texture options: grout needs wrap=repeat, the default, on both axes
! retex-combine: error: texture options: grout cannot be used with repeat=mirror
! retex-combine: error: texture option vary='spin': expected turn, flip, shift and a number of at most 9 digits, or some of them, as in vary=turn,flip,7
! retex-combine: error: texture option tiles='a,,b': expected 1 to 8 pictures without a colon or comma in their names, of at most 255 bytes each, as in tiles=b.jpg,c.jpg
! retex-combine: error: texture: grout is wider than a repeat
! retex-combine: error: texture option hue='red': expected degrees, as in hue=30
! retex-combine: error: cannot read gone.png: No such file or directory
! retex-combine: error: texture option blur='.5': expected a part of the image's width from 0 to 0.25, as in blur=0.01
! retex-combine: error: texture: this repeat is more than 256 times as long as wide
= 2
$ retex-combine set.exr --texture:tiles=tile.png Floor=brick.jpg -o tile.png
! retex-combine: error: tile.png: the output would replace the texture
= 2
$ printf 'output,Floor\nx.exr,:tiles=gone.png brick.jpg\n' >t.csv
$ retex-combine set.exr --batch t.csv
! retex-combine: error: t.csv:2: cannot read gone.png: No such file or directory
= 2
$ test -e x.exr
= 1
