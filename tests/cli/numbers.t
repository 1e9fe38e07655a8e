# Numbers that are no colour: sets, packs and streams with NaN or infinity are refused by every reader, whole or row by
# row, and nothing is written; but depth may be infinite.
$ make_set s.exr 48 32
$ make_set nan.exr 48 32 t0_dep1=nan
$ retex-info nan.exr | head -1
> layout         paper
$ for command in 'retex-combine -q nan.exr -o x.exr' "retex-combine -q nan.exr --texture Floor=rgb(1,0,0) -o x.png" \
+     'retex-pack -q nan.exr -o x.retex' 'retex-pack -q --lossless nan.exr -o x.retex' 'retex-info --check nan.exr' \
+     'retex-combine -q - -o x.exr'; do
+     $command <nan.exr
+     echo $?
+ done
> 2
> 2
> 2
> 2
> 1
> 2
! retex-combine: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-combine: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-info: error: nan.exr: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
! retex-combine: error: standard input: part t0_dep1 holds NaN at 5,3 in channel B: such values are refused
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2
$ for part in beauty t0_dep2 t0_uv1 t0_spread1 t0_albedo1 t1_dep1; do
+     make_set nan.exr 48 32 $part=-inf
+     retex-pack -q --lossless nan.exr -o x.retex
+ done
! retex-pack: error: nan.exr: part beauty holds -infinity at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_dep2 holds -infinity at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t0_uv1 holds -infinity at 5,3 in channel A: such values are refused
! retex-pack: error: nan.exr: part t0_spread1 holds -infinity at 5,3 in channel G: such values are refused
! retex-pack: error: nan.exr: part t0_albedo1 holds -infinity at 5,3 in channel B: such values are refused
! retex-pack: error: nan.exr: part t1_dep1 holds -infinity at 5,3 in channel B: such values are refused
= 2
$ make_set inf.exr 48 32 depth=inf
$ retex-combine -q inf.exr -o y.exr
$ retex-pack -q --lossless inf.exr -o y.retex
$ retex-info --check inf.exr
> inf.exr: ok
$ retex-info --check y.retex
> y.retex: ok
$ make_set nan.exr 48 32 depth=nan
$ retex-info --check nan.exr
! retex-info: error: nan.exr: part depth holds NaN at 5,3 in channel R: such values are refused
= 1
$ make_set nan.exr 48 32 footprints denoise noise_indep=nan
$ retex-denoise -q nan.exr -o x.exr
! retex-denoise: error: nan.exr: part noise_indep holds NaN at 5,3 in channel B: such values are refused
= 2
$ make_set nan.exr 48 32 t0_dep1=nan
$ retex-diff nan.exr s.exr --part t0_dep1 --fail-psnr 1 | sed 's/.*: //'
> 1 samples are NaN or infinite

