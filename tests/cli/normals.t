# Normal maps: a target is rendered with its normal tilted, and a texture says where it points.
$ cp "$TESTS/finishes.pov" room.pov
$ cp "$SCENES/textures/brick.jpg" .
$ python3 "$TESTS/normal_maps.py"
$ printf 'exec retex-render -q --size 48x36 --spp 32 -t Wall -t Floor room.pov "$@"' >r
$ printf 'exec sh r --finish Wall=normals "$@"' >n
$ sh n --full-precision -o full.exr
$ sh n -o set.exr
$ retex-info set.exr | grep normals
>   normals      of original, by 15 degrees: it takes normal maps
$ printf 'retex-diff "$1" "$2" --fail-psnr "$3" -q || echo "$1 $2 $3"' >near
$ printf 'exec retex-combine -q "$@"' >c
$ printf 'm=$1; shift; exec sh c full.exr --texture:normal=$m Wall="$@"' >m

# A flat map is none, also for a colour; 8 bits have no 0, and 127 and 128 both stand for it.
$ sh c full.exr --texture Wall=color.ppm -o none.exr
$ for f in flat other; do
+     sh m $f.ppm color.ppm -o a.exr
+     sh near a.exr none.exr 80
+ done
$ sh m flat.ppm tan -o a.exr
$ sh c full.exr --texture Wall=tan -o b.exr
$ sh near a.exr b.exr 80
$ sh m waves10.ppm color.ppm -o waves.exr
$ sh near waves.exr none.exr 42
$ sh m none color.ppm -o a.exr; cmp a.exr none.exr

# Vectors turn with the texture: by placement, as if the map had been turned beforehand.
$ sh m waves10.ppm:rotate=90 color.ppm -o a.exr
$ sh m turned.ppm turned_color.ppm -o b.exr
$ sh near a.exr b.exr 60
$ sh near a.exr waves.exr 36
> a.exr waves.exr 36
$ sh m turned.ppm:rotate=-90 turned_color.ppm -o a.exr
$ sh near a.exr waves.exr 60
$ for p in flip=u scale=-1,1; do
+     sh m waves10.ppm:$p color.ppm -o a.exr
+     sh m flipped.ppm flipped_color.ppm -o b.exr
+     sh near a.exr b.exr 60
+ done
$ sh m waves10.ppm:rotate=180 color.ppm -o a.exr
$ sh m waves10.ppm:flip=uv color.ppm -o b.exr
$ sh near a.exr b.exr 60
$ sh m waves10.ppm:repeat=mirror color.ppm -o a.exr
$ sh m waves10.ppm:wrap=mirror color.ppm -o b.exr
$ cmp a.exr b.exr
$ sh near a.exr waves.exr 36
> a.exr waves.exr 36

# Green points up, or down where the name or the option says so.
$ for m in waves_nor_dx.ppm plain_down.ppm,dx; do
+     sh m $m color.ppm -o a.exr
+     sh near a.exr waves.exr 80
+ done
$ sh m waves_nor_dx.ppm,gl color.ppm -o a.exr
$ sh m plain_down.ppm color.ppm -o b.exr
$ cmp a.exr b.exr
$ sh near a.exr waves.exr 42
> a.exr waves.exr 42

# As the same paths give it with the map; none is much farther.
$ printf 'exec sh n --spp 128 --plain "$@"' >p
$ sh n --spp 128 -o long.exr
$ for m in waves10 waves30; do
+     sh p --replace:normal=$m.ppm Wall=color.ppm -o own-$m.exr
+     sh c long.exr --texture:normal=$m.ppm Wall=color.ppm -o $m.exr
+ done
$ sh near own-waves10.exr waves10.exr 47
$ sh near own-waves30.exr waves30.exr 40
$ sh c long.exr --texture Wall=color.ppm -o n.exr
$ sh near own-waves10.exr n.exr 47
> own-waves10.exr n.exr 47
$ sh near own-waves30.exr n.exr 40
> own-waves30.exr n.exr 40
$ sh m steep.ppm:scale=.2 tan -o steep.exr
$ oiiotool --stats steep.exr | awk '/Min:/ { print ($3 >= 0 ? "never below 0" : $0) }'
> never below 0

# The error map knows how much the normals in a footprint differ; ridges finer than a pixel are flat on average. Later hits alone give .018.
$ for m in flat ridges; do
+     sh m $m.ppm:scale=.2 tan -o a.exr --error e-$m.exr
+     oiiotool --stats e-$m.exr | awk -v m=$m '/Avg:/ { print m, ($3 > .028 ? "off" : $3 < .001 ? "right" : $0) }'
+ done
> flat right
> ridges off
$ cat >t.csv <<'END'
+ output,Wall
+ v1.exr,:normal=waves10.ppm color.ppm
+ v2.exr,color.ppm
+ v3.exr,:normal=turned.ppm:scale=2 tan
+ END
$ sh n --spp 8 --plain --variants t.csv
$ sh n --spp 8 --plain --replace:normal=waves10.ppm Wall=color.ppm -o w1.exr
$ sh n --spp 8 --plain --replace Wall=color.ppm -o w2.exr
$ sh n --spp 8 --plain --replace:normal=turned.ppm:scale=2 Wall=tan -o w3.exr
$ for k in 1 2 3; do cmp v$k.exr w$k.exr; done
$ sh near v1.exr v2.exr 42

