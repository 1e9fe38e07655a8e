# Tiles of a colour, whose joints are as sharp as those between pictures, against tiles in numpy: several widths of tiles
# and joints, some of them much wider than the pixels, from above and at a slant.
% judge() { /usr/bin/python3 "$TESTS/grout.py" "$@"; }
$ cat >even.pov <<'END'
+ #version 3.7;
+ global_settings { assumed_gamma 1 radiosity {} }
+ background { rgb 1 }
+ #if (Low) camera { location <.1,.35,-1> look_at <.1,.1,.3> angle 60 right x*16/9 up y }
+ #else camera { location <.1,1.5,.3> look_at <.1,0,.3001> angle 60 right x*16/9 up y } #end
+ #declare Floor = texture { uv_mapping pigment { rgb .5 } finish { ambient 0 diffuse 1 } }
+ mesh2 { vertex_vectors { 4, <-3,0,-3>, <3,0,-3>, <3,0,3>, <-3,0,3> } uv_vectors { 4, <0,0>, <1,0>, <1,1>, <0,1> }
+     face_indices { 2, <0,1,2>, <0,2,3> } texture { Floor } }
+ END
$ for low in 0 1; do retex-render -q --size 240x135 --spp 64 -D Low=$low -t Floor even.pov -o set$low.exr; done
$ oiiotool -q --pattern constant:color=.6,.3,.1 400x400 3 -d float -o tile.exr
$ while read size grout repeat; do
+     for camera in above low; do
+         set=set0.exr; [ $camera = above ] || set=set1.exr
+         for of in 'color rgb(.6,.3,.1)' 'picture tile.exr'; do
+             retex-combine -q $set --texture:width=$size:grout=$grout:repeat=$repeat:groutcolor='rgb(.05,.05,.05)' \
+                 Floor="${of#* }" -o ${of%% *}.exr
+         done
+         judge $camera $size $grout $repeat 45 color.exr picture.exr
+     done
+ done <<'END'
+ .3,.3 .02 straight
+ .6,.3 .05 brick
+ .6,.3 .005 brick
+ 1,1 .1 straight
+ 2,1 .3 straight
+ END

# Memory stays small, whatever is laid; what varies is alike in a colour.
$ for o in repeat=herringbone repeat=basket repeat=hexagon repeat=brick:vary=turn,flip,shift,3; do
+     /usr/bin/python3 -c 'import resource, subprocess, sys
+ subprocess.run(sys.argv[1:], check=True)
+ most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss >> 10
+ if most > 300: print(sys.argv[4], most, "MB")' retex-combine -q set0.exr --texture:width=.6,.3:grout=.05:$o Floor=tan -o x.exr
+ done
