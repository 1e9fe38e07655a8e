# retex-render --layout and --clusters, and what retex-info says of the sets.
% box=scenes/cornell-box/cornell-box.pov
$ ln -s "$SCENES" scenes
$ retex-render -q --size 16x12 --spp 2 -t floor $box -o f.exr
$ retex-info f.exr | grep '^layout\|^orders\|^clusters\|^AOVs'
> layout         footprints
> orders         6
> clusters       2 sharp, 2 broad
> AOVs           21: 9 radiance, 6 UV, 6 spread
$ retex-render -q --size 16x12 --spp 2 -t floor --layout footprints --clusters 4+2+8 --orders 6 $box -o g.exr
$ cmp f.exr g.exr
$ retex-render -q --size 16x12 --spp 2 -t floor --clusters 4+4 $box -o g.exr
$ retex-info g.exr | grep '^clusters'
> clusters       2 sharp, 2 broad
$ retex-render -q --size 16x12 --spp 2 -t floor --layout paper $box -o p.exr
$ retex-info p.exr | grep '^layout\|^orders\|^clusters\|^AOVs'
> layout         paper
> orders         6
> AOVs           33: 21 radiance, 6 UV, 6 spread

# Of several targets the one that has most is told of: the wall is seen here, the floor is not.
$ retex-render -q --size 16x12 --spp 32 -t Floor -t Red --clusters 4+4 --crop 0,5,2,2 $box -o w.exr
$ retex-info w.exr | grep '^clusters'
> clusters       4 sharp, 0 broad

# As many clusters as the samples of a pixel need and K or S+B allow; what no pixel has is left out.
$ for k in 2 1+1 2+1 3+1 1+3 4 8 12+4 16; do
+     printf '%s: ' $k
+     retex-render -q --size 16x12 --spp 32 -t floor --orders 1 --clusters $k $box |
+         retex-info - 2>/dev/null | grep '^clusters\|^AOVs' | tr -s ' \n' ' '
+     echo
+ done
> 2: clusters 2 sharp, 2 broad, quarters of pixels AOVs 19: 9 radiance, 5 UV, 5 spread
> 1+1: clusters 1 sharp, 1 broad, quarters of pixels AOVs 13: 7 radiance, 3 UV, 3 spread
> 2+1: clusters 2 sharp, 1 broad, quarters of pixels AOVs 16: 8 radiance, 4 UV, 4 spread
> 3+1: clusters 3 sharp, 1 broad, quarters of pixels AOVs 19: 9 radiance, 5 UV, 5 spread
> 1+3: clusters 1 sharp, 3 broad, quarters of pixels AOVs 19: 9 radiance, 5 UV, 5 spread
> 4: clusters 4 sharp, 4 broad, quarters of pixels AOVs 31: 13 radiance, 9 UV, 9 spread
> 8: clusters 8 sharp, 8 broad, quarters of pixels AOVs 55: 21 radiance, 17 UV, 17 spread
> 12+4: clusters 12 sharp, 4 broad, quarters of pixels AOVs 55: 21 radiance, 17 UV, 17 spread
> 16: clusters 16 sharp, 16 broad, quarters of pixels AOVs 103: 37 radiance, 33 UV, 33 spread
$ retex-info --json f.exr | grep -o '"hit":[0-9]*,"kind":"[a-z]*"'
> "hit":1,"kind":"sharp"
> "hit":2,"kind":"sharp"
> "hit":13,"kind":"broad"
> "hit":14,"kind":"broad"
> "hit":17,"kind":"interreflection"
> "hit":18,"kind":"interreflection"

