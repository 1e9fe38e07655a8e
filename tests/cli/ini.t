# POV-Ray's .ini files and switches. What a scene sees was compared with what POV-Ray 3.7.0.10 prints for the same files
# and switches, run with `-D -F`; sections, quotes, names without endings, and lines of switches as well.
$ cat >t.pov <<'END'
+ #debug concat("frame ", str(frame_number, 0, 0), " of ", str(initial_frame, 0, 0), " to ", str(final_frame, 0, 0))
+ #debug concat(" clock ", str(clock, 0, 9), " size ", str(image_width, 0, 0), " x ", str(image_height, 0, 0), "\n")
+ sphere { 0, 1 pigment { rgb 1 } }
+ light_source { -9 * z rgb 1 }
+ camera { location -4 * z look_at 0 }
+ END
% render() {
%     retex-render -v --spp 1 "$@" 2>&1 | sed "/samples:/d; s/retex-render: //; s/\.000000000//g"
% }
$ cat >a.ini <<'END'
+ ; a comment
+ Width=8
+ Height = 6
+
+ [low]
+ Width=16
+ [Rather High, 3:2]
+ width="32" ; as wide
+ +H24
+ END
$ render a.ini t.pov -o x.exr
> frame 0 of 0 to 0 clock 0 size 8 x 6
$ render 'a.ini[LOW]' t.pov -o x.exr
> frame 0 of 0 to 0 clock 0 size 16 x 6
$ render t.pov 'a.ini[rather high, 3:2]' -o x.exr
> frame 0 of 0 to 0 clock 0 size 32 x 24
$ render a.ini +W5 t.pov -o x.exr
> frame 0 of 0 to 0 clock 0 size 5 x 6
$ render +W5 a.ini t.pov -o x.exr
> frame 0 of 0 to 0 clock 0 size 8 x 6
$ render --size 9x7 a.ini +W5 t.pov -o x.exr
> frame 0 of 0 to 0 clock 0 size 9 x 7

# Frames: all, cyclic, other numbers and clocks, a subset by numbers and by shares, a step; and a clock without frames.
$ for s in +KFF3 '+KFF3 +KC' '+KFI2 +KFF4 +KI1 +KF2' '+KFF3 +KI1 +KF0' '+KFF10 +SF3 +EF4' '+KFF10 +SF0.25 +EF0.35' \
+     '+KFI0 +KFF20 +KC +SF0.5 +EF0.5' '+KFF7 +STP3 +SF2' '+KFF1' '+K.3' '+KI.2 +KF3'; do
+     echo "$s"
+     render +It +W4 +H4 $s -o x-%d.exr
+ done
> +KFF3
> frame 1: frame 1 of 1 to 3 clock 0 size 4 x 4
> frame 2: frame 2 of 1 to 3 clock 0.500000000 size 4 x 4
> frame 3: frame 3 of 1 to 3 clock 1 size 4 x 4
> +KFF3 +KC
> frame 1: frame 1 of 1 to 4 clock 0 size 4 x 4
> frame 2: frame 2 of 1 to 4 clock 0.333333343 size 4 x 4
> frame 3: frame 3 of 1 to 4 clock 0.666666687 size 4 x 4
> +KFI2 +KFF4 +KI1 +KF2
> frame 2: frame 2 of 2 to 4 clock 1 size 4 x 4
> frame 3: frame 3 of 2 to 4 clock 1.500000000 size 4 x 4
> frame 4: frame 4 of 2 to 4 clock 2 size 4 x 4
> +KFF3 +KI1 +KF0
> frame 1: frame 1 of 1 to 3 clock 1 size 4 x 4
> frame 2: frame 2 of 1 to 3 clock 0.500000000 size 4 x 4
> frame 3: frame 3 of 1 to 3 clock 0 size 4 x 4
> +KFF10 +SF3 +EF4
> frame 3: frame 3 of 1 to 10 clock 0.222222224 size 4 x 4
> frame 4: frame 4 of 1 to 10 clock 0.333333343 size 4 x 4
> +KFF10 +SF0.25 +EF0.35
> frame 2: frame 2 of 1 to 10 clock 0.111111112 size 4 x 4
> frame 3: frame 3 of 1 to 10 clock 0.222222224 size 4 x 4
> +KFI0 +KFF20 +KC +SF0.5 +EF0.5
> frame 11: frame 11 of 0 to 21 clock 0.523809552 size 4 x 4
> +KFF7 +STP3 +SF2
> frame 2: frame 2 of 1 to 7 clock 0.166666672 size 4 x 4
> frame 5: frame 5 of 1 to 7 clock 0.666666687 size 4 x 4
> +KFF1
> frame 1: frame 1 of 1 to 1 clock 0 size 4 x 4
> +K.3
> frame 0 of 0 to 0 clock 0.300000012 size 4 x 4
> +KI.2 +KF3
> frame 0 of 0 to 0 clock 0 size 4 x 4
$ render +It +W4 +H4 +KFF10 --frames 3-4 -o x-%d.exr
> frame 3: frame 3 of 1 to 10 clock 0.222222224 size 4 x 4
> frame 4: frame 4 of 1 to 10 clock 0.333333343 size 4 x 4
$ render +It +W4 +H4 +KI2 +KF4 --frames 3-5 -o x-%d.exr
> frame 3: frame 3 of 3 to 5 clock 2 size 4 x 4
> frame 4: frame 4 of 3 to 5 clock 3 size 4 x 4
> frame 5: frame 5 of 3 to 5 clock 4 size 4 x 4

