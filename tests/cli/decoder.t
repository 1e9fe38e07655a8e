# Pictures that take what they want are decoded in a process of their own (--safe): one line says what was wrong, and no
# process is left.
$ make_set s.exr 24 16
$ python3 "$TESTS/decoder.py"
$ for f in tile.tif channels.tif scans.jpg most.jpg few.tif; do
+     retex-combine -q --safe s.exr --texture floor=$f -o x.exr
+     echo $f $?
+ done
> tile.tif 2
> channels.tif 2
> scans.jpg 2
> most.jpg 0
> few.tif 0
! retex-combine: error: tile.tif: the picture is in tiles of 40000 x 40000 pixels, which are not read (--safe)
! retex-combine: error: channels.tif: the picture has 128 channels, of which at most 64 are read (--safe)
! retex-combine: error: scans.jpg: a JPEG of more than 200 scans, which are not read (--safe)
# Without --safe they are the user's own.
$ retex-combine -q s.exr --texture floor=scans.jpg -o x.exr

# Memory counts with that of the command.
$ retex-combine -q --safe --max-memory 100M s.exr --texture floor=wide.tif -o x.exr
! retex-combine: error: wide.tif: decoding it takes more than the 100 MB that --max-memory leaves
= 2
$ retex-combine -q --safe --max-memory 1G s.exr --texture floor=wide.tif -o y.exr && ls y.exr
> y.exr

# Time is the command's; what ends the command ends the decoder.
% # How many processes have the mark: left MARK.
% left() {
%     sleep .3
%     grep -ls "DECODER_MARK=$1" /proc/[0-9]*/environ | wc -l
% }
$ DECODER_MARK=a$$ retex-combine -q --safe --max-time 1 s.exr --texture floor=long.png -o x.exr
! retex-combine: error: not done within the 1 s of --max-time
= 2
$ left a$$
> 0
$ cat >end.py <<'END'
+ import signal, subprocess, sys, time
+ signal.signal(2, signal.SIG_DFL)
+ command = ["retex-combine", "-q", "--safe", "s.exr", "--texture", "floor=long.png", "-o", "x.exr"]
+ combine = subprocess.Popen(command, stderr=subprocess.DEVNULL)
+ time.sleep(.5)
+ combine.send_signal(int(sys.argv[1]))
+ print(combine.wait())
+ END
$ for signal in 15 2 9; do
+     DECODER_MARK=b$$ python3 end.py $signal
+     left b$$
+ done
> -15
> 0
> -2
> 0
> -9
> 0

# The program that decodes.
$ RETEX_DECODER=/nowhere/decode retex-combine -q --safe s.exr --texture floor=most.jpg -o x.exr
! retex-combine: error: most.jpg: no process for it: No such file or directory
= 2
$ RETEX_DECODER=/bin/false retex-combine -q --safe s.exr --texture floor=most.jpg -o x.exr
! retex-combine: error: most.jpg: the process that decodes it ended (without a word): it is damaged
= 2
$ RETEX_DECODER=/bin/echo retex-combine -q --safe s.exr --texture floor=most.jpg -o x.exr
! retex-combine: error: most.jpg: the process that decodes it ended (without a word): it is damaged
= 2
$ RETEX_DECODER=/bin/yes retex-combine -q --safe s.exr --texture floor=most.jpg -o x.exr
! retex-combine: error: most.jpg: the process that decodes it gave a wrong answer: it is damaged
= 2
# What it says to a user: which layers this kernel has.
$ $(dirname "$(command -v retex-combine)")/../lib/retex-decode | sed 's/: \(yes\|no\)/: ANSWER/g'
> retex-decode: other programs of retex start it, to decode a picture; seccomp: ANSWER, Landlock: ANSWER
# The user's configuration, and the tables of its spaces, are read before the decoder gives up its rights.
$ cat >table.spi1d <<'END'
+ Version 1
+ From 0.0 1.0
+ Length 3
+ Components 1
+ {
+ 0.0
+ 0.2
+ 1.0
+ }
+ END
$ cat >c.ocio <<'END'
+ ocio_profile_version: 1
+ search_path: .
+ roles: {default: lin, scene_linear: lin}
+ displays: {d: [!<View> {name: v, colorspace: lin}]}
+ colorspaces:
+   - !<ColorSpace> {name: lin}
+   - !<ColorSpace> {name: odd, to_reference: !<FileTransform> {src: table.spi1d, interpolation: linear}}
+ END
$ retex-combine -q s.exr -o t.png
$ for f in t.png few.tif s.exr; do
+     OCIO=c.ocio retex-combine -q s.exr --texture:colorspace=odd floor=$f -o any.exr
+     OCIO=c.ocio retex-combine --safe -q s.exr --texture:colorspace=odd floor=$f -o safe.exr &&
+         cmp any.exr safe.exr && echo $f
+ done
> t.png
> few.tif
> s.exr
$ retex-combine -q s.exr --texture floor=t.png -o any.exr
$ cmp -s any.exr safe.exr
= 1

# One that goes through OpenImageIO, as it is turned by Exif, and is larger than the buffer of a stream.
$ python3 - "$SCENES/textures/damask.jpg" turned.jpg <<'END'
+ import sys
+ data = open(sys.argv[1], "rb").read()
+ exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x03\0\0\0\0\0\0"
+ open(sys.argv[2], "wb").write(data[:2] + b"\xff\xe1" + (len(exif) + 2).to_bytes(2, "big") + exif + data[2:])
+ END
$ retex-combine -q s.exr --texture floor=turned.jpg -o any.exr
$ retex-combine --safe -q s.exr --texture floor=turned.jpg -o safe.exr
$ cmp any.exr safe.exr
