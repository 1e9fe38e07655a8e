# Finishes to choose from after rendering: of one target and of two, alone and with lamps.
$ cp "$TESTS/finishes.pov" room.pov
$ cp "$SCENES/textures/brick.jpg" .
$ retex-render --list-finishes room.pov
> Gloss
> Dull
> Shiny
> Coated
> Smooth
> Glass
> matt	built in
> satin	built in
> polished	built in
> metal	built in
> original	as the scene has it

# Each finish is the picture that is rendered with it shown, along the same paths: as it is, and with constant textures.
% render() { retex-render -q --size 48x36 --spp 32 room.pov "$@"; }
% finished() { render --finish Floor=original,Gloss,Coated,polished --finish Wall=original,satin "$@"; }
$ finished --full-precision -o full.exr
$ finished --threads 1 -o set.exr
$ finished --threads 7 -o seven.exr
$ cmp set.exr seven.exr
$ retex-info set.exr | grep -E 'finishes|parameter'
>   finishes     original (as rendered), Gloss, Coated, polished
>   finishes     original (as rendered), satin
$ retex-info --json set.exr | grep -c correction
> 0
= 1
$ render -t Floor -t Wall -o none.exr
$ retex-info --json none.exr | grep -q correction
$ for f in original Gloss Coated polished; do
+     for w in original satin; do
+         finished --plain --show floor=$f --show Wall=$w -o p.exr
+         retex-combine -q full.exr --finish Floor=$f --finish Wall=$w -o c.exr
+         retex-diff -q c.exr p.exr --fail-psnr 80 || echo $f $w
+     done
+ done
% T="--texture Floor=rgb(.3,.7,.2) --texture Wall=rgb(.8,.2,.5)"
% P="--replace Floor=rgb(.3,.7,.2) --replace Wall=rgb(.8,.2,.5)"
$ for f in Gloss Coated polished; do
+     finished $P --show Floor=$f --show Wall=satin -o p.exr
+     for s in full set; do retex-combine -q $s.exr $T --finish Floor=$f --finish Wall=satin -o $s-c.exr; done
+     retex-diff -q full-c.exr p.exr --fail-psnr 60 || echo $f full
+     retex-diff -q set-c.exr p.exr --fail-psnr 55 || echo $f
+ done
$ retex-combine -q full.exr --finish Floor=Gloss -o a.exr
$ retex-combine -q full.exr -o b.exr
$ retex-diff -q a.exr b.exr --fail-psnr 40
= 1

# Three finishes make a set 1.79 times as large: light of more choices is rounded to coarser steps, and most of all the
# mean over them, which no picture shows (2.01 without that).
$ for f in '' '--finish Floor=original,Gloss,polished'; do
+     retex-render -q --size 160x120 --spp 32 room.pov -t Floor -t Wall $f -o size.exr
+     stat -c %s size.exr
+ done | paste -s | awk '{ print ($2 < 1.8 * $1 ? "small" : $2 / $1) }'
> small

# Matte surfaces that a mesh lights are traced in packets of their own; with another finish they are not.
$ cat >m.pov <<'END'
+ camera { location <0,1,-4> look_at <0,.5,0> }
+ #declare Floor = texture { pigment { rgb .7 } finish { ambient 0 diffuse 1 } }
+ plane { y, 0 texture { Floor } }
+ sphere { <0,.6,0>, .6 pigment { rgb .6 } finish { ambient 0 diffuse 1 } }
+ mesh { triangle { <-3,3,-3>, <3,3,-3>, <3,3,3> } triangle { <-3,3,-3>, <3,3,3>, <-3,3,3> } pigment { rgb 1 }
+     finish { emission 1 diffuse 0 } }
+ END
% matte() { retex-render -q --size 32x24 --spp 16 m.pov --finish Floor=original,polished "$@"; }
$ matte --full-precision -o m.exr
$ for f in original polished; do
+     matte --plain --show Floor=$f --replace 'Floor=rgb(.3,.7,.2)' -o p.exr
+     retex-combine -q m.exr --finish Floor=$f --texture 'Floor=rgb(.3,.7,.2)' -o c.exr
+     retex-diff -q c.exr p.exr --fail-psnr 60 || echo $f
+ done
$ sed '/#declare Floor/s/diffuse 1/retex { roughness 0.08 ior 1.5 }/' m.pov >e.pov
$ retex-render -q --size 32x24 --spp 256 --plain e.pov -o e.exr
$ for f in polished original; do
+     retex-render -q --size 32x24 --spp 256 --plain --finish Floor=$f m.pov -o p.exr
+     matte --spp 256 --plain --show Floor=$f -o s.exr
+     for i in p s; do retex-diff -q $i.exr e.exr --fail-psnr 34 || echo $i $f; done
+ done
> p original
> s original

