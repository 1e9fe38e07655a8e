# Colours of EXR pictures are named in their headers wherever one is written, and followed where one is read; and
# channels have names that other programs know.
$ skip-without iinfo openimageio-tools
$ make_set s.exr 48 32
$ cp "$SCENES/textures/brick.jpg" .
$ retex-combine -q s.exr --texture Floor=brick.jpg -o linear.exr
$ iinfo -v linear.exr | sed -n "s/^ *\(colorInteropID\|chromaticities\): /\1 /p"
> chromaticities 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329
> colorInteropID "lin_rec709_scene"
$ for space in ACEScg ACES2065-1 sRGB ACEScct Rec709 raw; do
+     retex-combine -q s.exr --texture Floor=brick.jpg --colorspace $space -o $space.exr
+     echo $space
+     iinfo -v $space.exr | sed -n 's/^ *\(colorInteropID\|chromaticities\): /\1 /p'
+ done
> ACEScg
> chromaticities 0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767
> colorInteropID "lin_ap1_scene"
> ACES2065-1
> chromaticities 0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767
> colorInteropID "lin_ap0_scene"
> sRGB
> colorInteropID "srgb_rec709_scene"
> ACEScct
> colorInteropID "ocio:acescct_ap1_scene"
> Rec709
> raw
> colorInteropID "data"
$ printf 'output,Floor\nbatch.exr,brick.jpg\n' >b.csv
$ retex-combine -q s.exr --batch b.csv --colorspace ACEScg
$ cmp batch.exr ACEScg.exr
$ retex-combine -q s.exr >stream.exr
$ retex-render -q --plain --size 32x24 --spp 1 "$SCENES/cornell-box/cornell-box.pov" -o plain.exr
$ for f in s stream plain; do iinfo -v $f.exr | sed -n "s/^ *colorInteropID: /$f /p"; done
> s "lin_rec709_scene"
> stream "lin_rec709_scene"
> plain "lin_rec709_scene"
$ retex-render -q --size 32x24 --spp 1 --aov albedo,normal,uv --aov-dir aov "$SCENES/cornell-box/cornell-box.pov" \
+     -o a.exr
$ for f in beauty albedo normal uv; do iinfo -v aov/$f.exr | sed -n "s/^ *colorInteropID: /$f /p"; done
> beauty "lin_rec709_scene"
> albedo "lin_rec709_scene"
> normal "data"
> uv "data"
$ iinfo -v -a a.exr | sed -n 's/^ *\(colorInteropID\|oiio:subimagename\): //p' | paste - - | sort
> "data"	"normal"
> "data"	"uv"
> "lin_rec709_scene"	"albedo"
> "lin_rec709_scene"	"beauty"

# The same picture, whatever it was written in.
$ for f in ACEScg ACES2065-1 sRGB ACEScct; do retex-combine -q s.exr --texture Floor=$f.exr -o $f-on.exr; done
$ retex-combine -q s.exr --texture Floor=linear.exr -o on.exr
$ for f in ACEScg ACES2065-1 sRGB ACEScct; do retex-diff -q on.exr $f-on.exr --fail-psnr 90 || echo $f; done
$ retex-combine -q s.exr --texture:colorspace=linear Floor=ACEScg.exr -o x.exr
$ retex-diff -q on.exr x.exr --fail-psnr 80
= 1

# UV for other programs: U, V and A, on the way through packs too.
$ retex-render -q --size 32x24 --spp 2 -t Floor --aov uv,depth,normal "$SCENES/cornell-box/cornell-box.pov" -o a.exr
$ retex-pack -q --lossless a.exr -o a.retex
$ retex-pack -q --unpack a.retex -o b.exr
$ retex-denoise -q a.exr -o d.exr
$ for f in a b d; do iinfo -v -a $f.exr | grep 'channel list: \(uv\|depth\|normal\)\.'; done
>     channel list: depth.R
>     channel list: normal.R, normal.G, normal.B
>     channel list: uv.A, uv.U, uv.V
>     channel list: depth.R
>     channel list: normal.R, normal.G, normal.B
>     channel list: uv.A, uv.U, uv.V
>     channel list: depth.R
>     channel list: normal.R, normal.G, normal.B
>     channel list: uv.A, uv.U, uv.V
$ for f in b d; do retex-diff -q --part uv a.exr $f.exr || echo $f; done
$ retex-diff -q --part uv a.retex a.exr
$ retex-combine -q a.retex --texture Floor=brick.jpg -o x.exr
$ oiiotool a.exr --subimage uv --ch uv.U,uv.V,uv.A --printstats | sed -n 's/ *Stats \(Min\|Max\)/\1/p'
> Min: -0.996351 -0.853927 1.000000 (float)
> Max: 0.996351 1.992549 1.000000 (float)

# $OCIO's displays and views, by name: two displays, of which each has two views.
$ cat >two.ocio <<'END'
+ ocio_profile_version: 2
+ roles: {default: lin, scene_linear: lin, data: lin}
+ file_rules:
+   - !<Rule> {name: Default, colorspace: default}
+ displays:
+   One:
+     - !<View> {name: Plain, colorspace: lin}
+     - !<View> {name: Half, colorspace: half}
+   Two:
+     - !<View> {name: Plain, colorspace: quarter}
+     - !<View> {name: Half, colorspace: eighth}
+ colorspaces:
+   - !<ColorSpace> {name: lin}
+ END
$ for c in 'half 2' 'quarter 4' 'eighth 8'; do
+     set -- $c
+     printf '  - !<ColorSpace>\n    name: %s\n' $1
+     printf '    to_scene_reference: !<MatrixTransform> {matrix: [%s,0,0,0, 0,%s,0,0, 0,0,%s,0, 0,0,0,1]}\n' $2 $2 $2
+ done >>two.ocio
% show() {
%     OCIO=two.ocio retex-combine -q s.exr --texture 'floor=rgb(0.2,0.1,0.05)' --texture 'wall=rgb(0.05,0.1,0.2)' "$@" \
%         -o shown.tif
%     oiiotool shown.tif --printstats | sed -n 's/ *Stats Avg: \([0-9.]*\).*/\1/p'
% }
$ for o in '' '--display Two' '--view Half' '--display Two --view Half'; do show $o; done |
+     awk 'NR == 1 { whole = $1 } { printf "%.3f\n", $1 / whole }'
> 1.000
> 0.250
> 0.500
> 0.125
