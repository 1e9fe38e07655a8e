# retex-pack --web: the folder for browsers, its picture as a reference of the player's arithmetic makes it, and what is refused.

% # The file is damaged: one bit of it is another.
% turn_a_bit() {
%     /usr/bin/python3 - "$1" <<'END'
% import sys
% with open(sys.argv[1], "r+b") as file:
%     file.seek(700)
%     byte = file.read(1)[0] ^ 1
%     file.seek(700)
%     file.write(bytes([byte]))
% END
% }

$ ln -s "$SCENES" scenes
$ retex-render -q --size 96x54 --spp 64 --denoise -t Floor -t Wall scenes/living-room/living-room.pov -o s.exr
$ rm scenes
$ retex-pack s.exr --web out/room 2>&1 | sed 's/[0-9]\{3,\}/N/g'
> retex-pack: set s.exr: N bytes
> retex-pack: folder out/room: N bytes, N until the picture, N until the first target
$ (cd out/room; ls | sed 's/-[0-9a-f]*[.]/-N./' | grep -v '_'; ls | grep -c '_')
> README.md
> indep-N.jpg
> index.html
> package.json
> picture-N.jpg
> reduced-N.jpg
> retex-room.d.ts
> retex-room.js
> room.json
> 14
$ test $(cat out/room/retex-room.js out/room/index.html | wc -c) -le 119808 && echo small
> small

# A folder that is there may be a stranger's: a link in it, or in its place, leads nothing elsewhere.
$ mkdir keep && echo mine >keep/mine
$ for name in index.html room.json look.json textures deep/down; do
+     mkdir -p bad/deep && ln -s "$PWD/keep/mine" bad/$name && retex-pack -q s.exr --web bad
+     rm -r bad
+ done 2>&1 | sort -u
> retex-pack: error: bad/deep/down is a link: a page is written beside none
> retex-pack: error: bad/index.html is a link: a page is written beside none
> retex-pack: error: bad/look.json is a link: a page is written beside none
> retex-pack: error: bad/room.json is a link: a page is written beside none
> retex-pack: error: bad/textures is a link: a page is written beside none
$ ln -s keep bad
$ retex-pack -q s.exr --web bad/
! retex-pack: error: bad/ is a link: a page is written beside none
= 2
$ ls keep; cat keep/mine; rm -r bad keep
> mine
> mine

# What a room of this size takes until the first target can be changed, and in all: a little more than it did.
$ retex-pack s.exr --web out/room 2>&1 | awk 'NR == 2 { print ($10 <= 34000), ($4 <= 56000) }' | grep -q '1 1' ||
+     retex-pack s.exr --web out/room

# The manifest names all files with their sizes and checksums, and the sizes that were printed are theirs.
$ retex-pack s.exr --web out/room 2>&1 | /usr/bin/python3 "$TESTS/../web/files.py" out/room
> README.md index.html package.json retex-room.d.ts retex-room.js room.json

# The same bytes for any number of threads; from a pack too it can be made.
$ retex-pack -q s.exr --web one --threads 1; diff -r one out/room && echo same
> same
$ retex-pack -q s.exr -o s.retex; retex-pack -q s.retex --web packed; ls packed | wc -l
> 23

# From a pack without loss it is the set's own. In finer packs all is of the picture's size, and nothing is there to be
# made compact; the message says what to take.
$ retex-pack -q s.exr --lossless -o l.retex; retex-pack -q l.retex --web whole; diff -r whole one && echo same
> same
$ make_compact s.exr fine.exr broad=1 interreflection=1 gain=1
$ retex-pack fine.exr --web fine
! retex-pack: error: this set cannot be written for browsers: reflected light has the picture's size, as in fine packs; take the set before packing
= 2
$ test -e fine || echo nothing
> nothing

