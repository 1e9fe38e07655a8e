# Animations: what a scene knows of a frame, --frames, and file names that hold its number.

# The values are those that POV-Ray 3.7.0.10 prints for the same scene with `-D -F +W4 +H4` and the switches
# `+KFF3`; `+KFI2 +KFF6`; `+KFF4`: clock is rounded to single precision. Of clock_delta, POV-Ray
# keeps six decimals, and in an animation of one frame it has no clock: here it is that of the first frame.
$ cat >s.pov <<'END'
+ #macro P(N, V) #debug concat(" ", N, " ", str(V, 0, 9)) #end #debug concat("frame ", str(frame_number, 0, 0))
+ P("of", initial_frame) P("to", final_frame)
+ P("clock", clock) P("delta", clock_delta) P("on", clock_on) P("from", initial_clock) P("until", final_clock)
+ #debug "\n"
+ sphere { clock * x, 1 pigment { rgb 1 } } light_source { -9 * z rgb 1 } camera { location -4 * z look_at 0 }
+ END
% # What the scene says of its frames.
% clock() {
%     retex-render --size 8x6 --spp 2 s.pov "$@" 2>&1 | sed '/samples:/d; s/retex-render: //; s/\.000000000//g'
% }
$ clock -v --frames 1-3 -o a-%d.exr
> frame 1: frame 1 of 1 to 3 clock 0 delta 0.500000000 on 1 from 0 until 1
> frame 2: frame 2 of 1 to 3 clock 0.500000000 delta 0.500000000 on 1 from 0 until 1
> frame 3: frame 3 of 1 to 3 clock 1 delta 0.500000000 on 1 from 0 until 1
$ clock -v --frames 2-6 -o b-%d.exr
> frame 2: frame 2 of 2 to 6 clock 0 delta 0.250000000 on 1 from 0 until 1
> frame 3: frame 3 of 2 to 6 clock 0.250000000 delta 0.250000000 on 1 from 0 until 1
> frame 4: frame 4 of 2 to 6 clock 0.500000000 delta 0.250000000 on 1 from 0 until 1
> frame 5: frame 5 of 2 to 6 clock 0.750000000 delta 0.250000000 on 1 from 0 until 1
> frame 6: frame 6 of 2 to 6 clock 1 delta 0.250000000 on 1 from 0 until 1
$ clock -v --frames 7 -o c-%03d.exr
> frame 7: frame 7 of 7 to 7 clock 0 delta 0 on 1 from 0 until 1
$ clock -v --frames 1-4x2 -o d-%d.png
> frame 1: frame 1 of 1 to 4 clock 0 delta 0.333333333 on 1 from 0 until 1
> frame 3: frame 3 of 1 to 4 clock 0.666666687 delta 0.333333333 on 1 from 0 until 1
$ clock -v --frames 2-5x3 -o d-%d.png
> frame 2: frame 2 of 2 to 5 clock 0 delta 0.333333333 on 1 from 0 until 1
> frame 5: frame 5 of 2 to 5 clock 1 delta 0.333333333 on 1 from 0 until 1
$ ls
> a-1.exr
> a-2.exr
> a-3.exr
> b-2.exr
> b-3.exr
> b-4.exr
> b-5.exr
> b-6.exr
> c-007.exr
> d-1.png
> d-2.png
> d-3.png
> d-5.png
> s.pov

# A still picture has no animation; -D sets its variables.
$ clock -v -o s.exr
> frame 0 of 0 to 0 clock 0 delta 0 on 0 from 0 until 0
$ clock -v -D clock=.3 -o s.exr
> frame 0 of 0 to 0 clock 0.300000000 delta 0 on 1 from 0 until 0
$ clock -v -D frame_number=4 -D final_frame=9 -D clock_delta=.5 -o s.exr
> frame 4 of 0 to 9 clock 0 delta 0.500000000 on 1 from 0 until 0

