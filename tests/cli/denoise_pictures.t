# retex-denoise on pictures of other renderers: how much nearer to the truth they come, layers that add up, what stays
# as it was, and what is refused. denoise_pictures.py makes the pictures and compares them.
$ /usr/bin/python3 "$TESTS/denoise_pictures.py" make
% without_time() { sed 's/[0-9]*\.[0-9]* s$/N s/'; }
% check() { /usr/bin/python3 "$TESTS/denoise_pictures.py" "$@"; }

# With a second render.
$ retex-denoise -v a.exr --other-half b.exr -o half.exr 2>&1 | without_time
> retex-denoise: guides: normal ViewLayer.Normal, albedo ViewLayer.Denoising Albedo, position ViewLayer.Position
> retex-denoise: half.exr: N s
$ check gain half.exr a.exr truth-cycles.exr ViewLayer.Combined least=12
> nearer
$ check same a.exr half.exr ViewLayer.Combined
$ retex-denoise -q --threads 1 a.exr --other-half b.exr -o one-thread.exr
$ cmp half.exr one-thread.exr
$ retex-denoise -q --layer Combined --other-half b.exr - -o - <a.exr | cmp - half.exr
# With the variance, with nothing, with a depth in place of positions, and without any guide.
$ retex-denoise -v one.exr --variance variance -o o.exr 2>&1 | without_time
> retex-denoise: guides: normal N, albedo albedo, position P
> retex-denoise: the layer variance is taken as the variance of each pixel's mean
> retex-denoise: o.exr: N s
$ check gain o.exr one.exr truth.exr least=10
> nearer
$ check same one.exr o.exr ''
$ retex-denoise -v one.exr -o o.exr 2>&1 | without_time
> retex-denoise: guides: normal N, albedo albedo, position P
> retex-denoise: the noise is estimated from the picture itself: what no guide shows may be taken for noise; --other-half is better
> retex-denoise: o.exr: N s
$ check gain o.exr one.exr truth.exr least=8
> nearer
$ retex-denoise -v depth.exr -o o.exr 2>&1 | without_time
> retex-denoise: guides: normal N, albedo albedo, depth Z
> retex-denoise: the noise is estimated from the picture itself: what no guide shows may be taken for noise; --other-half is better
> retex-denoise: o.exr: N s
$ check gain o.exr one.exr truth.exr least=8
> nearer
$ retex-denoise -v bare.exr -o o.exr 2>&1 | without_time
> retex-denoise: guides: none
> retex-denoise: the noise is estimated from the picture itself: what no guide shows may be taken for noise; --other-half is better
> retex-denoise: o.exr: N s
$ check gain o.exr one.exr truth.exr least=1.5
> nearer
# Guides by their names, and one channel.
$ retex-denoise -q bare.exr -o x.exr
$ retex-denoise -q one.exr -o y.exr
$ retex-denoise -q --normal N --albedo albedo --position P one.exr -o z.exr
$ cmp y.exr z.exr
$ cmp -s x.exr y.exr
= 1
$ retex-denoise -q grey.exr --variance variance -o o.exr
$ check changed grey.exr o.exr
> Y
$ retex-denoise -q one.exr --layer A --variance variance.R -o o.exr
$ check changed one.exr o.exr
> A
# A picture of our own renderer.
$ for k in 1 2 t; do
+     spp=8
+     seed=$k
+     [ $k = t ] && spp=256 && seed=3
+     mkdir r$k
+     retex-render -q --plain --size 96x72 --seed $seed --spp $spp "$SCENES/cornell-box/cornell-box.pov" --aov-dir r$k \
+         --aov normal_mean,albedo_mean,position -o p.exr
+ done 2>/dev/null
$ check render
$ for o in '--other-half r2.exr r1.exr' r.exr; do
+     retex-denoise -q $o -o o.exr
+     check gain o.exr r.exr rt.exr least=4.4
+ done
> nearer
> nearer

# Layers that add up still do, to the rounding of a half, and where the picture is asked for too; multi-part files.
$ retex-denoise -v a.exr --other-half b.exr --layer DiffDir --layer DiffInd --layer Emit -o sum.exr 2>&1 | without_time
> retex-denoise: guides: normal ViewLayer.Normal, albedo ViewLayer.Denoising Albedo, position ViewLayer.Position
> retex-denoise: ViewLayer.Combined is the sum of the layers, and becomes that of the denoised ones
> retex-denoise: sum.exr: N s
$ check sum sum.exr
> adds up
$ check gain sum.exr a.exr truth-cycles.exr ViewLayer.Combined least=13
> nearer
$ check changed a.exr sum.exr
> ViewLayer.Combined.R ViewLayer.Combined.G ViewLayer.Combined.B ViewLayer.DiffDir.R ViewLayer.DiffDir.G ViewLayer.DiffDir.B ViewLayer.DiffInd.R ViewLayer.DiffInd.G ViewLayer.DiffInd.B
$ retex-denoise -q a.exr --other-half b.exr --layer Combined --layer DiffInd --layer DiffDir --layer Emit -o all.exr
$ check sum all.exr
> adds up
$ cmp sum.exr all.exr
$ retex-denoise -q a-parts.exr --other-half b-parts.exr --layer DiffDir --layer DiffInd --layer Emit -o parts.exr
$ check sum parts.exr
> adds up
$ check same a-parts.exr parts.exr ViewLayer.Combined ViewLayer.DiffDir ViewLayer.DiffInd ViewLayer.Emit
> ViewLayer.Emit.R is the same
> ViewLayer.Emit.G is the same
> ViewLayer.Emit.B is the same
$ retex-denoise a.exr --layer DiffDir --layer Emit -o o.exr 2>&1 | without_time
> retex-denoise: the noise is estimated from the picture itself: what no guide shows may be taken for noise; --other-half is better
> retex-denoise: ViewLayer.Combined is not the sum of the layers, and stays as it is
> retex-denoise: o.exr: N s
$ check changed a.exr o.exr
> ViewLayer.DiffDir.R ViewLayer.DiffDir.G ViewLayer.DiffDir.B ViewLayer.Emit.R ViewLayer.Emit.G ViewLayer.Emit.B

