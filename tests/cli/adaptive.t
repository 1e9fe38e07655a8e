# retex-render --noise: tiles get the samples they need, the same for any number of threads.
$ ln -s "$SCENES" scenes
$ for t in 1 3; do
+     retex-render -q --size 96x64 --spp 256 --noise 0.06 --threads $t \
+         -t Floor scenes/glass-caustics/glass-caustics.pov -o $t.exr
+ done
$ cmp 1.exr 3.exr
$ retex-render -q --size 96x64 --spp 256 --noise 0.3 -t Floor scenes/glass-caustics/glass-caustics.pov -o rough.exr
$ for f in rough 1; do retex-info $f.exr | awk '/^samples/ { print $2 }'; done | tr '\n' ' ' |
+     awk '{ print ($1 >= 16), ($1 < $2), ($2 < 256) }'
> 1 1 1
# The most is --spp.
$ retex-render -q --size 96x64 --spp 24 --noise 0.001 -t Floor scenes/glass-caustics/glass-caustics.pov -o most.exr
$ retex-render -q --size 96x64 --spp 24 -t Floor scenes/glass-caustics/glass-caustics.pov -o all.exr
$ retex-info most.exr | awk '/^samples/ { print $2 }'
> 24
$ retex-diff most.exr all.exr >/dev/null
$ retex-render -q --size 96x64 --spp 24 --noise 0 scenes/glass-caustics/glass-caustics.pov 2>&1
> retex-render: error: --noise: expected a number from 1e-06 to 10, not '0'
= 2
$ retex-render -q --size 16x12 --noise 0.1 --control-data biased -t Floor scenes/glass-caustics/glass-caustics.pov \
+     -o c.exr 2>&1
> retex-render: error: --noise cannot be combined with --control, --control-data or --variants: these need equal samples per pixel
= 2
