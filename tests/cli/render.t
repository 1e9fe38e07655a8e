# retex-render: errors of usage and of scenes, with file, line and column; the whole pipe.
$ ln -s "$SCENES" scenes
$ retex-render -q --size 32x24 --spp 2 -t floor scenes/cornell-box/cornell-box.pov -o s.exr
$ retex-info --check s.exr
> s.exr: ok
$ retex-render -q --size 32x24 --spp 2 -t floor scenes/cornell-box/cornell-box.pov |
+     retex-sample -q - --texture floor=scenes/textures/brick.jpg | retex-combine -q - -o y.png
$ retex-combine -q s.exr --texture floor=scenes/textures/brick.jpg -o z.png
$ cmp y.png z.png
$ for n in 1 2 7; do
+     retex-render -q --threads $n --size 32x24 --spp 2 -t floor scenes/cornell-box/cornell-box.pov -o $n.exr
+ done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr
$ cmp 1.exr s.exr
$ rm ?.exr ?.png

$ retex-render
! retex-render: error: no scene given; try --help
= 2
$ retex-render none.pov -o x.exr
! retex-render: error: none.pov: cannot read none.pov: No such file or directory
= 2
$ printf 'sphere { 0, 1\n  pigment { rgb 1 }\n  nonsense\n}\n' >bad.pov; retex-render bad.pov -o x.exr
! retex-render: error: bad.pov:3:3: expected an object modifier or }, found `nonsense`, which is not declared
= 2
$ printf 'camera { location -z }\nbox { 0, 1\n' >open.pov; retex-render open.pov -o x.exr
! retex-render: error: open.pov:3:1: expected an object modifier or }, found the end of the file; the `{` of line 2 is not closed
= 2
$ printf '#declare A = 1;\n#include "missing.inc"\n' >include.pov; retex-render include.pov -o x.exr
! retex-render: error: include.pov:2:10: cannot find the file `missing.inc` in the scene's folder or the include path
= 2
$ printf '#while (1) #end\n' >forever.pov
$ retex-render forever.pov -o x.exr 2>err
= 2
$ grep -c '^retex-render: error: forever.pov:1:' err
> 1
$ retex-render -t Nope scenes/cornell-box/cornell-box.pov -o x.exr
! retex-render: error: no texture, pigment, material or object `Nope` in the scene; there are: Floor, White, Red, Green, Lamp
= 2
$ retex-render --size 0x5 bad.pov -o x.exr
! retex-render: error: --size: expected WxH, not `0x5`
= 2
$ retex-render --crop 1,2 bad.pov -o x.exr
! retex-render: error: --crop: expected X,Y,W,H, not `1,2`
= 2
$ retex-render --spp 0 bad.pov -o x.exr
! retex-render: error: --spp: expected a whole number from 1 to 1048576, not '0'
= 2
$ retex-render --layout cubist scenes/cornell-box/cornell-box.pov -o x.exr
! retex-render: error: --layout: expected footprints or paper, not `cubist`
= 2
$ retex-render --replace floor=none.jpg -q --size 32x24 --spp 1 scenes/cornell-box/cornell-box.pov -o x.exr
! retex-render: error: cannot read none.jpg: No such file or directory
= 2
$ retex-render -q --size 32x24 --spp 1 --plain scenes/cornell-box/cornell-box.pov -o nowhere/x.exr
! retex-render: error: cannot write nowhere/x.exr: No such file or directory
= 2
$ retex-render -q --size 32x24 --spp 1 --plain scenes/cornell-box/cornell-box.pov -o /dev/full
! retex-render: error: cannot write /dev/full: No space left on device
= 2
$ retex-render -q --size 32x24 --spp 1 -t floor scenes/cornell-box/cornell-box.pov >/dev/full
! retex-render: error: cannot write standard output: No space left on device
= 2
$ { sleep 1; retex-render -q --size 32x24 --spp 1 -t floor scenes/cornell-box/cornell-box.pov; echo $? >&2; } | :
! 141
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# An old file is whole after a failure.
$ echo old >old.exr; retex-render bad.pov -o old.exr 2>/dev/null; cat old.exr; ls -A
> old
> bad.pov
> err
> forever.pov
> include.pov
> old.exr
> open.pov
> scenes

