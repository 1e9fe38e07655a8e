# retex-denoise: what it writes, pipes, what is refused, and that no partial file stays.
% without_time() { sed 's/[0-9]*\.[0-9]* s$/N s/'; }
% any_part() { sed 's/part [a-zA-Z_]*:/part NAME:/' "$@"; }
$ make_set s.exr 64 48 denoise
$ retex-denoise s.exr -o d.exr 2>&1 | without_time
> retex-denoise: d.exr: 64 x 48, N s
$ retex-info --check d.exr
> d.exr: ok
$ for f in s.exr d.exr; do retex-info $f | grep '^denoise'; done
> denoise data   yes
> denoised       yes
$ for f in s.exr d.exr; do retex-info --json $f | grep -o '"denoised":[a-z]*\|"denoise_data":[a-z]*'; done
> "denoise_data":true
> "denoised":false
> "denoise_data":false
> "denoised":true
$ retex-info --json s.exr | grep -c '"noise_indep"'
> 1
$ retex-info --json d.exr | grep -c '"noise_\|"guide_'
> 0
= 1
$ retex-denoise -q s.exr -o again.exr
$ cmp d.exr again.exr
$ retex-denoise -q --threads 1 s.exr -o one.exr
$ cmp d.exr one.exr
$ retex-denoise -v s.exr -o again.exr 2>&1 | sed 's/[0-9]*\.[0-9]* s/N s/g'
> retex-denoise: again.exr: 64 x 48, N s
> retex-denoise: read N s, denoised N s, written N s

# A set that does not stay in memory: the same bits, as EXR and as a pack, from a pack too, and no temporary file stays.
$ make_set l.exr 40 250 denoise
$ retex-denoise -q l.exr -o ld.exr
$ retex-denoise -q --memory 0 l.exr -o lm.exr
$ cmp ld.exr lm.exr
$ make_set l.exr 40 250 footprints denoise
$ retex-denoise -q l.exr -o ld.retex
$ retex-denoise -q --memory 0 l.exr -o lm.retex
$ cmp ld.retex lm.retex
$ retex-pack -q --lossless l.exr -o l.retex
$ retex-denoise -q --memory 0 l.retex -o lm.retex
$ cmp ld.retex lm.retex
$ ls -A
> again.exr
> d.exr
> l.exr
> l.retex
> ld.exr
> ld.retex
> lm.exr
> lm.retex
> one.exr
> s.exr
$ head -c 20000 l.exr >half.exr
$ retex-denoise -q --memory 0 half.exr -o x.exr 2>&1 | grep -c '^retex-denoise: error: .*half.exr'
> 1
$ rm half.exr l*
$ retex-denoise s.exr -o x.exr --memory -1
! retex-denoise: error: --memory: expected a size such as 512M, 2G or a number of MB, not '-1'
= 2

# It retextures like any other set, and its picture is its recombination.
$ retex-combine -q d.exr --texture 'floor=rgb(0.8,0.1,0.1)' -o red.exr
$ retex-diff -q d.exr red.exr
= 1
$ retex-combine -q d.exr -o same.exr
$ retex-diff -q same.exr d.exr --fail-rel 0.001

# The other layout.
$ make_set f.exr 32 24 footprints denoise
$ retex-denoise -q f.exr -o fd.exr
$ retex-info --check fd.exr
> fd.exr: ok
$ retex-denoise -q --no-footprints --full-precision f.exr -o kept.exr
$ retex-diff -q --part t0_uv1 kept.exr f.exr
$ retex-diff -q --part t1_uv3 kept.exr f.exr

