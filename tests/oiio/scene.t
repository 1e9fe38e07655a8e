# pov.imageio: scenes through the programs of OpenImageIO. Pictures and sets are those of retex-render.
$ skip-without oiiotool openimageio-tools
$ cp -r "$SCENES/cornell-box/." .
$ mv cornell-box.pov box.pov
$ cp "$SCENES/textures/brick.jpg" .

% # Two sets say the same of themselves, but for bytes of compression.
% same_sets() {
%     for f; do retex-info --json $f.exr | tr ',' '\n' | grep -v file_bytes >$f.txt; done
%     cmp $1.txt $2.txt
% }
% same() { retex-diff "$@" >/dev/null && echo same; }
% errors() { oiiotool "$1" -o no.exr 2>&1 | grep ERROR; }
% warnings() { iinfo -v "$1" | grep warnings; }

# A picture alone is known before it is rendered.
$ iinfo -v 'box.pov?spp=2&width=32&seed=7' | sort
>     channel list: R, G, B
>     chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329
>     colorInteropID: "lin_rec709_scene"
>     oiio:ColorSpace: "Linear"
>     oiio:subimagename: "beauty"
>     retex:layout: "plain"
>     retex:max_depth: 16
>     retex:role: "picture"
>     retex:scene: "box.pov"
>     retex:seed: 7
>     retex:spp: 2
> box.pov?spp=2&width=32&seed=7 :   32 x   32, 3 channel, float pov
$ oiiotool 'box.pov?spp=2&width=32&seed=7' -d half -o a.exr
$ retex-render -q --plain --spp 2 --size 32x32 --seed 7 box.pov -o b.exr
$ same a.exr b.exr
> same
$ oiiotool 'box.pov?spp=2&height=16&filter=gaussian&max_depth=3&crop=4,4,10,8' -d half -o a.exr
$ retex-render -q --plain --spp 2 --size 16x16 --filter gaussian --max-depth 3 --crop 4,4,10,8 box.pov -o b.exr
$ same a.exr b.exr
> same
$ oiiotool 'box.pov?spp=4&size=32x24&denoise=1&threads=1' -d half -o a.exr
$ retex-render -q --plain --spp 4 --size 32x24 --denoise box.pov -o b.exr
$ same a.exr b.exr
> same
$ cat >d.pov <<'END'
+ camera { location -3*z direction z right x up y }
+ #ifndef (C) #declare C = 0; #end
+ light_source { -9*z rgb 1 }
+ #include "ball.inc"
+ END
$ mkdir inc
$ printf 'sphere { 0, clock pigment { rgb C } }\n' >inc/ball.inc
$ oiiotool 'd.pov?include=inc&declare.C=0.5&declare.clock=1&size=16x16&spp=2' -d half -o a.exr
$ retex-render -q --plain -I inc -D C=0.5 -D clock=1 --size 16x16 --spp 2 d.pov -o b.exr
$ same a.exr b.exr
> same

# One side gives the other by the scene's own shape.
$ printf 'camera { location -3*z direction z right 2*x up y }\nsphere { 0, 1 }\n' >wide.pov
$ for o in width=32 height=16 'width=20&height=30'; do
+     iinfo "wide.pov?spp=1&$o" | sed 's/.* : *//'
+ done
> 32 x   16, 3 channel, float pov
> 32 x   16, 3 channel, float pov
> 20 x   30, 3 channel, float pov

# A set: what oiiotool writes of it is the one that retex-render writes, but for bytes of compression.
$ oiiotool 'box.pov?spp=2&size=32x24&targets=Floor,Walls=White+Red' -o a.exr
$ retex-render -q --full-precision --spp 2 --size 32x24 -t Floor -t Walls=White,Red box.pov -o b.exr
$ retex-info --check a.exr
> a.exr: ok
$ same_sets a b
$ grep -c crc32 a.txt | sed 's/^[1-9].*/checksums/'
> checksums
$ for f in a b; do retex-combine -q $f.exr --texture Floor=brick.jpg --texture 'Walls=rgb(.2,.5,.2)' -o $f.png; done
$ cmp a.png b.png
% paper='targets=Floor&layout=paper&orders=2&strict_paper=1'
$ oiiotool "box.pov?spp=2&size=32x24&$paper&no_denoise_data=1&aov=depth,uv&noise=0.5" -o a.exr
$ retex-render -q --full-precision --spp 2 --size 32x24 -t Floor --layout paper --orders 2 --strict-paper \
+     --no-denoise-data --aov depth,uv --noise 0.5 box.pov -o b.exr
$ same_sets a b
$ retex-info --check a.exr
> a.exr: ok