# Headers and other channels stay, whatever the compression, tiles and windows.
$ for f in none zips rle piz pxr24 b44 tiled pieces cropped; do
+     retex-denoise -q $f.exr -o o.exr
+     check same $f.exr o.exr ViewLayer.Combined
+ done
> part 0: compression: pxr24, zip
> part 0: compression: b44, piz

# What is refused.
$ for f in nan inf two cut; do
+     head -c 20000 a.exr >cut.exr
+     retex-denoise -q $f.exr -o no.exr
+ done
! retex-denoise: error: nan.exr: layer RGB holds NaN at 7,5: --accept-damaged takes the mean of the pixels around
! retex-denoise: error: inf.exr: layer RGB holds infinity at 7,5: --accept-damaged takes the mean of the pixels around
! retex-denoise: error: two.exr has several pictures, A.Combined and B.Combined: choose by --layer
! retex-denoise: error: cut.exr is damaged or truncated: Preparing to read scanline 0 (chunk 0), found corrupt leader: packed size 30366, file size 20000
= 2
$ ls no.exr 2>/dev/null
= 2
$ retex-denoise -q --accept-damaged nan.exr -o o.exr
$ check gain o.exr one.exr truth.exr least=8
> nearer
$ for o in '--layer nothing' '--layer DiffDir --layer ViewLayer.DiffDir' '--normal nothing' '--variance nothing' \
+     '--other-half small.exr' '--other-half two.exr' '--other-half missing.exr' '--other-half b.exr --variance Emit' \
+     '--no-footprints' '--full-precision' '--max-pixels 100' '--other-half a.exr'; do
+     retex-denoise -q a.exr $o -o no.exr || echo $?
+ done
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
> 2
! retex-denoise: error: a.exr has no layer nothing
! retex-denoise: error: the layer ViewLayer.DiffDir is given twice
! retex-denoise: error: a.exr has no layer nothing
! retex-denoise: error: a.exr has no layer nothing
! retex-denoise: error: small.exr has no layer ViewLayer.Combined, as a.exr has
! retex-denoise: error: two.exr has no layer ViewLayer.Combined, as a.exr has
! retex-denoise: error: cannot read missing.exr: No such file or directory
! retex-denoise: error: a second half tells the noise: a variance is not used with it
! retex-denoise: error: --no-footprints: a.exr is a picture, not a set
! retex-denoise: error: --full-precision: a.exr is a picture, not a set
! retex-denoise: error: a.exr is too large: 120 x 90 pixels, more than the 100 of --max-pixels
! retex-denoise: error: a.exr is the same render as a.exr: the other half needs another seed
$ ls no.exr 2>/dev/null
= 2
$ retex-denoise -q one.exr --other-half small.exr -o no.exr
! retex-denoise: error: small.exr: layer RGB is not 120 x 90 pixels, as in one.exr
= 2
$ retex-denoise -q a.exr -o no.png
! retex-denoise: error: no.png: a denoised picture is an OpenEXR file, .exr, as a.exr is
= 2
$ make_set s.exr 32 24 denoise
$ retex-denoise -q s.exr --layer beauty -o no.exr
! retex-denoise: error: --layer is for pictures: s.exr is a set, or no OpenEXR file
= 2
$ retex-denoise -q a.exr -o a.exr
! retex-denoise: error: a.exr: the output would replace the set
= 2
$ retex-denoise -q - -o no.exr <a.exr
! retex-denoise: error: standard input is not a set (no `retex` attribute)
= 2
$ ls no.* 2>/dev/null
= 2
$ oiiotool bare.exr --compression dwaa:45 -o dwaa.exr
$ oiiotool bare.exr -otex levels.exr
$ for f in dwaa levels; do retex-denoise -q $f.exr -o no.exr; done
! retex-denoise: error: dwaa.exr: part 0 cannot be copied: its compression, DWA, is not read; `oiiotool IN --compression zip -o OUT` changes it
! retex-denoise: error: levels.exr: part 0 cannot be copied: its levels of detail would be lost
= 2
$ retex-denoise -q bare.exr -o no.retex
! retex-denoise: error: no.retex: a denoised picture is an OpenEXR file, .exr, as bare.exr is
= 2
$ retex-denoise -q bare.exr -o /dev/full
! retex-denoise: error: cannot write /dev/full: No space left on device
= 2
$ RETEX_MAX_MEMORY=2M retex-denoise -q a.exr -o no.exr 2>&1 | sed "s/a picture to denoise/out of memory/"
> retex-denoise: error: out of memory: this takes more than the 2 MB of --max-memory
$ retex-denoise -q --strength 3 --radius 8 a.exr -o o.exr
$ check changed a.exr o.exr
> ViewLayer.Combined.R ViewLayer.Combined.G ViewLayer.Combined.B
$ retex-denoise -q --strength 3 a.exr -o p.exr
$ cmp -s o.exr p.exr
= 1