# Recombined, it is the picture of retex-combine: originals, one texture, two, colours, placed ones.
$ cp "$TESTS"/../web/*.py .
$ mkdir T; for t in brick damask fans terrazzo travertine walnut-herringbone; do
+     oiiotool "$SCENES/textures/$t.jpg" --resize 256x256 -o T/$t.jpg
+ done
% near() { /usr/bin/python3 near.py "$@"; }
$ near s.exr one <<'END'
+ 40
+ 40 Floor=T/walnut-herringbone.jpg
+ 38 Wall=T/brick.jpg
+ 38 Floor=T/terrazzo.jpg Wall=T/damask.jpg
+ 40 Floor=0.8,0.1,0.1 Wall=0.2,0.3,0.7
+ 40 Floor=T/brick.jpg:scale=3,2:rotate=30:offset=0.2,0.5
+ END
$ near s.exr packed <<'END'
+ 40 Floor=T/fans.jpg Wall=T/travertine.jpg
+ END

# Lamps that can be changed: as rendered, and as in a set that was rendered so.
$ make_lamps s.exr lamps.exr
$ make_lamps s.exr other.exr 0.25,1,0
$ retex-pack -q lamps.exr --web lamps
$ near lamps.exr lamps <<'END'
+ 38 Floor=T/walnut-herringbone.jpg
+ END
$ /usr/bin/python3 reference.py lamps a.exr Lamp=0.25,1,0 Wall=0.8,0.1,0.1
$ retex-combine -q other.exr --texture Wall='rgb(0.8,0.1,0.1)' -o b.exr
$ retex-diff -q a.exr b.exr --fail-psnr 38

# A set with terms of single lamps, whose `rest` has no light: as rendered, each alone, mixtures, with new textures. In so small a picture, edges of
# lamps, which are kept at half its size, count. What is loaded first is what a room without lamps has, but for the
# manifest.
$ ln -s "$SCENES" scenes
$ retex-render -q --size 96x54 --spp 64 --denoise -t Floor -t Wall --lamps each scenes/living-room/living-room.pov \
+     -o each.exr
$ rm scenes
$ retex-pack each.exr --web each 2>&1 | sed 's/[0-9]\{3,\}/N/g'; ls each/lamps-* | wc -l
> retex-pack: set each.exr: N bytes
> retex-pack: folder each: N bytes, N until the picture, N until the first target
> retex-pack: lamps Daylight, Garden, Lamp: N bytes, loaded when one is changed; shares of light 2 to 8 times smaller than the picture
> 1
$ retex-pack -q each.exr --no-lamps --web none; diff -rq each none | sed 's/-[0-9a-f]\{8\}//'
> Only in each: lamps.jpg
> Files each/room.json and none/room.json differ
$ near each.exr each <<'END'
+ 40
+ 35 light:*=0 light:Daylight=1
+ 32 light:*=0 light:Garden=1
+ 37 light:*=0 light:Lamp=1
+ 35 light:Daylight=0.2 light:Lamp=3*rgb(1,0.6,0.3) Floor=T/walnut-herringbone.jpg
+ 35 light:Garden=2*rgb(0.2,0.5,1) light:Lamp=0 Wall=0.2,0.3,0.7
+ 39 light:Lamp=1.001
+ END
$ python3 - <<'END'
+ import json
+ heights = [tile["height"] for tile in json.load(open("each/room.json"))["lamps"]["tiles"]]
+ print(len(set(heights)) > 1 and heights == sorted(heights, reverse=True))
+ END
> True
$ retex-pack -q each.exr --web again --threads 1
$ diff -r again each
$ retex-pack -q each.exr -o each.retex
$ retex-pack -q each.retex --web packed-lamps
$ near each.exr packed-lamps <<'END'
+ 34 light:Daylight=0.1 light:Lamp=2
+ END
$ turn_a_bit again/lamps-*
$ /usr/bin/python3 reference.py again b.exr 2>&1 | sed 's/-.*[.]jpg/.jpg/'
> lamps.jpg is damaged

# Of more lamps than a page has the dimmest join `rest`, each with its value. A room with other lamps replaces their file.
$ retex-pack each.exr --web again --web-lamps 1 2>&1 | sed '1,2d; s/[0-9]\{3,\}/N/g'; ls again/lamps-* | wc -l
> retex-pack: lamps Daylight, rest: N bytes, loaded when one is changed; shares of light 2 to 8 times smaller than the picture
> retex-pack: Garden, Lamp join rest, being dimmest: a page has 1 lamps, or as many as --web-lamps says
> 1
$ /usr/bin/python3 reference.py again a.exr light:Daylight=0.1 light:rest=2
$ retex-combine -q each.exr --light Daylight=0.1 --light '*=2' -o b.exr
$ retex-diff -q a.exr b.exr --fail-psnr 31
$ /usr/bin/python3 reference.py again a.exr 'light:*=0' light:rest=1
$ retex-combine -q each.exr --light Daylight=0 -o b.exr
$ retex-diff -q a.exr b.exr --fail-psnr 32

# A lamp that is off in the picture: the page has the picture without it, and can turn it on. It does not join `rest`.
$ cat >off.pov <<'END'
+ #version 3.7;
+ #declare F = texture { pigment { rgb .5 } }
+ camera { location <0, 1, -3> look_at 0 }
+ plane { y, -1 texture { F } }
+ #declare Sun = light_source { <-2, 4, -3> rgb 1 }
+ light_source { Sun }
+ #declare Spot = light_source { <2, 2, -1> 0 }
+ light_source { Spot }
+ #declare Red = light_source { <1, 3, -2> <.5, 0, 0> }
+ light_source { Red }
+ END
$ retex-render -q --size 96x72 --spp 64 --denoise -t F --lamps each off.pov -o off.exr
$ retex-pack -q off.exr --web off
$ near off.exr off <<'END'
+ 38 F=0.3,0.6,0.2
+ 38 F=0.3,0.6,0.2 light:Spot=1
+ 38 F=0.3,0.6,0.2 light:Sun=0.2
+ 38 F=0.3,0.6,0.2 light:Red=rgb(0,0.5,1)
+ END
$ retex-pack off.exr --web off --web-lamps 1; test -e off/room.json && echo kept
> kept
! retex-pack: error: a page of 1 lamps has no room for all that are off in the picture: --web-lamps has more, --no-lamps none
$ retex-pack off.exr -o y.retex --web-lamps 2
! retex-pack: error: --web-lamps is of --web, and of sets that keep their lamps
= 2
$ retex-pack off.exr --web off --web-lamps 0
! retex-pack: error: --web-lamps: expected a whole number from 1 to 64, not '0'
= 2

# Finishes: each is the picture of retex-combine, with new textures and with lamps, and those that visitors cannot change
# apart join `rest` with each finish apart. Their light is loaded at once, and cannot be left out.
$ cp "$TESTS/finishes.pov" room.pov
$ retex-render -q --size 96x72 --spp 64 --denoise --finish Floor=original,Gloss --finish Wall=original,satin room.pov \
+     -o shine.exr
$ retex-pack shine.exr --web shine 2>&1 | sed 's/[0-9]\{3,\}/N/g'
> retex-pack: set shine.exr: N bytes
> retex-pack: folder shine: N bytes, N until the picture, N until the first target
> retex-pack: finishes of Floor, Wall: N bytes, loaded at once; shares of light 2 to 8 times smaller than the picture
$ near shine.exr shine <<'END'
+ 38
+ 38 finish:Floor=Gloss
+ 37 finish:Wall=satin
+ 38 finish:Floor=Gloss finish:Wall=satin Floor=T/walnut-herringbone.jpg
+ 38 finish:Floor=Gloss Wall=0.8,0.2,0.2
+ END

# Maps of finishes: of one target, and of two, one a colour.
$ near shine.exr shine <<'END'
+ 42 Floor=T/brick.jpg:finish=T/fans.jpg
+ 42 Floor=T/brick.jpg:scale=2:finish=T/fans.jpg Wall=0.8,0.2,0.2:finish=T/terrazzo.jpg finish:Wall=satin
+ END
$ python3 - <<'END'
+ import json
+ room = json.load(open("shine/room.json"))
+ print([(t["name"], t["finishes"], t["finish"]) for t in room["targets"]])
+ for p in room["parameters"]:
+     print(p["name"], repr(p["lamp"]), p["finishes"], p["value"][0], p["kept"][0])
+ END
> [('Floor', ['original', 'Gloss'], 1), ('Wall', ['original', 'satin'], 1)]
> finish0 '' [0, 0] 1.0 1.0
> finish1 '' [1, 1] 1.0 0.25
> finish2 '' [2, 1] 0.0 0.25
> finish3 '' [1, 2] 0.0 0.25
> finish4 '' [2, 2] 0.0 0.25
$ retex-render -q --size 96x72 --spp 64 --denoise --finish Floor=original,Gloss -l Lamp -l Panel room.pov -o lit.exr
$ retex-pack -q lit.exr --web lit
$ near lit.exr lit <<'END'
+ 40
+ 39 finish:Floor=Gloss light:Lamp=0.2
+ 33 finish:Floor=Gloss light:Panel=0
+ 41 Floor=0.6,0.3,0.2:finish=T/fans.jpg light:Lamp=0.2
+ END
$ retex-pack lit.exr --web lit --web-lamps 1 2>&1 | sed '1,2d; s/[0-9]\{3,\}/N/g'
> retex-pack: lamps Lamp, rest; finishes of Floor: N bytes, loaded at once; shares of light 2 to 8 times smaller than the picture
> retex-pack: Panel joins rest, being dimmest: a page has 1 lamps, or as many as --web-lamps says
$ python3 - <<'END'
+ import json
+ for p in json.load(open("lit/room.json"))["parameters"]:
+     print(p["name"], p["lamp"], p["finishes"], round(p["value"][0], 4), round(p["kept"][0], 4))
+ END
> Lamp finish0 Lamp [0] 1.2 1.2
> Lamp finish1 Lamp [1] 1.2 0.6
> Lamp finish2 Lamp [2] 0.0 0.6
> rest finish0 rest [0] 1.0 1.0
> rest finish1 rest [1] 1.0 0.5
> rest finish2 rest [2] 0.0 0.5
$ near lit.exr lit <<'END'
+ 40 finish:Floor=Gloss
+ 39 finish:Floor=Gloss light:Lamp=0.2
+ END
$ /usr/bin/python3 reference.py lit a.exr light:rest=2 finish:Floor=Gloss
$ retex-combine -q lit.exr --light Panel=2 --finish Floor=Gloss -o b.exr
$ retex-diff -q a.exr b.exr --fail-psnr 39
$ retex-pack shine.exr --web dull --no-lamps; test -e dull || echo nothing
> nothing
! retex-pack: error: a set with finishes keeps them as lamps, which cannot be left out

# A floor to the horizon, whose UV go far; a target that is not seen; a size and samples so few that nothing spreads.
$ cat >far.pov <<'END'
+ #declare F = texture { pigment { rgb .5 } }
+ #declare G = texture { pigment { rgb .4 } }
+ camera { location <0, 1, -3> look_at 0 }
+ light_source { <-2, 4, -3> rgb 1 }
+ plane { y, -1 texture { F } }
+ sphere { <0, 0, -99>, 1 texture { G } }
+ END
$ retex-render -q --size 96x72 --spp 16 -t F -t G far.pov -o far.exr
$ retex-render -q --size 1x1 --spp 1 -t F -t G far.pov -o tiny.exr
$ for s in far tiny; do
+     retex-pack -q $s.exr --web web-$s
+     echo 36 F=T/brick.jpg:scale=.5 G=1,0,0 | near $s.exr web-$s
+ done
$ python3 -c 'import json; print(max(t["uv_max"][1] for t in json.load(open("web-far/room.json"))["targets"]) > 2048)'
> True

# A damaged file is noticed.
$ turn_a_bit one/indep-*
$ /usr/bin/python3 reference.py one b.exr 2>&1 | sed 's/-.*[.]jpg/.jpg/'
> indep.jpg is damaged

# Another room in the same folder: its files replace those of the old one, and no others. If it fails, the old one stays.
$ retex-pack -q s.exr --quality 50 --web out/room 2>/dev/null
$ echo mine >out/room/mine-1.jpg
$ retex-pack s.exr --web out/room 2>&1 | /usr/bin/python3 "$TESTS/../web/files.py" out/room
> README.md index.html mine-1.jpg package.json retex-room.d.ts retex-room.js room.json
$ rm out/room/mine-1.jpg
$ cp -r out/room kept
$ retex-pack -q s.exr --quality 50 --web out/room
$ for f in out/room/dep_Wall_sharp-*; do
+     rm -rf kept/${f##*/}
+     mkdir kept/${f##*/}
+ done
$ find kept -type f | sort | xargs md5sum >before
$ retex-pack -q s.exr --quality 50 --web kept 2>&1 | sed 's/-[0-9a-f]*[.]jpg.*//'
> retex-pack: error: cannot write kept/dep_Wall_sharp
$ find kept -type f | sort | xargs md5sum | cmp - before && echo kept
> kept

# Smaller rooms beside it: what they are, their pictures against the whole one, averaged, and the same bytes for any number of threads. Another
# room without them leaves none behind, and one that fails leaves those that were there.
$ retex-pack s.exr --web many --web-smaller 2,3 2>&1 | tee said | sed -n '3,$s/[0-9]\{3,\}/N/gp'
> retex-pack: smaller room, 48x27: N bytes, N until the picture, N until the first target
> retex-pack: smaller room, 32x18: N bytes, N until the picture, N until the first target
$ /usr/bin/python3 "$TESTS/../web/files.py" many <said
> README.md index.html package.json retex-room.d.ts retex-room.js room.json
$ cp -r many half
$ cp half/$(grep -o '"file":"room-[^"]*' half/room.json | sed 's/.*"//; q') half/room.json
$ for t in 0.8,0.8,0.8 T/brick.jpg:scale=2,2; do
+     case $t in *:*) o="--texture:${t#*:} Floor=${t%%:*}" ;; *) o="--texture Floor=rgb($t)" ;; esac
+     retex-combine -q s.exr $o --size 48x27 -o a.exr
+     /usr/bin/python3 reference.py half b.exr Floor=$t
+     retex-diff -q a.exr b.exr --fail-psnr 40
+ done
$ retex-pack -q s.exr --web again --web-smaller 2,3 --threads 1; diff -r many again && echo same
> same
$ cp -r many both; retex-pack -q s.exr --web many; retex-pack -q s.exr --web fresh; diff -r many fresh && echo none
> none
$ for f in again/dep_Wall_sharp-*; do
+     rm both/${f##*/}
+     mkdir both/${f##*/}
+ done
$ find both -type f | sort | xargs md5sum >before
$ retex-pack -q s.exr --web both --web-smaller 4 2>&1 | sed 's/-[0-9a-f]*[.]jpg.*//'
> retex-pack: error: cannot write both/dep_Wall_sharp
$ find both -type f | sort | xargs md5sum | cmp - before && echo kept
> kept
$ retex-pack s.exr --web w --web-smaller 5
! retex-pack: error: --web-smaller: expected up to 4 of 2, 3, 4, 6 and 8, divided by commas, not '5'
= 2
$ retex-pack s.exr -o w.retex --web-smaller 2
! retex-pack: error: --web-smaller is of --web
= 2
$ retex-pack s.retex --web w --web-smaller 2; test -e w || echo nothing
> nothing
! retex-pack: error: the set cannot be reduced: its images have several sizes, as those of packs have

# What is refused, without leaving anything.
$ make_set other.exr 64 48; retex-pack other.exr --web other
! retex-pack: error: this set cannot be written for browsers: its layout is not footprints
= 2
$ test -e other || echo nothing
> nothing
$ retex-pack s.exr --web w -o x.retex
! retex-pack: error: --web writes a folder: it takes neither -o, --unpack, --lossless, --levels nor --stats
= 2
$ retex-pack s.exr --web s.exr 
! retex-pack: error: cannot write s.exr/index.html: Not a directory
= 2
$ retex-pack nothing.exr --web w; test -e w || echo nothing
> nothing
! retex-pack: error: cannot read nothing.exr: No such file or directory
