# What is pointed at in a room as people find them, of which one image covers all, is retextured as the same room in which
# it is an object of its own, with UV that are right by construction (face_rooms.py). Noise of 48 samples is about 46 dB.
$ python3 "$TESTS/face_rooms.py"
$ cp "$SCENES/textures/fans.jpg" .
$ oiiotool --create 8x8 4 -o clear.png
% render() { retex-render -q --size 96x72 "$@"; }
% # FILE is as near to OTHER as DECIBELS say; else what is wrong is said: near DECIBELS FILE OTHER WHAT.
% near() { retex-diff -q --fail-psnr $1 $2 $3 || echo $room: $4; }
% # The same samples: as the room that is right, to rounding of the UV. as_right ROOM TARGET OPTIONS
% as_right() {
%     room=$1 target=$2 options=$3
%     render --spp 48 -t "A=$target" $room.pov -o $room.exr
%     render --spp 48 -t A=Right $room-right.pov -o $room-right.exr
%     for s in $room $room-right; do retex-combine -q $s.exr --texture$options A=fans.jpg -o $s-new.exr; done
%     near 60 $room-new.exr $room-right-new.exr 'other than the right one'
% }
% # Other samples: as the room rendered with the texture, to noise. as_rendered ROOM TARGET OPTIONS
% as_rendered() {
%     room=$1 target=$2 options=$3
%     render --spp 48 -t "A=$target" --replace$options A=fans.jpg $room.pov -o again.exr
%     near 42 $room-new.exr again.exr 'other than rendered again'
% }
% # The original is there, and below a clear texture as well, to rounding of what a set stores. has_original ROOM
% has_original() {
%     room=$1
%     render --spp 48 --plain $room.pov -o plain.exr
%     retex-combine -q $room.exr -o old.exr
%     near 75 old.exr plain.exr 'the original is lost'
%     retex-combine -q $room.exr --texture A=clear.png -o old.exr
%     near 60 old.exr plain.exr 'the original is another below a clear texture'
% }
$ as_right room @48:66/flat :width=90cm
$ as_rendered room @48:66/flat :width=90cm
$ has_original room
$ retex-info room.exr | grep -E '^  (idents|size|original) '
>   idents       #1/flat:1
>   size         1 x 1 scene units a unit of u and of v
$ as_right crate @32:44/object:uv=box :width=60cm
$ as_rendered crate @32:44/object:uv=box :width=60cm
$ has_original crate
$ retex-info crate.exr | grep -E '^  idents '
>   idents       #2:uv=box
$ as_right pillar @52:42/object:uv=cylinder :width=60cm
$ as_rendered pillar @52:42/object:uv=cylinder :width=60cm
$ has_original pillar
# Without the projection, or with all that the image covers, it is another picture.
$ render --spp 8 -t A=@48:66/flat --replace A=fans.jpg room.pov -o flat.exr
$ for t in @48:66/flat:uv=model @48:66; do
+     render --spp 8 -t A=$t --replace A=fans.jpg room.pov -o other.exr
+     retex-diff -q --fail-psnr 30 flat.exr other.exr || echo $t
+ done
> @48:66/flat:uv=model
> @48:66
