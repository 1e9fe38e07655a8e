# A target that is pointed at stands in a set as a name that means the same at every size: it resumes a render, is rendered
# again with --control and --variants, and has finishes, the other layout and a matte.
$ python3 "$TESTS/face_rooms.py"
$ cp "$SCENES/textures/fans.jpg" .
% render() { retex-render -q --size 96x72 "$@"; }
# Another pixel of the floor resumes a render; another target does not.
$ render --spp 4 -t A=@48:66/flat room.pov -o whole.exr
$ (ulimit -f 300; render --spp 4 -t A=@48:66/flat --threads 1 --resume room.pov -o resumed.exr)
! retex-render: error: cannot write resumed.exr.partial: File too large
= 2
$ render --spp 4 -t A=@48:66 --resume room.pov -o resumed.exr
! retex-render: error: resumed.exr.partial is of another render: other options, another scene or build
= 2
$ render --spp 4 -t A=@30:60/flat --resume room.pov -o resumed.exr
$ cmp whole.exr resumed.exr
$ retex-render -q --size 48x36 --spp 1 -t A=@40:33/flat room.pov -o small.exr
$ for s in whole small; do
+     retex-info $s.exr | awk '/^  idents/ { i = $2 } /^  share/ { print i, int(($2 + 5) / 10) }'
+ done
> #1/flat:1 4
> #1/flat:1 4
# A set tells its targets with their UV: --control renders them again.
$ render --spp 32 --control-data biased -t A=@32:44/object:uv=box crate.pov -o control.exr
$ render --spp 32 --control control.exr --replace A=fans.jpg crate.pov -o near.exr
$ render --spp 32 -t 'A=#2:uv=box' --replace A=fans.jpg crate.pov -o truth.exr
$ retex-diff -q --fail-psnr 38 near.exr truth.exr
# Finishes, the other layout and masks know the target as well.
% # Both rooms, rendered with the options; and whether their pictures with the texture and an edit are one.
% both() {
%     render --spp 8 -t A=@48:66/flat "$@" room.pov -o room.exr
%     render --spp 8 -t A=Right "$@" room-right.pov -o room-right.exr
% }
% same() {
%     for n in room room-right; do retex-combine -q $n.exr --texture A=fans.jpg "$@" -o $n-new.exr; done
%     retex-diff -q --fail-psnr 70 room-new.exr room-right-new.exr # the same samples
% }
$ both --finish A=original,polished
$ same --finish A=polished
$ both --layout paper
$ same
$ render --spp 8 -t A=@48:66/flat --mattes m.exr room.pov -o b.exr
$ oiiotool m.exr --ch mask_A.R -o room-mask.exr
$ render --spp 8 -t A=Right --mattes m.exr room-right.pov -o b.exr
$ oiiotool m.exr --ch mask_A.R -o room-right-mask.exr
$ oiiotool --stats room-mask.exr | sed -n 's/^ *Stats Max: \([0-9.]*\) .*/\1/p'
> 1.000000
$ retex-diff --fail-abs 0 room-mask.exr room-right-mask.exr >/dev/null
# A table renders what --replace does.
$ printf 'output,A\na.exr,fans.jpg\n' >table.csv
$ render --spp 4 -t A=@48:66/flat --variants table.csv room.pov
$ render --spp 4 -t A=@48:66/flat --replace A=fans.jpg room.pov -o b.exr
$ retex-diff --fail-abs 0 a.exr b.exr >/dev/null