# Names: relative to the file; outputs get their number.
$ mkdir d
$ cp t.pov d
$ cat >d/b.ini <<'END'
+ Input_File_Name=t
+ Output_File_Name="o 1%"
+ +W4 +H4 -d
+ Include_Ini=frames
+ END
$ printf 'Final_Frame=10\n+SF9 Declare=A=1\n' >d/frames.ini
$ render d/b.ini
> d/b.ini:3: -d has no meaning here
> frame 9: frame 9 of 1 to 10 clock 0.888888896 size 4 x 4
> frame 10: frame 10 of 1 to 10 clock 1 size 4 x 4
$ render d/b.ini +SF10 +FJ
> d/b.ini:3: -d has no meaning here
> frame 10: frame 10 of 1 to 10 clock 1 size 4 x 4
$ render d/b.ini -o kept.png --frames 2
> d/b.ini:3: -d has no meaning here
> frame 2: frame 2 of 1 to 10 clock 0.111111112 size 4 x 4
$ printf 'Include_Ini=d/b.ini\nOutput_File_Name=s.png\n+SF10' >c.ini
$ render c.ini
> d/b.ini:3: -d has no meaning here
> frame 10: frame 10 of 1 to 10 clock 1 size 4 x 4
$ ls
> a.ini
> c.ini
> d
> kept.png
> o 1%09.png
> o 1%10.jpg
> o 1%10.png
> s10.png
> t.pov
> x-%d.exr
> x-1.exr
> x-11.exr
> x-2.exr
> x-3.exr
> x-4.exr
> x-5.exr
> x.exr

# The window; declarations, of which -D wins; the seed.
$ render t.pov +W20 +H10 +SC3 +EC6 +SR.5 -o x.exr
> frame 0 of 0 to 0 clock 0 size 20 x 10
$ retex-info x.exr | grep ^size
> size           4 x 5 pixels, box filter
$ echo '#debug concat("A is ", str(A, 0, 0), "\n")' >>t.pov
$ printf 'Declare=A=3\n' >a.ini
$ render t.pov a.ini --size 4x4 -o x.exr
> frame 0 of 0 to 0 clock 0 size 4 x 4
> A is 3
$ render t.pov a.ini -D A=4 --size 4x4 +SS7 -o x.exr
> frame 0 of 0 to 0 clock 0 size 4 x 4
> A is 4
$ retex-info x.exr | grep ^samples
> samples        1 a pixel, seed 7

# Continue_Trace is --resume; commands are not run; what has no meaning is passed over.
$ cat >e.ini <<'END'
+ Declare=A=1
+ Continue_Trace=On
+ Final_Frame=2
+ Antialias=On
+ Post_Frame_Command=touch ran
+ Pre_Frame_Command=
+ +Q9 +A0.1 t.pov
+ END
$ render e.ini --size 4x4 -o e-%d.exr
> e.ini:4: Antialias has no meaning here
> e.ini:5: warning: Post_Frame_Command is not run
> e.ini:7: +Q9 has no meaning here
> e.ini:7: +A0.1 has no meaning here
> frame 1: frame 1 of 1 to 2 clock 0 size 4 x 4
> frame 1: A is 1
> frame 2: frame 2 of 1 to 2 clock 1 size 4 x 4
> frame 2: A is 1
$ render e.ini --size 4x4 -o e-%d.exr
> e.ini:4: Antialias has no meaning here
> e.ini:5: warning: Post_Frame_Command is not run
> e.ini:7: +Q9 has no meaning here
> e.ini:7: +A0.1 has no meaning here
> frame 1: e-1.exr is there
> frame 2: e-2.exr is there
$ ls ran
! ls: cannot access 'ran': No such file or directory
= 2
$ retex-render -q e.ini --list-targets
! retex-render: e.ini:5: warning: Post_Frame_Command is not run