# What can be seen to fail is seen before the rendering, which at this size would take minutes.
$ cat >ball.pov <<'END'
+ camera { location -5*z }
+ #declare Ball = texture { pigment { rgb 1 } }
+ sphere { 0, 1 texture { Ball } } light_source { -9*z rgb 1 }
+ END
$ rm -f err
$ set -- --size 2000x2000 --spp 4096 ball.pov
+ timeout 5 retex-render "$@" -o nowhere/x.exr
+ timeout 5 retex-render "$@" -o nowhere/x.png
+ timeout 5 retex-render "$@" -o x.xyz
+ timeout 5 retex-render "$@" -o noending
+ timeout 5 retex-render "$@" -o ball.pov
+ timeout 5 retex-render "$@" -o x.exr --stats nowhere/x.json
! retex-render: error: cannot write nowhere/x.exr: No such file or directory
! retex-render: error: cannot write nowhere/x.png: No such file or directory
! retex-render: error: x.xyz: no picture format that can be written has the ending .xyz; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
! retex-render: error: noending: cannot tell the picture's format: the name has no ending, such as .png or .exr
! retex-render: error: ball.pov: the output would replace the scene
! retex-render: error: --stats: cannot write nowhere/x.json: No such file or directory
= 2
$ OCIO=nowhere timeout 5 retex-render --size 2000x2000 --spp 4096 ball.pov -o x.png 2>err
= 2
$ grep -c "error: x.png: \$OCIO is 'nowhere'" err
> 1
$ retex-render --max-pixels 4000000000 --size 60000x60000 -t ball ball.pov -o x.exr 2>err
= 2
$ grep -c 'error: 60000x60000 pixels need .* GB of memory, there are .*: render parts with --crop' err
> 1

