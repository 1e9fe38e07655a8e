# Colours that textures state: ICC profiles, PNG's chunks, OpenEXR's attributes. profiles.py writes the files, and what
# they are in scene-linear Rec.709 by published matrices. The tolerance is the rounding of those to 5 digits.
$ /usr/bin/python3 "$TESTS/profiles.py"
$ make_set s.exr 48 32
$ ls *.expected.exr | wc -l
> 18
$ for e in *.expected.exr; do
+     n=${e%.expected.exr}
+     p=$(ls $n.png $n.tif 2>/dev/null)
+     [ -z "$p" ] || retex-diff $p $e --fail-abs 0.0005 | sed "s/^/$p: /" | grep differ
+ done
= 1
$ retex-diff -q adobe-j.jpg adobe-j.expected.exr --fail-psnr 40

# The same as textures, through 16-bit integers and floats; of those with sRGB profiles, the bytes of those without.
$ for e in adobe adobe16 p3 grey cicp cicp-2020 gamma primaries adobe-t float-f; do
+     p=$(ls $e.png $e.tif 2>/dev/null)
+     retex-combine -q s.exr --texture Floor=$p -o a.exr
+     retex-combine -q s.exr --texture Floor=$e.expected.exr -o b.exr
+     retex-diff -q a.exr b.exr --fail-psnr 70 || echo $p
+     retex-combine -q s.exr --texture Floor=none.png -o c.exr
+     retex-diff -q a.exr c.exr --fail-psnr 56 && echo "$p is as none"
+ done 2>err
= 1
$ grep -v 'with negative colours' err
= 1
$ retex-combine -q s.exr --texture Floor=none.png -o none.exr
$ for n in srgb srgb-first gamma-srgb; do
+     retex-combine -q s.exr --texture Floor=$n.png -o x.exr
+     cmp x.exr none.exr
+ done
$ for n in srgb plain; do retex-combine -q s.exr --texture Floor=$n-j.jpg -o $n.exr; done
$ cmp srgb.exr plain.exr

# Who names a space is believed.
$ for f in adobe.png p3.png cicp.png gamma.png bad-cut.tif; do
+     retex-combine -q s.exr --texture:colorspace=sRGB Floor=$f -o x.exr
+     cmp x.exr none.exr
+ done
$ retex-combine -q s.exr --texture:colorspace=linear Floor=adobe.png -o x.exr
$ retex-combine -q s.exr --texture:colorspace=linear Floor=none.png -o y.exr
$ cmp x.exr y.exr

# With --safe, too.
$ for f in adobe.png adobe-j.jpg adobe-t.tif cicp.png; do
+     retex-combine -q s.exr --texture Floor=$f -o x.exr 2>err
+     retex-combine -q --safe s.exr --texture Floor=$f -o y.exr 2>>err
+     cmp x.exr y.exr
+ done
$ grep -v 'with negative colours' err
= 1

