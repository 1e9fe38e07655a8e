# What a scene may read: files in the current folder, in its own, in those of -I and in POV-Ray's.
$ mkdir -p a/b/folder a/bc
$ make_picture a/up.png size=4x4
$ cp a/up.png a/bc/beside.png
$ cp a/up.png a/b/in.png
$ echo '#declare Up = 1;' >a/up.inc
$ mkfifo a/b/pipe
$ ln -s ../up.png a/b/link.png
% scene() { printf '%s\nbackground { rgb 1 }\nsphere { -9*z, 1 }\n' "$2" >"a/b/$1.pov"; }
$ for i in in.png ../up.png ../bc/beside.png link.png /etc/passwd nowhere.png pipe folder; do
+     n=$(basename $i .png)
+     scene $n "box { -1, 1 pigment { image_map { png \"$i\" } } }"
+ done
$ scene include '#include "../up.inc"'
$ scene fopen '#fopen F "../up.inc" read'
$ cd a/b
+ for n in in up beside link passwd nowhere pipe folder include fopen; do
+     retex-render -q --plain --spp 1 --size 8x8 $n.pov -o x.exr
+     echo $n $?
+ done
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
$ cd a/b
+ for n in up beside link include fopen; do
+     retex-render -q --plain --spp 1 --size 8x8 -I .. $n.pov -o x.exr
+     echo $n $?
+ done
> up 0
> beside 0
> link 0
> include 0
> fopen 0

