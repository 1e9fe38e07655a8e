# retex-pack: sizes, round trips, what is refused, and that no partial file stays.
$ make_set s.exr 64 48
$ retex-pack s.exr -o s.retex -q
$ retex-info --check s.retex >info
$ retex-pack s.exr -o s.retex 2>&1 | sed 's/[0-9.]\{3,\}/N/g'
> retex-pack: set s.exr: N bytes
> retex-pack: pack s.retex: N bytes (ratio N)
$ test $(stat -c %s s.retex) -lt $(($(stat -c %s s.exr) / 3)) && echo small
> small
$ unzip -v s.retex 2>/dev/null | head -0
$ head -c 4 s.retex | od -An -tx1
>  50 4b 03 04

# Lossless: the set that comes back is the same file.
$ retex-pack -q --lossless s.exr -o l.retex
$ retex-pack -q --unpack l.retex -o back.exr
$ cmp s.exr back.exr
$ test $(stat -c %s l.retex) -lt $(stat -c %s s.exr) && echo smaller
> smaller
$ retex-pack -q --unpack s.retex -o lossy.exr
$ retex-diff -q --all-parts --allow-inf lossy.exr s.exr
= 1
$ retex-diff -q lossy.exr s.exr --fail-psnr 40
$ retex-diff -q --part t0_spread1 lossy.exr s.exr --fail-rel 0.05
$ retex-diff -q --part depth --allow-inf lossy.exr s.exr
$ retex-pack -q --unpack s.retex -o again.exr
$ cmp lossy.exr again.exr

# A pack is a zip that other programs open, and its pictures are JPEGs.
$ python3 - <<'END'
+ import zipfile
+ z = zipfile.ZipFile("s.retex")
+ print(z.testzip(), *z.namelist()[:3])
+ open("p.jpg", "wb").write(z.read("picture.jpg"))
+ END
> None manifest.json index picture.jpg
$ retex-diff -q p.jpg s.exr --fail-psnr 38

# Pipes: in, out, and both.
$ retex-pack -q s.exr -o - >piped.retex
$ cmp s.retex piped.retex
$ retex-pack -q - <s.exr >piped.retex
$ cmp s.retex piped.retex
$ retex-pack -q --unpack - <l.retex | retex-pack -q --lossless - | cmp - l.retex

# Options.
$ retex-pack
! retex-pack: error: no set given; try --help
= 2
$ retex-pack s.exr t.exr -o x.retex
! retex-pack: error: one input is enough; what is 't.exr'?
= 2
$ retex-pack s.exr -o x.retex --codec jxl
! retex-pack: error: --codec: there is no codec 'jxl'; this version has: jpeg
= 2
$ retex-pack -q s.exr -o x.retex --codec jpeg
$ cmp x.retex s.retex
$ rm x.retex
$ retex-pack s.exr -o x.retex --quality 0
! retex-pack: error: --quality: expected a whole number from 1 to 100, not '0'
= 2
$ retex-pack s.exr -o x.retex --quality 50 --lossless
! retex-pack: error: --quality and --lossless exclude each other
= 2
$ retex-pack --unpack s.retex -o x.exr --lossless
! retex-pack: error: --unpack takes neither --quality nor --lossless
= 2
$ retex-pack -q s.exr --quality 50 -o q50.retex
$ test $(stat -c %s q50.retex) -lt $(stat -c %s s.retex) && echo smaller
> smaller