# With lamps: both are chosen in any order, and the finish of one target leaves lamps as they are.
$ render --finish Floor=original,Gloss -l Lamp --full-precision -o lit.exr
$ render --finish Floor=original,Gloss -l Lamp --light Lamp=.2 --show Floor=Gloss --plain -o p.exr
$ retex-combine -q lit.exr --finish Floor=Gloss --light Lamp=.2 -o c.exr
$ retex-diff -q c.exr p.exr --fail-psnr 60
$ retex-combine -q lit.exr --solo Lamp --finish floor=gloss -o d.exr
$ retex-diff -q c.exr d.exr --fail-psnr 40
= 1
$ retex-info lit.exr | grep -A1 ^param
> parameter Lamp
>   as rendered  1.2 1.2 1.2
> parameter rest
>   as rendered  1 1 1

# --show only chooses the picture; the set has all finishes.
$ finished --show Floor=Gloss --full-precision -o shown.exr
$ retex-combine -q shown.exr --finish Floor=original -o c.exr
$ retex-combine -q full.exr -o b.exr
$ retex-diff -q b.exr c.exr --fail-psnr 80
$ retex-combine -q full.exr --finish Floor=Gloss -o c.exr
$ retex-combine -q shown.exr -o b.exr
$ retex-diff -q b.exr c.exr --fail-psnr 80

# One finish alone: it is that of the set, which has none to choose from.
$ render --finish Floor=Gloss --full-precision -o one.exr
$ render --finish Floor=Gloss --plain -o p.exr
$ retex-combine -q one.exr -o c.exr
$ retex-diff -q c.exr p.exr --fail-psnr 80
$ retex-info one.exr | grep -c 'finishes\|parameter'
> 0
= 1

# In one pass, from samples, from a stream, in tables, in packs and after denoising.
$ retex-combine -q set.exr --finish Floor=Coated --texture Wall=brick.jpg -o one.exr
$ retex-sample -q set.exr --texture Wall=brick.jpg | retex-combine -q - --finish Floor=Coated -o two.exr
$ cmp one.exr two.exr
$ cat >t.csv <<'END'
+ output,Wall,finish:Floor
+ three.exr,brick.jpg,coated
+ four.exr,brick.jpg,
+ END
$ retex-combine -q set.exr --batch t.csv
$ cmp one.exr three.exr
$ retex-combine -q set.exr --batch t.csv --finish Floor=Coated
$ cmp one.exr four.exr
$ retex-combine set.exr --finish wall=satin --finish Floor=Gloss -o one.exr 2>&1 | sed 's/, [0-9.]* s$//'
> retex-combine: one.exr: original textures, finish:Floor=Gloss;finish:wall=satin, 48 x 36
$ retex-denoise -q set.exr -o den.exr
$ retex-pack -q den.exr -o den.retex
$ retex-pack -q set.exr --lossless -o set.retex
$ retex-combine -q set.retex --finish Floor=Gloss -o two.exr
$ retex-combine -q set.exr --finish Floor=Gloss -o one.exr
$ cmp one.exr two.exr
$ for f in original Gloss Coated polished; do
+     finished --spp 128 --plain --show Floor=$f -o truth.exr
+     retex-combine -q set.exr --finish Floor=$f -o n.exr
+     for s in den.exr den.retex; do
+         retex-combine -q $s --finish Floor=$f -o d.exr
+         retex-diff -q d.exr truth.exr --fail-psnr 30 || echo $f $s
+     done
+ done