# Kinds, by footprint; with several targets each has its own.
$ retex-info --json f.exr | grep -o '"kind":"\(sharp\|broad\|interreflection\|hit\)"' | sort | uniq -c
>       2 "kind":"broad"
>       2 "kind":"interreflection"
>       2 "kind":"sharp"
$ retex-info --json p.exr | grep -o '"kind":"\(sharp\|broad\|interreflection\|hit\)"' | sort | uniq -c
>       6 "kind":"hit"
$ retex-render -q --size 16x12 --spp 2 -t floor -t white $box -o two.exr
$ retex-info --json two.exr | grep -o '"kind":"\(sharp\|broad\|interreflection\|hit\)"' | sort | uniq -c
>       3 "kind":"broad"
>       6 "kind":"interreflection"
>       4 "kind":"sharp"
$ retex-info --check two.exr
> two.exr: ok
$ retex-info --json two.exr | grep -o '"name":"dep_floor_sharp[^"]*"' | head -n 4
> "name":"dep_floor_sharp1"
> "name":"dep_floor_sharp2"
> "name":"dep_floor_sharp_a1"
> "name":"dep_floor_sharp_b1"
$ retex-info --json two.exr | grep -o '"name":"\(dep_floor_sharp_[^"]*m[^"]*\|share_[^"]*\)"'
> "name":"share_floor_sharp1"
> "name":"share_floor_sharp2"
> "name":"share_floor_interreflection1"
> "name":"share_floor_interreflection2"
> "name":"share_white_sharp1"
> "name":"share_white_sharp2"
> "name":"share_white_broad1"
> "name":"share_white_broad2"
> "name":"share_white_interreflection1"
> "name":"share_white_interreflection2"
> "name":"share_white_interreflection3"
> "name":"share_white_interreflection4"
> "name":"dep_floor_sharp_m5"
> "name":"dep_floor_sharp_m6"
> "name":"dep_floor_sharp_m8"
> "name":"dep_floor_sharp_m10"
> "name":"dep_floor_sharp_m11"

# What retex-info advises where light keeps the original.
$ cat >shell.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 } #declare Shell = pigment { rgb 0.8 }
+ #declare Ball = pigment { rgb 0.7 }
+ camera { location <0.5, 0.3, -1> look_at 0 }
+ sphere { 0, 3 pigment { Shell } finish { diffuse 1 } }
+ sphere { y, 0.5 pigment { Ball } } light_source { 0 rgb 1 }
+ END
$ for options in '--orders 3 -t shell' '--orders 5 -t shell -t ball' '--layout paper -t shell -t ball' \
+     '--layout paper --strict-paper -t shell' '-t shell -t ball'; do
+     echo "$options"
+     retex-render -q --size 16x12 --spp 2 $options shell.pov | retex-info - 2>&1 >/dev/null | sed 's/[0-9.]*%/N%/'
+ done
> --orders 3 -t shell
> --orders 5 -t shell -t ball
> retex-info: warning: N% of the light, were the targets white, keeps the original textures: more --orders keep its hits apart
> --layout paper -t shell -t ball
> retex-info: warning: N% of the light keeps the original textures: fewer targets may keep its hits apart
> --layout paper --strict-paper -t shell
> retex-info: warning: N% of the light keeps the original textures: it has more hits than a set can keep apart
> -t shell -t ball

# In glass there are more sharp clusters, for a set of any number of threads; where the floor is seen
# directly there are none. Fewer are asked for by X, in 3+1+X.
% glass() { retex-render -q --size 64x48 --spp 16 -t Floor "$@" scenes/glass-caustics/glass-caustics.pov; }
$ glass --threads 1 -o glass.exr
$ retex-info glass.exr | grep '^clusters'
> clusters       12 sharp, 2 broad, quarters of pixels
$ glass --threads 3 -o threads.exr
$ cmp glass.exr threads.exr
$ for c in 4+2 3+1+2; do glass --clusters $c | retex-info - | grep '^clusters'; done
> clusters       4 sharp, 2 broad, quarters of pixels
> clusters       5 sharp, 2 broad, quarters of pixels
$ retex-render -q --size 16x12 --spp 32 -t floor $box | retex-info - | grep '^clusters'
> clusters       4 sharp, 2 broad, quarters of pixels

