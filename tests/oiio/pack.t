# retex.imageio: packs through the programs of OpenImageIO.
$ skip-without oiiotool openimageio-tools
$ retex-render -q --size 48x32 --spp 2 -t Floor -t Wall=White "$SCENES/cornell-box/cornell-box.pov" -o s.exr
$ retex-pack -q s.exr -o room.retex
$ cp "$SCENES/textures/brick.jpg" .
$ retex-combine -q room.retex -o plain.exr
$ retex-combine -q room.retex --texture Floor=brick.jpg -o brick.exr

% same() { retex-diff "$@" >/dev/null && echo same; }

# Its picture, the parts of its set by name, and what is told of them.
$ iinfo room.retex
> room.retex :   48 x   32, 3 channel, float retex (134 subimages)
$ iinfo -v -a room.retex | grep -A 16 'subimage  1:' | sort
>     channel list: indep.R, indep.G, indep.B
>     channel list: original_Floor.R, original_Floor.G, original_Floor.B
>     chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329
>     chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329
>     colorInteropID: "lin_rec709_scene"
>     colorInteropID: "lin_rec709_scene"
>     full/display origin: 0, 0
>     full/display size: 48 x 32
>     oiio:ColorSpace: "Linear"
>     oiio:ColorSpace: "Linear"
>     oiio:subimagename: "indep"
>     oiio:subimagename: "original_Floor"
>     retex:role: "original"
>     retex:role: "radiance"
>     retex:target: "Floor"
>  subimage  1:   48 x   32, 3 channel, half retex
>  subimage  2: 1024 x 1024, 3 channel, half retex
$ iinfo -v room.retex | grep -v 'retex: \|subimages' | sort
>     Software: "retex-render 0.1.0"
>     channel list: R, G, B
>     chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329
>     colorInteropID: "lin_rec709_scene"
>     oiio:ColorSpace: "Linear"
>     oiio:subimagename: "beauty"
>     retex:layout: "footprints"
>     retex:max_depth: 16
>     retex:role: "picture"
>     retex:scene: "cornell-box.pov"
>     retex:seed: 0
>     retex:spp: 2
>     retex:targets: "Floor,Wall"
> room.retex :   48 x   32, 3 channel, float retex
$ oiiotool room.retex -d half --subimage 0 -o x.exr && same x.exr plain.exr
> same

# The target of every part that has one is that in the part's name, whatever it is for.
$ iinfo -v -a room.retex |
+     awk -F '"' '
+         function end() {
+             split(name, word, "_")
+             if (word[2])
+                 print role, (target == word[2] ? target : name " is of " target)
+         }
+         /oiio:subimagename/ { end(); name = $2; role = target = "" }
+         /retex:role/ { role = $2 }
+         /retex:target"*:/ { target = $2 }
+         END { end() }' |
+     sort | uniq -c | awk '{ $1 = ""; print substr($0, 2) }'
> albedo Floor
> albedo Wall
> gain Floor
> gain Wall
> original Floor
> original Wall
> radiance Floor
> radiance Wall
> radiance correction_Floor is of
> radiance correction_Wall is of
> share Floor
> share Wall
> spread Floor
> spread Wall
> uv Floor
> uv Wall

# In a mixture of several targets' footprints each share has its own: in the set's manifest, and as the plugin shows it.
$ make_set m.exr 24 16 footprints
$ retex-pack -q --lossless m.exr -o m.retex
$ iinfo -v m.exr | sed -n 's/^ *retex: //p' >manifest.json
$ /usr/bin/python3 - <<'END' | sort >manifest.txt
+ import json
+ manifest = json.loads(json.load(open("manifest.json")))
+ for mixture in manifest["mixtures"]:
+     for share in mixture:
+         target = manifest["footprints"][share["footprint"]]["target"]
+         print(share["weight"], manifest["targets"][target]["name"])
+ END
$ iinfo -v -a m.retex |
+     awk -F '"' '
+         /oiio:subimagename/ { name = $2 }
+         /retex:role/ { role = $2 }
+         /retex:target"*:/ && role == "share" { print name, $2 }' |
+     sort >shown.txt
$ cat manifest.txt
> share-0 Floor
> share-1 Wall
> share-2 Floor
> share-3 Wall
> share-4 Wall
$ cmp manifest.txt shown.txt

