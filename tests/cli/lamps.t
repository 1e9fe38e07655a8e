# Lamps of a set: values on the command line, in tables, in streams and in names that OpenImageIO opens.
$ make_set s.exr 48 32
$ make_lamp_terms s.exr l.exr
$ cp "$SCENES/textures/brick.jpg" .
$ retex-info l.exr | grep -A1 ^param
> parameter Lamp
>   as rendered  1 0.5 2
> parameter Window
>   as rendered  1 1 1
> parameter rest
>   as rendered  1 1 1
$ make_lamp_terms s.exr m.exr several
$ make_lamp_terms s.exr o.exr off
$ retex-info m.exr | grep several
>   light        of several colours, which a new one multiplies
$ retex-info o.exr | grep -A2 Window
> parameter Window
>   as rendered  0 0 0
>   shines with  1 1 1

# Where no lamp is changed the picture is, to the byte, that of the set without lamps.
$ retex-combine -q s.exr -o s-original.exr
$ retex-combine -q l.exr --light Lamp=1 -o l-original.exr
$ cmp s-original.exr l-original.exr
$ retex-combine -q s.exr --texture Floor=brick.jpg -o s-brick.exr
$ retex-combine -q l.exr --texture Floor=brick.jpg --light Lamp=1 -o l-brick.exr
$ cmp s-brick.exr l-brick.exr
$ retex-combine l.exr --light lamp=2*rgb'(1,1,1)' --light Window=0 -o a.exr 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: a.exr: original textures, light:Window=0;light:lamp=2*rgb(1,1,1), 48 x 32

# Lamps add up: each alone, and all.
$ for n in Lamp Window rest; do retex-combine -q l.exr --texture Floor=brick.jpg --solo $n -o $n.exr; done
$ oiiotool Lamp.exr Window.exr --add rest.exr --add -o sum.exr
$ retex-combine -q l.exr --texture Floor=brick.jpg --light '*=1*1' --light Lamp=1 -o all.exr
$ retex-diff -q sum.exr all.exr --fail-psnr 55
$ retex-diff -q Lamp.exr all.exr --fail-psnr 40
= 1

# A lamp that is off is not in the picture, and is turned on by its brightness.
$ retex-combine -q o.exr -o off.exr
$ retex-combine -q l.exr --light Window=0 -o without.exr
$ retex-diff -q off.exr without.exr --fail-psnr 80
$ retex-combine -q o.exr --light Window=1 -o on.exr
$ retex-combine -q l.exr -o whole.exr
$ cmp on.exr s-original.exr

# The same in one pass, from samples, from a stream, and in a table.
% lit='--light Lamp=2*3000K --light *=0 --light Window=red'
$ retex-combine -q l.exr --texture Floor=brick.jpg $lit -o one.exr
$ retex-sample -q l.exr --texture Floor=brick.jpg -o x.exr
$ retex-combine -q l.exr x.exr $lit -o two.exr
$ cmp one.exr two.exr
$ retex-sample -q l.exr --texture Floor=brick.jpg | retex-combine -q - $lit -o three.exr
$ cmp one.exr three.exr
$ retex-combine -q l.exr --threads 1 --texture Floor=brick.jpg $lit -o four.exr
$ cmp one.exr four.exr
$ cat >t.csv <<'END'
+ output,Floor,light:lamp,light:*,light:Window
+ five.exr,brick.jpg,2*3000K,0,red
+ six.exr,,,,
+ END
$ retex-combine -q l.exr --batch t.csv
$ cmp one.exr five.exr
$ cmp six.exr s-original.exr
$ cat >t.csv <<'END'
+ output,Floor,light:lamp
+ seven.exr,brick.jpg,2*3000K
+ eight.exr,brick.jpg,
+ END
$ retex-combine -q l.exr --batch t.csv --solo Lamp --light Window=red
$ cmp one.exr seven.exr
$ retex-diff -q one.exr eight.exr --fail-psnr 60
= 1
$ retex-combine -q l.exr --texture Floor=brick.jpg --light Lamp=2*3000K --light '*=0' --light Window=red --error e.exr \
+     -o nine.exr
$ cmp one.exr nine.exr
$ retex-combine -q l.exr --texture Floor=brick.jpg --error f.exr -o nine.exr
$ cmp -s e.exr f.exr
= 1

