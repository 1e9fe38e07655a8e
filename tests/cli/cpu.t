# The vector instructions of a processor change no bit: all that is made with those of every x86-64, and of processors
# with AVX2, is what this machine makes with the widest that it has. RETEX_CPU names them.
$ ln -s "$TESTS/../golden/room.pov" .
$ cp "$TESTS/finishes.pov" .
$ retex-render -q --size 75x20 --spp 16 --lamps each -t Floor -t Left -DGlass=1 -DLamps=1 room.pov -o set.exr
$ retex-render -q --size 44x20 --spp 4 --finish Floor=matt,satin --finish Wall=normals -t Floor -t Wall finishes.pov \
+     -o finishes.exr
$ retex-render -q --size 44x20 --spp 4 -t Floor finishes.pov -o plain.exr
$ retex-render -q --size 44x20 --spp 4 --layout paper -t Floor finishes.pov -o paper.exr
$ cat >make <<'END'
+ set -e
+ export RETEX_CPU=$1
+ mkdir $1
+ T=$SCENES/textures
+ retex-render -q --size 75x20 --spp 4 --lamps each --denoise -t Floor -t Left -DGlass=1 -DLamps=1 room.pov -o $1/r.exr
+ retex-render -q --size 40x30 --spp 4 --plain --aov irradiance room.pov -o $1/plain.exr
+ retex-denoise -q set.exr -o $1/denoised.exr
+ retex-denoise -q --quality preview set.exr -o $1/preview.exr
+ retex-denoise -q paper.exr -o $1/paper.exr
+ retex-denoise -q finishes.exr -o $1/finishes.exr
+ for s in set finishes paper; do
+     retex-pack -q --lossless $s.exr -o $1/$s-lossless.retex
+     retex-pack -q --unpack $1/$s-lossless.retex -o $1/$s-again.exr
+     retex-combine -q $s.exr --texture:rotate=20:scale=2 Floor=$T/brick.jpg -o $1/$s.exr
+     retex-sample -q $s.exr --texture:scale=.3 Floor=$T/fans.jpg -o $1/$s-samples.exr
+ done
+ retex-combine -q set.exr --texture:width=.5:grout=.02:hue=40 Floor=$SCENES/living-room/textures/linen.jpg --exposure .5 \
+     --white-balance 4000 -o $1/laid.png
+ retex-combine -q set.exr --light light1=.5 --texture Left=red -o $1/light.jpg
+ retex-combine -q finishes.exr --texture:finish=$T/fans.jpg Floor=$T/brick.jpg \
+     --texture:normal=$T/fans.jpg Wall=$T/damask.jpg -o $1/maps.exr
+ retex-combine -q set.exr --size 30x --texture Floor=$T/terrazzo.jpg -o $1/small.tif
+ retex-pack -q plain.exr --web $1/web
+ retex-pack -q plain.exr -o $1/plain.retex
+ retex-combine -q $1/plain.retex --texture Floor=$T/damask.jpg -o $1/pack.exr
+ retex-diff set.exr $1/r.exr >$1/diff || true
+ END
$ for level in widest avx2 baseline; do sh make $level; done
$ ls widest | wc -l
> 24
$ diff -r widest avx2
$ diff -r widest baseline
