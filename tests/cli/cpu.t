# The vector instructions of a processor change no bit: all that is made with those of every x86-64, and of processors
# with AVX2, is what this machine makes with the widest that it has. RETEX_CPU names them.
$ skip-unless grep -qw avx2 /proc/cpuinfo
$ for t in brick fans damask; do oiiotool "$SCENES/textures/$t.jpg" --resize 256x256 -o $t.png; done
$ ln -s "$TESTS/../golden/room.pov" .
$ cp "$TESTS/finishes.pov" .
$ retex-render -q --size 75x20 --spp 16 --lamps each -t Floor -t Left -DGlass=1 -DLamps=1 room.pov -o set.exr
$ retex-render -q --size 44x20 --spp 4 --finish Floor=matt,satin --finish Wall=normals -t Floor -t Wall finishes.pov \
+     -o finishes.exr
$ retex-render -q --size 44x20 --spp 4 -t Floor finishes.pov -o plain.exr
$ retex-render -q --size 44x20 --spp 4 --layout paper -t Floor finishes.pov -o paper.exr
% # The files that a function writes into the folder `out` are the same for all levels; prints how many: same FUNCTION.
% made() { (set -e; mkdir out; export RETEX_CPU=$1; $2; find out -type f -exec sha256sum {} + | sort; rm -r out); }
% same() {
%     made widest $1 >sums
%     for level in avx2 baseline; do made $level $1 | cmp sums -; done
%     wc -l <sums
% }

# Renders and denoising.
% renders() {
%     retex-render -q --size 75x20 --spp 4 --lamps each --denoise -t Floor -t Left -DGlass=1 -DLamps=1 room.pov \
%         -o out/room.exr
%     retex-render -q --size 40x30 --spp 4 --plain --aov irradiance room.pov -o out/plain.exr
% }
$ same renders
> 2
% denoises() {
%     for s in set paper finishes; do retex-denoise -q $s.exr -o out/$s.exr; done
%     retex-denoise -q --quality preview set.exr -o out/preview.exr
% }
$ same denoises
> 4

# Packs and pages.
% packs() {
%     for s in set finishes paper; do
%         retex-pack -q --lossless $s.exr -o out/$s.retex
%         retex-pack -q --unpack out/$s.retex -o out/$s.exr
%     done
% }
$ same packs
> 6
% pages() {
%     retex-pack -q plain.exr --web out/web
%     retex-pack -q plain.exr -o out/plain.retex
%     retex-combine -q out/plain.retex --texture Floor=damask.png -o out/pack.exr
% }
$ same pages | sed 's/[0-9]\{2,\}/many/'
> many

# Retextures: turned, in samples, laid, adjusted, with other lamps, with maps, in another size.
% turned() {
%     for s in set finishes paper; do retex-combine -q $s.exr --texture:rotate=20:scale=2 Floor=brick.png -o out/$s.exr; done
% }
$ same turned
> 3
% sampled() {
%     for s in set finishes paper; do retex-sample -q $s.exr --texture:scale=.3 Floor=fans.png -o out/$s.exr; done
% }
$ same sampled
> 3
% edited() {
%     retex-combine -q set.exr --texture:width=.5:grout=.02:hue=40 Floor=damask.png --exposure .5 --white-balance 4000 \
%         -o out/laid.png
%     retex-combine -q set.exr --light light1=.5 --texture Left=red -o out/light.jpg
%     retex-combine -q finishes.exr --texture:finish=fans.png Floor=brick.png --texture:normal=fans.png Wall=damask.png \
%         -o out/maps.exr
%     retex-combine -q set.exr --size 30x --texture Floor=brick.png -o out/small.tif
% }
$ same edited
> 4

# What differs from what, by all of its measures.
% differs() { retex-diff --json finishes.exr plain.exr >out/measures || grep -q '"psnr": [0-9]' out/measures; }
$ same differs
> 1
