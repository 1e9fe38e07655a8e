# Targets without identifiers. Three boxes fill the picture, each a known share of it.
$ cat >room.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 } camera { orthographic location <0,0,-5> look_at 0 right 4*x up 4*y } light_source { <1,2,-9> rgb 1 }
+ #declare Pine = texture { pigment { rgb <.8,.4,.2> } }
+ #macro Slab(A, B) box { A, B
+ pigment { rgb <.1,.2,.7> } } #end
+ #declare Post = box { <-2,-2,0>, <-1,2,1> }
+ object { Post texture { Pine } }
+ Slab(<-1,-2,0>, <0,2,1>)
+ union {
+ box { <0,-2,0>, <1,2,1> }
+ mesh2 { vertex_vectors { 4, <1,-2,0>, <2,-2,0>, <2,2,0>, <1,2,0> } texture_list { 2, texture { pigment { rgb .3 } }, texture { Pine } }
+ face_indices { 2, <0,1,2>,0, <0,2,3>,1 } }
+ pigment { image_map { png "grey.png" } } }
+ END
$ printf 'P6 1 1 255 \200\200\200' >grey.ppm
$ oiiotool grey.ppm -o grey.png
% # Which parts a target has, and their shares of the picture: shares TARGET…
% shares() {
%     for t; do
%         retex-render -q --size 8x8 --spp 2 -t "A=$t" room.pov -o a.exr &&
%             retex-info a.exr | awk '/^ +idents/ { i = $2 } /^ +share/ { print i, $2 }'
%     done
% }
$ shares Pine '#1' '#2' '#4' '#4.1' '#1,#2' '@0:0' '@0:0/object' '@7:7' '@7:0' '@7:0/object' '@7:0/material' \
+     '@3:4,@4:4' '#4.2/material' '@0:0/flat' '@4:0/level' '@7:7/flat' '#4/level:1' room.pov:5 room.pov:6 room.pov:7 \
+     room.pov:8 room.pov:10 '~rgb(.1,.2,.7)' '~rgb( .8, .4, .2 ),#2' '*grey.png' 'gr?y.png' grey.png
> Pine 37.50%
> #1 25.00%
> #2 25.00%
> #4 25.00%
> #4.1 12.50%
> #1,#2 50.00%
> #1/material 37.50%
> #1 25.00%
> #4.1 12.50%
> #1/material 37.50%
> #4.2 12.50%
> #1/material 37.50%
> #2,#3 50.00%
> #4.2/material 37.50%
> #1/flat:5 25.00%
> #3/level:5 100.00%
> #4/flat:1 25.00%
> #4/level:1 100.00%
> room.pov:5 25.00%
> room.pov:6 25.00%
> room.pov:7 25.00%
> room.pov:8 50.00%
> room.pov:10 25.00%
> ~rgb(.1,.2,.7) 25.00%
> ~rgb( 62.50%
> *grey.png 25.00%
> gr?y.png 25.00%
> grey.png 25.00%
# A set by number is the same as one by name, but for the rounding of the file.
$ retex-render -q --size 16x16 --spp 4 -t A=Pine room.pov -o name.exr
$ retex-render -q --size 16x16 --spp 4 -t 'A=@0:0/object,#4.2' --full-precision room.pov -o number.exr
$ for s in name number; do retex-combine -q $s.exr --texture 'A=rgb(.1,.9,.5)' -o $s-new.exr; done
$ retex-diff -q --fail-psnr 75 name-new.exr number-new.exr
# The original shows without a texture; a new one is what rendering again with it gives.
$ retex-combine -q number.exr -o same.exr
$ retex-render -q --plain --size 16x16 --spp 4 room.pov -o plain.exr
$ retex-diff --fail-psnr 75 same.exr plain.exr >/dev/null
$ retex-combine -q number.exr --texture 'A=rgb(.1,.9,.5)' -o new.exr
$ retex-render -q --size 16x16 --spp 4 -t 'A=@0:0/object,#4.2' --replace 'A=rgb(.1,.9,.5)' room.pov -o again.exr
$ retex-diff --fail-psnr 75 new.exr again.exr >/dev/null
# Nothing matches: one line each, with what is near.
$ for t in '#5' '#0' '#x' '#1.' '#1.1' '#4.3' '@8:0' '@1' '@1:2:3:4' '@1:2/wall' '@1:2/' '#1/flat' '#1/flat:7' \
+     '#1/level:0' '#1.1/flat:1' '#1/material:1' '~rgb(.8,.3,.2)' '~rgb(1,2)' '~red' '~rde' room.pov:11 hall.pov:7 \
+     '*oak.png' Pin '#1,' ',#1' '#1,~rgb(1,1,1)'; do
+     retex-render -q --size 8x8 -t "A=$t" room.pov -o b.exr
+     echo $?
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
> 2
> 2
> 2
! retex-render: error: no object `#5`: the scene has 4, from #1 on; --list-targets -v lists those that are seen
! retex-render: error: no object `#0`: the scene has 4, from #1 on; --list-targets -v lists those that are seen
! retex-render: error: target `#x`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
! retex-render: error: target `#1.`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
! retex-render: error: no texture `#1.1`: the parts of object #1 have 0 of their own
! retex-render: error: no texture `#4.3`: the parts of object #4 have 2 of their own
! retex-render: error: pixel @8:0 does not lie inside the picture of 8x8
! retex-render: error: target `@1`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `@1:2:3:4`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `@1:2/wall`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `@1:2/`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; or after either /material, /object, /flat or /level
! retex-render: error: target `#1/flat`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
! retex-render: error: no face `#1/flat:7`: object #1 has 6
! retex-render: error: target `#1/level:0`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
! retex-render: error: target `#1.1/flat:1`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
! retex-render: error: target `#1/material:1`: expected #N, an object's number, or #N.K, one of its textures; or #N/material, #N/flat:FACE, #N/level:FACE
! retex-render: error: no surface of the colour `~rgb(.8,.3,.2)` in the scene; nearest: ~rgb(0.8,0.4,0.2), ~rgb(0.3,0.3,0.3), ~rgb(0.1,0.2,0.7)
! retex-render: error: target `~rgb(1,2)`: expected a colour, as ~rgb(.6,.4,.2), which is scene-linear, ~#cbaa7c or ~tan
! retex-render: error: no surface of the colour `~red` in the scene; nearest: ~rgb(0.8,0.4,0.2), ~rgb(0.3,0.3,0.3), ~rgb(0.1,0.2,0.7)
! retex-render: error: target `~rde`: expected a colour, as ~rgb(.6,.4,.2), which is scene-linear, ~#cbaa7c or ~tan
! retex-render: error: no object that begins in `room.pov:11` in the scene; nearest: room.pov:10, room.pov:9, room.pov:7, room.pov:6
! retex-render: error: no object that begins in `hall.pov:7` in the scene; nearest: room.pov:7, room.pov:6, room.pov:8
! retex-render: error: no image `*oak.png` in the scene; nearest: *grey.png
! retex-render: error: no texture, pigment, material or object `Pin` in the scene; similar: Pine
! retex-render: error: target `A`: an identifier is missing or too long
! retex-render: error: target `A`: an identifier is missing or too long
! retex-render: error: no surface of the colour `~rgb(1,1,1)` in the scene; nearest: ~rgb(0.8,0.4,0.2), ~rgb(0.1,0.2,0.7), ~rgb(0.3,0.3,0.3)
$ ls b.exr
! ls: cannot access 'b.exr': No such file or directory
= 2
# A pixel of the sky, and a picture that shows nothing.
$ cat >ball.pov <<'END'
+ camera { location <0,0,-5> look_at 0 } light_source { <1,2,-9> rgb 1 } sphere { 0, 1 } background { rgb 1 }
+ END
$ retex-render -q --size 40x30 -t A=@1:15 ball.pov -o b.exr
! retex-render: error: pixel @1:15 shows no object; the nearest that does is @14:15
= 2
$ retex-render -q --size 40x30 -t A=@39:29,@2:2 ball.pov -o b.exr
! retex-render: error: pixel @39:29 shows no object; the nearest that does is @25:17
= 2
$ cat >away.pov <<'END'
+ camera { location <0,0,-5> look_at -9*z } light_source { <1,2,-9> rgb 1 } sphere { 0, 1 }
+ END
$ retex-render -q --size 40x30 -t A=@1:15 away.pov -o b.exr
! retex-render: error: pixel @1:15 shows no object, nor does any other
= 2
# Eight targets at most.
$ retex-render -q --size 8x8 -t 'A=#1' -t 'B=#2' -t 'C=#3' -t 'D=#4' -t 'E=#1' -t 'F=#1' -t 'G=#1' -t 'H=#1' \
+     -t 'I=#1' room.pov -o b.exr
! retex-render: error: 9 targets, where there may be 8
= 2
# With -v the list has also what can be pointed at, and where it stands; without, only names.
$ retex-render -q --list-targets --size 8x8 room.pov
>  37.50%  Pine
>  25.00%  Post
$ retex-render -q -v --list-targets --size 8x8 room.pov 2>/dev/null
>  37.50%  Pine
>  25.00%  Post
> 100.00%  #1/level:5         level      room.pov:5 in room.pov:6
>  37.50%  #1/material        material   Pine
>  37.50%  ~rgb(0.8,0.4,0.2)  colour     room.pov:5 in room.pov:6
>  25.00%  #1                 box        room.pov:5 in room.pov:6
>  25.00%  #2                 box        room.pov:7
>  25.00%  #3                 box        room.pov:9 in room.pov:8
>  25.00%  #4/flat:1          flat       room.pov:10 in room.pov:8
>  25.00%  *grey.png          image      room.pov:9 in room.pov:8
>  25.00%  ~rgb(0.1,0.2,0.7)  colour     room.pov:7
>  12.50%  #4.1               mesh       room.pov:10 in room.pov:8
>  12.50%  #4.2               mesh       room.pov:10 in room.pov:8
>  12.50%  ~rgb(0.3,0.3,0.3)  colour     room.pov:10 in room.pov:8
# The sheet has a colour for each object and each part with a texture of its own; labels where there is room.
$ retex-render -q --list-targets=sheet.exr --size 8x8 room.pov
>  37.50%  Pine
>  25.00%  Post
$ oiiotool --dumpdata sheet.exr | sed -n 's/.*): //p' | sort | uniq -c | awk '{ print $1 }'
> 8
> 16
> 16
> 16
> 8
$ retex-render -q --list-targets=big.exr --size 400x400 room.pov >/dev/null
$ oiiotool big.exr --cut 100x400+0+0 --colorcount '1,1,1:0,0,0' | grep -o '^ *[0-9]*'
>      128
>       76
$ retex-render -q --list-targets=- room.pov
! retex-render: error: the answer and the file of --list-targets cannot both be standard output
= 2
$ retex-render -q --list-targets=room.pov room.pov
! retex-render: error: room.pov: the file of --list-targets would replace the scene
= 2
$ retex-render -q --list-targets=sheet.what room.pov
! retex-render: error: sheet.what: no picture format that can be written has the ending .what; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
= 2
$ retex-render -q --list-targets= room.pov
! retex-render: error: --list-targets: the name is empty
= 2
# Its memory is limited.
$ retex-render -q -v --list-targets --max-memory 200 --size 16000x16000 room.pov 2>&1 |
+     grep -c 'pixels need .* of memory'
> 1
# A width on a cylinder means whole repeats around it, in set and --replace alike: 4.4 become 4, which need no seam.
$ printf 'P6 4 1 255 \200\000\000\377\377\377\000\000\200\000\200\000' >stripes.ppm
$ cat >can.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 }
+ camera { orthographic location -9*z right 4*x up 3*y } background { rgb 1 }
+ #declare T = texture { pigment { rgb 1 } }
+ cylinder { -y, y, 1 texture { T } rotate 90*y }
+ END
$ retex-render -q --spp 16 --size 16x12 -t T can.pov -o set.exr
$ for w in 1.5708 1.428; do
+     retex-combine -q set.exr --texture:width=$w,2 T=stripes.ppm -o s$w.exr
+     retex-render -q --spp 16 --plain --size 16x12 -t T --replace:width=$w,2 T=stripes.ppm can.pov -o r$w.exr
+ done
$ retex-diff -q --fail-abs 1e-4 s1.5708.exr s1.428.exr && retex-diff -q --fail-abs 1e-4 r1.5708.exr r1.428.exr &&
+     echo same
> same
# Parts of different size get the same scale of texture: a width of 1 is 1 on all of them. Set and --replace agree.
$ cat >parts.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 }
+ camera { orthographic location -9*z right 4*x up 3*y } background { rgb 1 }
+ light_source { -99*z rgb 1 }
+ box { <-2,-1.5,0>, <0,1.5,1> pigment { rgb .5 } }
+ box { -1, 1 scale <1,.5,2> translate <1,1,1> pigment { rgb .5 } }
+ END
$ retex-render -q --spp 64 --size 16x12 -t 'T=~rgb(.5,.5,.5)' parts.pov -o parts.exr
$ retex-info parts.exr | sed -n '/  size/p'
>   size         1 x 1 scene units a unit of u and of v
$ retex-combine -q parts.exr --texture:width=2 T=stripes.ppm -o parts-s.exr
$ retex-render -q --spp 64 --plain --size 16x12 -t 'T=~rgb(.5,.5,.5)' --replace:width=2 T=stripes.ppm parts.pov \
+     -o parts-r.exr
$ retex-diff -q --fail-psnr 35 parts-s.exr parts-r.exr
$ oiiotool parts-s.exr --cut 8x1+0+2 -o a.exr
$ oiiotool parts-s.exr --cut 8x1+8+2 -o b.exr
$ retex-diff -q --fail-psnr 35 a.exr b.exr && echo alike
> alike