# What was lost, measured: all keys, sizes by use that add up to the file, and more decibels at more quality.
$ retex-pack -q s.exr -o st.retex --stats st.json
$ retex-pack -q s.exr -o st.retex --quality 50 --stats - >st50.json
$ test $(grep -o '"set_bytes": [0-9]*' st.json | cut -d' ' -f2) = $(stat -c %s s.exr) && echo the size of the set
> the size of the set
$ python3 - <<'END'
+ import json
+ a, b = json.load(open("st.json")), json.load(open("st50.json"))
+ print(*a)
+ print(*a["bytes"])
+ print(sum(b["bytes"].values()) == b["pack_bytes"], [a["psnr"][k] > b["psnr"][k] > 30 for k in a["psnr"]])
+ END
> codec quality set_bytes pack_bytes bytes psnr promised measured
> picture radiance gains uv spread weights albedo originals other
> True [True, True, True, True]
# Of a rendered set too, where compacting takes noise away: more quality is less loss in each picture, and little in
# the end.
$ ln -s "$SCENES" scenes
$ retex-render -q --size 96x72 --spp 32 -t Floor scenes/glass-caustics/glass-caustics.pov -o g.exr
$ rm scenes
$ for q in 70 90 95 100; do retex-pack -q g.exr -o g.retex --quality $q --stats g$q.json; done
$ python3 - <<'END'
+ import json
+ p = [json.load(open(f"g{q}.json"))["psnr"] for q in (70, 90, 95, 100)]
+ print([all(a[k] < b[k] for k in a) for a, b in zip(p, p[1:])], min(p[2].values()) > 40, min(p[3].values()) > 50)
+ END
> [True, True, True] True True
# No quality loses more than it promises, nor much more with textures that packing does not try.
$ ln -s "$SCENES" scenes
$ retex-render -q --size 64x48 --spp 32 -t Floor -t Wall scenes/living-room/living-room.pov -o r.exr
$ retex-denoise -q r.exr -o rd.exr
$ retex-denoise -q g.exr -o gd.exr
% # Two decibels less than a report promises: textures that packing does not try lose as little.
% promised() { python3 -c "import json; print(json.load(open('$1'))['promised'] - 2)"; }
$ for t in brick terrazzo; do oiiotool scenes/textures/$t.jpg --resize 256x256 -o $t.png; done
$ for s in r rd g gd; do
+     for t in brick terrazzo; do
+         retex-combine -q $s.exr --texture Floor=$t.png -o $t.exr
+     done
+     for q in 30 90 100; do
+         retex-pack -q $s.exr -o p.retex --quality $q --stats $s$q.json
+         for t in brick terrazzo; do
+             retex-combine -q p.retex --texture Floor=$t.png -o b.exr
+             retex-diff -q $t.exr b.exr --fail-psnr $(promised $s$q.json) || echo $s $q $t
+         done
+     done
+ done
$ rm scenes
$ python3 - <<'END'
+ import json
+ p = {s: [json.load(open(f"{s}{q}.json")) for q in (30, 90, 100)] for s in ("r", "rd", "g", "gd")}
+ print([j["promised"] for j in p["rd"]], p["r"][1]["promised"] < 34)
+ def measured(j):
+     return j["promised"] <= j["measured"] == min(j["psnr"][k] for k in ("original", "white", "squares"))
+ print([[measured(j) for j in p[s]] for s in p])
+ END
> [28.0, 34.0, 50.0] True
> [[True, True, True], [True, True, True], [True, True, True], [True, True, True]]
# Lossless packs of rendered and of denoised sets, too.
$ for s in g gd; do
+     retex-pack -q --lossless $s.exr -o l.retex
+     retex-info --check l.retex >/dev/null
+     echo $?
+     retex-pack -q --unpack l.retex -o back.exr
+     cmp $s.exr back.exr
+ done
> 0
> 0
$ retex-pack -q --unpack - <l.retex | retex-pack -q --lossless - | cmp - l.retex
$ retex-combine -q gd.exr -o o.exr
$ retex-combine -q l.retex -o p.exr
$ cmp o.exr p.exr
$ retex-pack -q --lossless s.exr -o st.retex --stats - | grep -o '"psnr.*'
> "psnr": {"original": 120.00, "white": 120.00, "waves": 120.00, "squares": 120.00}
$ retex-info s.retex | grep -A1 'in the pack' | sed 's/[0-9]\+$/N/;s/ \+/ /g'
> bytes in the pack
>  picture N
$ retex-pack -q s.exr -o - --stats st.json
! retex-pack: error: --stats reads the pack again: it must be a file, -o FILE.retex
= 2
$ retex-pack -q s.exr -o y.retex --stats nowhere/st.json
! retex-pack: error: --stats: cannot write nowhere/st.json: No such file or directory
= 2
$ ls y.retex
! ls: cannot access 'y.retex': No such file or directory
= 2

# Input that is no set.
$ retex-pack none.exr -o x.retex
! retex-pack: error: cannot read none.exr: No such file or directory
= 2
$ make_picture p.exr
$ retex-pack p.exr -o x.retex 2>err
= 2
$ grep -c 'retex-pack: error: .*p.exr' err
> 1
$ head -c 20000 s.exr >cut.exr
$ retex-pack cut.exr -o x.retex 2>err
= 2
$ grep -c 'retex-pack: error: .*cut.exr' err
> 1

# Packs that are damaged: a flipped byte in the data, a truncated file, something behind the end. The message names the
# file, and nothing is written.
$ cp s.retex flip.retex
$ printf 'X' | dd of=flip.retex bs=1 seek=40000 conv=notrunc 2>/dev/null
$ retex-pack --unpack flip.retex -o x.exr 2>err
= 2
$ grep -c 'retex-pack: error: .*flip.retex.*damaged' err
> 1
$ head -c 30000 s.retex >cut.retex
$ retex-pack --unpack cut.retex -o x.exr 2>err
= 2
$ grep -c 'retex-pack: error: .*cut.retex.*damaged' err
> 1
$ retex-info --check flip.retex >/dev/null 2>&1
= 1
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# A full disk, a closed pipe, a folder that is not there; an old file stays whole.
$ retex-pack -q s.exr -o /dev/full
! retex-pack: error: cannot write /dev/full: No space left on device
= 2
$ retex-pack -q s.exr >/dev/full
! retex-pack: error: cannot write standard output: No space left on device
= 2
$ { sleep 0.3; retex-pack -q s.exr; echo $? >&2; } | :
! 141
$ retex-pack -q s.exr -o nowhere/x.retex
! retex-pack: error: cannot write nowhere/x.retex: No such file or directory
= 2
$ echo old >old.exr
$ retex-pack -q --unpack flip.retex -o old.exr 2>/dev/null
= 2
$ cat old.exr
> old
$ ls -A | grep -v '^[a-z0-9]*\.[a-z]*$'
> err
> info

# A name that promises the other format.
$ retex-pack -q s.exr -o t.exr
! retex-pack: error: t.exr: a pack is no OpenEXR file; its name ends in .retex
= 2
$ retex-pack -q --unpack s.retex -o t.retex
! retex-pack: error: t.retex: --unpack writes an OpenEXR file, .exr
= 2
