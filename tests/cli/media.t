# Fog, media, dispersion and subsurface scattering with the options of retex-render.
$ cp "$TESTS/media.pov" room.pov
$ echo 'exec retex-render -q --size 24x18 --spp 8 -t Floor -t Wall "$@" room.pov' >render
$ chmod +x render
$ ./render --threads 1 -o set.exr
$ ./render --threads 2 -o again.exr
$ cmp set.exr again.exr
$ ls
> again.exr
> render
> room.pov
> set.exr

# In both layouts a set is the plain picture.
$ for l in footprints paper; do
+     ./render --layout $l --full-precision -o $l.exr
+     retex-combine -q $l.exr -o $l-again.exr
+     ./render --plain -o plain.exr
+     retex-diff --fail-abs 0 $l-again.exr plain.exr
+ done
> psnr 120.00 relmse 0 mae 0 flip 0 (p99 0) max 0 rel 0 at 0,0 B
> psnr 120.00 relmse 0 mae 0 flip 0 (p99 0) max 0 rel 0 at 0,0 B

# A render that was killed, at one thread and at two.
$ for k in 1 2 3 5; do timeout --foreground -s KILL 0.$k ./render --resume -o resumed.exr || true; done 2>/dev/null
$ ./render --resume --threads 1 -o resumed.exr
$ cmp resumed.exr set.exr

# Rows of a table, a cut-out, frames.
$ cat >table.csv <<'END'
+ output,Floor,Wall
+ a.exr,"rgb(.1,.6,.3)","rgb(.8,.3,.3)"
+ b.exr,,"rgb(.2,.3,.3)"
+ END
$ ./render --variants table.csv
$ ./render --replace 'Floor=rgb(.1,.6,.3)' --replace 'Wall=rgb(.8,.3,.3)' -o a2.exr
$ ./render --replace 'Wall=rgb(.2,.3,.3)' -o b2.exr
$ cmp a.exr a2.exr
$ cmp b.exr b2.exr
$ ./render --plain --crop 5,4,9,8 -o crop.exr
$ [ "$(make_values crop.exr 0,0 8,7)" = "$(make_values plain.exr 5,4 13,11)" ] || echo other pixels
$ ./render --plain --frames 1-2 -o f%d.exr
$ ./render --plain --seed 2 -o seed2.exr
$ cmp f2.exr seed2.exr

# Without media paths are traced side by side, and with them one after the other: they are the same.
$ for o in --plain '--clusters 4'; do
+     ./render $o -D Fog=1 -o fog.exr
+     ./render $o -D Fog=1 -D Far=1 -o far.exr
+     retex-diff -q --fail-abs 0 fog.exr far.exr || echo differs
+ done

# Air is no surface: AOVs are as without it, but for the light that arrives.
$ for d in '' '-D Clear=1'; do
+     ./render --plain $d --aov depth,albedo,normal,position,uv,object,roughness,metallic,irradiance --aov-dir "aov$d" \
+         -o plain.exr
+ done
$ for f in aov/*.exr; do cmp -s "$f" "aov-D Clear=1/${f#*/}" || basename "$f"; done
> beauty.exr
> irradiance.exr

# Fewer samples where there is less noise, denoising, and a set as a control variate: nearer to many samples.
% psnr() { retex-diff --json "$1" truth.exr | sed 's/.*"psnr": *\([0-9]*\).*/\1/'; }
$ ./render --spp 1024 --seed 5 --replace 'Floor=rgb(.1,.6,.3)' -o truth.exr
$ ./render --seed 3 --replace 'Floor=rgb(.1,.6,.3)' -o few.exr
$ ./render --seed 3 --replace 'Floor=rgb(.1,.6,.3)' --denoise -o denoised.exr
$ ./render --spp 32 -o set32.exr
$ ./render --seed 3 --control set32.exr --replace 'Floor=rgb(.1,.6,.3)' -o control.exr
$ ./render --seed 3 --spp 512 --noise .1 --replace 'Floor=rgb(.1,.6,.3)' -o noise.exr
$ for p in denoised control noise; do
+     [ $(psnr $p.exr) -gt $(psnr few.exr) ] || echo "$p $(psnr $p.exr), few $(psnr few.exr)"
+ done

# One path, with what is between surfaces.
$ for s in 0 1 2 3; do
+     ./render --trace-pixel 12,9,$s
+     ./render --trace-pixel 18,9,$s
+ done | grep -o '^media let\|^scattered at\|^fog lets\|random numbers below' | sort -u
> fog lets
> media let
> random numbers below
> scattered at
