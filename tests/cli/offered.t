# Targets that a scene offers by name, and points of the scene as selectors.
% render() { retex-render -q --size 64x48 --spp 4 "$@"; }
% told() { retex-info $1 | awk '/^  idents/ { i = $2 } /^  share/ { print i, $2 }'; }
$ cp "$SCENES/textures/fans.jpg" .

# A room whose floor is boards of three heights, and a rug; of the wall behind nothing has a name.
$ for k in 0 1 2 3 4 5 6 7 8 9; do
+     echo "box { <$k-5,-.1,-4>, <$k-4,.00$(((k * 7) % 3)),4> translate x*5 scale <.5,1,.5> translate <-2.5,0,0> }"
+ done >boards.inc
$ echo 'box { <-2.5,-.1,-2>, <2.5,.001,2> }' >slab.inc
$ cat >rest.inc <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 }
+ camera { location <0,1.6,-1.9> look_at <0,.5,1> angle 70 }
+ light_source { <-1,2.4,-1.2> rgb 1 area_light x, z, 2, 2 jitter adaptive 0 }
+ #default { texture { pigment { rgb .6 } } }
+ #declare Rug = box { <-.6,0,.2>, <.6,.009,1.4> }
+ #declare Wall = box { <-3,0,2>, <3,3,2.1> }
+ object { Rug }
+ object { Wall }
+ box { <-3,2.2,1.9>, <3,3,2.1> pigment { rgb .3 } }
+ #ifdef (Retex) global_settings { retex_targets {
+     "Floor" "@.2:0:-1/level", "Wall" "@0:1:2/flat"
+     "Rug (all)" "Rug:uv=box"
+     "Wrong" "#99" "Wrong again" "@0:1:2/level,Rag" "Wall" "@-2:1:2/flat"
+ } } #end
+ END
$ for s in boards slab; do echo "#include \"rest.inc\" #include \"$s.inc\"" >$s.pov; done

# What a name stands for is what is kept, to the byte; options of the command line go before those of the scene.
$ for t in 'Floor' 'Wall' 'Rug (all)'; do
+     render -t "$t" boards.pov -o name.exr && told name.exr
+     case $t in Floor) s=@.2:0:-1/level ;; Wall) s=@-2:1:2/flat ;; *) s=Rug:uv=box ;; esac
+     render -t "$t=$s" boards.pov -o selector.exr && cmp name.exr selector.exr
+     retex-pack -q name.exr -o name.retex && retex-pack -q selector.exr -o selector.retex &&
+         cmp name.retex selector.retex
+ done
> #9/level:4 41.28%
> #2/flat:5 52.08%
> Rug:uv=box 6.05%
$ render -t 'Rug (all):uv=planar' boards.pov -o b.exr && told b.exr
> Rug:uv=planar 6.05%
$ render -t floor boards.pov -o b.exr && told b.exr
> #9/level:4 41.28%
$ render --replace Floor=#a04020 boards.pov -o a.exr && render -t A=@.2:0:-1/level --replace A=#a04020 boards.pov -o b.exr
$ retex-diff -q --fail-abs 0 a.exr b.exr
# Such names go before identifiers; what is called exactly so goes before another case of one.
$ render -t Wall=Wall boards.pov -o b.exr && told b.exr
> Wall 52.08%
$ cat >cases.pov <<'END'
+ camera { location -5*z } light_source { -9*z, 1 }
+ #declare ground = pigment { rgb 1 } box { <-9,-9,0>, <0,9,1> pigment { ground } } box { <0,-9,0>, <9,9,1> }
+ global_settings { retex_targets { "Ground" "#2" } }
+ END
$ for t in ground Ground GROUND; do render -t $t cases.pov -o b.exr && told b.exr; done
> ground 50.00%
> #2 50.00%
> #2 50.00%
# The boards are one floor: the new texture lies across them as over a slab. The rug is not taken.
$ for s in boards slab; do
+     retex-render -q --size 96x72 --spp 48 -t Floor $s.pov -o $s.exr
+     retex-combine -q $s.exr --texture:width=90cm Floor=fans.jpg -o $s-new.exr
+     told $s.exr | sed 's/.* \(..\..\).*/\1/'
+ done
> 41.1
> 41.1
$ retex-diff -q --fail-psnr 38 boards-new.exr slab-new.exr

# The list has them first.
$ retex-render --list-targets --size 64x48 boards.pov | cat -A
>  41.28%  Floor^Ioffered by the scene: @.2:0:-1/level$
>  52.08%  Wall^Ioffered by the scene: @-2:1:2/flat$
>   6.05%  Rug (all)^Ioffered by the scene: Rug:uv=box$
>  52.08%  Wall=Wall$
>   6.05%  Rug$
! retex-render: warning: target `Wrong` of the scene: no object `#99`: the scene has 13, from #1 on; --list-targets -v lists those that are seen
! retex-render: warning: target `Wrong again` of the scene: no texture, pigment, material or object `Rag` in the scene; similar: Rug
$ RETEX_MAX_TIME=60 retex-render --complete boards.pov -t ''
> Floor	41.24 % of the picture
> Wall	52.50 % of the picture
> Rug	5.69 % of the picture