# All that is written of it is the set again, checksums included.
$ oiiotool room.retex -o set.exr
$ retex-info --check set.exr
> set.exr: ok
$ retex-pack -q --unpack room.retex -o un.exr
$ for part in un set; do retex-info --json $part.exr | tr ',' '\n' | grep -v 'file_bytes\|crc32' >$part.txt; done
$ cmp un.txt set.txt
$ for set in un set; do retex-combine -q $set.exr --texture Floor=brick.jpg -o $set-brick.exr; done
$ cmp un-brick.exr set-brick.exr
$ oiiotool room.retex -q -o x.png 2>&1 >/dev/null | head -1
> oiiotool WARNING: -o : png does not support multiple subimages for x.png

# Textures: to the bit what retex-combine makes.
$ oiiotool 'room.retex?Floor=brick.jpg' -d half -o x.exr && same x.exr brick.exr
> same
$ retex-combine -q room.retex --texture:scale=2,2:rotate=30:wrap=mirror floor=brick.jpg \
+     --texture 'Wall=rgb(0.8,0.1,0.1)' -o both.exr
$ oiiotool 'room.retex?floor=brick.jpg&floor.scale=2,2&floor.rotate=30&floor.wrap=mirror&Wall=rgb(0.8,0.1,0.1)' \
+     -d half -o x.exr && same x.exr both.exr
> same
$ same brick.exr both.exr || echo 'not the same'
> not the same
$ cp brick.jpg 'a&b%.jpg'
$ oiiotool 'room.retex?Floor=a%26b%25.jpg' -d half -o x.exr && same x.exr brick.exr
> same
# A folder is the base colour that it holds, in safe access too.
$ mkdir -p planks/textures
$ cp brick.jpg planks/textures/planks_diff_2k.jpg
$ touch planks/textures/planks_ao_2k.jpg
$ for o in Floor=planks 'Floor=planks/&safe=1'; do
+     oiiotool "room.retex?$o" -d half -o x.exr && same x.exr brick.exr
+ done
> same
> same
! retex: warning: planks: the ambient occlusion map is not used
! retex: warning: planks: the ambient occlusion map is not used
$ oiiotool 'room.retex?Floor=brick.jpg' --tocolorspace sRGB -o x.png
$ retex-combine -q room.retex --texture Floor=brick.jpg -o y.png
$ retex-diff x.png y.png --fail-psnr 60 >/dev/null && echo near
> near
$ maketx room.retex -o x.tx
$ oiiotool 'room.retex?Floor=brick.jpg' -otex y.tx
$ iinfo x.tx y.tx
> x.tx :   48 x   32, 3 channel, float tiff (+mipmap)
> y.tx :   48 x   32, 3 channel, float tiff (+mipmap)
$ retex-combine -q room.retex --texture Wall=room.retex -o x.exr &&
+     oiiotool 'room.retex?Wall=room.retex' -d half -o y.exr && same x.exr y.exr
> same
! retex-combine: warning: room.retex: 21 texels of 1536 brighter than white, up to 19.9, the first at 18,1: a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly
! retex: warning: room.retex: 21 texels of 1536 brighter than white, up to 19.9, the first at 18,1: a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly

# What is wrong with options.
$ for o in Flor=brick.jpg Floor=none.jpg Floor=- Floor.scale=2 'Floor=brick.jpg&Floor.scal=2' \
+     'Floor=brick.jpg&Floor.scale=0' 'Floor=brick.jpg&floor=brick.jpg' 'Floor=rgb(1,2)' \
+     'Floor=brick.jpg&Floor.wrap=a:b'; do
+     oiiotool "room.retex?$o" -o no.exr 2>&1 | grep ERROR
+ done
> oiiotool ERROR: read : "room.retex?Flor=brick.jpg": no target is called 'Flor'; the set has Floor, Wall; is Floor meant?
> oiiotool ERROR: read : "room.retex?Floor=none.jpg": cannot read none.jpg: No such file or directory
> oiiotool ERROR: read : "room.retex?Floor=-": cannot read -: No such file or directory
> oiiotool ERROR: read : "room.retex?Floor.scale=2": Floor has options, but no texture; expected Floor=IMAGE too
> oiiotool ERROR: read : "room.retex?Floor=brick.jpg&Floor.scal=2": no texture option is called 'scal'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize; is scale meant?
> oiiotool ERROR: read : "room.retex?Floor=brick.jpg&Floor.scale=0": texture option scale='0': a scale cannot be 0
> oiiotool ERROR: read : "room.retex?Floor=brick.jpg&floor=brick.jpg": target Floor is given two textures
> oiiotool ERROR: read : "room.retex?Floor=rgb(1,2)": colour 'rgb(1,2)': expected rgb(r,g,b) with three numbers
> oiiotool ERROR: read : "room.retex?Floor=brick.jpg&Floor.wrap=a:b": texture option wrap='a:b': expected repeat, mirror, clamp or black, or two of them for u,v
$ oiiotool 'room.retex?Floor' -o no.exr 2>&1 | grep ERROR
> oiiotool ERROR: read : File does not exist: "room.retex?Floor"
$ iinfo 'room.retex?Floor'
! iinfo ERROR: "room.retex?Floor" : ImageInput::create() called with malformed filename
= 1

