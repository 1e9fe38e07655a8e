# retex-import: floor and wall as targets that the scene offers. import_targets.py has the models, and judges the targets
# by a ray tracer of its own.
% judge() { /usr/bin/python3 $TESTS/import_targets.py "$@"; }
% offers() { retex-render --list-targets --size 64x48 $1/$1.pov; }
$ judge

# A floor of boards of three heights, of tiles on a bed, of a mesh that has all the room, in a room that is turned, one that
# is named so, and one without a ceiling: Floor is all of it, and nothing else; Wall is the largest that is seen.
$ for m in boards tiles atlas named; do
+     for c in 4.6,1.5,-3.6:1.5,.9,-1 .5,1.5,-3.7:4,.9,-1; do
+         retex-import -qf $m.gltf --camera $c:75 -o $m && offers $m | judge judge $m
+     done
+ done
> as expected
> as expected
> as expected
> as expected
> as expected
> as expected
> as expected
> as expected
$ retex-import -q turned.gltf --camera 5.784,1.5,-.818:1.799,.9,-.116:75 -o turned && offers turned | judge judge turned
> as expected
$ retex-import -q diorama.gltf -o diorama && offers diorama | judge judge diorama
> as expected
# A partition that has the walls behind it is none. A material that the ceiling has too is not that of all walls.
$ retex-import -f --targets divided.gltf --camera 2.4,1.5,-3.9:2.4,1,-1:75 -o divided 2>/dev/null | cut -f1
> Floor
> Wall
$ offers divided | judge judge divided
> as expected
$ retex-import -f --targets divided.gltf --camera .4,1.5,-3.7:4.5,.3,-1:75 -o x 2>/dev/null | cut -f1
> Floor
> Wall
# A new floor lies along the walls, also where the room is turned.
$ retex-import -qf boards.gltf --exposure 0 --camera 4.6,1.5,-3.6:1.5,.9,-1:75 -o boards
$ retex-import -qf turned.gltf --exposure 0 --camera 5.784,1.5,-.818:1.799,.9,-.116:75 -o turned
$ cp "$SCENES/textures/fans.jpg" .
$ for m in boards turned; do
+     retex-render -q --spp 16 --size 64x48 --aov albedo --replace:width=1m Floor=fans.jpg $m/$m.pov -o $m.exr
+     oiiotool $m.exr --subimage 1 -o $m-albedo.exr
+ done
$ retex-diff -q --fail-psnr 32 boards-albedo.exr turned-albedo.exr

# They are told, and printed where one asks for that. All walls of one material are a target besides.
$ retex-import -f --targets boards.gltf --camera 4.6,1.5,-3.6:1.5,.9,-1:75 -o x 2>told | sed 's/@[^/]*/@P/g'
> Floor	@P/level	22.0 %
> Wall	@P/level	26.9 %
> Walls	Mat:uv=box	48.0 %
$ grep ready told
> retex-import: targets that are ready: Floor, Wall, Walls; -t of retex-render takes them by name
$ sed -n '/ready/,/#end/p' x/x.pov | sed 's/@[^/]*/@P/g'
> // ---- surfaces that are ready: retex-render -t Floor -t Wall ----
>
> #ifdef (Retex) global_settings { retex_targets {
>   "Floor" "@P/level" // 22 % of the view
>   "Wall" "@P/level" // 27 % of the view
>   "Walls" "Mat:uv=box" // 48 % of the view
> } } #end
# The bed of tiles is seen between them, and is of the floor.
$ retex-import -qf --targets tiles.gltf --camera .5,1.5,-3.7:4,.9,-1:75 -o x | grep Floor | sed 's/@[^/]*/@P/g'
> Floor	@P/level,@P/level	21.6 %
# Of furniture, of a house with a lawn and of trees there is none.
$ for m in furniture exterior park; do retex-import -f --targets $m.gltf -o x 2>&1 | grep 'ready\|level'; grep -c retex_targets x/x.pov; done
> 0
> 0
> 0
= 1

# Seen by a camera of the model, they have the share that the renderer finds.
$ /usr/bin/python3 -c 'import json
+ m = json.load(open("boards.gltf"))
+ m["nodes"].append({"camera": 0, "translation": [2.4, 1.5, 3.5], "rotation": [-.1, 0, 0, .995]})
+ m["scenes"][0]["nodes"].append(len(m["nodes"]) - 1)
+ m["cameras"] = [{"type": "perspective", "perspective": {"yfov": .8, "aspectRatio": 1.3333, "znear": .1}}]
+ json.dump(m, open("own.gltf", "w"))'
$ retex-import -f --exposure 0 -q --targets own.gltf -o own | awk '/^Floor/ { print $(NF - 1) }' >shares
$ retex-render --list-targets own/own.pov | awk '$2 == "Floor" { print $1 + 0 }' >>shares
$ awk '{ s[NR] = $1 } END { print NR, (s[1] > 5 && s[1] - s[2] < 2 && s[2] - s[1] < 2 ? "alike" : s[1] " " s[2]) }' shares
> 2 alike
