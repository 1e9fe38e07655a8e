# retex-pack --web --preset: the look that a page begins with, what it takes along, and what is refused.
$ ln -s "$SCENES" scenes
$ retex-render -q --size 96x54 --spp 16 --denoise -t Floor -t Wall --lamps each scenes/living-room/living-room.pov \
+     -o s.exr
$ rm scenes
$ mkdir T; for t in brick damask fans travertine walnut-herringbone; do
+     oiiotool "$SCENES/textures/$t.jpg" --resize 256x256 -o T/$t.jpg
+ done
$ cp T/walnut-herringbone.jpg 'T/my; oak %.jpg'
$ oiiotool T/brick.jpg --iscolorspace sRGB --tocolorspace linear --nosoftwareattrib -d half -o T/brick.exr
$ mkdir -p looks
$ retex-combine -q s.exr --texture:scale=2,3:rotate=30:tiles=T/fans.jpg,T/travertine.jpg 'Floor=T/my; oak %.jpg' \
+     --texture Wall=T/brick.exr --texture:over:scale=.5 Wall=T/damask.jpg --light Lamp=2 --exposure 0.5 --view Filmic \
+     --save-preset looks/evening.json -o a.png

# Its pictures are copied, under names that addresses need not escape; what browsers do not read becomes PNG.
$ retex-pack -q s.exr --preset looks/evening.json --web room
$ ls room room/textures | sed 's/-[0-9a-f]\{8\}[.]/-N./' | grep -v '_[FW].*-N' | grep . | LC_ALL=C sort -u
> README.md
> brick-N.png
> damask-N.jpg
> fans-N.jpg
> indep-N.jpg
> index.html
> lamps-N.jpg
> look.json
> my__oak__-N.jpg
> package.json
> picture-N.jpg
> reduced-N.jpg
> retex-room.d.ts
> retex-room.js
> room.json
> room/textures:
> room:
> textures
> travertine-N.jpg
$ grep -o '<retex-room.*' room/index.html | sed 's/-[0-9a-f]\{8\}[.]/-N./g'
> <retex-room src="." preset="look.json" textures="textures/my__oak__-N.jpg textures/brick-N.png"></retex-room>
$ python3 -c 'import json; print(json.load(open("room/look.json"))["edit"])' |
+     sed 's/-[0-9a-f]\{8\}[.]/-N./g; s/;/\n/g'
> Floor=textures/my__oak__-N.jpg
> Floor.scale=2,3
> Floor.rotate=30
> Floor.tiles=textures/fans-N.jpg,textures/travertine-N.jpg
> Wall=textures/brick-N.png
> over:Wall=textures/damask-N.jpg
> over:Wall.scale=0.5,0.5
> light:Lamp=2
> picture:exposure=0.5
> picture:view=Filmic

# So it is where the folder is named from the root.
$ retex-pack -q s.exr --preset looks/evening.json --web "$PWD/rooted" && diff -r room rooted && rm -r rooted

# The folder holds all of it, wherever it lies: the tools make the picture that the preset was of, but for the 8 bits
# of the PNG.
$ mkdir away
$ mv room away
$ mv T T2
$ retex-combine -q s.exr --preset away/room/look.json -o b.png
$ mv T2 T
$ mv away/room .
$ retex-diff -q a.png b.png --fail-psnr 50

# A look with another texture.
$ retex-combine -q s.exr --texture Floor=T/fans.jpg --save-preset looks/fans.json -o a.exr
$ retex-pack -q s.exr --preset looks/fans.json --web fans
$ retex-combine -q s.exr --preset fans/look.json -o b.exr
$ cmp a.exr b.exr

# From its own look it can be made again. Another look takes away what only the first one has, and none all of it, but
# for files of others.
$ cp -r room again
$ retex-pack -q s.exr --preset again/look.json --web again
$ diff -r room again
$ echo mine >again/textures/mine.jpg
$ retex-pack -q s.exr --preset looks/fans.json --web again
$ ls again/textures | sed 's/-[0-9a-f]*[.]/-N./'
> fans-N.jpg
> mine.jpg
$ retex-pack -q s.exr --web again
$ grep -o '<retex-room.*' again/index.html
> <retex-room src="."></retex-room>
$ ls again/textures
> mine.jpg
$ test -e again/look.json || echo gone
> gone
$ rm -r fans/textures
$ mkdir fans/textures
$ retex-pack -q s.exr --web fans
$ ls -d fans/textures 2>/dev/null || echo gone
> gone