# Statistics to a file or standard output.
$ retex-render -q --size 8x6 --spp 1 ball.pov -o y.exr --stats -  | grep paths
>   "paths": 48,
$ retex-render -q --size 8x6 --spp 1 ball.pov -o - --stats -
! retex-render: error: the output and --stats cannot both be standard output
= 2
$ retex-render -q --size 8x6 --spp 1 ball.pov -o y.exr --stats /dev/full
! retex-render: error: --stats: cannot write /dev/full: No space left on device
= 2
$ retex-render --list-targets --size 8x6 ball.pov -o x.txt
! retex-render: error: --list-targets goes to standard output: no -o
= 2
# Each contribution is of a lamp: light sources, things that shine (too small a mesh for paths to hit), the sky.
$ cat >lamps.pov <<'END'
+ #version 3.7;
+ camera { location <0,3,-6> look_at 0 }
+ light_source { <-3,4,0> 1 }
+ light_source { <3,4,0> 1 spotlight point_at 0 radius 40 falloff 60 }
+ plane { y, 0 pigment { rgb .5 } }
+ mesh {
+     triangle { <-2,1,0>, <-1.99,1,0>, <-2,1.01,.005> }
+     pigment { rgb 1 }
+     finish { emission 1e7 }
+ }
+ sphere { <2,1,0>, .5 pigment { rgb 1 } finish { emission 30 } }
+ sky_sphere { pigment { gradient y color_map { [0 rgb .1] [1 rgb 1] } } }
+ END
$ for s in $(seq 0 31); do
+     retex-render --trace-pixel 4,3,$s --size 8x6 --plain -l one=light_source#1 -l two=light_source#2 -l mesh='#2' \
+         -l sky lamps.pov
+ done | grep -o 'of lamp.*' | sort -u
> of lamp mesh
> of lamp one
> of lamp rest
> of lamp sky
> of lamp two
$ cat >layers.pov <<'END'
+ camera { location -3*z look_at 0 }
+ light_source { -9*z 1 }
+ #declare Varnish = texture { pigment { rgbf <.5,.3,.2,.5> } }
+ box { -1, 1 texture { pigment { rgb .8 } } texture { Varnish } }
+ END
$ for s in $(seq 0 15); do
+     retex-render --trace-pixel 4,3,$s --size 8x6 -t Varnish layers.pov | tr '\n' ' ' | grep -o 'below.*Varnish d\|leaf . of 2' | paste -sd ,
+ done | sort -u
> below a layer of target Varnish d,leaf 1 of 2
> leaf 0 of 2
$ retex-render --trace-pixel 1,1,0 --size 8x6 ball.pov -o x.txt
! retex-render: error: --trace-pixel goes to standard output: no -o
= 2
$ retex-render --aov depth, --size 8x6 ball.pov -o x.exr 2>&1 |
+     sed 's/expected beauty, [a-z_, ]*, not/expected LIST, not/'
> retex-render: error: --aov: expected LIST, not ``
$ retex-render --size +8x6 ball.pov -o x.exr
! retex-render: error: --size: expected WxH, not `+8x6`
= 2
$ retex-render -D A=1/3 --size 8x6 ball.pov -o x.exr
! retex-render: error: --declare: expected NAME=NUMBER or NAME="TEXT", not `A=1/3`
= 2
$ retex-render -D clock=noon --size 8x6 ball.pov -o x.exr
! retex-render: error: --declare: expected NAME=NUMBER or NAME="TEXT", not `clock=noon`
= 2
$ retex-render -q --size 8x6 --spp 1 --aov depth ball.pov -o y.png
! retex-render: warning: y.png holds the picture only: --aov needs .exr or .retex
$ retex-render -q --size 8x6 --spp 1 --aov depth,irradiance --aov-dir guides ball.pov -o y.png
$ ls guides
> beauty.exr
> beauty.png
> depth.exr
> depth.png
> irradiance.exr
> irradiance.png
$ retex-render -q --size 8x6 --spp 1 --aov-dir guides ball.pov -o y.exr
$ ls guides | grep -c '^depth\|^irradiance\|^object'
> 6
$ rm -r guides
$ retex-render -q --size 8x6 --spp 1 --aov-dir nowhere/guides ball.pov -o y.png
! retex-render: error: --aov-dir: cannot make the folder nowhere/guides: No such file or directory
= 2
$ retex-render -q --size 8x6 --aov-dir guides --list-targets ball.pov
! retex-render: error: --aov-dir cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants or --control
= 2

# A scene without any object is a picture as in POV-Ray: black, or its background or sky.
$ : >empty.pov
$ c='rgb <.25,.5,1>'
+ for s in "blue background { $c }" "sky sky_sphere { pigment { $c } }" "fog fog { $c distance 1 }"; do
+     echo "#version 3.7; global_settings { assumed_gamma 1 } ${s#* }" >${s%% *}.pov
+ done
+ for s in empty blue sky fog; do
+     retex-render -q --size 8x6 --spp 2 $s.pov -o x.exr && oiiotool x.exr --printstats | grep -E 'Stats (Min|Max)' |
+         sed 's/^ *//'
+ done
> Stats Min: 0.000000 0.000000 0.000000 (float)
> Stats Max: 0.000000 0.000000 0.000000 (float)
> Stats Min: 0.250000 0.500000 1.000000 (float)
> Stats Max: 0.250000 0.500000 1.000000 (float)
> Stats Min: 0.250000 0.500000 1.000000 (float)
> Stats Max: 0.250000 0.500000 1.000000 (float)
> Stats Min: 0.250000 0.500000 1.000000 (float)
> Stats Max: 0.250000 0.500000 1.000000 (float)
! retex-render: empty.pov: warning: no object and no sky: the picture will be black
! retex-render: blue.pov: warning: no object in the scene
! retex-render: sky.pov: warning: no object in the scene
! retex-render: fog.pov: warning: no object in the scene
$ retex-render -q --size 8x6 --spp 2 --aov-dir aovs empty.pov -o x.exr
! retex-render: empty.pov: warning: no object and no sky: the picture will be black
$ retex-info -q --check x.exr
$ retex-pack -q x.exr -o x.retex
$ retex-info -q --check x.retex
$ rm -r aovs x.*
$ retex-render -q --size 8x6 -t ball empty.pov -o x.exr
! retex-render: error: no target `ball`: the scene uses no declared texture or object
= 2