# What is stated wrongly is said, and not followed.
$ (echo output,Floor; for f in bad-*; do echo x-$f.exr,$f; done) >bad.csv
$ retex-combine s.exr --batch bad.csv 2>&1 | sed '/ <- /d; / pictures, /d'
> retex-combine: warning: bad-cicp-short.png: its chunk cICP is damaged; its colours are taken as sRGB
> retex-combine: warning: bad-cicp.png: its chunk cICP names colours that cannot be converted, 9/16/0/1; its colours are taken as sRGB
> retex-combine: warning: bad-cmyk.png: its ICC profile is damaged, or not for its colours; its colours are taken as sRGB
> retex-combine: warning: bad-cut.tif: its ICC profile is damaged; its colours are taken as sRGB
> retex-combine: warning: bad-gamma.png: its chunk gAMA is damaged; its colours are taken as sRGB
> retex-combine: warning: bad-kind.tif: its ICC profile is for colours of another kind, GRAY; its colours are taken as sRGB
> retex-combine: warning: bad-noise-f.tif: its ICC profile is damaged; its colours are taken as scene-linear
> retex-combine: warning: bad-noise.tif: its ICC profile is damaged; its colours are taken as sRGB
> retex-combine: warning: bad-primaries.png: its chunk cHRM has primaries that span no colour space; its colours are taken as sRGB
> retex-combine: warning: bad-tags.jpg: its ICC profile is damaged; its colours are taken as sRGB
$ for f in x-bad-*.png.exr; do cmp $f none.exr; done
$ (echo output,Floor; for f in hurt-*; do echo $f.exr,$f; done) >hurt.csv
$ retex-combine s.exr --batch hurt.csv 2>&1 |
+     sed -e 's/^retex-combine: warning: hurt-[0-9]*.tif: its ICC profile is .*; its colours are taken as sRGB$//' \
+         -e 's/^retex-combine: warning: hurt-.*: [0-9]* texels* .*//' -e '/ <- /d; / pictures, /d' -e '/^$/d'
$ for f in $(sed '1d; s/,.*//' hurt.csv); do test -e $f || echo $f; done
$ cat >m.pov <<'END'
+ #version 3.7;
+ camera{location -3*z}
+ light_source{-3*z,1}
+ plane{z,0 pigment{image_map{tiff "bad-cut.tif"}}}
+ END
$ retex-render -q --size 8x6 --spp 1 --plain m.pov -o x.exr
! retex-render: m.pov:4: warning: image_map: bad-cut.tif: its ICC profile is damaged; its colours are taken as sRGB

# OpenEXR: what no configuration knows, and OpenImageIO's name of the space.
$ oiiotool --pattern constant:color=.7,.25,.1 8x8 3 -d float --attrib colorInteropID studio:ours -o unknown.exr
$ oiiotool unknown.exr --attrib:type=float[8] chromaticities .713,.293,.165,.83,.128,.044,.32168,.33767 -o known.exr
$ oiiotool unknown.exr --eraseattrib colorInteropID --attrib oiio_ColorSpace ACEScg -o name.exr
$ sed -i 's/oiio_ColorSpace/oiio:ColorSpace/g' name.exr
$ oiiotool unknown.exr --eraseattrib colorInteropID --attrib:type=float[8] chromaticities .3,.3,.3,.3,.3,.3,.3127,.329 \
+     -o odd.exr
$ oiiotool --pattern constant:color=1.029762,.192967,.066253 8x8 3 -d float -o cg.exr
$ for f in unknown known name odd; do retex-combine -q s.exr --texture Floor=$f.exr -o x-$f.exr; done
! retex-combine: warning: unknown.exr: its header names the colour space 'studio:ours', which is not known; its colours are taken as scene-linear Rec.709
! retex-combine: warning: known.exr: its header names the colour space 'studio:ours', which is not known; the colours are taken by its chromaticities
! retex-combine: warning: odd.exr: the chromaticities in its header span no colour space; its colours are taken as scene-linear Rec.709
$ retex-combine -q s.exr --texture Floor=cg.exr -o cg-on.exr
$ for f in known name; do retex-diff -q x-$f.exr cg-on.exr --fail-psnr 80 || echo $f; done
$ cmp x-unknown.exr x-odd.exr

# Little CMS's own program gives the same.
$ skip-without transicc liblcms2-utils
$ set -- $(echo 200 90 30 | transicc -n -t1 -i adobe.icc -o '*sRGB' 2>&1 | tail -n 1)
+ oiiotool --pattern constant:color=$(awk "BEGIN{print $1/255 \",\" $2/255 \",\" $3/255}") 8x8 3 -d float -o by-lcms.exr
$ retex-combine -q s.exr --texture:colorspace=sRGB Floor=by-lcms.exr -o a.exr
$ retex-combine -q s.exr --texture Floor=patch.png -o b.exr
$ retex-diff -q a.exr b.exr --fail-psnr 70