# Points: the face next to them, of meshes, boxes, discs, planes and copies; at an edge the larger one. Of 8 x 6 units
# these have 1, 4, 3.14, 1 and .5, and the plane behind the rest.
$ cat >shapes.pov <<'END'
+ #version 3.7; camera { orthographic location <0,0,-9> right 8*x up 6*y direction z }
+ light_source { -9*z rgb 1 } #default { pigment { rgb .5 } }
+ #declare Copied = mesh2 { vertex_vectors { 5, <0,0,0>, <1,0,0>, <1,1,0>, <0,1,0>, <2,2,9> }
+     face_indices { 3, <0,1,2>, <0,2,3>, <2,3,4> } }
+ plane { -z, -5 }
+ disc { <-2,0,0>, z, 1 }
+ sphere { <2,2,0>, .5 }
+ mesh2 { vertex_vectors { 4, <0,-3,0>, <2,-3,0>, <2,-1,0>, <0,-1,0> } face_indices { 2, <0,1,2>, <0,2,3> } }
+ box { <-4,2,0>, <-3,3,2> }
+ object { Copied translate <-4,-3,0> }
+ object { Copied translate <-2,-3,1> }
+ object { Copied rotate z*45 translate <3,0,0> }
+ box { <3,2,1>, <3.5,3,1.1> }
+ END
$ for p in 0:0:4.5 -2:.5:-.1 -1.1:.1:.2 1.5:-2.5:0 .5:-1.5:.01 -3.5:2.5:-.2 -4:2.5:0; do
+     render -t A=@$p/object shapes.pov -o b.exr && told b.exr
+ done
> #1 71.09%
> #2 6.77%
> #2 6.77%
> #4 8.33%
> #4 8.33%
> #5 2.08%
> #5 2.08%
$ for p in 1.5:-2.5:0 .5:-1.5:.01 1:-2:0 -4:2.5:0 3:2.5:1 -3.3:-2.8:.2 -1.9:-2.1:.9 3:.5:.1; do
+     for s in flat level; do render -t A=@$p/$s shapes.pov -o b.exr && told b.exr; done
+ done
> #4/flat:1 8.33%
> #4/level:1 21.61%
> #4/flat:1 8.33%
> #4/level:2 21.61%
> #4/flat:1 8.33%
> #4/level:1 21.61%
> #5/flat:1 0.00%
> #5/level:1 0.00%
> #9/flat:5 1.04%
> #9/level:5 3.12%
> #6/flat:1 2.08%
> #6/level:1 21.61%
> #7/flat:1 2.08%
> #7/level:2 3.12%
> #8/flat:1 2.34%
> #8/level:1 21.61%
# What cannot be.
$ for t in @1:2:x @1:2: @1:2:3:4 @1:2:1e99 @1:2:3/wall; do render -t A=$t shapes.pov -o x.exr; done
! retex-render: error: target `@1:2:x`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `@1:2:`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `@1:2:3:4`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `@1:2:1e99`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `@1:2:3/wall`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
= 2
$ for t in Wrong 'Wrong again' Flor; do render -t Floor -t "$t" boards.pov -o x.exr; done
! retex-render: error: target `Wrong` of the scene: no object `#99`: the scene has 13, from #1 on; --list-targets -v lists those that are seen
! retex-render: error: target `Wrong again` of the scene: no texture, pigment, material or object `Rag` in the scene; similar: Rug
! retex-render: error: no texture, pigment, material or object `Flor` in the scene; similar: Floor
= 2
$ for o in '"" "#1"' '"a/b" "#1"' '"a"' '"a" "#1" "b"' 'a'; do
+     echo "camera{} sphere { 0, 1 } global_settings { retex_targets { $o } }" >bad.pov
+     render bad.pov -o x.exr
+ done
! retex-render: error: bad.pov:1:60: retex_targets: `` is no name of a target: 1 to 127 letters, digits, spaces and `_-.+()`
! retex-render: error: bad.pov:1:60: retex_targets: `a/b` is no name of a target: 1 to 127 letters, digits, spaces and `_-.+()`
! retex-render: error: bad.pov:1:64: expected a string, found `}`
! retex-render: error: bad.pov:1:73: expected a string, found `}`
! retex-render: error: bad.pov:1:60: expected a string, found `a`, which is not declared
= 2
$ echo 'camera{} sphere { 0, 1 } global_settings { retex_targets { "A" "@0:0:0" } }' >ball.pov
$ render -t A ball.pov -o x.exr
! retex-render: error: target `A` of the scene: no flat face is in the scene: @X:Y:Z finds those of meshes, boxes, planes and discs
= 2
$ for n in 64 65; do
+     echo "camera{} sphere { 0, 1 } global_settings { retex_targets { $(seq -f '"A%g" "#1"' $n) } }" >many.pov
+     render many.pov --list-targets >/dev/null 2>&1; echo $?
+ done
> 0
> 2
$ ls x.exr
! ls: cannot access 'x.exr': No such file or directory
= 2