# No scene.
$ retex-render . -o x.exr; echo 'sphere { 0, 1 }' | retex-render /dev/stdin -o x.exr
! retex-render: error: .: cannot read `.`: Is a directory
! retex-render: error: /dev/stdin: cannot read `/dev/stdin`: it is a device or a pipe
= 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# The modes of --control are three, and the first is the default.
$ retex-render -q --size 8x6 --spp 4 -t ball ball.pov -o y.exr
$ for m in unbiased halves biased; do
+     retex-render -q --size 8x6 --spp 4 --seed 1 --control y.exr --control-mode $m \
+         --replace 'ball=rgb(1,0,0)' ball.pov -o $m.exr
+ done
$ retex-render -q --size 8x6 --spp 4 --seed 1 --control y.exr --replace 'ball=rgb(1,0,0)' ball.pov -o default.exr
$ cmp default.exr unbiased.exr
$ cmp -s unbiased.exr halves.exr || echo halves differ
> halves differ
$ cmp -s unbiased.exr biased.exr || echo biased differs
> biased differs
$ cmp -s halves.exr biased.exr || echo from halves too
> from halves too

# --control needs something new, and another seed than the set's.
$ retex-render -q --size 8x6 --spp 2 -t ball ball.pov -o y.exr
$ retex-render -q --size 8x6 --spp 2 --control y.exr ball.pov -o x.exr
! retex-render: error: --control needs --replace, without --variants
= 2
$ retex-render -q --size 8x6 --spp 2 --seed 0 --control y.exr --replace 'ball=rgb(1,0,0)' ball.pov -o x.exr
! retex-render: error: --control y.exr: the set has the same seed, 0: the new samples must have other noise
= 2
$ retex-render -q --size 8x6 --spp 2 --control y.exr --control-mode magic --replace 'ball=rgb(1,0,0)' ball.pov -o x.exr
! retex-render: error: --control-mode: expected unbiased, halves or biased, not `magic`
= 2
$ retex-render -q --size 8x6 --spp 2 --control y.exr --replace 'ball=rgb(1,0,0)' ball.pov -o y.exr
! retex-render: error: y.exr: the output would replace the set of --control
= 2
$ retex-render -q --size 8x6 --spp 2 --plain --control-data unbiased ball.pov -o y.exr
$ retex-info --check y.exr
> y.exr: ok
$ retex-render -q --size 8x6 --spp 2 --control y.exr --replace 'ball=rgb(1,0,0)' ball.pov -o y.png

# A width in scene units, here of a floor with a repeat of 8/3: the same as a scale.
$ retex-render -q --size 32x24 --spp 2 \
+     --replace:width=1.3333333333333333 floor=scenes/textures/brick.jpg scenes/cornell-box/cornell-box.pov -o w1.exr
$ retex-render -q --size 32x24 --spp 2 \
+     --replace:scale=2 floor=scenes/textures/brick.jpg scenes/cornell-box/cornell-box.pov -o w2.exr
$ retex-diff w1.exr w2.exr --fail-psnr 70 >/dev/null
$ rm w1.exr w2.exr