# Diffuse light alone follows them: what a mirror reflects does not, and its weights stay 1.
$ printf 'exec sh r --finish Floor=Gloss,normals "$@"' >g
$ sh g --full-precision -o gloss.exr
$ sh c gloss.exr --texture:normal=waves30.ppm Floor=black -o a.exr
$ sh c gloss.exr --texture Floor=black -o b.exr
$ sh near a.exr b.exr 100

# In one pass, from samples, from a stream, in tables, texts and packs, of frames.
$ V='--texture:normal=waves10.ppm:scale=2 Wall=color.ppm'
+ sh c set.exr $V -o one.exr
+ retex-sample -q set.exr $V | sh c - -o two.exr
+ cmp one.exr two.exr
+ retex-sample -q set.exr $V -o s.exr
+ sh c set.exr s.exr -o two.exr
+ cmp one.exr two.exr
+ retex-pack -q set.exr --lossless -o set.retex
+ sh c set.retex $V -o two.exr
$ cmp one.exr two.exr
$ cat >t.csv <<'END'
+ output,Wall
+ three.exr,:normal=waves10.ppm:scale=2 color.ppm
+ four.exr,:normal=waves10.ppm:scale=2:rotate=90 color.ppm
+ END
$ sh c set.exr --batch t.csv
$ cmp one.exr three.exr
$ sh m waves10.ppm:scale=2:rotate=90 color.ppm -o a.exr
$ sh near a.exr four.exr 49
$ cp waves10.ppm w.0007.ppm
$ sh c set.exr --frames 7 --texture:normal=w.%04d.ppm:scale=2 Wall=color.ppm -o f.%04d.exr
$ cmp one.exr f.0007.exr
$ retex-pack -q full.exr --quality 95 -o full.retex
$ sh c full.retex --texture:normal=waves10.ppm Wall=color.ppm -o a.exr
$ sh near a.exr waves.exr 38
$ oiiotool --pattern constant:color=0,0,0,0 8x8 4 -d uint8 -o clear.png
$ sh m waves30.ppm clear.png -o a.exr
$ sh c full.exr --texture Wall=clear.png -o b.exr
$ sh near a.exr b.exr 80

# A folder's normal map, the one whose green points up first; where nothing takes it, it is told.
$ mkdir wall
$ cp brick.jpg wall/wall_diff_1k.jpg
$ cp brick.jpg wall/wall_rough_1k.jpg
$ oiiotool waves10.ppm -o wall/wall_nor_gl_1k.png
$ oiiotool waves_nor_dx.ppm -o wall/wall_nor_dx_1k.png
$ sh m waves10.ppm brick.jpg -o b.exr
$ sh c full.exr --texture Wall=wall -o a.exr
! retex-combine: warning: wall: the roughness map is not used
$ cmp a.exr b.exr
$ rm wall/wall_nor_gl_1k.png
$ sh c full.exr --texture Wall=wall -o a.exr
! retex-combine: warning: wall: the roughness map is not used
$ sh near a.exr b.exr 80
$ sh c full.exr --texture:normal=none Wall=wall -o a.exr
! retex-combine: warning: wall: roughness and normal maps are not used
$ sh c full.exr --texture Wall=brick.jpg -o b.exr
$ cmp a.exr b.exr
$ sh c full.exr --texture Floor=wall -o a.exr
! retex-combine: warning: wall: roughness and normal maps are not used

# What is refused.
$ sh r --finish Wall=matt,satin,normals -o x.exr
! retex-render: error: --finish: Wall has normals of one finish only, as in Wall=matt,normals
= 2
$ sh r --finish Wall=normals,matt -o x.exr
! retex-render: error: --finish: Wall has normals of one finish only, as in Wall=matt,normals
= 2
$ sh n --show Wall=normal-u -o x.exr
! retex-render: error: --show `Wall=normal-u`: --finish gives Wall no finish of that name
= 2
$ sh c set.exr --finish Wall=normal-u -o x.exr
! retex-combine: error: Wall has one finish, with normals: there is none to choose
= 2
$ sh c set.exr --texture:normal=waves10.ppm Floor=brick.jpg -o x.exr
! retex-combine: error: Floor takes no normal maps: normal= cannot be used on it; render the set with --finish Floor=normals
= 2
$ sh c set.exr --texture:finish=waves10.ppm Wall=brick.jpg -o x.exr
! retex-combine: error: Wall has no finishes to choose from: finish= cannot be used on it; render the set with --finish Wall=NAME,NAME
= 2
$ sh c set.exr --texture:finish=a.png:normal=b.png Wall=brick.jpg -o x.exr
! retex-combine: error: texture options: finish= and normal= exclude each other
= 2
$ sh c set.exr --texture:normal=gone.png Wall=brick.jpg -o x.exr
! retex-combine: error: cannot read gone.png: No such file or directory
= 2
$ sh c set.exr --texture:normal=,dx Wall=brick.jpg -o x.exr
! retex-combine: error: texture option normal=',dx': expected a picture without a colon in its name, as in normal=bricks_nor_gl.png or normal=bricks.png,dx, or none
= 2
$ sh r --replace:normal=flat.ppm Wall=tan -o x.exr
! retex-render: error: Wall takes no normal maps: normal= cannot be used on it
= 2
$ sh n --replace:finish=flat.ppm Wall=tan -o x.exr
! retex-render: error: Wall has no finishes to choose from: finish= cannot be used on it
= 2
$ retex-combine -q set.exr --solve full.exr --free finish:Wall
! retex-combine: error: the set has no finishes of 'Wall' to choose from
= 2
$ test -e x.exr
= 1
