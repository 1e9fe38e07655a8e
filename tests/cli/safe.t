# What a scene may read: files in the current folder, in its own, in those of -I and in POV-Ray's.
$ mkdir -p a/b/folder a/bc; make_picture a/up.png size=4x4; cp a/up.png a/bc/beside.png; cp a/up.png a/b/in.png; echo '#declare Up = 1;' >a/up.inc; mkfifo a/b/pipe; ln -s ../up.png a/b/link.png
$ scene() { printf '%s\nbackground { rgb 1 }\n' "$2" >"a/b/$1.pov"; }; for i in in.png ../up.png ../bc/beside.png link.png /etc/passwd nowhere.png pipe folder; do n=$(basename $i .png); scene $n "box { -1, 1 pigment { image_map { png \"$i\" } } }"; done; scene include '#include "../up.inc"'; scene fopen '#fopen F "../up.inc" read'
$ cd a/b; for n in in up beside link passwd nowhere pipe folder include fopen; do retex-render -q --plain --spp 1 --size 8x8 $n.pov -o x.exr; echo $n $?; done
> in 0
> up 2
> beside 2
> link 2
> passwd 2
> nowhere 2
> pipe 2
> folder 2
> include 2
> fopen 2
! retex-render: error: up.pov:1:39: the image `../up.png` is outside the folders that may be read: the current one, the scene's, those of -I, POV-Ray's; name its folder with -I
! retex-render: error: beside.pov:1:39: the image `../bc/beside.png` is outside the folders that may be read: the current one, the scene's, those of -I, POV-Ray's; name its folder with -I
! retex-render: error: link.pov:1:39: the image `link.png` is outside the folders that may be read: the current one, the scene's, those of -I, POV-Ray's; name its folder with -I
! retex-render: error: passwd.pov:1:39: the image `/etc/passwd` is outside the folders that may be read: the current one, the scene's, those of -I, POV-Ray's; name its folder with -I
! retex-render: error: nowhere.pov:1:39: cannot find the image `nowhere.png` in the scene's folder or the include path
! retex-render: error: pipe.pov:1:39: the image `pipe` is no file, but a folder, a device or a pipe
! retex-render: error: folder.pov:1:39: the image `folder` is no file, but a folder, a device or a pipe
! retex-render: error: include.pov:1:10: the file `../up.inc` is outside the folders that may be read: the current one, the scene's, those of -I, POV-Ray's; name its folder with -I
! retex-render: error: fopen.pov:1:22: the file `../up.inc` is outside the folders that may be read: the current one, the scene's, those of -I, POV-Ray's; name its folder with -I
$ cd a/b; for n in up beside link include fopen; do retex-render -q --plain --spp 1 --size 8x8 -I .. $n.pov -o x.exr; echo $n $?; done
> up 0
> beside 0
> link 0
> include 0
> fopen 0