# With a journal, a picture is made again where a lamp of its row has changed.
$ retex-combine -q l.exr --batch t.csv --manifest j
$ retex-combine l.exr --batch t.csv --manifest j --resume 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: 0 pictures, 2 kept
$ sed -i s/2.3000K/3000K/ t.csv
$ retex-combine l.exr --batch t.csv --manifest j --resume 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: seven.exr: Floor <- brick.jpg, light:Lamp=rgb(1.754746,0.8492223,0.27115253), 48 x 32
> retex-combine: 1 picture, 1 kept

# Packs: without loss, with it, where a dim lamp stays as fine as a bright one, and without lamps.
$ make_set n.exr 96 64 footprints denoise
$ make_lamp_terms n.exr f.exr
$ retex-pack -q f.exr --lossless -o a.retex
$ retex-pack -q f.exr -o b.retex 2>&1
> retex-pack: warning: the set cannot be made compact and takes more room: its footprints are of another form than those of layout footprints
$ for v in Lamp=20 Window=red rest=.01; do
+     for p in f.exr a.retex b.retex; do retex-combine -q $p --light $v --light '*=0' -o $p.png --depth 16; done
+     cmp f.exr.png a.retex.png
+     retex-diff -q f.exr.png b.retex.png --fail-psnr 44
+ done
$ retex-pack -q f.exr --no-lamps -o c.retex 2>&1
> retex-pack: warning: the set cannot be made compact and takes more room: its footprints are of another form than those of layout footprints
$ retex-pack -q n.exr -o d.retex 2>&1
> retex-pack: warning: the set cannot be made compact and takes more room: its footprints are of another form than those of layout footprints
$ cmp c.retex d.retex
$ retex-info c.retex 2>/dev/null | grep -c param
> 0
= 1
$ retex-pack -q f.exr --no-lamps --lossless -o c.retex
$ retex-pack -q n.exr --lossless -o d.retex
$ cmp c.retex d.retex
$ make_lamp_terms n.exr g.exr off
$ retex-pack g.exr --no-lamps -o e.retex
! retex-pack: error: the lamp Window is off in the picture, which only a set with lamps can tell
= 2
$ retex-pack --unpack b.retex --no-lamps -o y.exr
! retex-pack: error: --no-lamps is of packing
= 2

# A lamp that becomes a million times as bright, by a slip, is told of; one that was off is compared with what it shines
# with. The picture is made.
$ retex-combine -q l.exr --light Lamp=1e9 -o x.png
! retex-combine: warning: lamp Lamp becomes 1e+09 times as bright as it was rendered, and so does its noise
$ retex-combine -q l.exr --light Lamp=1e6 --light Window='2e6*red' -o x.png
! retex-combine: warning: lamp Window becomes 2e+06 times as bright as it was rendered, and so does its noise
$ retex-combine -q o.exr --light Window=999999 -o x.png
$ retex-combine -q o.exr --light Window=2e6 -o x.png
! retex-combine: warning: lamp Window becomes 2e+06 times as bright as it was rendered, and so does its noise
$ printf 'output,light:rest\ny1.png,1e9\ny2.png,1e3\n' >w.csv
$ retex-combine -q l.exr --batch w.csv
! retex-combine: warning: lamp rest becomes 1e+09 times as bright as it was rendered, and so does its noise
$ retex-render -q --plain --size 8x6 --spp 1 "$SCENES/cornell-box/cornell-box.pov" --light Lamp=1e7 -o x.png
! retex-render: warning: lamp Lamp becomes 1e+07 times as bright as it was rendered, and so does its noise

# What is refused.
$ retex-combine l.exr --light rets=0 -o y.exr
! retex-combine: error: no lamp is called 'rets'; the set has Lamp, Window, rest; is rest meant?
= 2
$ retex-combine s.exr --light Lamp=0 -o y.exr
! retex-combine: error: the set has no lamps: the light of 'Lamp' cannot be changed; render it with --lamps
= 2
$ retex-combine l.exr --light Lamp=bleu -o y.exr
! retex-combine: error: light 'bleu': expected numbers, colours and kelvins, as in 2.5, #ffd0a0 or 1.5*3000K; is blue meant?
= 2
$ retex-combine l.exr --light Lamp=1 --light Lamp=2 -o y.exr
! retex-combine: error: light:Lamp is given twice
= 2
$ printf 'output,light:Lamp,light:lamp,light:Sun\ny.exr,-1,2,3\n' >w.csv
$ retex-combine l.exr --batch w.csv
! retex-combine: error: w.csv:1: lamp 'lamp' has two columns
! retex-combine: error: w.csv:1: no lamp is called 'Sun'; the set has Lamp, Window, rest
! retex-combine: error: w.csv:2: light '-1': expected numbers, colours and kelvins, as in 2.5, #ffd0a0, 3000K or 1.5*3000K
= 2
$ ls y.exr
! ls: cannot access 'y.exr': No such file or directory
= 2
$ printf 'output,light:Lamp\ny.exr,1\n' >w.csv
$ retex-combine s.exr --batch w.csv
! retex-combine: error: w.csv:1: the set has no lamps: the light of 'Lamp' cannot be changed; render it with --lamps
= 2