# A target whose surfaces all belong to another.
$ retex-render -q --size 8x6 --spp 1 -t ball -t b=Ball ball.pov -o y.exr
! retex-render: warning: target `b` has no surface: its surfaces belong to targets named before it

# Many pictures along the same paths: each is to the bit what --replace gives. More than sixteen take more traversals.
$ {
+     echo output,floor
+     for k in $(seq 17); do echo "v$k.exr,\"rgb(0.$k,0.5,0)\""; done
+     echo v18.exr,:scale=2 scenes/textures/brick.jpg
+     echo v19.exr,
+ } >rows.csv
+ retex-render -q --size 32x24 --spp 2 --variants rows.csv scenes/cornell-box/cornell-box.pov
+ retex-render -q --size 32x24 --spp 2 --replace 'floor=rgb(0.5,0.5,0)' scenes/cornell-box/cornell-box.pov -o w5.exr
+ retex-render -q --size 32x24 --spp 2 \
+     --replace:scale=2 floor=scenes/textures/brick.jpg scenes/cornell-box/cornell-box.pov -o w18.exr
+ retex-render -q --size 32x24 --spp 2 --plain scenes/cornell-box/cornell-box.pov -o w19.exr
+ for k in 5 18 19; do cmp v$k.exr w$k.exr; done
$ ls v*.exr | wc -l
> 19
$ rm v*.exr w*.exr
# Likewise where the lights are meshes, with more samples than go side by side.
$ printf 'output,Floor\nv1.exr,scenes/textures/brick.jpg\nv2.exr,\n' >mesh.csv
$ for s in living-room glass-caustics; do
+     set -- --size 32x24 --spp 70 scenes/$s/$s.pov
+     retex-render -q --variants mesh.csv "$@"
+     retex-render -q --replace Floor=scenes/textures/brick.jpg "$@" -o w1.exr
+     retex-render -q --plain "$@" -o w2.exr
+     for k in 1 2; do cmp v$k.exr w$k.exr; done
+ done
$ rm mesh.csv v1.exr v2.exr w1.exr w2.exr
$ printf 'output,floor\nscenes/cornell-box/cornell-box.pov,\n' |
+     retex-render -q --variants - scenes/cornell-box/cornell-box.pov
! retex-render: error: standard input:2: scenes/cornell-box/cornell-box.pov: the output of the table's line 2 would replace the scene
! retex-render: error: standard input:2: scenes/cornell-box/cornell-box.pov: no picture format that can be written has the ending .pov; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
= 2
$ printf 'output,floor\nx.png,none.jpg\n' | retex-render -q --variants - --size 8x6 scenes/cornell-box/cornell-box.pov
! retex-render: error: standard input:2: cannot read none.jpg: No such file or directory
= 2
$ printf 'output,floor\nx.nothing,\n' | retex-render -q --variants - scenes/cornell-box/cornell-box.pov
! retex-render: error: standard input:2: x.nothing: no picture format that can be written has the ending .nothing; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
= 2
$ printf 'output,nope\n' | retex-render -q --variants - scenes/cornell-box/cornell-box.pov
! retex-render: error: standard input:1: no texture, pigment, material or object `nope` in the scene; there are: Floor, White, Red, Green, Lamp
= 2
$ printf 'output,nope\n' | retex-render -q -t floor --variants - scenes/cornell-box/cornell-box.pov
! retex-render: error: standard input:1: no target is called 'nope'; the scene has floor; name it with -t
= 2
$ printf 'output,floor\n' | retex-render -q --variants - scenes/cornell-box/cornell-box.pov -o x.exr
! retex-render: error: the table of --variants names the outputs: no -o
= 2

