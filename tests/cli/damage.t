# Damage never gets a fresh checksum: what reads a set, samples, a stream or a pack refuses it, whatever is damaged, and
# leaves no file.
% # FILE with two other bytes, AT bytes from its beginning, is d.exr: damage FILE AT.
% damage() {
%     cp $1 d.exr
%     printf 'XY' | dd of=d.exr bs=1 seek=$2 conv=notrunc 2>/dev/null
% }
$ make_set s.exr 64 48 footprints denoise
$ ls
> s.exr

# The manifest: one name for another, one digit for another.
$ sed 's/"uv":"t0_uv1"/"uv":"t0_uv2"/' s.exr >m.exr
$ cmp s.exr m.exr | cut -d' ' -f1-3
> s.exr m.exr differ:
$ retex-info --check m.exr
! retex-info: error: m.exr: the manifest is damaged: its checksum is wrong
= 1
$ retex-combine m.exr -o m.png
! retex-combine: error: m.exr: the manifest is damaged: its checksum is wrong
= 2
$ retex-denoise m.exr -o m2.exr
! retex-denoise: error: m.exr: the manifest is damaged: its checksum is wrong
= 2
$ retex-pack --lossless m.exr -o m.retex
! retex-pack: error: m.exr: the manifest is damaged: its checksum is wrong
= 2
$ retex-sample m.exr --texture 'Floor=rgb(1,0,0)' -o m2.exr
! retex-sample: error: m.exr: the manifest is damaged: its checksum is wrong
= 2
$ retex-info m.exr
! retex-info: error: m.exr: the manifest is damaged: its checksum is wrong
= 2
$ ls m*
> m.exr
$ sed 's/"mean_albedo":\[0/"mean_albedo":[1/' s.exr | retex-combine - -o m.png
! retex-combine: error: standard input: the manifest is damaged: its checksum is wrong
= 2
$ sed 's/{"retex":1/{"retex":3/' s.exr | retex-info --check -
! retex-info: error: standard input: the manifest is damaged: its checksum is wrong
= 1
$ sed 's/{"retex":1,"crc32"/{"retex":1,"crc33"/' s.exr | retex-info --check -
! retex-info: error: standard input: the manifest is damaged: its checksum is missing
= 1

# Sets without checksums of bands, which other programs may write, are read as well.
$ make_bandless <s.exr >bandless.exr
$ cmp s.exr bandless.exr | wc -l
> 1
$ retex-info --check bandless.exr
> bandless.exr: ok
$ for s in s bandless; do retex-combine -q $s.exr --texture 'Floor=rgb(1,0.5,0.2)' -o $s.png; done
$ cmp s.png bandless.png

# Samples that are stored as they are, as pipes had them: two bytes of them, seen by those who read all and those
# who read row by row; the message names the part. So in a set without checksums of bands, and in a stream.
$ retex-pack -q --lossless s.exr -o s.retex
$ retex-pack -q --unpack s.retex -o - >q.exr
$ make_plain q.exr p.exr
$ retex-info --check p.exr
> p.exr: ok
$ retex-combine -q p.exr --texture 'Floor=rgb(1,0.5,0.2)' -o p.png
$ cmp s.png p.png
$ damage p.exr $(($(wc -c <p.exr) - 90000))
$ make_bandless <d.exr >e.exr
$ cmp d.exr e.exr | wc -l
> 1
$ for d in d e; do
+     retex-info --check $d.exr
+     echo $?
+     retex-denoise -q $d.exr -o x.exr
+     echo $?
+     retex-denoise -q --memory 1 $d.exr -o x.exr
+     echo $?
+     retex-pack -q --lossless $d.exr -o x.retex
+     echo $?
+ done
> 1
> 2
> 2
> 2
> 1
> 2
> 2
> 2
! retex-info: error: d.exr: the checksum of part guide_seen_normal is wrong
! retex-denoise: error: d.exr: the checksum of part guide_seen_normal is wrong
! retex-denoise: error: d.exr: the checksum of part guide_seen_normal is wrong
! retex-pack: error: d.exr: the checksum of part guide_seen_normal is wrong
! retex-info: error: e.exr: the checksum of part guide_seen_normal is wrong
! retex-denoise: error: e.exr: the checksum of part guide_seen_normal is wrong
! retex-denoise: error: e.exr: the checksum of part guide_seen_normal is wrong
! retex-pack: error: e.exr: the checksum of part guide_seen_normal is wrong
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2
$ retex-sample -q p.exr --texture 'Floor=rgb(1,0.5,0.2)' >q.exr
$ make_plain q.exr t.exr
$ damage t.exr $(($(wc -c <t.exr) - 20000))
$ for t in t d; do
+     retex-combine -q - -o $t.png <$t.exr
+     echo $?
+ done
> 0
> 2
! retex-combine: error: standard input: the checksum of part sample_Floor_3 is wrong
$ cmp s.png t.png
$ ls d.png
! ls: cannot access 'd.png': No such file or directory
= 2
$ retex-info --check - <d.exr
! retex-info: error: standard input: the checksum of part sample_Floor_3 is wrong
= 1
$ cp s.png d.png
$ retex-combine -q d.exr -o d.png
! retex-combine: error: d.exr: the checksum of part sample_Floor_3 is wrong
= 2
$ cmp s.png d.png

# Samples in a file of their own, and the set that they are of.
$ retex-sample -q s.exr --texture 'Floor=rgb(1,0.5,0.2)' -o t.exr
$ retex-combine -q s.exr t.exr -o t.png
$ cmp s.png t.png
$ damage t.exr $(($(wc -c <t.exr) * 3 / 4))
$ retex-combine -q s.exr d.exr -o u.png 2>err
= 2
$ cut -d: -f1-4 err
> retex-combine: error: d.exr: part sample_Floor_1 is damaged or truncated
$ ls u.png
! ls: cannot access 'u.png': No such file or directory
= 2
$ sed 's/"sample_Floor_1"/"sample_Floor_2"/' t.exr >d.exr
$ retex-combine -q s.exr d.exr -o u.png
! retex-combine: error: d.exr: the manifest is damaged: its checksum is wrong
= 2