# What the set, or a page, cannot show is refused before anything is written; the folder that was there stays.
$ find room -type f | sort | xargs -d '\n' md5sum >before
% # The look of EDIT is refused, and neither a new folder nor a file of `room` is written: try EDIT [FOLDER].
% try() {
%     printf '{"retex-preset": 1, "edit": "%s"}' "$1" >looks/try.json
%     retex-pack -q s.exr --preset looks/try.json --web "${2:-new}"
%     test $? = 2 && test ! -e new && find room -type f | sort | xargs -d '\n' md5sum | cmp - before
% }
$ try 'Flor=tan'
! retex-pack: error: no target is called 'Flor'; the set has Floor, Wall; is Floor meant?
$ try 'light:Sun=2'
! retex-pack: error: no lamp is called 'Sun'; the set has Daylight, Garden, Lamp, rest
$ try 'picture:view=Log'
! retex-pack: error: looks/try.json: pages have no view 'Log': expected Standard, Filmic, Neutral or Raw
$ try 'Floor=away.jpg'
! retex-pack: error: cannot read looks/away.jpg: No such file or directory
$ try 'Floor=away.jpg' room
! retex-pack: error: cannot read looks/away.jpg: No such file or directory
$ try 'Floor' room
! retex-pack: error: looks/try.json: `Floor`: expected TARGET=IMAGE, TARGET.OPTION=VALUE, light:LAMP=VALUE, finish:TARGET=NAME or picture:KEY=VALUE
$ echo no >looks/x.jpg
$ try 'Floor=../T/fans.jpg;Wall=x.jpg' room
! retex-pack: error: looks/x.jpg: cannot read: "looks/x.jpg" is not a JPEG file, magic number doesn't match (was 0x6e6f)
$ retex-pack s.exr --preset looks/fans.json -o s.retex
! retex-pack: error: --preset is of --web
= 2

# What a file is, its content says: an EXR with another name becomes PNG, and a JPEG is called so.
$ cp T/brick.exr looks/wrong.jpg
$ cp T/fans.jpg looks/fans
$ printf '{"retex-preset": 1, "edit": "Floor=wrong.jpg;Wall=fans"}' >looks/names.json
$ retex-pack -q s.exr --preset looks/names.json --web names
$ ls names/textures | sed 's/-[0-9a-f]*[.]/-N./'
> fans-N.jpg
> wrong-N.png

# Normal maps, and the roughness of folders, are not on pages, which is told. A map of finishes is a file that
# browsers read.
$ printf '{"retex-preset": 1, "edit": "Floor=../T/fans.jpg;Floor.normal=../T/damask.jpg"}' >looks/bumps.json
$ retex-pack -q s.exr --preset looks/bumps.json --web bumps
! retex-pack: warning: Floor: a page does not show normal maps: looks/../T/damask.jpg
$ ls bumps/textures | sed 's/-[0-9a-f]*[.]/-N./'
> fans-N.jpg
$ grep -q normal bumps/look.json || echo none
> none
% look() {
%     printf '{"retex-preset": 1, "edit": "Floor=%s"}' "$1" >look.json
%     retex-pack -q f.exr --preset look.json --web finished && ls finished/textures | sed 's/-[0-9a-f]*[.]/-N./'
% }
$ cp "$TESTS/finishes.pov" room.pov
$ retex-render -q --size 48x36 --spp 4 --denoise --finish Floor=original,Gloss room.pov -o f.exr
$ mkdir oak
$ cp T/fans.jpg oak/oak_color.jpg
$ cp T/damask.jpg oak/oak_roughness.jpg
$ look 'oak'
> oak_color-N.jpg
! retex-pack: warning: Floor: a page does not show the roughness of a folder: oak/oak_roughness.jpg
$ look 'T/fans.jpg;Floor.finish=T/damask.jpg;finish:Floor=Gloss'
> damask-N.jpg
> fans-N.jpg
$ look 'T/fans.jpg;Floor.finish=T/brick.exr'
! retex-pack: error: a page cannot show the map of finishes T/brick.exr: it must be PNG or JPEG
= 2