# Finishes of a set that is resumed are the same.
$ (ulimit -f 200; finished --resume --threads 1 -o resumed.exr)
! retex-render: error: cannot write resumed.exr.partial: File too large
= 2
$ finished --resume -o resumed.exr
$ cmp set.exr resumed.exr

# What is refused.
$ render --finish Floor=Glass,matt -o x.exr
! retex-render: error: finish `Glass` of Floor cannot be kept apart: it lets light through
= 2
$ render --finish Floor=Shiny,matt -o x.exr
! retex-render: error: finish `Shiny` of Floor cannot be kept apart: it emits light
= 2
$ render --finish Pane=matt,satin -o x.exr
! retex-render: error: --finish: light goes through target Pane: its finish cannot be chosen later
= 2
$ sed 's/^#declare Pane .*/#declare Pane = texture { pigment { rgb .9 } finish { retex { transmission .8 } } }/' room.pov \
+     >glass.pov
$ retex-render -q --size 8x6 --spp 1 --finish Pane=matt,satin glass.pov -o x.exr
! retex-render: error: --finish: light goes through target Pane: its finish cannot be chosen later
= 2
$ render --finish Floor=mat -o x.exr
! retex-render: error: no finish is called `mat`; is matt meant?; --list-finishes lists what there is
= 2
$ render --finish Flor=matt,satin -t Floor -o x.exr
! retex-render: error: --finish `Flor=matt,satin`: no target is called `Flor`; is Floor meant?
= 2
$ render --finish Floor=matt,satin,polished,metal,original -o x.exr
! retex-render: error: --finish: Floor has more than 4 finishes
= 2
$ render --finish Floor=matt,matt -o x.exr
! retex-render: error: --finish: Floor has finish matt twice
= 2
$ render --finish Floor=matt,satin --show Floor=metal -o x.exr
! retex-render: error: --show `Floor=metal`: --finish gives Floor no finish of that name
= 2
$ render --show Floor=metal -o x.exr
! retex-render: error: --show chooses among the finishes of --finish, of which there are none
= 2
$ render --finish Floor=matt,satin --layout paper -o x.exr
! retex-render: error: --layout paper keeps no finishes apart
= 2
$ finished -t Wall -t Floor -t Panel --finish Panel=original,satin -o x.exr
! retex-render: error: --finish: 16 combinations of finishes, where there may be 8
= 2
$ retex-combine set.exr --finish Floor=gold -o x.exr
! retex-combine: error: Floor has no finish 'gold'; it has original, Gloss, Coated, polished
= 2
$ retex-combine set.exr --finish Flor=Gloss -o x.exr
! retex-combine: error: no target is called 'Flor'; the set has Floor, Wall; is Floor meant?
= 2
$ retex-combine set.exr --light Lamp=1 -o x.exr
! retex-combine: error: the set has no lamps: the light of 'Lamp' cannot be changed; render it with --lamps
= 2
$ retex-combine set.exr --finish Floor -o x.exr
! retex-combine: error: finish 'Floor': expected TARGET=NAME, a target and one of its finishes
= 2
$ retex-combine lit.exr --finish Wall=satin -o x.exr
! retex-combine: error: no target is called 'Wall'; the set has Floor
= 2
$ printf 'output,finish:Wall,finish:Floor,finish:floor\nx.exr,,,\n' >t.csv
$ retex-combine lit.exr --batch t.csv
! retex-combine: error: t.csv:1: no target is called 'Wall'; the set has Floor
! retex-combine: error: t.csv:1: the finish of 'Floor' has two columns
= 2
$ test -e x.exr
= 1
