# What a name may read with RETEX_SAFE=1, or safe=1 in itself: the folder of the pack or the scene, and pictures of the
# list.
$ skip-without oiiotool openimageio-tools
% # Its message, if it is refused.
% refused() { oiiotool "$1" -o x.exr 2>&1 | grep ERROR; }
$ mkdir in in/sub
$ make_set in/s.exr 24 16
$ retex-pack -q in/s.exr -o in/room.retex
$ make_picture in/t.png size=8x8
$ cp in/t.png in/sub
$ cp in/t.png up.png
$ ln -s ../up.png in/link.png
$ oiiotool up.png -o in/t.ppm
$ mkfifo in/pipe.png in/pipe.retex in/pipe.pov
$ for t in up.png ../up.png link.png /etc/passwd /nowhere nowhere.png t.ppm pipe.png sub in/t.png; do
+     RETEX_SAFE=1 refused "in/room.retex?Floor=$t"
+ done
> oiiotool ERROR: read : "in/room.retex?Floor=up.png": cannot read up.png: No such file or directory
> oiiotool ERROR: read : "in/room.retex?Floor=../up.png": ../up.png is outside the folder of the file that is read, the only one that may be (--safe)
> oiiotool ERROR: read : "in/room.retex?Floor=link.png": link.png is outside the folder of the file that is read, the only one that may be (--safe)
> oiiotool ERROR: read : "in/room.retex?Floor=/etc/passwd": /etc/passwd is outside the folder of the file that is read, the only one that may be (--safe)
> oiiotool ERROR: read : "in/room.retex?Floor=/nowhere": /nowhere is outside the folder of the file that is read, the only one that may be (--safe)
> oiiotool ERROR: read : "in/room.retex?Floor=nowhere.png": cannot read nowhere.png: No such file or directory
> oiiotool ERROR: read : "in/room.retex?Floor=t.ppm": in/t.ppm: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
> oiiotool ERROR: read : "in/room.retex?Floor=pipe.png": in/pipe.png is a folder, a device or a pipe: only files are read (--safe)
> oiiotool ERROR: read : "in/room.retex?Floor=sub": in/sub: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has t.png
> oiiotool ERROR: read : "in/room.retex?Floor=in/t.png": cannot read in/t.png: No such file or directory

# Names are taken from the pack's folder, and give what retex-combine makes of the same file.
$ retex-combine -q in/room.retex --texture Floor=in/t.png -o y.exr
$ for n in 'Floor=t.png&safe=1' 'safe=1&Floor=sub/t.png' "Floor=$PWD/in/t.png&safe=1"; do
+     oiiotool "in/room.retex?$n" -d half -o x.exr && retex-diff -q x.exr y.exr || echo "$n"
+ done
# Only who runs the program turns it off.
$ for s in 0 1 2; do
+     refused "in/room.retex?Floor=up.png&safe=$s"
+     RETEX_SAFE=1 refused "in/room.retex?Floor=up.png&safe=$s"
+ done
> oiiotool ERROR: read : "in/room.retex?Floor=up.png&safe=0": cannot read up.png: No such file or directory
> oiiotool ERROR: read : "in/room.retex?Floor=up.png&safe=1": cannot read up.png: No such file or directory
> oiiotool ERROR: read : "in/room.retex?Floor=up.png&safe=1": cannot read up.png: No such file or directory
> oiiotool ERROR: read : "in/room.retex?Floor=up.png&safe=2": safe: expected 0 or 1, not '2'
> oiiotool ERROR: read : "in/room.retex?Floor=up.png&safe=2": safe: expected 0 or 1, not '2'