# A frame is the same alone and among others; its seed is that of --seed plus its number.
$ retex-render -q --size 8x6 --spp 2 --seed 5 -D clock=.5 -D frame_number=2 s.pov -t x=#1 -o still.exr
$ retex-render -q --size 8x6 --spp 2 --seed 3 s.pov -t x=#1 --frames 1-3 -o m-%d.exr
$ retex-diff m-2.exr still.exr --fail-abs 0 >/dev/null && echo same
> same
$ cp m-2.exr kept.exr
$ rm m-*
$ retex-render -q --size 8x6 --spp 2 --seed 3 s.pov -t x=#1 --frames 1-3x2 -o m-%d.exr
$ retex-diff m-1.exr m-3.exr --fail-abs 0 >/dev/null || echo differ
> differ
$ ls m-*
> m-1.exr
> m-3.exr

# Every file of a frame may have its number.
$ make_picture t-1.png
$ make_picture t-2.png noise=.2
$ retex-render -q --size 8x6 --spp 2 s.pov -t x=#1 --replace x=t-%d.png --frames 1-2 -o r-%d.exr --stats r-%d.json
$ retex-diff r-1.exr r-2.exr --fail-abs 0 >/dev/null || echo differ
> differ
$ retex-render -q --size 8x6 --spp 2 s.pov --frames 1-2 -o v-%d.exr --aov-dir v-%d --aov depth
$ ls
> a-1.exr
> a-2.exr
> a-3.exr
> b-2.exr
> b-3.exr
> b-4.exr
> b-5.exr
> b-6.exr
> c-007.exr
> d-1.png
> d-2.png
> d-3.png
> d-5.png
> kept.exr
> m-1.exr
> m-3.exr
> r-1.exr
> r-1.json
> r-2.exr
> r-2.json
> s.exr
> s.pov
> still.exr
> t-1.png
> t-2.png
> v-1
> v-1.exr
> v-2
> v-2.exr
$ ls v-2
> beauty.exr
> beauty.png
> depth.exr
> depth.png
$ retex-render -q --size 8x6 --spp 2 s.pov --frames 4 -o 100%%-%%d-%d.exr
$ ls 1*
> 100%-%d-4.exr

# Mistakes are found before the first frame.
$ rm -f *.exr
$ for n in '' 3-1 1-2x0 -1-2 1-2y 1-2-3 9999999999 1.5; do retex-render -q --frames "$n" s.pov -o x-%d.exr; done
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not ``
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not `3-1`
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not `1-2x0`
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not `-1-2`
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not `1-2y`
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not `1-2-3`
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not `9999999999`
! retex-render: error: --frames: expected the first frame and the last, as 1-12, or 1-12x2, not `1.5`
= 2
$ for n in x.exr x%s.exr x%4d.exr x%.exr x%0999d.exr x%; do retex-render -q --frames 1-2 s.pov -o $n; done
! retex-render: error: the output: 2 frames need a number in the name, as name-%04d.exr, not `x.exr`
! retex-render: error: the output: expected %d or %04d, the frame's number, or %% for a percent sign, in `x%s.exr`
! retex-render: error: the output: expected %d or %04d, the frame's number, or %% for a percent sign, in `x%4d.exr`
! retex-render: error: the output: expected %d or %04d, the frame's number, or %% for a percent sign, in `x%.exr`
! retex-render: error: the output: expected %d or %04d, the frame's number, or %% for a percent sign, in `x%0999d.exr`
! retex-render: error: the output: expected %d or %04d, the frame's number, or %% for a percent sign, in `x%`
= 2
$ retex-render -q --frames 0-100000 s.pov -o x-%d.exr
! retex-render: error: 100001 frames are more than the 100000 that one command makes: give a part of them with --frames
= 2
$ retex-render -q --frames 1-2 s.pov -o x-%d.exr --stats x.json
! retex-render: error: --stats: 2 frames need a number in the name, as name-%04d.exr, not `x.json`
= 2
$ retex-render -q --frames 1-2 s.pov
! retex-render: error: the output: 2 frames need a number in the name, as name-%04d.exr, not `-`
= 2
$ retex-render -q --frames 1-2 s.pov -D clock=1 -o x-%d.exr
! retex-render: error: -D clock=1: an animation sets this for each frame
= 2
$ retex-render -q --frames 1-2 s.pov -o no/x-%d.exr
! retex-render: error: frame 1: cannot write no/x-1.exr: No such file or directory
= 2
$ retex-render -q --frames 1-2 s.pov -t x=#1 --replace x=t-%d.png -o t-%d.png
! retex-render: error: frame 1: t-1.png: the output would replace the texture
= 2
$ retex-render -q --frames 1-3 s.pov -t x=#1 --replace x=t-%d.png -o u-%d.png
! retex-render: error: frame 3: cannot read t-3.png: No such file or directory
= 2
$ printf 'output,x\n' >t.csv
$ retex-render -q --frames 1-2 s.pov -t x=#1 --variants t.csv
! retex-render: error: --variants makes one table of pictures: no frames
= 2
$ ls
> d-1.png
> d-2.png
> d-3.png
> d-5.png
> r-1.json
> r-2.json
> s.pov
> t-1.png
> t-2.png
> t.csv
> u-1.png
> u-2.png
> v-1
> v-2

