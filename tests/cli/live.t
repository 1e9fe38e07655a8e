# A scene that stays open: pictures of its views are those of renders.
$ cat >live.pov <<'END'
+ #version 3.7;
+ #declare Cam_A = camera { location <1,2,-4> look_at <0,.5,0> angle 50 }
+ #declare Floor = texture { pigment { checker rgb 1 rgb .2 } }
+ camera { location <0,1,-5> look_at <0,.5,0> right x*1.4 angle 40 }
+ light_source { <3,5,-5> 1 }
+ plane { y, 0 texture { Floor } }
+ sphere { <0,.5,0>, .5 pigment { rgb <1,.3,.1> } }
+ box { <-1.5,0,0>, <-.8,.6,.7> pigment { rgb .5 } rotate y*20 }
+ box { <.8,0,0>, <1.5,.6,.7> pigment { rgb .4 } rotate y*20 }
+ sphere { <1.2,2,1>, .3 pigment { rgb 1 } finish { emission 3 } }
+ END
% check() { /usr/bin/python3 -B "$TESTS/live.py" "$@"; }
$ check same_as_render
> [1, 2, 4, 8, 10, 20] True True True
> [1, 2, 4, 8, 10, 20] True True True
> [1, 2, 4, 8, 10, 20] True True True
> [1, 2, 4, 8, 10, 20] True True True
> (0, b'')
$ check denoised
> {'error': 'there is no picture of two samples that could be denoised', 'bytes': 0}
> {'error': 'there is no picture of two samples that could be denoised', 'bytes': 0}
> [1, 2, 4, 8, 16, 32] True
> True True
> [2, 8, 32]
> True
> True
> {'error': 'there is no request `look`', 'bytes': 0} (0, b'')
$ check surfaces
> material #5  True True
> material #1 Floor True True
> material #2  True True
> material #3  True True
> material #4  True True
> object #5  True True
> object #1 Floor True True
> object #2  True True
> object #3  True True
> object #4  True True
> flat #1/flat:1  True True
> flat #3/flat:5  True True
> flat #3/flat:4  True True
> flat #3/flat:2  True True
> flat #4/flat:4  True True
> flat #4/flat:2  True True
> flat #4/flat:5  True True
> level #1/level:1  True True
> level #4/level:5  True True
> level #3/level:2  True True
> level #4/level:4  True True
> level #4/level:2  True True
> nothing
$ check levels
> 82 82 0 True
> True (0, b'')
$ check uv
> [{'target': 'Floor', 'unit': [0.01, 0.01]}, {'target': 'Box', 'unit': [1, 1]}] [0, 1, 2]
> Floor True
> Box True
$ check lines
> ({'error': 'expected WIDTH HEIGHT, not `3 x`', 'bytes': 0}, b'')
> ({'error': 'expected WIDTH HEIGHT, not `0 5`', 'bytes': 0}, b'')
> ({'error': 'expected 1 to 1048576 samples, not `0`', 'bytes': 0}, b'')
> ({'error': 'expected view WIDTH HEIGHT CAMERA SPP', 'bytes': 0}, b'')
> ({'error': 'camera `1,2,3`: expected X,Y,Z:X,Y,Z[:ANGLE]', 'bytes': 0}, b'')
> ({'error': 'camera `1,2,3:1,2,3`: it is where it looks at', 'bytes': 0}, b'')
> ({'error': 'camera `1,2,3:0,0,0:171`: expected X,Y,Z:X,Y,Z[:ANGLE], where it is, what it looks at, and an angle from 1 to 170 degrees', 'bytes': 0}, b'')
> ({'error': 'camera `nan,2,3:0,0,0`: expected X,Y,Z:X,Y,Z[:ANGLE], where it is, what it looks at, and an angle from 1 to 170 degrees', 'bytes': 0}, b'')
> ({'error': '99999x99999 pixels are more than the 268435456 of --max-pixels', 'bytes': 0}, b'')
> ({'error': 'there is no request `look`', 'bytes': 0}, b'')
> ({'error': 'a line has at most 1023 bytes, and no NUL', 'bytes': 0}, b'')
> ({'error': 'expected uv WIDTH HEIGHT CAMERA', 'bytes': 0}, b'')
> ({'error': 'expected surfaces WIDTH HEIGHT CAMERA', 'bytes': 0}, b'')
> (3, 3, 4) True
> True
> stopped True
> followed 1 True
> 0
$ check endings
> -15
> -13 b''

# What is refused.
$ for c in Cam_B 1,2:3 1,2,3:4,5,6:0 1,2,3:1,2,3; do retex-render --camera $c live.pov -o x.exr; done
! retex-render: error: live.pov:11:1: no camera is declared as `Cam_B`; is Cam_A meant?
! retex-render: error: --camera: camera `1,2:3`: expected X,Y,Z:X,Y,Z[:ANGLE], where it is, what it looks at, and an angle from 1 to 170 degrees
! retex-render: error: --camera: camera `1,2,3:4,5,6:0`: expected X,Y,Z:X,Y,Z[:ANGLE], where it is, what it looks at, and an angle from 1 to 170 degrees
! retex-render: error: --camera: camera `1,2,3:1,2,3`: it is where it looks at
= 2
$ (ulimit -f 1; retex-render -q --plain --spp 4 --size 35x25 --camera 1,2,-4:0,.5,0 live.pov --resume -o x.exr)
! retex-render: error: cannot write x.exr.partial: File too large
= 2
$ retex-render --plain --spp 4 --size 35x25 --camera 1,2,-4:0,.5,1 live.pov --resume -o x.exr
! retex-render: error: x.exr.partial is of another render: other options, another scene or build
= 2
$ rm x.exr.partial
$ for o in --list-targets --noise=1 '--crop 0,0,1,1' --denoise '--aov uv' '-o x.exr'; do
+     retex-render --live $o live.pov </dev/null
+ done
! retex-render: error: --live cannot be combined with --list-targets
! retex-render: error: --live cannot be combined with --noise
! retex-render: error: --live cannot be combined with --crop
! retex-render: error: --live cannot be combined with --denoise
! retex-render: error: --live cannot be combined with --aov
! retex-render: error: --live goes to standard output: no -o
= 2
$ retex-render --live --max-memory 200M --max-pixels 1000000000 --size 20000x20000 live.pov </dev/null 2>err
= 2
$ sed 's/[0-9.]* GB/N GB/; s/are [0-9.]*:/are N:/' err
> retex-render: error: 20000x20000 pixels need N GB of memory, there are N: render parts with --crop, or raise --max-memory
