# retex-combine --solve: which colours, lamps and finishes come nearest to a picture, or to a colour.
$ cp "$TESTS/finishes.pov" room.pov
% render() {
%     retex-render -q --size 96x72 --spp 24 -t Floor -t Wall -l Lamp --finish Floor=original,Gloss,Coated room.pov "$@"
% }
% # Whether the first line of standard input has the numbers of the known edit: near TOLERANCE, a share of each.
% near() {
%     head -1 | sed 's/[0-9.]*[0-9]/\n&\n/g' | awk -v t=$1 -v wanted='0.5 0.2 0.1 0.1 0.4 0.6 0.7' '
%         BEGIN { split(wanted, w) }
%         /^[0-9]/ { n++; if ($1 < w[n] * (1 - t) || $1 > w[n] * (1 + t)) print n, $1 }
%         END { print n }'
% }
$ render -o set.exr
$ printf 'Floor=rgb(0.5,0.2,0.1)\nWall=rgb(0.1,0.4,0.6)\n' >colours
$ printf -- '--texture Floor=rgb(0.5,0.2,0.1) --texture Wall=rgb(0.1,0.4,0.6) --light Lamp=0.7 --finish Floor=Gloss' \
+     >edit

# A known edit is found, from a linear picture and from what a display shows; what is printed makes the picture again.
$ retex-combine -q set.exr $(cat edit) -o known.exr
$ retex-combine -q set.exr --solve known.exr --free Floor,Wall,light:Lamp,finish:Floor >found
$ head -2 found
> Floor=rgb(0.5,0.2,0.1);Wall=rgb(0.1,0.4,0.6);light:Lamp=0.7;finish:Floor=Gloss
> --texture 'Floor=rgb(0.5,0.2,0.1)' --texture 'Wall=rgb(0.1,0.4,0.6)' --light 'Lamp=0.7' --finish 'Floor=Gloss'
$ cut -d+ -f1 found | sed -n 3,5p
> Floor: 0.5 0.2 0.1
> Wall: 0.1 0.4 0.6
> light:Lamp: 0.7
$ cut -d';' -f1 found | tail -2 | head -1
> finish:Floor: Gloss
$ eval "retex-combine -q set.exr $(sed -n 2p found) -o again.exr"
$ retex-diff -q again.exr known.exr --fail-psnr 75
$ retex-combine -q set.exr $(cat edit) -o known.png
$ retex-combine set.exr --solve known.png --free Floor,Wall,light:Lamp,finish:Floor -o again.png 2>err | head -1 >found
$ sed 's/[0-9][0-9.]* s$//; s/^\(retex-combine: \)[0-9]* /\1N /' err
> retex-combine: N pixels of known.png are clipped or transparent and do not count
> retex-combine: again.png:
$ near .01 <found
> 7
$ retex-diff -q again.png known.png --fail-psnr 50

# One percent of noise does little; a new render by other paths, 24 samples, gives near values.
$ oiiotool --create 96x72 3 --noise:type=gaussian:mean=1:stddev=0.01 known.exr --mul -d float -o noisy.exr
$ retex-combine -q set.exr --solve noisy.exr --free Floor,Wall,light:Lamp,finish:Floor | near .01
> 7
$ render --plain --seed 5 --spp 24 --show Floor=Gloss --light Lamp=0.7 --replace 'Floor=rgb(0.5,0.2,0.1)' \
+     --replace 'Wall=rgb(0.1,0.4,0.6)' -o new.exr
$ retex-combine -q set.exr --solve new.exr --free Floor,Wall,light:Lamp --finish Floor=Gloss | near .05
> 7
$ retex-combine -q set.exr --solve new.exr --free Floor,Wall,light:Lamp,finish:Floor | grep ^finish | cut -d';' -f1
> finish:Floor: Gloss

# What is fixed counts: textures, lamps, finishes, samples. Packs and pipes.
$ cp "$SCENES/textures/brick.jpg" .
$ retex-combine -q set.exr --texture Floor=brick.jpg --texture 'Wall=rgb(0.1,0.4,0.6)' --light Lamp=2 -o fixed.exr
$ retex-combine -q set.exr --texture Floor=brick.jpg --light Lamp=2 --solve fixed.exr | sed -n '1p;3p' | cut -d+ -f1
> Wall=rgb(0.1,0.4,0.6)
> Wall: 0.1 0.4 0.6
$ retex-sample -q set.exr --texture Floor=brick.jpg -o samples.exr
$ retex-combine -q set.exr samples.exr --light Lamp=2 --solve fixed.exr | head -1
> Wall=rgb(0.1,0.4,0.6)
$ retex-sample -q set.exr --texture Floor=brick.jpg | retex-combine -q - --light Lamp=2 --solve fixed.exr 2>&1 |
+     cut -c1-80
> Wall=rgb(0.1,0.4,0.6)
> --texture 'Wall=rgb(0.1,0.4,0.6)'
> Wall: 0.1 0.4 0.6 +- 4.6e-07 1.5e-06 2.2e-06
> difference: 0.0001422 rms, PSNR 85.08 dB, 6912 pixels
$ retex-pack -q --lossless set.exr -o set.retex
$ retex-combine -q set.retex --solve known.exr --free Floor,Wall,light:Lamp,finish:Floor | head -1
> Floor=rgb(0.5,0.2,0.1);Wall=rgb(0.1,0.4,0.6);light:Lamp=0.7;finish:Floor=Gloss
$ retex-pack -q set.exr -o small.retex
$ retex-combine -q small.retex $(cat edit) -o small.exr
$ retex-combine -q small.retex --solve small.exr --free Floor,Wall,light:Lamp,finish:Floor | near .005
> 7
$ for t in 1 2 7; do
+     retex-combine -q set.exr --threads $t --memory $((t % 2)) --solve new.exr \
+         --free Floor,Wall,light:Lamp,finish:Floor >t$t
+ done
$ cmp t1 t2
$ cmp t1 t7

