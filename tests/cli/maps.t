# Maps of finishes: a texture says which finish of its target is where.
$ cp "$TESTS/finishes.pov" room.pov
$ cp "$SCENES/textures/brick.jpg" .
% render() { retex-render -q --size 48x36 --spp 32 room.pov "$@"; }
% finished() { render --finish Floor=matt,Gloss,polished -t Floor -t Wall "$@"; }
$ finished --full-precision -o full.exr
$ finished -o set.exr
% near() { retex-diff "$1" "$2" --fail-psnr "$3" -q || echo "$1 $2 $3"; }
$ for g in 0 .25 .5 .75 1; do oiiotool --pattern constant:color=$g,$g,$g 8x8 3 -d uint8 -o g$g.png; done
$ oiiotool --pattern constant:color=1,0,0 8x8 3 -d uint8 -o red.png
$ oiiotool --pattern constant:color=0,1,0 8x8 3 -d uint8 -o green.png
$ oiiotool --pattern checker:width=4:height=4:color1=1,1,1:color2=0,0,0 8x8 3 -d uint8 -o map.png

# A map of one value is a choice of one finish: black the first, white the last, or a colour each.
$ for p in g0:matt g1:polished red:Gloss green:polished; do
+     retex-combine -q full.exr --texture:finish=${p%:*}.png Floor=brick.jpg -o ${p%:*}.exr
+     retex-combine -q full.exr --texture Floor=brick.jpg --finish Floor=${p#*:} -o c.exr
+     near ${p%:*}.exr c.exr 100
+     cp c.exr ${p#*:}.exr
+ done

# Between two of the list it is the mean of both: values are followed as they are. 64/255 of three finishes is half of
# each, nearly.
$ for s in .25:g0:red .75:red:g1; do
+     retex-combine -q full.exr --texture:finish=g${s%%:*}.png Floor=brick.jpg -o m.exr
+     t=${s#*:}
+     oiiotool ${t%:*}.exr ${t#*:}.exr --add --mulc .5 -o c.exr
+     near m.exr c.exr 55
+ done
$ near g0.exr g1.exr 40
> g0.exr g1.exr 40

# The map of two halves of a texture: as a scene with a pattern of both finishes, and as the same paths with the map.
$ printf '#declare Retex = 1;\n' >e.pov
$ sed '/plane { y, 0 texture { Floor } }/d' room.pov >>e.pov
$ cat >>e.pov <<'END'
+ #declare P = pigment { rgb <.3,.7,.2> };
+ plane { y, 0
+     texture { checker
+         texture { P finish { retex { roughness 0.85 } } }
+         texture { P finish { retex { roughness 0.08 } } }
+         scale 0.5
+     }
+ }
+ END
$ retex-render -q --size 48x36 --spp 2048 --seed 9 --plain e.pov -o truth.exr
% two() { retex-render -q --size 48x36 --finish Floor=matt,polished -t Floor room.pov "$@"; }
$ two --spp 512 -o half.exr
$ for s in '' :rotate=90; do
+     retex-combine -q half.exr --texture:finish=map.png:scale=.5$s 'Floor=rgb(.3,.7,.2)' -o c$s.exr
+ done
$ two --plain --spp 512 --replace:finish=map.png:scale=.5 'Floor=rgb(.3,.7,.2)' -o p.exr
$ for i in p c; do near $i.exr truth.exr 36; done
$ near c.exr p.exr 40
$ near c:rotate=90.exr truth.exr 36
> c:rotate=90.exr truth.exr 36
$ retex-combine -q half.exr --texture:finish=map.png:scale=.5 'Floor=rgb(.3,.7,.2)' -o c.exr --error e.exr
$ retex-combine -q half.exr --finish Floor=polished --texture 'Floor=rgb(.3,.7,.2)' -o d.exr --error n.exr
$ oiiotool e.exr n.exr --sub -o more.exr
$ oiiotool --stats more.exr |
+     awk '/Min:/ { print ($3 > -1e-4 ? "no less" : $0) }
+          /Max:/ { print ($3 > 1e-3 ? "more where the finish varies" : $0) }
+          /Avg:/ { print ($4 > 1e-3 ? "most where it is seen" : $0) }'
> no less
> more where the finish varies
> most where it is seen

# In one pass, from samples, from a stream, in tables and texts, in packs, of frames.
% mapped='--texture:finish=map.png:scale=2 Floor=brick.jpg'
$ retex-combine -q set.exr $mapped -o one.exr
$ retex-sample -q set.exr $mapped | retex-combine -q - -o two.exr
$ cmp one.exr two.exr
$ retex-sample -q set.exr $mapped -o s.exr
$ retex-combine -q set.exr s.exr -o two.exr
$ cmp one.exr two.exr
$ retex-sample -q set.exr --texture Floor=brick.jpg |
+     retex-sample -q - --texture:finish=map.png:scale=2 Wall=brick.jpg -o x.exr
! retex-sample: error: Wall has no finishes to choose from: finish= cannot be used on it; render the set with --finish Wall=NAME,NAME
= 2
$ retex-sample -q set.exr --texture Wall=brick.jpg | retex-sample -q - $mapped | retex-combine -q - -o two.exr
$ retex-combine -q set.exr $mapped --texture Wall=brick.jpg -o three.exr
$ cmp two.exr three.exr
$ printf 'output,Floor\nfour.exr,:finish=map.png:scale=2 brick.jpg\nfive.exr,:scale=2 brick.jpg\n' >t.csv
$ retex-combine -q set.exr --batch t.csv
$ cmp one.exr four.exr
$ retex-combine -q set.exr --texture:scale=2 Floor=brick.jpg -o c.exr
$ cmp c.exr five.exr
$ retex-pack -q set.exr --lossless -o set.retex
$ retex-combine -q set.retex $mapped -o two.exr
$ cmp one.exr two.exr
$ cp map.png map.0007.png
$ retex-combine -q set.exr --frames 7 --texture:finish=map.%04d.png:scale=2 Floor=brick.jpg -o f.%04d.exr
$ cmp one.exr f.0007.exr
$ retex-pack -q full.exr --quality 95 -o full.retex
$ for p in g0:matt g1:polished; do
+     retex-combine -q full.retex --texture:finish=${p%:*}.png Floor=brick.jpg -o a.exr
+     retex-combine -q full.retex --texture Floor=brick.jpg --finish Floor=${p#*:} -o c.exr
+     near a.exr c.exr 100
+ done
$ retex-combine -q full.exr $mapped -o a.exr
$ retex-combine -q full.retex $mapped -o c.exr
$ near a.exr c.exr 36

# Pictures of one traversal have each their own map.
$ cat >t.csv <<'END'
+ output,Floor
+ v1.exr,:finish=map.png:scale=2 brick.jpg
+ v2.exr,:scale=2 brick.jpg
+ END
$ two --spp 8 --plain --variants t.csv
$ two --spp 8 --plain --replace:finish=map.png:scale=2 Floor=brick.jpg -o w1.exr
$ two --spp 8 --plain --replace:scale=2 Floor=brick.jpg -o w2.exr
$ cmp v1.exr w1.exr
$ cmp v2.exr w2.exr
$ near v1.exr v2.exr 40
> v1.exr v2.exr 40

# Where the texture is transparent, the finish shows that is chosen without a map.
$ oiiotool --pattern constant:color=0,0,0,0 8x8 4 -d uint8 -o clear.png
$ for f in matt polished; do
+     retex-combine -q full.exr --texture:finish=map.png Floor=clear.png --finish Floor=$f -o a.exr
+     retex-combine -q full.exr --texture Floor=clear.png --finish Floor=$f -o c.exr
+     near a.exr c.exr 100
+ done

# A folder's roughness chooses between the finishes next to it; 0.85 is matt, 0.08 polished, Gloss a mirror.
$ mkdir oak arm
$ cp brick.jpg oak/oak_diff_1k.jpg
$ cp brick.jpg arm/arm_diff_1k.jpg
$ render --finish Floor=matt,satin,polished,metal -o four.exr
$ retex-info four.exr | grep finishes
>   finishes     matt (as rendered), satin, polished, metal
$ for p in .85:matt .4:satin .08:polished 0:polished 1:matt; do
+     r=${p%:*}
+     g=$(awk "BEGIN { print 1 - $r }")
+     oiiotool --pattern constant:color=$r,$r,$r 8x8 3 -d float -o oak/oak_rough_1k.exr
+     retex-combine -q four.exr --texture Floor=oak -o a.exr
+     retex-combine -q four.exr --finish Floor=${p#*:} --texture Floor=brick.jpg -o c.exr
+     near a.exr c.exr 90
+     rm oak/oak_rough_1k.exr
+     oiiotool --pattern constant:color=.5,$r,.5 8x8 3 -d float -o arm/arm_arm_1k.exr
+     retex-combine -q four.exr --texture Floor=arm -o a.exr 2>>warned
+     near a.exr c.exr 90
+     oiiotool --pattern constant:color=$g,$g,$g 8x8 3 -d float -o oak/oak_gloss_1k.exr
+     retex-combine -q four.exr --texture Floor=oak -o a.exr
+     near a.exr c.exr 90
+     rm oak/oak_gloss_1k.exr
+ done
$ sort -u warned
> retex-combine: warning: arm: metalness and ambient occlusion maps are not used
$ oiiotool --pattern constant:color=.4,.4,.4 8x8 3 -d float -o oak/oak_rough_1k.exr
$ cp g.5.png oak/oak_nor_gl_1k.png
$ retex-combine four.exr --texture Floor=oak -o a.exr 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: warning: oak: the normal map is not used
> retex-combine: a.exr: Floor <- oak, 48 x 36
$ retex-combine four.exr --texture:finish=none Floor=oak -o b.exr 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: warning: oak: roughness and normal maps are not used
> retex-combine: b.exr: Floor <- oak, 48 x 36
$ retex-combine -q four.exr --texture Floor=brick.jpg -o c.exr
$ cmp b.exr c.exr
$ near a.exr b.exr 60
> a.exr b.exr 60

# What is refused, also in tables before anything is rendered.
$ retex-combine four.exr --texture:finish=gone.png Floor=brick.jpg -o x.exr
! retex-combine: error: cannot read gone.png: No such file or directory
= 2
$ retex-combine four.exr --texture:finish= Floor=brick.jpg -o x.exr
! retex-combine: error: texture option finish='': expected a picture without a colon in its name, as in finish=gloss.png, or none
= 2
$ retex-combine set.exr --texture:finish=map.png Wall=brick.jpg -o x.exr
! retex-combine: error: Wall has no finishes to choose from: finish= cannot be used on it; render the set with --finish Wall=NAME,NAME
= 2
$ retex-combine four.exr --texture:finish=room.pov Floor=brick.jpg -o x.exr
! retex-combine: error: room.pov: cannot read: OpenImageIO could not find a format reader for "room.pov". Is it a file format that OpenImageIO doesn't know about?
= 2
$ cat >t.csv <<'END'
+ output,Floor
+ x.exr,:finish=gone.png brick.jpg
+ y.exr,brick.jpg
+ END
$ retex-combine four.exr --batch t.csv
! retex-combine: error: t.csv:2: cannot read gone.png: No such file or directory
= 2
$ render --replace:finish=map.png Floor=brick.jpg -o x.exr
! retex-render: error: Floor has no finishes to choose from: finish= cannot be used on it
= 2
$ retex-combine four.exr --texture:finish=map.png Floor=brick.jpg -o map.png
! retex-combine: error: map.png: the output would replace the texture
= 2
$ test -e x.exr || test -e y.exr
= 1
