# The share of light that --max-depth leaves out. Within a closed surface of albedo a that emits evenly all light has
# been reflected k times with a share of (1 - a) a^k, so that n segments leave out a^n.
% furnace() {
%     echo "#version 3.7; global_settings { assumed_gamma 1 } #default { finish { ambient 0 diffuse 1 } }
%           camera { location <0.5, 0.3, -1> direction z right 2 * x up 2 * y }
%           sphere { 0, 3 pigment { rgb 1 } finish { diffuse $1 emission 1 - $1 } }" >f.pov
%     shift
%     retex-render -q --size 48x48 --spp 64 f.pov "$@"
% }
% share() { retex-info --json $1 | sed -n 's/.*"depth_cut":\([^,]*\),.*/\1/p'; }
$ for a in .5 .9; do
+     for n in 1 2 4 8; do
+         furnace $a -t W=#1 --max-depth $n -o s.exr
+         echo "$(share s.exr) $a $n" | awk '{ r = $1 / $2 ^ $3; print $2, $3, (r > .9 && r < 1.1 ? "right" : r) }'
+     done
+ done
> .5 1 right
> .5 2 right
> .5 4 right
> .5 8 right
> .9 1 right
> .9 2 right
> .9 4 right
> .9 8 right

# The same for all threads, and through a pack; the picture is what it is without.
$ for t in 1 7; do furnace .9 -t W=#1 --max-depth 3 --threads $t -o s$t.exr; done
$ cmp s1.exr s7.exr
$ retex-pack -q s1.exr -o s.retex
$ test "$(share s.retex)" = "$(share s1.exr)"
$ retex-info s1.exr | sed -n '/^max/s/[0-9][.][0-9]*%/N%/p'
> max depth      3 segments, without 7N% of the light
$ furnace .9 --plain --max-depth 3 -o p.exr
$ retex-diff -q s1.exr p.exr