# So is one without noise, one with lamps, finishes or normal maps; lamps alone make a set too.
$ oiiotool 'box.pov?spp=4&size=32x24&targets=Floor&denoise=1' -o a.exr
$ retex-render -q --full-precision --spp 4 --size 32x24 -t Floor --denoise box.pov -o b.exr
$ same_sets a b
$ retex-info --check a.exr
> a.exr: ok
$ oiiotool 'box.pov?spp=2&size=32x24&targets=Floor&lamps=each&light_share=0.3' -o l.exr
$ retex-render -q --full-precision --spp 2 --size 32x24 -t Floor --lamps each --light-share .3 box.pov -o m.exr
$ same_sets l m
$ retex-combine -q l.exr --solo Lamp -o l.png
$ retex-combine -q m.exr --solo Lamp -o m.png
$ cmp l.png m.png
$ oiiotool 'box.pov?spp=2&size=32x24&targets=Floor&finishes=Floor=original+polished&show=Floor=polished' -o l.exr
$ retex-render -q --full-precision --spp 2 --size 32x24 --finish Floor=original,polished --show Floor=polished box.pov \
+     -o m.exr
$ same_sets l m
$ retex-combine -q m.exr --finish Floor=original -o m.exr.exr
$ retex-pack -q --lossless m.exr -o m.retex
$ oiiotool 'm.retex?finish:floor=Original' -d half -o y.exr
$ retex-diff -q m.exr.exr y.exr --fail-psnr 90
$ oiiotool 'box.pov?show=Floor=matt' -o y.exr 2>&1 | grep ERROR
> oiiotool ERROR: read : "box.pov?show=Floor=matt": show chooses among finishes, of which there are none
$ cp "$SCENES/textures/brick.jpg" n_nor_dx.jpg
$ oiiotool 'box.pov?spp=2&size=32x24&targets=Floor&finishes=Floor=normals' -o l.exr
$ retex-render -q --full-precision --spp 2 --size 32x24 --finish Floor=normals box.pov -o m.exr
$ same_sets l m
$ retex-pack -q --lossless m.exr -o m.retex
$ retex-combine -q m.exr --texture:normal=n_nor_dx.jpg Floor=tan -o n.exr
$ oiiotool 'm.retex?Floor=tan&Floor.normal=n_nor_dx.jpg' -d half -o y.exr
$ retex-diff -q n.exr y.exr --fail-psnr 90
$ oiiotool 'box.pov?spp=2&size=32x24&lamps=Bulb=Lamp' -o l.exr
$ retex-info l.exr | grep -i 'bulb\|targets'
> parameter Bulb

# Packs take textures, and a scene has planes of further values.
$ retex-pack -q a.exr -o a.retex
$ retex-combine -q a.retex --texture Floor=brick.jpg -o x.exr
$ oiiotool 'a.retex?Floor=brick.jpg' -d half -o y.exr
$ same x.exr y.exr
> same
$ iinfo -a 'box.pov?spp=1&size=16x12&aov=depth,normal'
> box.pov?spp=1&size=16x12&aov=depth,normal :   16 x   12, 3 channel, float pov (3 subimages)

# A flag that is set to 0 is not set: numbers of images.
$ for p in '' '&plain=0' '&plain=1' '&plain=1&no_ambient=0'; do
+     oiiotool -a "box.pov?spp=1&size=8x8&targets=Floor$p" -o flag.exr 2>err
+     oiiotool --info -a flag.exr | grep -c ' subimage '
+ done | xargs
> 22 22 0 0

# What is wrong with options.
$ oiiotool 'box.pov?aov=smell' -o no.exr 2>&1 | sed -n '/ERROR/s/expected beauty, [a-z_, ]*, not/expected LIST, not/p'
> oiiotool ERROR: read : "box.pov?aov=smell": aov: expected LIST, not `smell`
$ for o in sppp=2 spp=many spp=0 width=0 size=3 'size=8x8&width=8' targets=Nope targets=Floor,, crop=0,0,900,900 \
+     plain=2 clusters=99 'layout=paper&clusters=3' 'denoise=1&spp=1' 'denoise=1&no_denoise_data=1' lamps=Nope \
+     lamps=each,, 'lamps=each&layout=paper' light_share=2 threads=x declare.A=1/3 threads=999; do
+     errors "box.pov?$o"
+ done
> oiiotool ERROR: read : "box.pov?sppp=2": there is no option 'sppp'; there are targets, lamps, light_share, finishes, show, spp, noise, size, width, height, crop, seed, max_depth, filter, layout, clusters, orders, strict_paper, plain, aov, denoise, no_denoise_data, caustics_guide, include, declare.NAME, caustics, no_caustics, ambient, no_ambient, lenient, strict, safe and threads
> oiiotool ERROR: read : "box.pov?spp=many": spp: expected a whole number from 1 to 1048576, not 'many'
> oiiotool ERROR: read : "box.pov?spp=0": spp: expected a whole number from 1 to 1048576, not '0'
> oiiotool ERROR: read : "box.pov?width=0": width: expected a whole number from 1 to 65536, not '0'
> oiiotool ERROR: read : "box.pov?size=3": size: expected WxH, not `3`
> oiiotool ERROR: read : "box.pov?size=8x8&width=8": size says it all: no width or height beside it
> oiiotool ERROR: read : "box.pov?targets=Nope": no texture, pigment, material or object `Nope` in the scene; there are: Floor, White, Red, Green, Lamp
> oiiotool ERROR: read : "box.pov?targets=Floor,,": targets: an empty name in 'Floor,,'
> oiiotool ERROR: read : "box.pov?crop=0,0,900,900": crop does not lie inside the picture of 640x640
> oiiotool ERROR: read : "box.pov?plain=2": plain: expected a whole number from 0 to 1, not '2'
> oiiotool ERROR: read : "box.pov?clusters=99": clusters: expected 2 to 16, at least one sharp and one broad, not `99`
> oiiotool ERROR: read : "box.pov?layout=paper&clusters=3": layout paper has no clusters: one of them
> oiiotool ERROR: read : "box.pov?denoise=1&spp=1": denoise needs two samples a pixel at least: one does not tell how noisy it is
> oiiotool ERROR: read : "box.pov?denoise=1&no_denoise_data=1": denoise reads what no_denoise_data leaves out: one of them
> oiiotool ERROR: read : "box.pov?lamps=Nope": no lamp `Nope`: nothing that shines has that name; nearest: Lamp; --list-lamps lists what there is
> oiiotool ERROR: read : "box.pov?lamps=each,,": lamps: an empty name in 'each,,'
> oiiotool ERROR: read : "box.pov?lamps=each&layout=paper": layout paper keeps no lamps apart
> oiiotool ERROR: read : "box.pov?light_share=2": light-share: expected a number from 0 to 1, not '2'
> oiiotool ERROR: read : "box.pov?threads=x": threads: expected a whole number from 0 to 256, not 'x'
> oiiotool ERROR: read : "box.pov?declare.A=1/3": declare.A: expected NAME=NUMBER or NAME="TEXT", not `A=1/3`
> oiiotool ERROR: read : "box.pov?threads=999": threads: expected a whole number from 0 to 256, not '999'