# Textures: texels that are no colour are mended, and mentioned; an albedo that is none too.
$ skip-without oiiotool openimageio-tools
$ cp "$SCENES/cornell-box/cornell-box.pov" box.pov
$ cp -r "$SCENES/cornell-box/textures" .
$ retex-render -q --size 32x24 --spp 2 -t Floor box.pov -o t.exr
$ oiiotool --pattern constant:color=5,4,3 16x16 3 -d float -o five.exr
$ oiiotool --pattern constant:color=3e38,3e38,3e38 16x16 3 -d float -o big.exr
$ oiiotool --pattern constant:color=.5,.5,.5 16x16 3 --fill:color=-1,.5,.5 2x2+3+4 -d float -o minus.exr
$ make_picture nan.exr nan
$ for texture in five.exr big.exr minus.exr nan.exr 'rgb(255,128,0)'; do
+     retex-combine -q t.exr --texture "Floor=$texture" -o o.exr
+     retex-diff -q o.exr o.exr || echo not finite
+ done
! retex-combine: warning: five.exr: 256 texels of 256 brighter than white, up to 5, the first at 0,0: a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly
! retex-combine: warning: big.exr: 256 texels beyond 65504, the first at 0,0: taken as that
! retex-combine: warning: minus.exr: 4 texels with negative colours, the first at 3,4: kept, for colours of wide gamuts have them
! retex-combine: warning: nan.exr: 1 texel not finite, the first at 32,20: taken as black
! retex-combine: warning: Floor=rgb(255,128,0): a surface of a colour above 1 gives back more light than it gets; if numbers from 0 to 255 are meant, it is rgb(1,0.216,0)
$ retex-sample -q t.exr --texture Floor=big.exr -o o.exr
! retex-sample: warning: big.exr: 256 texels beyond 65504, the first at 0,0: taken as that
$ retex-combine -q t.exr o.exr -o p.exr
$ retex-diff -q p.exr p.exr
$ cat >b.csv <<'END'
+ output,Floor
+ a.png,five.exr
+ b.png,five.exr
+ c.png,"rgb(2,2,2)"
+ END
$ retex-combine -q t.exr --batch b.csv
! retex-combine: warning: five.exr: 256 texels of 256 brighter than white, up to 5, the first at 0,0: a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly; and 1 more warning, which -q hides
$ retex-combine -qv t.exr --batch b.csv 2>&1 | grep warning | sed 's/^/! /'
> ! retex-combine: warning: five.exr: 256 texels of 256 brighter than white, up to 5, the first at 0,0: a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly
> ! retex-combine: warning: Floor=rgb(2,2,2): a surface of a colour above 1 gives back more light than it gets
$ retex-render -q --plain --size 16x12 --spp 1 --replace Floor=nan.exr box.pov -o p.exr
! retex-render: warning: nan.exr: 1 texel not finite, the first at 32,20: taken as black
$ retex-diff -q p.exr p.exr
$ printf 'output,Floor\na.exr,five.exr\n' >b.csv
$ retex-render -q --size 16x12 --spp 1 -t Floor --variants b.csv box.pov
! retex-render: warning: five.exr: 256 texels of 256 brighter than white, up to 5, the first at 0,0: a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly
$ for space in sRGB ACEScg; do
+     retex-combine -q t.exr --texture:colorspace=$space Floor=textures/encaustic-tiles.jpg -o o.exr
+ done
! retex-combine: warning: textures/encaustic-tiles.jpg: 181364 texels with negative colours, the first at 1,1: kept, for colours of wide gamuts have them
$ retex-combine -q t.exr --texture Floor=big.exr --error e.exr -o o.exr
! retex-combine: warning: big.exr: 256 texels beyond 65504, the first at 0,0: taken as that
$ retex-diff -q e.exr e.exr
$ oiiotool five.exr --mulc 0.19 -o one.exr
$ retex-combine -q t.exr --texture Floor=one.exr -o o.exr

# Images and pigments of scenes.
$ cat >s.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 }
+ camera { location -5*z look_at 0 }
+ light_source { -9*z rgb 1 }
+ sphere { 0, 1 pigment { rgb <255,128,0> } }
+ sphere { x, 1 pigment { image_map { exr "five.exr" } } }
+ sphere { y, 1 pigment { image_map { exr "five.exr" } } finish { emission 1 } }
+ sphere { -y, 1 pigment { rgb 9 } finish { emission 1 } }
+ sky_sphere { pigment { image_map { exr "nan.exr" map_type 1 } } }
+ END
$ retex-render -q --plain --size 16x12 --spp 1 s.pov -o p.exr
! retex-render: s.pov:5: warning: image_map: five.exr: 256 texels of 256 brighter than white, up to 5, the first at 0,0: a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly
! retex-render: s.pov:8: warning: image_map: nan.exr: 1 texel not finite, the first at 32,20: taken as black
! retex-render: s.pov:4: warning: a surface of rgb <255,128,0> gives back more light than it gets: colours go from 0 to 1, not to 255
$ retex-diff -q p.exr p.exr
