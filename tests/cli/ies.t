# Light distributions of light sources: files of IES LM-63, which scenes name.
$ cat >a.ies <<'END'
+ IESNA:LM-63-2002
+ [TEST] 1
+ TILT=NONE
+ 1 -1 1 4 4 1 2 0 0 0
+ 1 1 10
+ 0 30 60 90
+ 0 30 60 90
+ 9 6 3 0
+ 9 7 4 0
+ 9 8 6 0
+ 9 9 8 0
+ END
$ cat >a.pov <<'END'
+ camera { location <0,2,-5> look_at 0 }
+ plane { y, 0 pigment { rgb .5 } finish { ambient 0 } }
+ sphere { <0,.5,0>, .5 pigment { rgb .7 } }
+ #declare Lamp = light_source { <.3,2,0>, <2,1,1>
+     #ifdef(Retex) retex { ies "a.ies" turn 20 } #end
+     fade_distance 1 fade_power 2 }
+ light_source { Lamp }
+ light_source { <3,4,-3>, .2 }
+ END
% render() { retex-render -q --size 32x24 "$@"; }
$ for n in 1 2 7; do render --plain --spp 4 --threads $n a.pov -o $n.exr; done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr

# Its light is a lamp's: other values after rendering are those that the scene would be rendered with.
$ retex-render -q --size 32x24 --spp 256 -l Lamp a.pov -o set.exr
$ retex-combine -q set.exr --light 'Lamp=rgb(.1,.3,.2)' -o edited.exr
$ retex-render -q --size 32x24 --spp 256 --plain -l Lamp --light 'Lamp=rgb(.1,.3,.2)' a.pov -o again.exr
$ retex-diff -q edited.exr again.exr --fail-psnr 45 && echo same
> same
$ retex-combine -q set.exr -o whole.exr
$ retex-diff -q edited.exr whole.exr --fail-psnr 45
= 1
$ retex-render --threads 1 --list-lamps --size 32x24 a.pov | sed 's/^ *[0-9.]*%//'
>   Lamp  rgb(2,1,1)
>   light2=light_source#2  rgb(0.0331,0.0331,0.0331)

# The file is one of the scene's: its folder's rules hold, and it is not written over.
$ mkdir b
$ cp a.pov b/b.pov
$ retex-render -q --plain --spp 1 --size 8x8 b/b.pov -o x.exr
$ retex-render --safe -q --plain --spp 1 --size 8x8 b/b.pov -o x.exr
! retex-render: error: b/b.pov:5:31: cannot find the light distribution `a.ies` in the scene's folder or the include path
= 2
$ sed 's/a.ies/..\/a.ies/' a.pov >b/b.pov
$ retex-render --safe -q --plain --spp 1 --size 8x8 b/b.pov -o x.exr
! retex-render: error: b/b.pov:5:31: the light distribution `../a.ies` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
= 2
$ cp a.ies c.ies
$ cp a.ies lamp.exr
$ sed 's/a.ies/lamp.exr/' a.pov >l.pov
$ retex-render -q --plain --spp 1 --size 8x8 l.pov -o lamp.exr
! retex-render: error: lamp.exr: the output would replace a file that the scene reads
= 2
$ cmp lamp.exr c.ies

# One line says what is wrong.
$ for s in 's/^9 8 6.*//' 's/NONE/lamp.tlt/' 's/^1 -1 1 4 4 1/1 -1 1 4 4 2/' 's/30 60/60 30/' 's/^9.*/0 0 0 0/' \
+     's/ 4 4 / 4 900000000 /'; do
+     sed "$s" c.ies >a.ies
+     retex-render -q --plain --spp 1 --size 8x8 a.pov -o x.exr
+     echo $?
+ done
> 2
> 2
> 2
> 2
> 2
> 2
! retex-render: error: a.pov:5:31: `a.ies` ends early, in line 12
! retex-render: error: a.pov:5:31: `a.ies`, line 3: TILT= with a file is not supported, only NONE and INCLUDE
! retex-render: error: a.pov:5:31: `a.ies`, line 4: photometry of type B is not supported, only type C
! retex-render: error: a.pov:5:31: `a.ies`, line 6: the vertical angles do not rise
! retex-render: error: a.pov:5:31: `a.ies`: all luminous intensities are 0
! retex-render: error: a.pov:5:31: `a.ies`, line 4: it cannot have 9e+08 horizontal angles
$ cp c.ies a.ies
$ sed 's/fade_power 2/& parallel point_at 0/' a.pov >p.pov
$ retex-render -q --plain --spp 1 --size 8x8 p.pov -o x.exr
! retex-render: error: p.pov:6:54: a light with ies cannot be parallel: all of its light would go one way
= 2