# Mistakes: one line, with file and line, before anything is rendered.
% # Options in a file: try TEXT OPTION…
% try() {
%     printf "$1" >f.ini
%     shift
%     retex-render -q "$@" f.ini t.pov -o x-%d.exr
% }
$ try 'Wdith=3'
! retex-render: error: f.ini:1: POV-Ray has no option `Wdith`; is Width meant?
= 2
$ try '\nWidth=-3'
! retex-render: error: f.ini:2: Width: expected a whole number from 1 to 16777216, not '-3'
= 2
$ try 'Width=3x'
! retex-render: error: f.ini:1: Width: expected a whole number from 1 to 16777216, not '3x'
= 2
$ try 'Width=3\nHeight=\n'
! retex-render: error: f.ini:2: Height: expected a whole number from 1 to 16777216, not ''
= 2
$ try '+Z'
! retex-render: error: f.ini:1: POV-Ray has no switch `+Z`
= 2
$ try '+W'
! retex-render: error: f.ini:1: +W: expected a whole number from 1 to 16777216, not ''
= 2
$ try '[a\n'
! retex-render: error: f.ini:1: expected `]` after a section's name
= 2
$ try 'Clock=nan'
! retex-render: error: f.ini:1: Clock: expected a number from -1e+30 to 1e+30, not 'nan'
= 2
$ try 'Cyclic_Animation=maybe'
! retex-render: error: f.ini:1: Cyclic_Animation: expected on or off, not 'maybe'
= 2
$ try 'Declare=A=1/3'
! retex-render: error: f.ini:1: Declare: expected NAME=NUMBER or NAME="TEXT", not `A=1/3`
= 2
$ try 'Width=4'
! retex-render: error: POV-Ray's Width needs Height
= 2
$ try 'Final_Frame=5\nInitial_Frame=7'
! retex-render: error: the last frame, 5, is before the first, 7
= 2
$ try 'Final_Frame=999999999'
! retex-render: error: 999999999 frames are more than the 100000 that one command makes: give a part of them with --frames
= 2
$ try 'Final_Frame=99999999999'
! retex-render: error: f.ini:1: Final_Frame: expected a whole number from 0 to 999999999, not '99999999999'
= 2
$ try 'Final_Frame=3' --frames 3-4
! retex-render: error: there are no frames 3 to 4: the animation has frames 1 to 3
= 2
$ try 'Final_Frame=3\n+SF3 +EF2'
! retex-render: error: there are no frames 3 to 2: the animation has frames 1 to 3
= 2
$ try '+SC9' --size 8x8
! retex-render: error: no pixel is between Start_Column and End_Column and between Start_Row and End_Row
= 2
$ try 'Final_Frame=3' -D clock=2
! retex-render: error: -D clock=2: an animation sets this for each frame
= 2
$ try 'no.ini'
! retex-render: error: f.ini:1: cannot read no.ini: No such file or directory
= 2
$ try 'f.ini'
! retex-render: error: f.ini:1: f.ini: .ini files that include each other more than 10 deep
= 2
$ try 'a\000b'
! retex-render: error: f.ini is no .ini file: it holds NUL bytes
= 2
$ printf '[Low]\n[High]\n' >f.ini
$ retex-render -q 'f.ini[hihg]' t.pov -o x.exr
! retex-render: error: f.ini has no section [hihg]; is High meant?
= 2
$ retex-render -q 'f.ini[x' t.pov -o x.exr
! retex-render: error: one scene at a time: `f.ini[x` and `t.pov`
= 2
$ retex-render -q no.ini
! retex-render: error: cannot read no.ini: No such file or directory
= 2
$ retex-render -q f.ini -o x.exr
! retex-render: error: no scene given; try --help
= 2
$ head -c 2000000 /dev/zero | tr '\0' ' ' >l.ini
$ retex-render -q l.ini
! retex-render: error: l.ini: an .ini file has less than 1048576 bytes
= 2
$ for k in 0 1 2 3 4 5 6 7 8; do for i in 1 2 3 4; do echo "g$((k + 1)).ini"; done >g$k.ini; done
$ : >g9.ini
$ retex-render -q g0.ini
! retex-render: error: g8.ini:3: more than 1000 .ini files in all
= 2

# With --safe, a file names only what is in its folder.
% cd d
$ for l in Input_File_Name=../t.pov Input_File_Name=/etc/passwd Include_Ini=../a.ini Library_Path=.. \
+     Output_File_Name=x; do
+     echo "$l" >h.ini
+     retex-render -q --safe h.ini -o x.exr
+ done
! retex-render: error: h.ini:1: Input_File_Name: ../t.pov is outside the folder of the .ini file (--safe)
! retex-render: error: h.ini:1: Input_File_Name: /etc/passwd.pov is outside the folder of the .ini file (--safe)
! retex-render: error: h.ini:1: the file: ../a.ini is outside the folder of the .ini file (--safe)
! retex-render: error: h.ini:1: Library_Path: .. is outside the folder of the .ini file (--safe)
! retex-render: error: h.ini:1: Output_File_Name: an .ini file names no output (--safe): give -o
= 2
$ echo 't.pov' >h.ini
$ retex-render -q --safe --size 4x4 h.ini -o x.exr
$ retex-render -q --safe --size 4x4 ../d/h.ini -o x.exr
% cd ..
$ retex-render -q --safe --size 4x4 d/h.ini -o y.exr
$ ls y.exr
> y.exr