# Sets are rounded to what their numbers are known to, so that they are smaller; resumed ones too.
$ set -- -q --size 32x24 --spp 8 -t floor scenes/cornell-box/cornell-box.pov
+ retex-render "$@" -o r.exr
+ retex-render "$@" --full-precision -o f.exr
+ retex-render "$@" --plain -o p.pfm
+ retex-diff -q p.pfm f.exr --fail-abs 1e-6 && echo exact
+ retex-diff -q p.pfm r.exr --fail-abs 1e-6 || echo rounded
+ for rounded in '' --full-precision; do
+     (ulimit -f 300; ! retex-render "$@" $rounded --threads 1 --resume -o m.exr 2>/dev/null)
+     retex-render "$@" $rounded --resume -o m.exr
+     cmp m.exr $([ "$rounded" ] && echo f.exr || echo r.exr)
+ done
> exact
> rounded
$ cmp m.exr f.exr
$ [ $(stat -c %s r.exr) -lt $(stat -c %s f.exr) ] && echo smaller
> smaller
$ rm ?.exr

# What denoising reads is in sets of two samples and more, but not in packs and pictures; without it the set is the same.
$ rm -f ?.exr
$ set -- -q --size 32x24 --spp 4 -t floor
+ retex-render "$@" scenes/cornell-box/cornell-box.pov -o d.exr
+ retex-render "$@" --no-denoise-data scenes/cornell-box/cornell-box.pov -o n.exr
+ retex-render "$@" --spp 1 scenes/cornell-box/cornell-box.pov -o o.exr
+ retex-render "$@" scenes/cornell-box/cornell-box.pov -o p.retex
+ retex-render "$@" --plain --aov depth scenes/cornell-box/cornell-box.pov -o a.exr
$ for f in d.exr n.exr o.exr p.retex a.exr; do
+     retex-info --json $f | grep -o '"\(noise\|guide_cover\)_[A-Za-z_]*"' | sort -u | wc -l
+ done
> 5
> 0
> 0
> 0
> 0
$ retex-info --json d.exr | grep -o '"\(noise\|guide_cover\)_[A-Za-z_]*"' | sort -u
> "guide_cover_floor"
> "noise_floor_broad"
> "noise_floor_sharp"
> "noise_indep"
> "noise_weight"
$ retex-info --json d.exr | grep -o '"guide_[a-z_]*"' | tr -d '"' | grep -v cover | sort -u >features
$ grep -c . features | sed 's/[1-9].*/some/'
> some
$ grep -o 'Cm .*guide_[a-z_]*' "$TESTS/../../man/retex-set.5" | grep -o 'guide_[a-z_]*' | grep -v cover | sort -u |
+     diff features -
$ retex-render -q --size 32x24 --spp 4 -t floor --no-denoise-data scenes/cornell-box/cornell-box.pov -o p2.retex
$ cmp p.retex p2.retex
$ rm p2.retex
$ for n in 1 2 7; do
+     retex-render -q --threads $n --size 70x50 --spp 4 -t floor -t white scenes/cornell-box/cornell-box.pov -o $n.exr
+ done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr

# --denoise does at once what retex-denoise does later, to the bit; of sets, packs and pictures.
$ retex-render -q --size 32x24 --spp 4 -t floor --denoise scenes/cornell-box/cornell-box.pov -o e.exr
$ retex-info --json e.exr | grep -c '"\(noise\|guide\)_'
> 0
= 1
$ retex-info --json e.exr | grep -o '"denoised":[a-z]*'
> "denoised":true
$ retex-info --check e.exr
> e.exr: ok
$ retex-denoise -q d.exr -o f.exr
$ cmp e.exr f.exr
$ for o in --full-precision '--layout paper'; do
+     retex-render -q --size 32x24 --spp 4 -t floor $o scenes/cornell-box/cornell-box.pov -o g.exr
+     retex-render -q --size 32x24 --spp 4 -t floor $o --denoise scenes/cornell-box/cornell-box.pov -o e.exr
+     retex-denoise -q $(echo $o | grep full) g.exr -o f.exr
+     cmp e.exr f.exr
+ done
$ rm g.exr
$ retex-render -q --size 32x24 --spp 4 -t floor --denoise scenes/cornell-box/cornell-box.pov -o e.retex
$ retex-info --json e.retex | grep -o '"denoised":[a-z]*'
> "denoised":true
$ retex-render -q --size 32x24 --spp 4 --plain scenes/cornell-box/cornell-box.pov -o x1.exr
$ retex-render -q --size 32x24 --spp 4 --plain --denoise scenes/cornell-box/cornell-box.pov -o x2.exr
$ retex-render -q --size 32x24 --spp 4 --denoise --replace 'floor=rgb(0.5,0.5,0)' scenes/cornell-box/cornell-box.pov \
+     -o x3.png
$ ls x?.*
> x1.exr
> x2.exr
> x3.png
$ rm x?.*
$ retex-render -q --size 8x6 --spp 2 --denoise --aov-dir guides ball.pov -o y.png
$ ls guides | grep -c '^depth\|^irradiance\|^object'
> 6
$ rm -r guides