# The tool stops at a frame that fails, and --resume goes on.
$ cp s.pov bad.pov
$ echo '#warning "odd" #if (frame_number = 3 & !defined(Mended)) #error "no frame 3" #end' >>bad.pov
$ retex-render --size 8x6 --spp 2 bad.pov --frames 1-4 -o x-%d.exr 2>&1 | sed 's/samples: .*/samples/'
> retex-render: frame 1: bad.pov:6: warning: odd
> retex-render: frame 1: 8x6, 2 samples
> retex-render: frame 2: 8x6, 2 samples
> retex-render: error: frame 3: bad.pov:6:65: no frame 3
$ ls x-*
> x-1.exr
> x-2.exr
$ retex-render --size 8x6 --spp 2 bad.pov -D Mended=1 --resume --frames 1-4 -o x-%d.exr 2>&1 |
+     sed 's/samples: .*/samples/'
> retex-render: frame 1: x-1.exr is there
> retex-render: frame 2: x-2.exr is there
> retex-render: frame 3: bad.pov:6: warning: odd
> retex-render: frame 3: 8x6, 2 samples
> retex-render: frame 4: 8x6, 2 samples
$ ls x-*
> x-1.exr
> x-2.exr
> x-3.exr
> x-4.exr

# retex-combine: sets, samples, textures and pictures by frame. Pictures are those of single commands.
$ mkdir c
% cd c
$ sed 's/, 1 pigment/, .5 + clock pigment/' ../s.pov >w.pov
$ for k in 1 2 3; do
+     retex-render -q --size 24x16 --spp 4 --seed $k -D clock=.$k w.pov -t x=#1 -o set-0$k.exr
+     make_picture t-$k.png noise=0.$k
+     retex-combine -q set-0$k.exr --texture:width=.7 x=t-$k.png -o one-$k.png
+     retex-combine -q set-0$k.exr --texture:width=.7 x=t-1.png -o fix-$k.png
+ done
$ for k in 1 2 3; do retex-combine -q set-02.exr --texture x=t-$k.png -o still-$k.png; done
$ retex-combine set-%02d.exr --frames 1-3 --texture:width=.7 x=t-%d.png -o a-%d.png 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: frame 1: a-1.png: x <- t-1.png, 24 x 16
> retex-combine: frame 2: a-2.png: x <- t-2.png, 24 x 16
> retex-combine: frame 3: a-3.png: x <- t-3.png, 24 x 16
> retex-combine: 3 frames
$ retex-combine -q set-%02d.exr --frames 1-3x2 --texture:width=.7 x=t-1.png -o b-%d.png
$ retex-combine -q set-02.exr --frames 1-3 --texture x=t-%d.png -o c-%d.png
$ retex-combine -q set-02.exr --memory 0 --frames 1-3 --texture x=t-%d.png -o d-%d.png --error d-%d.exr
$ for k in 1 2 3; do
+     cmp one-$k.png a-$k.png
+     cmp still-$k.png c-$k.png
+     cmp still-$k.png d-$k.png
+ done
$ cmp fix-1.png b-1.png
$ cmp fix-3.png b-3.png
$ ls b-* d-*
> b-1.png
> b-3.png
> d-1.exr
> d-1.png
> d-2.exr
> d-2.png
> d-3.exr
> d-3.png
$ for k in 1 2 3; do
+     retex-sample -q set-0$k.exr --texture x=t-$k.png -o s-$k.exr
+     retex-combine -q set-0$k.exr s-$k.exr -o e-$k.png
+ done
$ retex-combine -q set-%02d.exr s-%d.exr --frames 1-3 -o f-%d.png
$ for k in 1 2 3; do cmp e-$k.png f-$k.png; done

