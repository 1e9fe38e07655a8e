# Damage never gets a fresh checksum: what reads a set, samples, a stream or a pack refuses it, whatever is damaged, and
# leaves no file.
$ make_set s.exr 64 48 footprints denoise; ls
> s.exr

# The manifest: one name for another, one digit for another.
$ sed 's/"uv":"t0_uv1"/"uv":"t0_uv2"/' s.exr >m.exr; cmp s.exr m.exr | cut -d' ' -f1-3; retex-info --check m.exr; echo $?; retex-combine m.exr -o m.png; echo $?; retex-denoise m.exr -o m2.exr; echo $?; retex-pack --lossless m.exr -o m.retex; echo $?; retex-sample m.exr --texture 'Floor=rgb(1,0,0)' -o m2.exr; echo $?; retex-info m.exr; echo $?; ls m*
> s.exr m.exr differ:
> 1
> 2
> 2
> 2
> 2
> 2
> m.exr
! retex-info: error: m.exr: the manifest is damaged: its checksum is wrong
! retex-combine: error: m.exr: the manifest is damaged: its checksum is wrong
! retex-denoise: error: m.exr: the manifest is damaged: its checksum is wrong
! retex-pack: error: m.exr: the manifest is damaged: its checksum is wrong
! retex-sample: error: m.exr: the manifest is damaged: its checksum is wrong
! retex-info: error: m.exr: the manifest is damaged: its checksum is wrong
$ sed 's/"mean_albedo":\[0/"mean_albedo":[1/' s.exr | retex-combine - -o m.png
! retex-combine: error: standard input: the manifest is damaged: its checksum is wrong
= 2
$ sed 's/{"retex":3/{"retex":2/' s.exr | retex-info --check -
! retex-info: error: standard input: the manifest is damaged: its checksum is wrong
= 1
$ sed 's/{"retex":3,"crc32"/{"retex":3,"crc33"/' s.exr | retex-info --check -
! retex-info: error: standard input: the manifest is damaged: its checksum is missing
= 1

# Sets of before, whose manifest has no checksum, are read, and --check says so.
$ sed 's/{"retex":3,"crc32"/{"retex":2,"older"/' s.exr >old.exr; retex-info --check old.exr; for s in s old; do retex-combine -q $s.exr --texture 'Floor=rgb(1,0.5,0.2)' -o $s.png; done; cmp s.png old.png; retex-info -q --check old.exr
> old.exr: ok, but for the manifest, which has no checksum: it is of an old version