# Scenes.
$ printf 'box { -1, 1 pigment { image_map { png "../up.png" } } }\nbackground { rgb 1 }\n' >in/up.pov
$ printf '#include "i.inc"\nbackground { rgb 1 }\n' >in/inc.pov
$ echo 'box { -1, 1 }' >in/sub/i.inc
$ cp in/sub/i.inc .
$ for n in 'up.pov?spp=1' 'up.pov?spp=1&safe=0' 'up.pov?spp=1&include=..' 'inc.pov?spp=1' 'inc.pov?spp=1&include=.' \
+     'inc.pov?spp=1&include=/' 'inc.pov?spp=1&include=nowhere' 'inc.pov?spp=1&include=sub'; do
+     RETEX_SAFE=1 refused "in/$n&size=8x8"
+ done
> oiiotool ERROR: read : "in/up.pov?spp=1&size=8x8": in/up.pov:1:39: the image `../up.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
> oiiotool ERROR: read : "in/up.pov?spp=1&safe=0&size=8x8": in/up.pov:1:39: the image `../up.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
> oiiotool ERROR: read : "in/up.pov?spp=1&include=..&size=8x8": .. is outside the folder of the file that is read, the only one that may be (--safe)
> oiiotool ERROR: read : "in/inc.pov?spp=1&size=8x8": in/inc.pov:1:10: cannot find the file `i.inc` in the scene's folder or the include path
> oiiotool ERROR: read : "in/inc.pov?spp=1&include=.&size=8x8": in/inc.pov:1:10: cannot find the file `i.inc` in the scene's folder or the include path
> oiiotool ERROR: read : "in/inc.pov?spp=1&include=/&size=8x8": / is outside the folder of the file that is read, the only one that may be (--safe)
> oiiotool ERROR: read : "in/inc.pov?spp=1&include=nowhere&size=8x8": cannot read nowhere: No such file or directory
= 1
$ for n in 'up.pov?safe=1' 'up.pov?safe=2' 'inc.pov?safe=0'; do
+     refused "in/$n&spp=1&size=8x8"
+ done
> oiiotool ERROR: read : "in/up.pov?safe=1&spp=1&size=8x8": in/up.pov:1:39: the image `../up.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
> oiiotool ERROR: read : "in/up.pov?safe=2&spp=1&size=8x8": safe: expected a whole number from 0 to 1, not '2'
= 1
# A pipe is not waited for. (Without options in the name OpenImageIO goes on to its own decoders, which do wait.)
$ for f in 'pipe.pov?spp=1' 'pipe.retex?Floor=t.png'; do RETEX_SAFE=1 timeout 20 iinfo "in/$f"; done
! iinfo ERROR: "in/pipe.pov?spp=1" : in/pipe.pov is a folder, a device or a pipe: only files are read (--safe)
! iinfo ERROR: "in/pipe.retex?Floor=t.png" : in/pipe.retex is a folder, a device or a pipe: only files are read (--safe)
= 1

# What a picture's parts are called does not reach the terminal as it is.
$ oiiotool in/t.png --attrib oiio:subimagename "$(printf 'a\033[2J')" in/t.png --attrib oiio:subimagename b --siappend \
+     -d half -o names.exr
$ retex-diff --all-parts names.exr names.exr | cat -v
> a?[2J: psnr 120.00 relmse 0 mae 0 flip 0 (p99 0) max 0 rel 0 at 0,0 B
> b: psnr 120.00 relmse 0 mae 0 flip 0 (p99 0) max 0 rel 0 at 0,0 B
$ retex-diff --all-parts names.exr in/t.png | cat -v
> part 'a?[2J' is missing in the second

# Limits of the environment.
$ make_picture in/big.png size=400x400
$ echo '#while (1) #declare A = 1; #end' >in/endless.pov
$ printf 'box { -1, 1 }\nbackground { rgb 1 }\n' >in/box.pov
$ for n in 'room.retex?Floor=in/big.png' 'box.pov?size=200x150' 'room.retex?Floor=in/t.png'; do
+     RETEX_MAX_PIXELS=20000 refused "in/$n"
+ done
> oiiotool ERROR: read : "in/room.retex?Floor=in/big.png": in/big.png: the picture is too large: 400 x 400 pixels, more than the 20000 of --max-pixels
> oiiotool ERROR: read : "in/box.pov?size=200x150": 200x150 pixels are more than the 20000 of --max-pixels
= 1
$ RETEX_MAX_PIXELS=100 refused 'in/room.retex?Floor=t.png'
> oiiotool ERROR: read : "in/room.retex?Floor=t.png": the picture is too large: 24 x 16 pixels, more than the 100 of --max-pixels
$ RETEX_MAX_STEPS=1000 refused 'in/endless.pov?spp=1'
> oiiotool ERROR: read : "in/endless.pov?spp=1": in/endless.pov:1:10: the scene takes more than the 1000 steps of --max-steps; is a loop endless?
$ RETEX_MAX_TIME=0.5 refused 'in/box.pov?spp=1000000&size=400x300'
> oiiotool ERROR: read : "in/box.pov?spp=1000000&size=400x300": this takes longer than the 0.5 s of --max-time
$ RETEX_MAX_MEMORY=50M refused 'in/box.pov?spp=1&size=4000x3000'
> oiiotool ERROR: read : "in/box.pov?spp=1&size=4000x3000": 4000x3000 pixels need 0.1 GB of memory, there are 0.1: render parts with --crop, or raise --max-memory
$ RETEX_MAX_MEMORY=1M refused 'in/room.retex?Floor=in/big.png'
> oiiotool ERROR: read : "in/room.retex?Floor=in/big.png": in/big.png: the picture is too large: 400 x 400 pixels, more than --max-memory has room for
$ RETEX_MAX_PIXELS=lots refused 'in/room.retex?Floor=t.png'
> oiiotool ERROR: read : "in/room.retex?Floor=t.png": RETEX_MAX_PIXELS: expected a whole number from 1, not 'lots'

# With safe access there are limits without any in the environment.
$ cp "$TESTS/../data/white-6000.png" in/white.png
$ for n in 'box.pov?size=7680x4321' 'box.pov?size=7680x4320'; do
+     iinfo "in/$n&safe=1"
+     RETEX_SAFE=1 iinfo "in/$n"
+     RETEX_SAFE=1 RETEX_MAX_PIXELS=268435456 iinfo "in/$n"
+     iinfo "in/$n"
+ done
> in/box.pov?size=7680x4321&safe=1 :    1 x    1, 3 channel, float pov
> in/box.pov?size=7680x4321 :    1 x    1, 3 channel, float pov
> in/box.pov?size=7680x4321 : 7680 x 4321, 3 channel, float pov
> in/box.pov?size=7680x4321 : 7680 x 4321, 3 channel, float pov
> in/box.pov?size=7680x4320&safe=1 : 7680 x 4320, 3 channel, float pov
> in/box.pov?size=7680x4320 : 7680 x 4320, 3 channel, float pov
> in/box.pov?size=7680x4320 : 7680 x 4320, 3 channel, float pov
> in/box.pov?size=7680x4320 : 7680 x 4320, 3 channel, float pov
$ for s in 1 0; do
+     n="in/room.retex?Floor=white.png&safe=$s"
+     refused "$n"
+     RETEX_SAFE=1 refused "$n"
+     RETEX_SAFE=1 RETEX_MAX_PIXELS=36000000 refused "in/room.retex?Floor=white.png"
+ done
> oiiotool ERROR: read : "in/room.retex?Floor=white.png&safe=1": in/white.png: the picture is too large: 6000 x 6000 pixels, more than the 33177600 of --max-pixels
> oiiotool ERROR: read : "in/room.retex?Floor=white.png&safe=1": in/white.png: the picture is too large: 6000 x 6000 pixels, more than the 33177600 of --max-pixels
> oiiotool ERROR: read : "in/room.retex?Floor=white.png&safe=0": cannot read white.png: No such file or directory
> oiiotool ERROR: read : "in/room.retex?Floor=white.png&safe=0": in/white.png: the picture is too large: 6000 x 6000 pixels, more than the 33177600 of --max-pixels
= 1