# --safe: not the current folder, unless the scene lies there, and nothing that leaves the folders on its way. What is
# there outside is not told.
$ mkdir here
$ cp a/up.png a/up.inc here
$ cd here
+ for n in in up beside link passwd nowhere pipe folder include fopen; do
+     retex-render --safe -q --plain --spp 1 --size 8x8 ../a/b/$n.pov -o x.exr
+     echo $n $?
+ done
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
! retex-render: error: ../a/b/up.pov:1:39: the image `../up.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
! retex-render: error: ../a/b/beside.pov:1:39: the image `../bc/beside.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
! retex-render: error: ../a/b/link.pov:1:39: the image `link.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
! retex-render: error: ../a/b/passwd.pov:1:39: the image `/etc/passwd` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
! retex-render: error: ../a/b/nowhere.pov:1:39: cannot find the image `nowhere.png` in the scene's folder or the include path
! retex-render: error: ../a/b/pipe.pov:1:39: the image `pipe` is no file, but a folder, a device or a pipe
! retex-render: error: ../a/b/folder.pov:1:39: the image `folder` is no file, but a folder, a device or a pipe
! retex-render: error: ../a/b/include.pov:1:10: the file `../up.inc` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
! retex-render: error: ../a/b/fopen.pov:1:22: the file `../up.inc` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
$ scene exists \
+     '#debug str(file_exists("in.png") + 10*file_exists("../up.png") + 100*file_exists("/etc/passwd") + 1000*file_exists("colors.inc"), 0, 0)'
$ scene current '#include "up.inc"'
$ for i in ../b/in.png ../../nowhere.png /nowhere dangling/x.png "$PWD/a/b/in.png" "$PWD/a/bc/beside.png"; do
+     ln -sf ../../nowhere a/b/dangling
+     scene "i$((k = k + 1))" "box { -1, 1 pigment { image_map { png \"$i\" } } }"
+ done
$ retex-render -v --safe --plain --spp 1 --size 8x8 a/b/exists.pov -o x.exr 2>&1 | head -1
> retex-render: 1001
$ retex-render -v --plain --spp 1 --size 8x8 -I a a/b/exists.pov -o x.exr 2>&1 | head -1
> retex-render: 1011
$ cd here
+ retex-render -q --plain --spp 1 --size 8x8 ../a/b/current.pov -o x.exr
+ retex-render --safe -q --plain --spp 1 --size 8x8 ../a/b/current.pov -o x.exr
! retex-render: error: ../a/b/current.pov:1:10: cannot find the file `up.inc` in the scene's folder or the include path
= 2
$ for n in 1 2 3 4 5 6; do
+     retex-render --safe -q --plain --spp 1 --size 8x8 a/b/i$n.pov -o x.exr 2>&1 | sed "s|$PWD|HERE|"
+ done
> retex-render: error: a/b/i1.pov:1:39: the image `../b/in.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
> retex-render: error: a/b/i2.pov:1:39: the image `../../nowhere.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
> retex-render: error: a/b/i3.pov:1:39: the image `/nowhere` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
> retex-render: error: a/b/i4.pov:1:39: the image `dangling/x.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
> retex-render: error: a/b/i6.pov:1:39: the image `HERE/a/bc/beside.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
$ for n in up beside link include fopen; do
+     retex-render --safe -q --plain --spp 1 --size 8x8 -I a a/b/$n.pov -o x.exr
+     echo $n $?
+ done
> up 0
> beside 0
> link 0
> include 0
> fopen 0
# The scene itself: no pipe, and no link that leads out.
$ mkfifo pipe.pov
$ ln -s ../up.inc a/b/away.pov
$ for s in pipe.pov a/b/away.pov /dev/zero; do retex-render --safe -q --plain $s -o x.exr; done
! retex-render: error: pipe.pov: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
! retex-render: error: a/b/away.pov: a/b/away.pov is outside the folders that may be read (--safe)
! retex-render: error: /dev/zero: /dev/zero is a folder, a device or a pipe: only files are read (--safe)
= 2
# The environment asks for it too, and no option takes it back.
$ for safe in '' 0 1 yes; do
+     RETEX_SAFE=$safe retex-render -q --plain --spp 1 --size 8x8 a/b/i1.pov -o x.exr 2>/dev/null
+     echo "'$safe' $?"
+ done
> '' 0
> '0' 0
> '1' 2
> 'yes' 2
# Fonts, density files, height fields, .ini files and what these name are files like others.
% scene() { printf '%s\nbackground { rgb 1 }\n' "$2" >"b/$1"; }
% ini() { printf "$2=$3\nInput_File_Name=in.pov\n" >b/$1.ini; }
$ cd a
+ cp "$TESTS/../data/density.df3" up.df3
+ cp "$(find /usr/share/fonts -name timrom.ttf | head -1)" up.ttf
+ printf 'Width=9\n' >up.ini
+ cp b/in.pov up.pov
+ scene font.pov 'text { ttf "../up.ttf" "A" .1, 0 }'
+ scene df3.pov \
+     'box { 0, 1 hollow pigment { rgbt 1 } interior { media { emission 1 density { density_file df3 "../up.df3" } } } }'
+ scene field.pov 'height_field { png "../up.png" }'
+ ini scene Input_File_Name ../up.pov
+ ini ini Include_Ini ../up.ini
+ ini library Library_Path ..
+ ini output Output_File_Name ../x.png
+ echo Input_File_Name=../up.pov >b/scene.ini
$ for n in font.pov df3.pov field.pov scene.ini ini.ini library.ini output.ini; do
+     retex-render --safe -q --plain --spp 1 --size 8x8 a/b/$n -o x.exr
+     echo $n $?
+ done
> font.pov 0
> df3.pov 2
> field.pov 2
> scene.ini 2
> ini.ini 2
> library.ini 2
> output.ini 2
! retex-render: a/b/font.pov:1: warning: the font `../up.ttf` is not in the folders that may be read: cyrvetic.ttf is used
! retex-render: error: a/b/df3.pov:1:95: the density_file `../up.df3` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
! retex-render: error: a/b/field.pov:1:20: the image `../up.png` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's
! retex-render: error: a/b/scene.ini:1: Input_File_Name: ../up.pov is outside the folder of the .ini file (--safe)
! retex-render: error: a/b/ini.ini:1: the file: ../up.ini is outside the folder of the .ini file (--safe)
! retex-render: error: a/b/library.ini:1: Library_Path: .. is outside the folder of the .ini file (--safe)
! retex-render: error: a/b/output.ini:1: Output_File_Name: an .ini file names no output (--safe): give -o
$ for n in font.pov df3.pov field.pov ini.ini library.ini output.ini; do
+     retex-render -I a -q --plain --spp 1 --size 8x8 a/b/$n -o x.exr
+     echo $n $?
+ done
> font.pov 0
> df3.pov 0
> field.pov 0
> ini.ini 0
> library.ini 0
> output.ini 0

# What a scene writes stays in memory.
$ cat >a/b/write.pov <<'END'
+ #fopen F "written.inc" write
+ #write(F, "#declare Radius = 1;")
+ #fclose F
+ #include "written.inc"
+ sphere { 0, Radius }
+ background { rgb 1 }
+ END
$ retex-render --safe -q --plain --spp 1 --size 8x8 a/b/write.pov -o x.exr
$ ls a/b/written.inc written.inc 2>/dev/null
= 2
# No colour space is a file.
$ retex-render --safe -q --plain --spp 1 --size 8x8 \
+     --replace:colorspace=/etc/passwd Floor=a/up.png "$SCENES/cornell-box/cornell-box.pov" -o x.exr
! retex-render: error: a/up.png: no colour space is called '/etc/passwd'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
= 2
# What it says does not fill the log of a service: 64 KiB, and a line that there was more.
$ printf 'background { rgb 1 }\nbox { -1, 1 }\n#for (I, 1, 10000)\n#warning "%s"\n#debug "abc\\n"\n#end\n' \
+     "$(printf '%0100d' 0)" >a/b/loud.pov
$ for o in '--safe' '--safe -v' ''; do
+     retex-render $o --plain --spp 1 --size 8x8 a/b/loud.pov -o x.exr 2>&1 | grep -v 8x8 >log
+     wc -c <log
+     tail -1 log
+ done
> 70631
> retex-render: warning: the scene says more, which is left out (--safe)
> 79703
> retex-render: warning: the scene says more, which is left out (--safe)
> 1400000
> retex-render: a/b/loud.pov:4: warning: 0000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000

# Pictures: those of the list, known by what is in them, are read as ever.
$ make_set s.exr 24 16
$ make_picture t.exr size=16x16
$ retex-combine -q s.exr -o t.png
$ for e in jpg tif tga bmp gif hdr exr webp; do retex-combine -q s.exr -o t.$e; done
$ for e in png jpg tif tga bmp gif hdr exr webp; do
+     cp t.$e t.$e.txt
+     retex-combine -q s.exr --texture floor=t.$e -o any.exr
+     for f in t.$e t.$e.txt; do
+         retex-combine --safe -q s.exr --texture floor=$f -o safe.exr && cmp any.exr safe.exr && echo "$f same"
+     done
+ done
> t.png same
> t.png.txt same
> t.jpg same
> t.jpg.txt same
> t.tif same
> t.tif.txt same
> t.tga same
> t.tga.txt same
> t.bmp same
> t.bmp.txt same
> t.gif same
> t.gif.txt same
> t.hdr same
> t.hdr.txt same
> t.exr same
> t.exr.txt same
> t.webp same
> t.webp.txt same
$ for t in linear:png linear:jpg linear:tif ACEScg:png ACEScg:exr sRGB:hdr sRGB:exr; do
+     retex-combine -q s.exr --texture:colorspace=${t%:*} floor=t.${t#*:} -o any.exr 2>/dev/null
+     retex-combine --safe -q s.exr --texture:colorspace=${t%:*} floor=t.${t#*:} -o safe.exr 2>/dev/null
+     cmp any.exr safe.exr
+ done
+ for e in png jpg exr hdr tga; do retex-diff --safe -q t.$e t.$e || echo $e; done
# All else is not, whatever it is called.
$ retex-combine -q s.exr -o t.ppm
$ retex-combine -q s.exr -o t.dpx
$ retex-combine -q s.exr -o t.sgi
$ cp t.ppm ppm.png
$ cp t.dpx dpx.tga
$ echo text >text.png
$ : >empty.png
$ cp t.png png.tga
$ printf 'BM but no picture, as the size of its header says' >bm.bmp
+ for f in t.ppm ppm.png t.dpx dpx.tga t.sgi text.png empty.png bm.bmp s.exr png.tga; do
+     retex-combine --safe -q s.exr --texture floor=$f -o x.exr
+     echo $f $?
+ done
> t.ppm 2
> ppm.png 2
> t.dpx 2
> dpx.tga 2
> t.sgi 2
> text.png 2
> empty.png 2
> bm.bmp 2
> s.exr 0
> png.tga 0
! retex-combine: error: t.ppm: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: ppm.png: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: t.dpx: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: dpx.tga: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: t.sgi: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: text.png: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: empty.png: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: bm.bmp: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
# A TGA without a footer needs its name, and a header that fits the file.
$ head -c $(($(wc -c <t.tga) - 26)) t.tga >bare.tga
$ cp bare.tga bare.dat
$ head -c 400 bare.tga >cut.tga
$ head -c 5000 /dev/zero >zero.tga
+ for f in bare.tga bare.dat cut.tga zero.tga; do
+     retex-combine --safe -q s.exr --texture floor=$f -o x.exr
+     echo $f $?
+ done
> bare.tga 0
> bare.dat 2
> cut.tga 2
> zero.tga 2
! retex-combine: error: bare.dat: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: cut.tga: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: zero.tga: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
# Of a GIF and a BMP the size is looked at before a decoder makes room for it.
$ printf 'GIF89a\030\171\030\171\200\0\0\0\0\0\377\377\377,\0\0\0\0\1\0\1\0\0\2\2\104\1\0;' >wide.gif
$ {
+     printf 'BM\66\0\0\0\0\0\0\0\66\4\0\0\50\0\0\0\60\165\0\0\60\165\0\0\1\0\10\0'
+     head -c 1048 /dev/zero
+ } >wide.bmp
$ for o in '--max-memory 200M' '--max-pixels 1000000'; do
+     for f in wide.gif wide.bmp; do retex-combine --safe $o -q s.exr --texture floor=$f -o x.exr; done
+ done
! retex-combine: error: wide.gif: the picture is too large: 961000000 pixels, more than --max-memory has room for
! retex-combine: error: wide.bmp: the picture is too large: 900000000 pixels, more than --max-memory has room for
! retex-combine: error: wide.gif: the picture is too large: 961000000 pixels, more than the 1000000 of --max-pixels
! retex-combine: error: wide.bmp: the picture is too large: 900000000 pixels, more than the 1000000 of --max-pixels
= 2
# No devices, no pipes; standard input as a stream is one all the same.
$ for f in pipe.pov /dev/zero /dev/stdin a /proc/self/environ; do
+     retex-combine --safe -q s.exr --texture floor=$f -o x.exr
+     retex-combine --safe -q $f -o x.exr
+ done
! retex-combine: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
! retex-combine: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
! retex-combine: error: /dev/zero is a folder, a device or a pipe: only files are read (--safe)
! retex-combine: error: /dev/zero is a folder, a device or a pipe: only files are read (--safe)
! retex-combine: error: /dev/stdin is a folder, a device or a pipe: only files are read (--safe)
! retex-combine: error: /dev/stdin is a folder, a device or a pipe: only files are read (--safe)
! retex-combine: error: a: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has up.df3, up.inc, up.ini and 3 more
! retex-combine: error: a is a folder, a device or a pipe: only files are read (--safe)
! retex-combine: error: /proc/self/environ: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-combine: error: /proc/self/environ is not a set: it is empty
= 2
$ printf 'output,floor\nb.png,t.ppm\n' >b.csv
$ retex-combine --safe -q s.exr --batch b.csv
! retex-combine: error: b.csv:2: t.ppm: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
= 2
$ retex-combine --safe -q s.exr --batch pipe.pov
! retex-combine: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
= 2
$ for o in '--replace Floor=t.ppm -o x.png' '--variants b.csv'; do
+     retex-render --safe -q --spp 1 --size 8x8 $o "$SCENES/cornell-box/cornell-box.pov"
+ done
! retex-render: error: t.ppm: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
! retex-render: error: b.csv:2: t.ppm: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
= 2
$ retex-sample --safe -q s.exr --texture floor=t.png | retex-combine --safe -q - -o x.exr
$ retex-pack --safe -q --lossless - -o x.retex <s.exr
$ for t in 'denoise -o x.exr' 'pack -o x.retex' 'sample --texture Floor=t.png -o x.exr' info; do
+     retex-$t --safe -q pipe.pov
+ done
! retex-denoise: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
! retex-pack: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
! retex-sample: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
! retex-info: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
= 2
$ retex-diff --safe t.ppm t.ppm
! retex-diff: error: t.ppm: no PNG, JPEG, OpenEXR, TIFF, TGA, BMP, GIF, WebP or Radiance HDR by what is in it: others are not read (--safe)
= 2
$ retex-diff --safe pipe.pov t.png
! retex-diff: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
= 2
$ retex-render --safe -q --spp 1 --size 8x8 --control pipe.pov \
+     --replace Floor=t.png "$SCENES/cornell-box/cornell-box.pov" -o m.exr
! retex-render: error: pipe.pov is a folder, a device or a pipe: only files are read (--safe)
= 2

# What a stranger's set or picture holds does not reach the terminal as it is.
$ n="$(printf 'a\033[2J.pov')"
+ printf 'box { -1, 1 }\nbackground { rgb 1 }\n' >"$n"
+ retex-render -q --spp 1 --size 8x8 --aov depth "$n" -o n.exr
$ retex-info n.exr | grep scene | cat -v
> scene          a?[2J.pov