# What shines in the project's scenes has a name.
$ for s in cornell-box glass-caustics kitchen living-room; do
+     retex-render -q --size 32x24 --list-lamps "$SCENES/$s/$s.pov" | sed 's/^[ 0-9.]*%  //'
+ done
> Lamp  rgb(20,17,12.4)
> Lamp  rgb(7.6,6.8,5.6)
> sky  several colours
> Sun  rgb(2,1.75,1.38)
> Daylight  rgb(3.5,3.9,4.4)
> Garden  rgb(1.7,1.85,1.8)
> Hood_Light  rgb(6,4.7,3.2)
> Shelf_Light  rgb(7,5.2,3.3)
> Pendant_Light  rgb(5.2,3.9,2.5)
> Daylight  rgb(5,5.6,6.3)
> Garden  rgb(2.8,3.1,3.2)
> Lamp  several colours

# What stands after the share is what -l takes, also of what has no name, and where another has the name of its number.
$ cat >stranger.pov <<'END'
+ camera { location <0,1,-4> look_at <0,.6,0> angle 40 }
+ sky_sphere { pigment { rgb .3 } } light_source { <1,3,-2> rgb 2 }
+ light_source { <-1,3,-2> rgb <1,.5,.2> spotlight point_at 0 }
+ #declare Sun = light_source { <0,5,0> rgb .3 }
+ light_source { Sun }
+ plane { y, 0 pigment { rgb .8 } }
+ mesh { triangle { <-1,2,-2>, <1,2,-2>, <1,2,0> } pigment { rgb 1 } finish { emission 3 diffuse 0 } }
+ union { sphere { <1,1,0>, .1 } sphere { <1.3,1,0>, .1 } pigment { rgb 1 } finish { emission 4 } }
+ #declare light2 = texture { pigment { rgb 1 } finish { emission 1 } }
+ box { <-1,0,0>, <-.8,.2,.2> texture { light2 } }
+ #declare Sky = sphere { <-1.4,1,0>, .1 pigment { rgb <1,.5,.2> } finish { emission 4 } }
+ object { Sky }
+ END
$ retex-render -q --size 32x24 --list-lamps stranger.pov | sed 's/^[ 0-9.]*%  //' >list
$ cat list
> light1=light_source#1  rgb(2,2,2)
> light2_=light_source#2  rgb(1,0.214,0.0331)
> Sun  rgb(0.0732,0.0732,0.0732)
> light2  rgb(1,1,1)
> Sky  rgb(25.3,5.42,0.838)
> object2=#2  rgb(12.8,12.8,12.8)
> object3=#3  rgb(25.3,25.3,25.3)
> object4=#4  rgb(25.3,25.3,25.3)
> rest  all other light
$ sed 's/  .*//; /^rest$/d' list >specs
$ retex-render -q --size 32x24 --list-lamps $(sed 's/^/-l /' specs) stranger.pov | sed 's/^[ 0-9.]*%  //' | cmp - list
$ retex-render -q --size 8x6 --spp 1 --lamps each stranger.pov -o x.exr

# Stopped and gone on with, and as frames: the same bits.
% render() { retex-render -q --size 32x24 --spp 2 -t Floor --lamps each "$@"; }
% scene=$TESTS/../../docs/suns.pov
$ render $scene -o whole.exr
$ render --max-time 0.0001 --resume $scene -o again.exr 2>/dev/null
= 2
$ render --resume $scene -o again.exr
$ cmp whole.exr again.exr
$ render --frames 1-2 $scene -o f-%d.exr
$ retex-combine -q f-%d.exr --frames 1-2 --solo Sun_16 -o p-%d.exr
$ retex-combine -q whole.exr --solo Sun_16 -o p.exr
$ retex-diff -q p-1.exr p.exr
= 1
$ retex-diff -q p-2.exr p.exr
= 1
$ rm whole.exr again.exr f-*.exr p*.exr