# The two targets of two sets in another order keep their textures.
$ echo 'sphere { x, .5 pigment { rgb 1 } }' | cat ../s.pov - >two.pov
$ for o in '1 -t x=#1 -t y=#2' '2 -t y=#2 -t x=#1'; do
+     retex-render -q --size 24x16 --spp 4 --seed 1 two.pov ${o#* } -o o-${o%% *}.exr
+ done
$ retex-combine -q o-%d.exr --frames 1-2 --texture x=t-1.png --texture 'y=rgb(1,0,0)' -o o-%d.png
$ retex-diff o-1.png o-2.png --fail-psnr 60 >/dev/null && echo same
> same
% cd ..

# A texture that stays is loaded once, and so what is odd about it is said once.
$ cd c
+ retex-combine -q set-%02d.exr --frames 1-3 --texture 'x=rgb(3,3,3)' -o g-%d.png
! retex-combine: warning: frame 1: x=rgb(3,3,3): a surface of a colour above 1 gives back more light than it gets

# A frame that fails ends the command, unless --keep-going.
% cd c
$ rm -f a-* b-*
$ head -c 2000 set-02.exr >short
$ mv short set-02.exr
$ retex-combine -q set-%02d.exr --frames 1-3 -o a-%d.png
! retex-combine: error: frame 2: set-02.exr is damaged or truncated: Attribute 'retex', type 'string': Invalid size 5631
= 2
$ ls a-*
> a-1.png
$ retex-combine -q set-%02d.exr --frames 1-3 --keep-going -o b-%d.png
! retex-combine: error: frame 2: set-02.exr is damaged or truncated: Attribute 'retex', type 'string': Invalid size 5631
! retex-combine: error: 1 of 3 frames failed
= 2
$ ls b-*
> b-1.png
> b-3.png
$ rm set-02.exr
$ retex-combine -q set-%02d.exr --frames 1-3 --keep-going -o b-%d.png
! retex-combine: error: frame 2: cannot read set-02.exr: No such file or directory
! retex-combine: error: 1 of 3 frames failed
= 2
$ retex-combine -q set-%02d.exr --frames 1-3 --texture x=t-%d.jpg -o b-%d.png
! retex-combine: error: frame 1: cannot read t-1.jpg: No such file or directory
= 2

# Mistakes.
$ retex-combine -q set-%02d.exr --frames 1-3 -o a.png
! retex-combine: error: the output: 3 frames need a number in the name, as name-%04d.exr, not `a.png`
= 2
$ retex-combine -q set-%s.exr --frames 1-3 -o a-%d.png
! retex-combine: error: the set: expected %d or %04d, the frame's number, or %% for a percent sign, in `set-%s.exr`
= 2
$ retex-combine -q set-%02d.exr --frames 1-3 -o set-%02d.exr
! retex-combine: error: frame 1: set-01.exr: the output would replace the set
= 2
$ retex-combine -q set-%02d.exr --frames 1-3 -o a-%d.png --error e.exr
! retex-combine: error: --error needs the textures: name them with --texture
= 2
$ retex-combine -q set-%02d.exr --frames 1-3 --texture x=t-%d.png -o t-%d.png
! retex-combine: error: frame 1: t-1.png: the output would replace the texture
= 2
$ retex-combine -q set-%02d.exr --frames 1-3 --batch x.csv
! retex-combine: error: --frames and --batch exclude each other
= 2
$ retex-combine -q set-01.exr --keep-going -o a.png
! retex-combine: error: --keep-going needs a table of pictures: --batch, or --frames
= 2
$ retex-combine -q set-%02d.exr --frames 1-3 --dry-run -o a-%d.png
! retex-combine: error: --dry-run needs a table of pictures: --batch
= 2
$ retex-combine -q set-%02d.exr --frames 1-3 --texture z=t-1.png -o a-%d.png
! retex-combine: error: frame 1: no target is called 'z'; the set has x
= 2

# retex-sample by frame: as frame by frame.
$ for k in 1 3; do retex-sample -q set-0$k.exr --texture:width=.7 x=t-1.png -o w-$k.exr; done
$ retex-sample -q set-%02d.exr --frames 1-3x2 --texture:width=.7 x=t-1.png -o v-%d.exr
$ for k in 1 3; do cmp v-$k.exr w-$k.exr; done
$ retex-sample -q set-%02d.exr --frames 1-3 --texture x=t-%d.png -o u-%d.exr
! retex-sample: error: frame 2: cannot read set-02.exr: No such file or directory
= 2
$ ls u-*
> u-1.exr
$ retex-sample -q set-%02d.exr --frames 1-3 --texture x=t-%d.png -o u.exr
! retex-sample: error: the output: 3 frames need a number in the name, as name-%04d.exr, not `u.exr`
= 2
$ retex-sample -q set-%02d.exr --frames 1-3 --texture x=t-%d.png -o t-%d.png
! retex-sample: error: frame 1: t-1.png: the output would replace the texture
= 2
$ retex-sample -q set-%02d.exr --frames 1-3 --texture x=t-%d.png -o set-%02d.exr
! retex-sample: error: frame 1: set-01.exr: the output would replace the set
= 2
% cd ..

# With --keep-going, a frame that fails does not end the others.
$ cat >bad.pov <<'END'
+ #if (frame_number = 2) #error "no second\n" #end
+ #include "s.pov"
+ #if (frame_number = 4) sphere { 0, 1 pigment { image_map { png "none.png" } } } #end
+ END
$ retex-render -q --size 8x6 --spp 2 bad.pov -t x=#1 --frames 1-5 -o k-%d.exr
! retex-render: error: frame 2: bad.pov:1:31: no second
= 2
$ ls k-*
> k-1.exr
$ rm k-*
$ retex-render -q --size 8x6 --spp 2 bad.pov -t x=#1 --frames 1-5 --keep-going -o k-%d.exr
! retex-render: error: frame 2: bad.pov:1:31: no second
! retex-render: error: frame 4: bad.pov:3:64: cannot find the image `none.png` in the scene's folder or the include path
! retex-render: error: 2 of 5 frames failed
= 2
$ ls k-*
> k-1.exr
> k-3.exr
> k-5.exr
$ retex-sample -q k-%d.exr --texture 'x=rgb(1,.5,.2)' --frames 1-5 -o y-%d.exr
! retex-sample: error: frame 2: cannot read k-2.exr: No such file or directory
= 2
$ ls y-*
> y-1.exr
$ rm y-*
$ retex-sample -q k-%d.exr --texture 'x=rgb(1,.5,.2)' --frames 1-5 --keep-going -o y-%d.exr
! retex-sample: error: frame 2: cannot read k-2.exr: No such file or directory
! retex-sample: error: frame 4: cannot read k-4.exr: No such file or directory
! retex-sample: error: 2 of 5 frames failed
= 2
$ ls y-*
> y-1.exr
> y-3.exr
> y-5.exr
$ retex-sample -q k-1.exr --texture 'x=rgb(1,.5,.2)' --keep-going -o y.exr
! retex-sample: error: --keep-going needs --frames
= 2
$ retex-render -q --size 8x6 --spp 2 s.pov --keep-going -o y.exr
! retex-render: error: --keep-going needs a table of pictures: --variants, or --frames
= 2
$ retex-render -q --size 8x6 --spp 2 s.pov -t x=#1 --replace x=t-%d.png --frames 1-3 --keep-going -o r-%d.exr
! retex-render: error: frame 3: cannot read t-3.png: No such file or directory
! retex-render: error: 1 of 3 frames failed
= 2
$ retex-render -q --size 8x6 --spp 2 --max-memory 64M s.pov +KFF2 --keep-going -o e-%d.exr && ls e-*
> e-1.exr
> e-2.exr
