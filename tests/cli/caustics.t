# A ball of tinted glass and a mirror throw caustics of a light source on the floor. A set is a polynomial in floor and
# tint there too: retextured as with rendering again; and its picture is that without a set.
$ cat >glass.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 photons { count 1000 } }
+ camera { location <0, 3, -4> look_at <0, .3, 0> angle 40 }
+ #default { finish { ambient 0 diffuse 1 } } #declare Ground = texture { pigment { rgb .5 } }
+ #declare Tint = texture { pigment { rgbf <.9, 1, .8, 1> }
+     finish { diffuse 0 reflection { 0, 1 fresnel } conserve_energy } }
+ plane { y, 0 texture { Ground } }
+ sphere { <-.8, 1, 0>, .5 texture { Tint } interior { ior 1.5 } photons { target refraction on reflection on } }
+ box { <.4, 0, -.5>, <1.2, 1.4, .3> pigment { rgb 1 } finish { diffuse .1 reflection .8 }
+     photons { target reflection on } rotate 30*y }
+ light_source { <1, 4, -3>, 1.5 }
+ END
% render() { retex-render -q --size 32x24 --spp 16 glass.pov "$@"; }
$ render -t Ground -t Tint -o set.exr
$ render --plain -o plain.exr
$ retex-diff -q set.exr plain.exr --fail-psnr 70 || echo other picture
$ for t in Ground Tint; do
+     render -t Ground -t Tint --replace $t='rgb(.3,.6,.9)' -o again.exr
+     retex-combine -q set.exr --texture $t='rgb(.3,.6,.9)' -o new.exr
+     retex-diff -q new.exr again.exr --fail-psnr 45 || echo $t differs
+ done
# The light is there, and not without photons; the options are for scenes that do not ask, or ask for it.
$ sed 's/photons { count 1000 }//' glass.pov >no.pov
% render() { retex-render -q --plain --size 32x24 --spp 16 "$@"; }
$ render --no-caustics glass.pov -o straight.exr
$ render no.pov -o no.exr
$ render --caustics no.pov -o asked.exr
$ retex-diff -q straight.exr no.exr --fail-abs 0 || echo straight differs
$ retex-diff -q asked.exr plain.exr --fail-abs 0 || echo asked differs
$ retex-diff -q straight.exr plain.exr --fail-psnr 30
= 1

# Finishes of a floor beside caustics that are guided: one is matt, one mirrors, so that what the guide takes of the choice
# of lobes differs. The mean of each is that of a render of it without the guide.
$ cat >sky.pov <<'END'
+ #version 3.7; global_settings { assumed_gamma 1 } camera { location <0, 3, -4> look_at 0 angle 40 }
+ #default { finish { ambient 0 diffuse 1 } } #declare Shiny = finish { diffuse .3 reflection .6 }
+ #declare Ground = texture { pigment { rgb .5 } finish { diffuse .6 specular albedo .3 roughness .05 } }
+ plane { y, 0 texture { Ground } }
+ sphere { 0, .5 pigment { rgbt 1 } finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
+     interior { ior 1.5 } translate .9*y }
+ disc { 5*y, y, .6 pigment { rgb 1 } finish { diffuse 0 emission 20 } }
+ sky_sphere { pigment { rgb 1 } }
+ END
% render() { retex-render -q --spp 256 --size 32x24 sky.pov "$@"; }
% mean() { oiiotool --subimage 0 --stats $1.exr | sed -n 's/.*Avg: \([0-9.]*\).*/\1/p'; }
$ render -t Ground --finish Ground=original,Shiny --caustics-guide -o set.exr
$ for f in original Shiny; do
+     retex-combine -q set.exr --finish Ground=$f -o guided.exr
+     render --plain --finish Ground=$f -o chance.exr
+     echo $(mean guided) $(mean chance) | awk '{ print (NF == 2 && $1 > .985 * $2 && $1 < 1.015 * $2) }'
+ done
> 1
> 1