# What is no pack.
$ head -c 20000 room.retex >cut.retex
$ cp brick.jpg picture.retex
$ printf 'not a pack' >junk.retex
$ printf 'PK\003\004' >short.retex
$ : >empty.retex
$ mkdir folder.retex
$ cp room.retex room.png
$ for f in cut junk short empty folder none; do iinfo $f.retex; done
! iinfo ERROR: "cut.retex" : cut.retex: the pack is damaged or truncated: its directory is missing
! iinfo ERROR: "junk.retex" : junk.retex: no .retex file by what is in it
! iinfo ERROR: "short.retex" : short.retex: the pack is damaged or truncated: its directory is missing
! iinfo ERROR: "empty.retex" : empty.retex: no .retex file: it is empty
! iinfo ERROR: "folder.retex" : cannot read folder.retex: Is a directory
! iinfo ERROR: "none.retex" : cannot read none.retex: No such file or directory
= 1
$ for f in cut junk short empty folder none; do oiiotool $f.retex -o no.exr 2>&1 | grep ERROR; done
> oiiotool ERROR: read : cut.retex: the pack is damaged or truncated: its directory is missing
> oiiotool ERROR: read : junk.retex: no .retex file by what is in it
> oiiotool ERROR: read : short.retex: the pack is damaged or truncated: its directory is missing
> oiiotool ERROR: read : empty.retex: no .retex file: it is empty
> oiiotool ERROR: read : cannot read folder.retex: Is a directory
> oiiotool ERROR: read : File does not exist: "none.retex"
$ iinfo picture.retex room.png
> picture.retex : 1024 x 1024, 3 channel, uint8 jpeg
! iinfo ERROR: "room.png" : Not a PNG file
= 1

# What is odd about a texture goes to standard error: it is no error.
$ oiiotool 'room.retex?Floor=rgb(255,128,0)' -d half -o x.exr && echo done
> done
! retex: warning: Floor=rgb(255,128,0): a surface of a colour above 1 gives back more light than it gets; if numbers from 0 to 255 are meant, it is rgb(1,0.216,0)

# Lamps: their values in the name, in one grammar with textures.
$ make_set lit.exr 48 32
$ make_lamp_terms lit.exr lamps.exr
$ retex-pack -q --lossless lamps.exr -o lamps.retex
$ retex-combine -q lamps.retex --texture Floor=brick.jpg --light Lamp=2*3000K --light '*=0' -o x.exr
$ oiiotool "lamps.retex?Floor=brick.jpg&light:lamp=2*3000K&light:*=0" -d half -o y.exr
$ retex-diff -q x.exr y.exr --fail-psnr 90
$ retex-combine -q lamps.retex --texture Floor=brick.jpg --exposure .5 --white-balance 4000 --auto-exposure -o x.exr
% picture='picture:exposure=.5&picture:white-balance=4000&picture:auto-exposure=yes&picture:view=Filmic'
$ oiiotool "lamps.retex?Floor=brick.jpg&$picture" -d half -o y.exr
$ retex-diff -q x.exr y.exr --fail-psnr 90
$ retex-combine -q lamps.retex --exposure 1 -o x.exr
$ oiiotool "lamps.retex?picture:exposure=1" -d half -o y.exr
$ retex-diff -q x.exr y.exr --fail-psnr 90
$ oiiotool 'lamps.retex?light:Lmap=2' -o y.exr 2>&1 | head -1
> oiiotool ERROR: read : "lamps.retex?light:Lmap=2": no lamp is called 'Lmap'; the set has Lamp, Window, rest; is Lamp meant?