# Both layouts show the picture that was rendered, and take new textures.
$ for s in f p two; do
+     retex-combine -q $s.exr -o back.exr
+     retex-render -q --size 16x12 --spp 2 --plain $box -o plain.exr
+     retex-diff -q back.exr plain.exr --fail-psnr 45 || echo $s
+ done
$ for s in footprints paper; do
+     retex-render -q --full-precision --size 16x12 --spp 2 -t floor --layout $s $box -o full.exr
+     retex-combine -q full.exr --texture 'floor=rgb(0.7,0.1,0.2)' -o red.exr
+     retex-render -q --size 16x12 --spp 2 --replace 'floor=rgb(0.7,0.1,0.2)' $box -o truth.exr
+     retex-diff -q red.exr truth.exr --fail-psnr 55 || echo $s
+ done

# A pack holds either.
$ for s in f p two; do
+     retex-pack -q --lossless $s.exr -o $s.retex
+     retex-combine -q $s.retex -o a.exr
+     retex-combine -q $s.exr -o b.exr
+     cmp a.exr b.exr
+ done
$ retex-info two.retex | grep '^clusters'
> clusters       2 sharp, 2 broad

# What is refused.
$ retex-render --layout cubist $box -o x.exr
! retex-render: error: --layout: expected footprints or paper, not `cubist`
= 2
$ retex-render --layout '' $box -o x.exr
! retex-render: error: --layout: expected footprints or paper, not ``
= 2
$ retex-render --clusters 0 $box -o x.exr
! retex-render: error: --clusters: expected 2 to 16, at least one sharp and one broad, not `0`
= 2
$ retex-render --clusters 1 $box -o x.exr
! retex-render: error: --clusters: expected 2 to 16, at least one sharp and one broad, not `1`
= 2
$ retex-render --clusters 17 $box -o x.exr
! retex-render: error: --clusters: expected 2 to 16, at least one sharp and one broad, not `17`
= 2
$ retex-render --clusters 12+5 $box -o x.exr
! retex-render: error: --clusters: expected 2 to 16, at least one sharp and one broad, not `12+5`
= 2
$ retex-render --clusters 4+2+11 $box -o x.exr
! retex-render: error: --clusters: expected 2 to 16, at least one sharp and one broad, not `4+2+11`
= 2
$ retex-render --clusters 0+3 $box -o x.exr
! retex-render: error: --clusters: expected 2 to 16, at least one sharp and one broad, not `0+3`
= 2
$ retex-render --clusters 3+0 $box -o x.exr
! retex-render: error: --clusters: expected 2 to 16, at least one sharp and one broad, not `3+0`
= 2
$ retex-render --clusters 99999999999 $box -o x.exr
! retex-render: error: --clusters: expected one number, or two or three as in 4+2+8, not `99999999999`
= 2
$ retex-render --clusters 3+ $box -o x.exr
! retex-render: error: --clusters: expected one number, or two or three as in 4+2+8, not `3+`
= 2
$ retex-render --clusters +1 $box -o x.exr
! retex-render: error: --clusters: expected one number, or two or three as in 4+2+8, not `+1`
= 2
$ retex-render --clusters -1 $box -o x.exr
! retex-render: error: --clusters: expected one number, or two or three as in 4+2+8, not `-1`
= 2
$ retex-render --clusters many $box -o x.exr
! retex-render: error: --clusters: expected one number, or two or three as in 4+2+8, not `many`
= 2
$ retex-render --clusters 3+1+1+1 $box -o x.exr
! retex-render: error: --clusters: expected one number, or two or three as in 4+2+8, not `3+1+1+1`
= 2
$ retex-render --clusters '' $box -o x.exr
! retex-render: error: --clusters: expected one number, or two or three as in 4+2+8, not ``
= 2
$ retex-render --layout paper --clusters 4 $box -o x.exr
! retex-render: error: --layout paper has no clusters: no --clusters
= 2
$ retex-render --clusters 3+1 --layout paper $box -o x.exr
! retex-render: error: --layout paper has no clusters: no --clusters
= 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2