# A lamp's colour; the other lamp does not change.
$ retex-combine -q set.exr --light Lamp='0.5*#ff8040' -o warm.exr
$ retex-combine -q set.exr --solve warm.exr --free color:Lamp,light:rest | sed -n '3,4p' | cut -d+ -f1
> color:Lamp: 1.349 0.2912 0.06915
> light:rest: 1

# A brand's colour, which the mean of a region becomes; one that no paint reaches.
$ retex-combine -q set.exr --solve '#406080' --free Wall --region 40,10,20,12 -o brand.exr | tail -1
> mean: srgb(0.2510,0.3764,0.5019), CIEDE2000 0.01
$ oiiotool brand.exr --cut 20x12+40+10 -o region.exr
$ oiiotool --stats region.exr | awk '/Avg/ { printf "%.3f %.3f %.3f\n", $3, $4, $5 }' # linear
> 0.051 0.117 0.216
$ retex-combine -q set.exr --solve '#fffa00' --free Wall --region 40,10,20,12 | sed -n '1p;3p' | sed 's/+-.*,/+-/'
> Wall=rgb(0.6959,0.8281,0)
> Wall: 0.6959 0.8281 0 +- at the end of its range

# A box that is white all around, with a lamp besides: what all together find is not further off than one colour alone, of
# a colour and of a picture with a texture, which colours do not make.
$ cp "$TESTS/closed_box.pov" .
$ retex-render -q --size 64x36 --spp 32 -t Floor -t Rest --lamps each closed_box.pov -o box.exr
% off() { retex-combine -q box.exr --solve '#7d8f86' --region 15,25,30,10 --free $1 2>>told | sed -n '$s/.* //p'; }
$ off Rest >one
$ off Floor,Rest,light:A >all
$ paste one all | awk '{ print ($2 <= $1 + .01) ? "near" : $0 }'
> near
$ retex-combine -q box.exr --texture Floor=brick.jpg -o bricks.exr
% decibels() { retex-combine -q box.exr --solve bricks.exr --region 4,12,16,18 --free $1 | sed -n 's/.*PSNR \(.*\) dB.*/\1/p'; }
$ decibels Floor >one
$ decibels Floor,Rest,light:A >all
! retex-combine: warning: --free Floor alone comes nearer than all that is sought, and is what was found
$ paste one all | awk '{ print ($2 >= $1 - .01) ? "near" : $0 }'
> near

# What is refused, in one line each; nothing is written.
$ oiiotool known.exr --resize 48x36 -o wrong.exr
$ head -c 300 known.png >cut.png
$ cat >lines <<'END'
+ wrong.exr
+ none.png
+ cut.png
+ #12345
+ known.exr --free Flor
+ known.exr --free light:Sun
+ known.exr --free finish:Wall
+ known.exr --free Floor,
+ known.exr --free Floor --texture Floor=tan
+ known.exr --free light:Lamp --light Lamp=2
+ known.exr --region 90,0,7,4
+ known.exr --region 1,2,3
+ known.exr --batch t.csv
+ known.exr --frames 1-2
+ known.exr --error e.exr
+ END
$ while read -r line; do
+     retex-combine -q set.exr --solve $line -o x.png 2>&1 >out
+     echo $?
+ done <lines 2>&1 | sed 's/^2$/=/'
> retex-combine: error: wrong.exr has 48 x 36 pixels, the set 96 x 72
> =
> retex-combine: error: cannot read none.png: No such file or directory
> =
> retex-combine: error: cut.png: cannot read: the file is truncated
> =
> retex-combine: error: colour '#12345': expected #rgb or #rrggbb with hexadecimal digits
> =
> retex-combine: error: no target is called 'Flor'; the set has Floor, Wall; is Floor meant?
> =
> retex-combine: error: no lamp is called 'Sun'; the set has Lamp, rest
> =
> retex-combine: error: the set has no finishes of 'Wall' to choose from
> =
> retex-combine: error: what is sought: expected TARGET, light:LAMP, color:LAMP or finish:TARGET, divided by commas
> =
> retex-combine: error: target 'Floor' is sought, but has a texture
> =
> retex-combine: error: the light of 'Lamp' is both sought and given
> =
> retex-combine: error: the region 90,0 to 97,4 is not within the picture of 96 x 72 pixels
> =
> retex-combine: error: --region: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '1,2,3'
> =
> retex-combine: error: the table of --batch names the outputs: no -o
> =
> retex-combine: error: --solve excludes --batch, --frames, --error and --save-preset
> =
> retex-combine: error: --error needs the textures: name them with --texture
> =
$ ls x.png
! ls: cannot access 'x.png': No such file or directory
= 2
$ cat out
$ retex-combine -q set.exr --free Floor -o x.png
! retex-combine: error: --free and --region belong to --solve
= 2
$ retex-combine -q set.exr --solve known.exr -o -
! retex-combine: error: with --solve, standard output has what is found: name a file with -o
= 2
$ retex-combine -q set.exr --solve known.exr -o known.exr
! retex-combine: error: known.exr: the output would replace the picture of --solve
= 2
$ retex-combine -q set.exr --solve known.exr -o none/x.png
! retex-combine: error: cannot write none/x.png: No such file or directory
= 2