# Options at both ends of what they may be.
$ for o in '--strength 0.1' '--strength 10' '--radius 1' '--radius 10' --no-footprints; do
+     retex-denoise -q s.exr $o -o x.exr && retex-info --check x.exr
+ done
> x.exr: ok
> x.exr: ok
> x.exr: ok
> x.exr: ok
> x.exr: ok
$ rm x.exr
# Each option changes what it says, and its default is what --help says.
$ for o in '--strength 0.5' '--strength 1' '--strength 2' '--radius 2' '--radius 5' '--radius 6'; do
+     retex-denoise -q s.exr $o -o x.exr
+     cmp -s d.exr x.exr && echo "$o is the default"
+ done
> --strength 1 is the default
> --radius 5 is the default
= 1
$ rm x.exr
# What is denoised is pooled, in all parts of the footprints; without footprints they stay.
$ for p in t1_uv1 t1_albedo1 t1_uv2 t1_spread2 t1_albedo2; do
+     retex-diff -q --part $p kept.exr f.exr || echo $p
+     retex-diff -q --part $p fd.exr f.exr && echo "$p is not pooled"
+ done
= 1
# Two qualities: final is the default, preview a smaller radius without footprints.
$ retex-denoise -q s.exr --quality final -o x.exr
$ cmp d.exr x.exr
$ retex-denoise -q s.exr --quality preview -o p.exr
$ cmp -s p.exr x.exr
= 1
$ retex-denoise -q s.exr --radius 2 --no-footprints --full-precision -o x.exr
$ retex-diff -q --part t1_uv1 p.exr x.exr
$ retex-denoise -q --memory 0 s.exr --quality preview -o x.exr
$ cmp p.exr x.exr
$ rm p.exr x.exr
$ retex-denoise s.exr -o x.exr --quality draft
! retex-denoise: error: --quality: expected preview or final, not 'draft'
= 2
$ retex-denoise --complete --quality '' | cut -f1
> preview
> final
$ retex-denoise s.exr -o x.exr --strength 0
! retex-denoise: error: --strength: expected a number from 0.1 to 10, not '0'
= 2
$ retex-denoise s.exr -o x.exr --strength nan
! retex-denoise: error: --strength: expected a number from 0.1 to 10, not 'nan'
= 2
$ retex-denoise s.exr -o x.exr --radius 11
! retex-denoise: error: --radius: expected a whole number from 1 to 10, not '11'
= 2
$ retex-denoise s.exr -o x.exr --radius 2.5
! retex-denoise: error: --radius: expected a whole number from 1 to 10, not '2.5'
= 2
$ retex-denoise s.exr -o x.exr --footprints
! retex-denoise: error: unknown option --footprints; is --no-footprints meant?
= 2
$ retex-denoise
! retex-denoise: error: no set given; - is standard input
= 2
$ retex-denoise s.exr t.exr -o x.exr
! retex-denoise: error: one set is enough; what is 't.exr'?
= 2
$ retex-denoise s.exr -o x.png
! retex-denoise: error: x.png: a set is an OpenEXR file, .exr, or a pack, .retex; pictures are made by retex-combine
= 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# The preview of a render is that of its set; --denoise alone is final.
$ cat >ball.pov <<'END'
+ camera { location -5*z }
+ light_source { <9,9,-9> rgb 1 area_light x, y, 4, 4 }
+ #declare Ball = texture { pigment { rgb 0.5 } }
+ sphere { 0, 1 texture { Ball } }
+ END
% ball() { retex-render -q --size 40x30 --spp 4 -t Ball ball.pov "$@"; }
$ ball -o n.exr
$ for q in preview final; do
+     ball --denoise=$q -o r.exr
+     retex-denoise -q --quality $q n.exr -o x.exr
+     cmp r.exr x.exr
+ done
$ ball --denoise -o x.exr
$ cmp r.exr x.exr
$ rm n.exr r.exr x.exr ball.pov
$ retex-render --denoise=draft absent.pov
! retex-render: error: --denoise: expected preview or final, not 'draft'
= 2

# Pipes: in, out, both; and between the other tools.
$ retex-denoise -q - <s.exr >piped.exr
$ retex-diff -q --all-parts --allow-inf piped.exr d.exr
$ retex-denoise s.exr 2>&1 >/dev/null | without_time
> retex-denoise: standard output: 64 x 48, N s
$ cat s.exr | retex-denoise -q - | retex-sample -q - --texture 'floor=rgb(0.8,0.1,0.1)' |
+     retex-combine -q - -o through.exr
$ cmp red.exr through.exr
$ ln -s "$SCENES" scenes
$ retex-render -q --size 16x12 --spp 2 -t floor scenes/cornell-box/cornell-box.pov | retex-denoise -q - |
+     retex-sample -q - --texture 'floor=rgb(1,0,0)' | retex-combine -q - -o x.png
$ ls x.png
> x.png
$ rm x.png

# The picture alone, without terms.
$ make_set plain.exr 32 24 plain denoise
$ retex-denoise -q plain.exr -o x.exr
$ retex-info x.exr | grep '^layout\|^denoise'
> layout         plain
> denoised       yes
$ retex-diff -q x.exr plain.exr --fail-abs 0
= 1
$ rm x.exr

