# retex-pack --web --preset: the look that a page begins with, what it takes along, and what is refused.
$ ln -s "$SCENES" scenes; retex-render -q --size 96x54 --spp 16 --denoise -t Floor -t Wall --lamps each scenes/living-room/living-room.pov -o s.exr; rm scenes; cp -r "$SCENES/textures" T
$ cp T/walnut-herringbone.jpg 'T/my; oak %.jpg'; oiiotool T/brick.jpg --iscolorspace sRGB --tocolorspace linear --nosoftwareattrib -d half -o T/brick.exr; mkdir -p looks
$ retex-combine -q s.exr --texture:scale=2,3:rotate=30:tiles=T/fans.jpg,T/travertine.jpg 'Floor=T/my; oak %.jpg' --texture Wall=T/brick.exr --texture:over:scale=.5 Wall=T/damask.jpg --light Lamp=2 --exposure 0.5 --view Filmic --save-preset looks/evening.json -o a.exr

# Its pictures are copied, under names that addresses need not escape; what browsers do not read becomes PNG.
$ retex-pack -q s.exr --preset looks/evening.json --web room; ls room room/textures | sed 's/-[0-9a-f]\{8\}[.]/-N./; s/_[a-z]*-N/_X-N/' | sort -u
> README.md
> brick-N.png
> damask-N.jpg
> dep_Floor_X-N.z
> dep_Wall_X-N.jpg
> fans-N.jpg
> index.html
> indep-N.jpg
> lamps-N.jpg
> look.json
> my__oak__-N.jpg
> package.json
> picture-N.jpg
> reduced-N.jpg
> retex-room.d.ts
> retex-room.js
> room.json
> room:
> room/textures:
> textures
> travertine-N.jpg
$ grep -o '<retex-room.*' room/index.html; python3 -c 'import json; print(json.load(open("room/look.json"))["edit"])' | sed 's/-[0-9a-f]\{8\}[.]/-N./g; s/;/\n/g'
> <retex-room src="." preset="look.json"></retex-room>
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

# The folder holds all of it, wherever it lies: the tools make the picture that the preset was of, but for the 8 bits of the PNG.
$ mkdir away; mv room away; mv T T2; retex-combine -q s.exr --preset away/room/look.json -o b.exr; mv T2 T; mv away/room .; retex-diff -q a.exr b.exr --fail-psnr 60
$ retex-combine -q s.exr --texture Floor=T/fans.jpg --save-preset looks/fans.json -o a.exr; retex-pack -q s.exr --preset looks/fans.json --web fans; retex-combine -q s.exr --preset fans/look.json -o b.exr; cmp a.exr b.exr

# From its own look it can be made again. Another look takes away what only the first one has, and none all of it, but for files of others.
$ cp -r room again; retex-pack -q s.exr --preset again/look.json --web again; diff -r room again
$ echo mine >again/textures/mine.jpg; retex-pack -q s.exr --preset looks/fans.json --web again; ls again/textures | sed 's/-[0-9a-f]*[.]/-N./'
> fans-N.jpg
> mine.jpg
$ retex-pack -q s.exr --web again; grep -o '<retex-room.*' again/index.html; ls again/textures again/look.json 2>/dev/null
> <retex-room src="."></retex-room>
> again/textures:
> mine.jpg
$ rm -r fans/textures; mkdir fans/textures; retex-pack -q s.exr --web fans; ls -d fans/textures 2>/dev/null || echo gone
> gone

# What the set, or a page, cannot show is refused before anything is written; the folder that was there stays.
$ find room -type f | sort | xargs -d '\n' md5sum >before; try() { printf '{"retex-preset": 1, "edit": "%s"}' "$1" >looks/try.json; retex-pack -q s.exr --preset looks/try.json --web "${2:-new}"; test $? = 2 && test ! -e new && find room -type f | sort | xargs -d '\n' md5sum | cmp - before; }; try 'Flor=tan'; try 'light:Sun=2'; try 'picture:view=Log'; try 'Floor=away.jpg'; try 'Floor=away.jpg' room; try 'Floor=../T/fans.jpg;Floor.finish=../T/brick.exr' room; try 'Floor' room; cp s.exr looks/x.jpg; try 'Floor=x.jpg'
! retex-pack: error: the set has no target 'Flor', nearest: 'Floor' (it has: Floor, Wall)
! retex-pack: error: the set has no lamp 'Sun' (it has: Daylight, Garden, Lamp)
! retex-pack: error: looks/try.json: pages have no view 'Log': expected Standard, Filmic, Neutral or Raw
! retex-pack: error: cannot open looks/away.jpg: No such file or directory
! retex-pack: error: cannot open looks/away.jpg: No such file or directory
$ retex-pack s.exr --preset looks/fans.json -o s.retex
! retex-pack: error: --preset is of --web
= 2

# Warned of: normal maps, which pages do not show.
$ printf '{"retex-preset": 1, "edit": "Floor=../T/fans.jpg;Floor.normal=../T/damask.jpg"}' >looks/bumps.json; retex-pack -q s.exr --preset looks/bumps.json --web bumps; ls bumps/textures | sed 's/-[0-9a-f]*[.]/-N./'; grep -c normal bumps/look.json