# What is no scene; one that is its own texture.
$ cat >bad.pov <<'END'
+ sphere { 0, 1
+   nonsense
+ }
+ END
$ : >empty.pov
$ head -c 1000 /dev/zero >zero.pov
$ cat >self.pov <<'END'
+ camera { location -z }
+ plane { z, 1 pigment { image_map { png "self.pov" } } }
+ END
$ for f in bad empty zero none self; do iinfo $f.pov; done
! iinfo ERROR: "bad.pov" : bad.pov:2:3: expected an object modifier or }, found `nonsense`, which is not declared
! iinfo ERROR: "empty.pov" : empty.pov: no .pov file: it is empty
! iinfo ERROR: "zero.pov" : zero.pov: no .pov file by what is in it
! iinfo ERROR: "none.pov" : cannot read none.pov: No such file or directory
! iinfo ERROR: "self.pov" : self.pov:3:1: self.pov:2: image_map: self.pov: cannot read: a scene cannot be a texture of a scene
= 1
$ for f in bad empty zero none self; do errors $f.pov; done
> oiiotool ERROR: read : bad.pov:2:3: expected an object modifier or }, found `nonsense`, which is not declared
> oiiotool ERROR: read : empty.pov: no .pov file: it is empty
> oiiotool ERROR: read : zero.pov: no .pov file by what is in it
> oiiotool ERROR: read : File does not exist: "none.pov"
> oiiotool ERROR: read : self.pov:3:1: self.pov:2: image_map: self.pov: cannot read: a scene cannot be a texture of a scene

# What is strange in a scene is told.
$ cat >c.pov <<'END'
+ camera { location -3*z }
+ light_source { -9*z rgb 1 }
+ sphere { 0, 1 pigment { rgb 1 } }
+ #warning "mind"
+ END
$ warnings 'c.pov?spp=1&size=8x6'
>     retex:warnings: "c.pov:4: warning: mind"
$ cat >dark.pov <<'END'
+ camera { location -3*z }
+ sphere { 0, 1 pigment { rgb 1 } finish { ambient 0 } }
+ END
$ warnings 'dark.pov?spp=1&size=8x6'
>     retex:warnings: "dark.pov: warning: no light source, nothing that shines and no sky: the picture will be black"
$ echo '#version 3.7; global_settings { assumed_gamma 1 } background { rgb <.25,.5,1> }' >blue.pov
$ warnings 'blue.pov?spp=1&size=8x6'
>     retex:warnings: "blue.pov: warning: no object in the scene"
$ oiiotool 'blue.pov?spp=1&size=8x6' --printstats | grep -E 'Stats (Min|Max)' | sed 's/^ *//'
> Stats Min: 0.250000 0.500000 1.000000 (float)
> Stats Max: 0.250000 0.500000 1.000000 (float)

# A view that cannot be shown: an error, or a warning.
$ cat >own.pov <<'END'
+ #version 3.7; camera { user_defined { location { function { 0 } } } }
+ light_source { -9*z rgb 1 }
+ sphere { 4 * z, 1 pigment { rgb 1 } }
+ END
$ errors own.pov
> oiiotool ERROR: read : own.pov:1:24: `user_defined` is not supported yet; with --lenient, a perspective camera is used
$ warnings 'own.pov?lenient=1&spp=1&size=8x6'
>     retex:warnings: "own.pov:1: warning: `user_defined` is not supported yet: a perspective camera is used"