# What it cannot go with is said before anything is rendered.
$ set -- --denoise --size 2000x2000 --spp 4096 ball.pov
+ for o in --no-denoise-data \
+     --list-targets '--trace-pixel 1,1,0' '--variants rows.csv' '--control d.exr --replace ball=rgb(1,0,0)' \
+     '--control-data biased' '--spp 1'; do
+     timeout 5 retex-render "$@" $o >x.exr
+     echo $?
+ done
> 2
> 2
> 2
> 2
> 2
> 2
> 2
! retex-render: error: --denoise needs the data that --no-denoise-data omits
! retex-render: error: --denoise cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants or --control
! retex-render: error: --denoise cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants or --control
! retex-render: error: --denoise cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants or --control
! retex-render: error: --denoise cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, --trace-pixel, --variants or --control
! retex-render: error: --denoise and --control-data exclude each other
! retex-render: error: --denoise needs at least two samples per pixel: one does not show the noise
$ rm x.exr

# Names are listed by their share of the picture, those of one share by the alphabet.
$ cat >shares.pov <<'END'
+ camera { orthographic location <0,0,-5> look_at 0 right 4*x up 4*y } light_source { <0,0,-9> rgb 1 }
+ #declare Pine = texture { pigment { rgb 1 } }
+ #declare Ash = texture { pigment { rgb 1 } }
+ #declare Oak = texture { pigment { rgb 1 } }
+ box { <-2,-2,0>, <-1,2,1> texture { Pine } }
+ box { <-1,-2,0>, <0,2,1> texture { Ash } }
+ box { <0,-2,0>, <2,2,1> texture { Oak } }
+ END
$ retex-render -q --list-targets --size 8x8 shares.pov
>  50.00%  Oak
>  25.00%  Ash
>  25.00%  Pine

# Behind a pane that changes nothing, matte surfaces that a mesh lights give light to what is nearer to them than the
# pane is to the eye.
$ cat >open.pov <<'END'
+ camera { location <0,1,-4> look_at <0,.6,0> angle 40 }
+ plane { y, 0 pigment { rgb .8 } finish { ambient 0 diffuse 1 } }
+ box { <-1,0,.3>, <1,2,.4> pigment { rgb <.9,.5,.3> } finish { ambient 0 diffuse 1 } }
+ mesh {
+     triangle { <-1,2.4,-2>, <1,2.4,-2>, <1,2.4,0> }
+     triangle { <-1,2.4,-2>, <-1,2.4,0>, <1,2.4,0> }
+     pigment { rgb 1 }
+     finish { emission 3 diffuse 0 }
+ }
+ END
$ cp open.pov pane.pov
$ echo 'plane { z, -3 pigment { rgbt 1 } finish { ambient 0 diffuse 0 } }' >>pane.pov
$ for n in open pane; do retex-render -q --plain --size 16x12 --spp 1024 $n.pov -o $n.exr; done
$ retex-diff -q pane.exr open.exr --fail-psnr 40