# A pack: by the name, as retex-pack makes it; made before, it lacks what is needed.
$ retex-denoise -q s.exr -o d.retex
$ retex-pack -q d.exr -o packed.retex
$ cmp d.retex packed.retex
$ retex-info d.retex | grep '^denoise'
> denoised       yes
$ retex-pack -q s.exr -o s.retex
$ retex-info s.retex | grep '^denoise'
> denoise data   no
$ retex-info --json s.retex | grep -c '"noise_\|"guide_'
> 0
= 1
$ retex-denoise s.retex -o x.exr 2>err
= 2
$ any_part err
> retex-denoise: error: the set lacks the part NAME: it was rendered or packed without what denoising needs, or is denoised already
$ retex-pack -q --lossless s.exr -o l.retex
$ retex-pack -q --unpack l.retex -o unpacked.exr
$ retex-denoise -q unpacked.exr -o x.exr
$ cmp x.exr d.exr
$ rm x.exr

# Sets without what is needed: rendered or packed without it, denoised already, on their way to retex-combine.
$ retex-denoise d.exr -o x.exr 2>err
= 2
$ any_part err
> retex-denoise: error: the set lacks the part NAME: it was rendered or packed without what denoising needs, or is denoised already
$ make_set w.exr
$ retex-denoise w.exr -o x.exr 2>err
= 2
$ any_part err
> retex-denoise: error: the set lacks the part NAME: it was rendered or packed without what denoising needs, or is denoised already
$ retex-sample -q s.exr --texture 'floor=rgb(1,0,0)' | retex-denoise - -o x.exr 2>err
= 2
$ cat err
> retex-denoise: error: a texture is laid on Floor: a denoised set is made of the set without it

# Input that is no set, or damaged: one line, and nothing is written.
$ retex-denoise none.exr -o x.exr
! retex-denoise: error: cannot read none.exr: No such file or directory
= 2
$ retex-sample -q s.exr --texture 'floor=rgb(1,0,0)' -o samples.exr
$ retex-denoise samples.exr -o x.exr
! retex-denoise: error: samples.exr holds samples, no set
= 2
$ make_picture p.png
$ retex-denoise p.png -o x.exr
! retex-denoise: error: p.png is not a set: neither an OpenEXR file nor a pack
= 2
$ : >empty.exr
$ retex-denoise empty.exr -o x.exr
! retex-denoise: error: empty.exr is not a set: it is empty
= 2
$ head -c 50000 s.exr >cut.exr
$ retex-denoise cut.exr -o x.exr 2>err
= 2
$ wc -l <err
> 1
$ grep -c 'retex-denoise: error: cut.exr: part .* is damaged' err
> 1
$ head -c 50000 s.exr | retex-denoise - -o x.exr 2>err
= 2
$ wc -l <err
> 1
$ grep -c 'retex-denoise: error: standard input: part .* is damaged' err
> 1
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# Noise that is no number is none that a set has.
$ make_set nan.exr 32 24 denoise noise_indep=nan
$ retex-denoise -q nan.exr -o n.exr
! retex-denoise: error: nan.exr: part noise_indep holds NaN at 5,3 in channel B: such values are refused
= 2
$ make_set inf.exr 32 24 footprints denoise noise_indep=inf
$ retex-denoise -q inf.exr -o n.exr
! retex-denoise: error: inf.exr: part noise_indep holds infinity at 5,3 in channel B: such values are refused
= 2
$ ls n.exr
! ls: cannot access 'n.exr': No such file or directory
= 2

# A full disk, a closed pipe, a folder that is not there, seen before the work; an old file stays whole.
$ retex-denoise -q s.exr -o /dev/full
! retex-denoise: error: cannot write /dev/full: No space left on device
= 2
$ retex-denoise -q s.exr >/dev/full
! retex-denoise: error: cannot write standard output: No space left on device
= 2
$ { sleep 0.3; retex-denoise -q s.exr; echo $? >&2; } | :
! 141
$ retex-denoise -q none.exr -o nowhere/x.exr
! retex-denoise: error: cannot write nowhere/x.exr: No such file or directory
= 2
$ echo old >old.exr
$ retex-denoise -q cut.exr -o old.exr 2>/dev/null
= 2
$ cat old.exr
> old
$ ls -A | grep -v '^[a-z-]*\.[a-z]*$'
> err
> scenes

# The bar is drawn on a terminal, and only there.
$ skip-without script no terminal to try
$ timeout 20 script -qec 'retex-denoise s.exr -o x.exr' /dev/null </dev/null | grep -c 'denoise \[#*\] 100%'
> 1
$ timeout 20 script -qec 'retex-denoise -q s.exr -o x.exr' /dev/null </dev/null
