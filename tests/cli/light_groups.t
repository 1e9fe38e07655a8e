# retex-import of pictures with light groups, as Blender writes them: a set with a lamp for each.
$ skip-unless /usr/bin/python3 -c 'import numpy, OpenImageIO'
$ /usr/bin/python3 "$TESTS/light_groups.py" make
$ retex-import -v a.exr -o g.exr
! retex-import: guides: normal ViewLayer.Denoising Normal, albedo ViewLayer.Denoising Albedo
! retex-import: 2 light groups; 31.84% of the light is of none, and is the lamp rest
! retex-import: g.exr: 96 x 64, 3 lamps
$ retex-info g.exr | grep -A2 ^param
> parameter Fill Light
>   as rendered  1 1 1
>   light        of several colours, which a new one multiplies
> parameter Key
>   as rendered  1 1 1
>   light        of several colours, which a new one multiplies
> parameter rest
>   as rendered  1 1 1
>   light        of several colours, which a new one multiplies
$ retex-info --check g.exr
> g.exr: ok

# Lamps are the layers, and add up to the picture; other light is other sums of layers. Names in any case.
% # The lamps of SET, each alone, add up to its picture.
% add() {
%     retex-combine -q $1 -o w.pfm
%     for n in Key "Fill Light" rest; do retex-combine -q $1 --solo "$n" -o "$n.pfm"; done
%     /usr/bin/python3 "$TESTS/light_groups.py" sum w.pfm Key.pfm "Fill Light.pfm" rest.pfm
% }
$ add g.exr
> equal
$ /usr/bin/python3 "$TESTS/light_groups.py" layers a.exr w.pfm=Combined Key.pfm=Combined_Key \
+     "Fill Light.pfm=Combined_Fill Light"
> w.pfm equal
> Key.pfm equal
> Fill Light.pfm equal
$ retex-combine -q g.exr --light key=2 -o key.pfm
$ retex-combine -q g.exr --light 'Fill Light=.25' --light rest=1 --light '*=0' -o fill.pfm
$ /usr/bin/python3 "$TESTS/light_groups.py" layers a.exr key.pfm=Combined+Combined_Key \
+     'fill.pfm=Combined+Combined_Key*-1+Combined_Fill Light*-.75'
> key.pfm equal
> fill.pfm equal

# Denoised they add up as well, by the noise of one render or of two, also where a lamp is below 0; each has less noise.
$ retex-import -q a.exr --other-half b.exr -o h.exr
$ retex-import filtered.exr -o f.exr
! retex-import: f.exr: 96 x 64, 3 lamps
$ retex-import unlike.exr -o u.exr
! retex-import: the light groups are brighter than the picture, by 8.8%: the lamp rest is below 0 there, as after denoising or clamping
! retex-import: u.exr: 96 x 64, 3 lamps
$ for f in g h f u; do
+     add $f.exr
+     retex-denoise -q $f.exr --full-precision -o d.exr
+     add d.exr
+ done
> equal
> equal
> equal
> equal
> equal
> equal
> equal
> equal
$ retex-denoise -q h.exr -o d.exr
$ retex-import -q truth.exr -o t.exr
$ for n in Key 'Fill Light'; do
+     for f in h d t; do retex-combine -q $f.exr --solo "$n" -o $f.pfm; done
+     /usr/bin/python3 "$TESTS/light_groups.py" gain d.pfm h.pfm t.pfm
+ done
> less noise
> less noise
$ for n in 1 3; do
+     retex-import -q --threads $n a.exr -o $n.exr
+     cmp g.exr $n.exr
+ done
$ retex-import -q a.exr -o - | retex-combine -q - --light Key=2 -o p.pfm
$ cmp p.pfm key.pfm
$ retex-info g.exr --layers l.exr
$ oiiotool --info -v l.exr | grep channel.list
>     channel list: R, G, B, indep.R, indep.G, indep.B, lamp_Fill Light.R, lamp_Fill Light.G, lamp_Fill Light.B, lamp_Key.R, lamp_Key.G, lamp_Key.B, lamp_rest.R, lamp_rest.G, lamp_rest.B

# Names that lamps cannot have, view layers, and what is refused.
$ retex-import -q two.exr --layer b.Combined -o x.exr
$ retex-info x.exr | grep ^param
> parameter x_y
> parameter rest
$ rm x.exr
$ retex-import two.exr -o x.exr
! retex-import: error: two.exr has several pictures, a.Combined and b.Combined: choose by --layer
= 2
$ retex-import many.exr -o x.exr
! retex-import: error: many.exr has more than 16 light groups, as many as a set may have lamps
= 2
$ retex-import none.exr -o x.exr
! retex-import: error: none.exr has no light groups: no layer a.Combined_NAME
= 2
$ retex-import taken.exr -o x.exr
! retex-import: error: taken.exr: a light group is called Rest, as lamps call all other light: rename it
= 2
$ retex-import a.exr --other-half a.exr -o x.exr
! retex-import: error: a.exr is the same render as a.exr: the other half needs another seed
= 2
$ retex-import a.exr --other-half truth.exr --scale 2 -o x.exr
! retex-import: error: --scale is for models: a.exr is a picture
= 2
$ retex-import a.exr -o x.png
! retex-import: error: -o x.png: a picture with light groups becomes a set: expected a name that ends in .exr
= 2
$ retex-import a.exr -o a.exr
! retex-import: error: a.exr: the output would replace the model
= 2
$ retex-import --max-pixels 1000 a.exr -o x.exr
! retex-import: error: a.exr is too large: 96 x 64 pixels, more than the 1000 of --max-pixels
= 2
$ retex-import g.exr -o x
! retex-import: error: g.exr: No suitable reader found for the file format of file "g.exr".
= 2
$ ls x.exr
! ls: cannot access 'x.exr': No such file or directory
= 2
$ printf 'v 0 0 0\n' >m.obj
$ retex-import m.obj --layer Combined -o x
! retex-import: error: --layer is for pictures with light groups: m.obj is no OpenEXR picture
= 2
