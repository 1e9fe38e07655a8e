# What is listed of a scene, with combinations of -t, -l, --finish, --camera and --crop: a sample, by the day of the last
# commit; long/listings runs all of them with sanitizers.
$ skip-unless /usr/bin/python3 -c ''
% day=$(($(git -C "$TESTS" show -s --format=%ct HEAD 2>/dev/null || echo 0) / 86400))
% sample() { /usr/bin/python3 -B "$TESTS/../lib/listings.py" "$(command -v retex-render)" 10 $day "$@"; }
$ sample "$SCENES"/*/*.pov "$TESTS"/../golden/room.pov "$TESTS/finishes.pov" >told
$ grep '^not ok\|^1' told
> 1..6

# Targets and their finishes leave the shares of lamps as they are.
% lamps() { retex-render -q --size 64x36 --list-lamps "$@" "$SCENES/living-room/living-room.pov"; }
$ lamps >plain
$ lamps -t Floor -t Wall | cmp - plain
$ lamps -t Floor -t Wall --finish Floor=matt,metal --finish Wall=original,satin --show Wall=satin | cmp - plain
$ lamps -l Lamp -l Garden -t Floor | sed 's/^[ 0-9.]*%  //'
> Lamp  several colours
> Garden  rgb(2.8,3.1,3.2)
> rest  all other light

# A rectangle has shares of its own; one that does not lie in the picture is refused by its own numbers.
$ cat >two.pov <<'END'
+ #version 3.7;
+ camera { orthographic location -z right 2*x up y }
+ #declare Left = box { <-.8,-.4,0>, <-.2,.4,.1> pigment { rgb 1 } finish { emission rgb <1,2,4> diffuse 0 } }
+ #declare Right = box { <.2,-.4,0>, <.8,.4,.1> pigment { rgb 1 } finish { emission 3 diffuse 0 } }
+ object { Left } object { Right }
+ END
$ retex-render -q --list-lamps --size 600x300 two.pov
>  39.17%  Left  rgb(1,2,4)
>  60.83%  Right  rgb(3,3,3)
$ retex-render -q --list-lamps --size 600x300 --crop 0,0,300,300 two.pov
> 100.00%  Left  rgb(1,2,4)
>   0.00%  Right  rgb(3,3,3)
$ retex-render -q --list-lamps --size 600x300 --crop 420,150,1,1 two.pov
>   0.00%  Left  rgb(1,2,4)
> 100.00%  Right  rgb(3,3,3)
$ retex-render -q --list-lamps --size 600x300 --crop 420,150,1,151 two.pov
! retex-render: error: crop 420,150,1,151 does not lie inside the picture of 600x300
= 2

# What is left of other light is not listed where it would be 0.00 %.
$ retex-render -q --list-lamps --size 64x32 -l Left --light Left=1e5 two.pov
> 100.00%  Left  rgb(1e+05,2e+05,4e+05)
$ retex-render -q --list-lamps --size 64x32 -l Left --light Left=1e3 two.pov
>  99.85%  Left  rgb(1e+03,2e+03,4e+03)
>   0.15%  rest  all other light

# Skies: of one colour, also where that is multiplied, or of several.
$ for c in '<.4,.5,1>' '<0,.5,1>' 0 '1 transmit .5'; do
+     echo "camera { } plane { y, -1 } background { rgb .2 } sky_sphere { pigment { rgb $c } }" >sky.pov
+     retex-render -q --list-lamps -l sky --size 16x8 sky.pov 2>&1
+ done
> 100.00%  sky  rgb(0.133,0.214,1)
> 100.00%  sky  rgb(0,0.214,1), by which a new one is multiplied
>   0.00%  sky  rgb(0,0,0), by which a new one is multiplied
> 100.00%  sky  rgb(0.517,0.517,0.517)
$ echo 'camera { } sky_sphere { pigment { gradient y color_map { [0 rgb 1] [1 rgb <0,0,1>] } } }' >sky.pov
$ retex-render -q --list-lamps --size 16x8 sky.pov
> 100.00%  sky  several colours

# Cameras that the scene declares, as --camera takes them: by name and by numbers the picture is the same.
$ cat >cameras.pov <<'END'
+ #declare Near = camera { location <1,2,-3> right 4/3*x up y angle 50 look_at <1,2,5> }
+ #declare Far = camera { location <0,1,-20> right 4/3*x up y angle 20 look_at <0,1,0> }
+ #declare Near = camera { location <2,2,-3> right 4/3*x up y angle 60 look_at <0,1,0> }
+ #declare Parallel = camera { orthographic location -5*z right 4*x up 3*y }
+ camera { Far }
+ light_source { <5,9,-9> 1 }
+ box { -1, 1 pigment { checker rgb 1 rgb <.5,.1,0> scale .3 } }
+ plane { y, -1 pigment { rgb .5 } }
+ END
$ retex-render --list-cameras cameras.pov | tee cameras.txt
> Far	0,1,-20:0,1,-19:20
> Near	2,2,-3:1.465478,1.732739,-2.198216:60
> Parallel	0,0,-5:0,0,-4:67.24781
$ for of in 1 2; do
+     retex-render -q --plain --spp 1 --size 32x24 --camera $(sed -n 2p cameras.txt | cut -f$of) cameras.pov -o by$of.exr
+ done
$ retex-diff -q by1.exr by2.exr --fail-psnr 60
$ retex-render --list-cameras --list-lamps cameras.pov
! retex-render: error: --list-targets, --list-lamps, --list-finishes, --list-cameras and --trace-pixel exclude each other
= 2
$ retex-render --list-cameras cameras.pov -o x.exr
! retex-render: error: --list-cameras goes to standard output: no -o
= 2
$ echo 'sphere { 0, 1 }' >none.pov
$ retex-render -q --list-cameras none.pov
