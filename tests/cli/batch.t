# Tables of pictures, retex-combine --batch and retex-render --variants: all is checked first, then made row by row.

% # What is in the folder that was not there at first, and what is not there any more.
% new_files() { ls -A | diff ../before -; }
% # Times of a report or of JSON as S.
% without_times() { sed 's/"seconds": [0-9.]*/"seconds": S/g'; }
% # Run $1 while the tool waits for an image from ../pipe, then give it the image.
% while_it_waits() { timeout 20 sh -c "exec 3>../pipe; $1; cat brick.jpg >&3"; }

$ make_set s.exr 48 32; cp "$SCENES/textures/brick.jpg" .; ln -s "$SCENES" scenes; ls -A >../before

# Every mistake of a table is told, in its order, and nothing is made.
$ cat >../t <<'END'
+ output,Floor,Sofa
+ gone/a.png,brick.jpg,none.jpg
+ -,x.png,
+ a.png,brick.jpg,,more
+ "b.png"x,
+ a.png,:foo=1 brick.jpg
+ ,brick.jpg
+ b.png,brick.jpg
+ ./b.png,brick.jpg
+ brick.jpg,"rgb(1,1,1)"
+ x.xyz
+ c.png,:colorspace=Nowhere brick.jpg
+ d.png,../before
+ e.png,scenes
+ "f.png,brick.jpg
+ END
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t:1: no target is called 'Sofa'; the set has Floor, Wall
! retex-combine: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:2: the folder of gone/a.png is not there; --mkdir makes it
! retex-combine: error: ../t:3: a table cannot write to standard output
! retex-combine: error: ../t:3: cannot read x.png: No such file or directory
! retex-combine: error: ../t:4: more cells than the first row has
! retex-combine: error: ../t:5: something follows a closing quote
! retex-combine: error: ../t:5: b.png: the output of the table's line 8 and the output of the table's line 5 are the same file
! retex-combine: error: ../t:6: no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize
! retex-combine: error: ../t:6: a.png: the output of the table's line 4 and the output of the table's line 6 are the same file
! retex-combine: error: ../t:7: no output in the first cell
! retex-combine: error: ../t:9: ./b.png: the output of the table's line 8 and the output of the table's line 9 are the same file
! retex-combine: error: ../t:10: brick.jpg: the output of the table's line 10 would replace the texture
! retex-combine: error: ../t:11: x.xyz: no picture format that can be written has the ending .xyz; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
! retex-combine: error: ../t:12: brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
! retex-combine: error: ../t:13: ../before: cannot read: OpenImageIO could not find a format reader for "../before". Is it a file format that OpenImageIO doesn't know about?
! retex-combine: error: ../t:14: scenes: a folder without a base colour, such as wood_diff_2k.jpg or wood_Color.png; it has README.md, brick.jpg, damask.jpg and 5 more
! retex-combine: error: ../t:15: a quoted cell has no closing quote
= 2
$ new_files

# Twenty of them are printed, the others counted; the report has all. Every row that names an image is told of.
$ {
+     echo output,floor
+     for k in $(seq 30); do echo "gone/$k.png,none.jpg"; done
+ } >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:2: the folder of gone/1.png is not there; --mkdir makes it
! retex-combine: error: ../t:3: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:3: the folder of gone/2.png is not there; --mkdir makes it
! retex-combine: error: ../t:4: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:4: the folder of gone/3.png is not there; --mkdir makes it
! retex-combine: error: ../t:5: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:5: the folder of gone/4.png is not there; --mkdir makes it
! retex-combine: error: ../t:6: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:6: the folder of gone/5.png is not there; --mkdir makes it
! retex-combine: error: ../t:7: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:7: the folder of gone/6.png is not there; --mkdir makes it
! retex-combine: error: ../t:8: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:8: the folder of gone/7.png is not there; --mkdir makes it
! retex-combine: error: ../t:9: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:9: the folder of gone/8.png is not there; --mkdir makes it
! retex-combine: error: ../t:10: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:10: the folder of gone/9.png is not there; --mkdir makes it
! retex-combine: error: ../t:11: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:11: the folder of gone/10.png is not there; --mkdir makes it
! retex-combine: error: ../t: 40 more mistakes
= 2
$ new_files
$ retex-combine s.exr --batch ../t --report ../report 2>/dev/null
= 2
$ grep -c '"line": .*"error"' ../report
> 60
$ printf 'output,floor,Floor\na.png,none.jpg\nb.png,none.jpg\n' >../t; retex-combine s.exr --batch ../t
! retex-combine: error: ../t:1: target 'Floor' has two columns
! retex-combine: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:3: cannot read none.jpg: No such file or directory
= 2
$ printf 'out,floor\n' >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t:1: the first row must name the columns: output, then targets
= 2
$ printf 'output,"floor\n' >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t:1: a quoted cell has no closing quote
= 2
$ tr '\0' a </dev/zero | head -c 70000000 >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t: more than the 64 MB that a table may have
= 2
$ retex-combine s.exr --batch /dev/zero
! retex-combine: error: /dev/zero: more than the 64 MB that a table may have
= 2
$ rm ../t

# An image whose beginning is no picture, of each reader; what is behind it is seen when the picture is made.
$ echo text >x.jpg
$ echo text >x.exr
$ : >x.png
$ head -c 9 brick.jpg >cut.jpg
$ head -c 2000 s.exr >cut.exr
$ {
+     echo output,floor
+     for f in x.jpg x.exr x.png cut.jpg cut.exr /dev/zero; do echo "${f##*/}.png,$f"; done
+ } >../t
$ retex-combine s.exr --batch ../t 2>&1 | cut -c 1-60
> retex-combine: error: ../t:2: x.jpg: cannot read: "x.jpg" is
> retex-combine: error: ../t:3: x.exr: cannot read: "x.exr" is
> retex-combine: error: ../t:4: x.png: cannot read: the file i
> retex-combine: error: ../t:6: cut.exr is damaged or truncate
> retex-combine: error: ../t:7: cannot read /dev/zero: it is a
$ rm x.* cut.*

# Targets that the set has not what is needed of.
$ retex-sample -q s.exr --texture floor=brick.jpg | retex-combine -q - --batch ../t2 2>&1 | cut -c 1-60
> retex-combine: error: ../t2: cannot read: No such file or di
$ printf 'output,wall,floor\nw.png,,\nf.png,,brick.jpg\n' >../t
$ retex-sample -q s.exr --texture floor=brick.jpg | retex-combine -q - --batch ../t 2>&1 | cut -c 1-80
> retex-combine: error: ../t:3: nothing can be put on target Floor: the set does n
$ new_files

# A mistake does not hide another one of its row: in its cells, in its place, in its format, in what the set has not.
$ cat >../t <<'END'
+ output,Sofa,Floor,Wall
+ gone/a.xyz,,:foo=1 brick.jpg,none.jpg
+ -,,none.jpg,,
+ a.png,,rgb(1),rgb(2)
+ END
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t:1: no target is called 'Sofa'; the set has Floor, Wall
! retex-combine: error: ../t:2: no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize
! retex-combine: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:2: the folder of gone/a.xyz is not there; --mkdir makes it
! retex-combine: error: ../t:2: gone/a.xyz: no picture format that can be written has the ending .xyz; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
! retex-combine: error: ../t:3: more cells than the first row has
! retex-combine: error: ../t:3: a table cannot write to standard output
! retex-combine: error: ../t:3: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:4: colour 'rgb(1)': expected rgb(r,g,b) with three numbers
! retex-combine: error: ../t:4: colour 'rgb(2)': expected rgb(r,g,b) with three numbers
= 2

# With --keep-going the rows with mistakes alone are left out: wrong cells, images, places. Others, such as the second with
# the same image, are made. It is told before, and the exit status is 2. Each part of a table tells of its own rows.
$ cat >../t <<'END'
+ output,Floor,Wall
+ a.png,brick.jpg
+ b.png,none.jpg
+ c.png,none.jpg
+ d.png,:foo=1 brick.jpg
+ gone/e.png,brick.jpg
+ f.png,brick.jpg,,x
+ "g.png"x
+ a.png,brick.jpg
+ ,brick.jpg
+ h.png,,brick.jpg
+ i.png,":colorspace=Nowhere brick.jpg"
+ j.png,":colorspace=Nowhere brick.jpg"
+ END
$ retex-combine s.exr --batch ../t --keep-going --report ../report 2>../log
= 2
$ sed 's/[0-9.]* s$/S/' ../log
> retex-combine: error: ../t:3: cannot read none.jpg: No such file or directory
> retex-combine: error: ../t:4: cannot read none.jpg: No such file or directory
> retex-combine: error: ../t:5: no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize
> retex-combine: error: ../t:6: the folder of gone/e.png is not there; --mkdir makes it
> retex-combine: error: ../t:7: more cells than the first row has
> retex-combine: error: ../t:8: something follows a closing quote
> retex-combine: error: ../t:9: a.png: the output of the table's line 2 and the output of the table's line 9 are the same file
> retex-combine: error: ../t:10: no output in the first cell
> retex-combine: error: ../t:12: brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
> retex-combine: error: ../t:13: brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
> retex-combine: a.png: Floor <- brick.jpg, 48 x 32, S
> retex-combine: h.png: Wall <- brick.jpg, 48 x 32, S
> retex-combine: error: 10 of 12 pictures failed
$ without_times <../report | sed '1,3d'
>   "mistakes": [
>     {"line": 3, "error": "cannot read none.jpg: No such file or directory"},
>     {"line": 4, "error": "cannot read none.jpg: No such file or directory"},
>     {"line": 5, "error": "no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize"},
>     {"line": 6, "error": "the folder of gone/e.png is not there; --mkdir makes it"},
>     {"line": 7, "error": "more cells than the first row has"},
>     {"line": 8, "error": "something follows a closing quote"},
>     {"line": 9, "error": "a.png: the output of the table's line 2 and the output of the table's line 9 are the same file"},
>     {"line": 10, "error": "no output in the first cell"},
>     {"line": 12, "error": "brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw"},
>     {"line": 13, "error": "brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw"}
>   ],
>   "rows": [
>     {"row": 1, "line": 2, "output": "a.png", "status": "made", "seconds": S, "textures": {"Floor": "brick.jpg"}},
>     {"row": 2, "line": 3, "output": "b.png", "status": "failed", "seconds": S, "error": "cannot read none.jpg: No such file or directory"},
>     {"row": 3, "line": 4, "output": "c.png", "status": "failed", "seconds": S, "error": "cannot read none.jpg: No such file or directory"},
>     {"row": 4, "line": 5, "output": "d.png", "status": "failed", "seconds": S, "error": "no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize"},
>     {"row": 5, "line": 6, "output": "gone/e.png", "status": "failed", "seconds": S, "error": "the folder of gone/e.png is not there; --mkdir makes it"},
>     {"row": 6, "line": 7, "output": "f.png", "status": "failed", "seconds": S, "error": "more cells than the first row has"},
>     {"row": 7, "line": 8, "output": "g.png", "status": "failed", "seconds": S, "error": "something follows a closing quote"},
>     {"row": 8, "line": 9, "output": "a.png", "status": "failed", "seconds": S, "error": "a.png: the output of the table's line 2 and the output of the table's line 9 are the same file"},
>     {"row": 9, "line": 10, "output": "", "status": "failed", "seconds": S, "error": "no output in the first cell"},
>     {"row": 10, "line": 11, "output": "h.png", "status": "made", "seconds": S, "textures": {"Wall": "brick.jpg"}},
>     {"row": 11, "line": 12, "output": "i.png", "status": "failed", "seconds": S, "error": "brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw"},
>     {"row": 12, "line": 13, "output": "j.png", "status": "failed", "seconds": S, "error": "brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw"}
>   ]
> }
$ ls -A | diff ../before - | grep '^>'
> > a.png
> > h.png
$ retex-combine -q s.exr --texture floor=brick.jpg -o ../one.png
$ cmp a.png ../one.png
$ rm a.png h.png
$ for k in 1 2 3 4; do
+     retex-combine s.exr --batch ../t --keep-going --progress json --shard $k/4 2>&1 | without_times
+ done
> retex-combine: error: ../t:3: cannot read none.jpg: No such file or directory
> retex-combine: error: ../t:4: cannot read none.jpg: No such file or directory
> {"row": 2, "line": 3, "output": "b.png", "status": "failed", "seconds": S, "error": "cannot read none.jpg: No such file or directory", "done": 1, "total": 3}
> {"row": 3, "line": 4, "output": "c.png", "status": "failed", "seconds": S, "error": "cannot read none.jpg: No such file or directory", "done": 2, "total": 3}
> {"row": 1, "line": 2, "output": "a.png", "status": "made", "seconds": S, "done": 3, "total": 3}
> retex-combine: error: 2 of 3 pictures failed
> {"total": 3, "made": 1, "failed": 2, "seconds": S}
> retex-combine: error: ../t:5: no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize
> retex-combine: error: ../t:6: the folder of gone/e.png is not there; --mkdir makes it
> retex-combine: error: ../t:7: more cells than the first row has
> {"row": 4, "line": 5, "output": "d.png", "status": "failed", "seconds": S, "error": "no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize", "done": 1, "total": 3}
> {"row": 5, "line": 6, "output": "gone/e.png", "status": "failed", "seconds": S, "error": "the folder of gone/e.png is not there; --mkdir makes it", "done": 2, "total": 3}
> {"row": 6, "line": 7, "output": "f.png", "status": "failed", "seconds": S, "error": "more cells than the first row has", "done": 3, "total": 3}
> retex-combine: error: 3 of 3 pictures failed
> {"total": 3, "made": 0, "failed": 3, "seconds": S}
> retex-combine: error: ../t:8: something follows a closing quote
> retex-combine: error: ../t:9: a.png: the output of the table's line 2 and the output of the table's line 9 are the same file
> retex-combine: error: ../t:10: no output in the first cell
> {"row": 7, "line": 8, "output": "g.png", "status": "failed", "seconds": S, "error": "something follows a closing quote", "done": 1, "total": 3}
> {"row": 8, "line": 9, "output": "a.png", "status": "failed", "seconds": S, "error": "a.png: the output of the table's line 2 and the output of the table's line 9 are the same file", "done": 2, "total": 3}
> {"row": 9, "line": 10, "output": "", "status": "failed", "seconds": S, "error": "no output in the first cell", "done": 3, "total": 3}
> retex-combine: error: 3 of 3 pictures failed
> {"total": 3, "made": 0, "failed": 3, "seconds": S}
> retex-combine: error: ../t:12: brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
> retex-combine: error: ../t:13: brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
> {"row": 11, "line": 12, "output": "i.png", "status": "failed", "seconds": S, "error": "brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw", "done": 1, "total": 3}
> {"row": 12, "line": 13, "output": "j.png", "status": "failed", "seconds": S, "error": "brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw", "done": 2, "total": 3}
> {"row": 10, "line": 11, "output": "h.png", "status": "made", "seconds": S, "done": 3, "total": 3}
> retex-combine: error: 2 of 3 pictures failed
> {"total": 3, "made": 1, "failed": 2, "seconds": S}
$ rm a.png h.png
$ retex-combine -q s.exr --batch ../t --keep-going --rows 10-10
$ rm h.png
$ retex-combine s.exr --batch ../t --keep-going --dry-run
> a.png: Floor <- brick.jpg
> h.png: Wall <- brick.jpg
! retex-combine: error: ../t:3: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:4: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:5: no texture option is called 'foo'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize
! retex-combine: error: ../t:6: the folder of gone/e.png is not there; --mkdir makes it
! retex-combine: error: ../t:7: more cells than the first row has
! retex-combine: error: ../t:8: something follows a closing quote
! retex-combine: error: ../t:9: a.png: the output of the table's line 2 and the output of the table's line 9 are the same file
! retex-combine: error: ../t:10: no output in the first cell
! retex-combine: error: ../t:12: brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
! retex-combine: error: ../t:13: brick.jpg: no colour space is called 'Nowhere'; there are Linear Rec.709, sRGB, Rec709, ACES2065-1, ACEScg, ACEScct, raw
! retex-combine: error: 10 of 12 pictures failed
= 2
$ retex-combine s.exr --batch ../t --keep-going --plan 2>/dev/null | sed 's/about.*//'
> rows 1 to 12 of 12: 2 to make, 0 kept
> to make:
$ sed -i 's/Floor/Sofa/' ../t
$ retex-combine s.exr --batch ../t --keep-going 2>&1 | head -1
> retex-combine: error: ../t:1: no target is called 'Sofa'; the set has Floor, Wall
$ new_files
$ printf '%s\n' output,Floor a.png,none.jpg b.png,none.jpg >../t
$ retex-combine s.exr --batch ../t --keep-going
! retex-combine: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:3: cannot read none.jpg: No such file or directory
! retex-combine: error: 2 of 2 pictures failed
= 2
$ printf '%s\n' output,Floor a.png,brick.jpg >../t
$ retex-combine -q s.exr --batch ../t --keep-going
$ rm a.png
# The output of a row with a mistake may be that of another row.
$ printf '%s\n' output,Floor a.png,none.jpg a.png,brick.jpg '"a.png"x' >../t
$ retex-combine -q s.exr --batch ../t --keep-going
! retex-combine: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-combine: error: ../t:2: a.png: the output of the table's line 3 and the output of the table's line 2 are the same file
! retex-combine: error: ../t:4: something follows a closing quote
! retex-combine: error: ../t:4: a.png: the output of the table's line 3 and the output of the table's line 4 are the same file
! retex-combine: error: 2 of 3 pictures failed
= 2
$ rm a.png
# Such rows are made later by --resume, and --verify knows them.
$ printf '%s\n' output,Floor a.png,brick.jpg b.png,../late.jpg c.png,,, >../t
$ retex-combine -q s.exr --batch ../t --keep-going --manifest ../m
! retex-combine: error: ../t:3: cannot read ../late.jpg: No such file or directory
! retex-combine: error: ../t:4: more cells than the first row has
! retex-combine: error: 2 of 3 pictures failed
= 2
$ retex-combine s.exr --batch ../t --keep-going --manifest ../m --verify
> b.png: stale: cannot read ../late.jpg: No such file or directory
> 1 of 3 pictures good; 1 stale
! retex-combine: error: ../t:4: more cells than the first row has
! retex-combine: error: 1 of 3 pictures failed
= 2
$ cp brick.jpg ../late.jpg
$ retex-combine -q s.exr --batch ../t --keep-going --manifest ../m --resume
! retex-combine: error: ../t:4: more cells than the first row has
! retex-combine: error: 1 of 3 pictures failed
= 2
$ ls ?.png
> a.png
> b.png
$ cut -d, -f1 ../m
> {"output": "a.png"
> {"output": "b.png"
$ rm ?.png ../m

# Tables of semicolons and of tabs, as spreadsheets write them; others that they write are named.
$ printf 'output;Floor;"Wall"\r\na.png;rgb(1,0,0);:scale=2,3 brick.jpg\r\n"b;1.png";;brick.jpg\r\n' >../t
$ retex-combine s.exr --batch ../t --dry-run
> a.png: Floor <- rgb(1,0,0), Wall <- brick.jpg
> b;1.png: Wall <- brick.jpg
$ printf '\357\273\277"output"\tFloor\tWall\na.png\trgb(1,0,0)\t\nb,;.png\t"brick.jpg"\n' >../t
$ retex-combine s.exr --batch ../t --dry-run
> a.png: Floor <- rgb(1,0,0)
> b,;.png: Floor <- brick.jpg
$ printf 'output\n"a;b.png"\n' >../t
$ retex-combine s.exr --batch ../t --dry-run
> a;b.png: original textures
$ printf '\377\376o\0u\0t\0' >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t: the table is UTF-16 text; save it as UTF-8
= 2
$ printf 'PK\3\4\0\0' >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t: not a table of text but a spreadsheet's own file; save it as CSV
= 2
$ printf 'output\0' >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t: not a table: it holds NUL bytes
= 2
$ printf 'Ausgabe;Floor\n' >../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t:1: the first row must name the columns: output, then targets
= 2
$ new_files

# What would be made.
$ cat >../t <<'END'
+ output,Floor,wall
+ out/new/a.png,brick.jpg,:scale=2 brick.jpg
+ "b,1.png","rgb(.5,1,1)"
+ c.jpg
+ END
$ retex-combine s.exr --batch ../t --mkdir --dry-run --texture 'wall=rgb(1,0,0)'
> out/new/a.png: Floor <- brick.jpg, Wall <- brick.jpg
> b,1.png: Floor <- rgb(0.5,1,1), Wall <- rgb(1,0,0)
> c.jpg: Wall <- rgb(1,0,0)
$ new_files
$ retex-combine s.exr --batch ../t --mkdir --dry-run -q
$ retex-combine s.exr --batch ../t --dry-run
! retex-combine: error: ../t:2: the folder of out/new/a.png is not there; --mkdir makes it
= 2
$ retex-combine s.exr --batch ../t --mkdir --dry-run --report - | head -1
! retex-combine: error: --dry-run and --report cannot both be standard output
$ new_files

# Line ends of other systems, a byte order mark, line ends in cells; control characters do not reach the terminal.
$ b='\357\273\277output,"floor"\r\n\r\n"a\n\033[1m.png","rgb(1,0,0)"\r\n'
+ printf "$b\"b\n.nope\"" >../odd
+ retex-combine s.exr --batch ../odd
+ printf "$b\"b\n\"\".png\",brick.jpg" >../odd
! retex-combine: error: ../odd:5: b?.nope: no picture format that can be written has the ending .nope; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
$ retex-combine s.exr --batch ../odd --dry-run
> a??[1m.png: Floor <- rgb(1,0,0)
> b?".png: Floor <- brick.jpg

# Made, with folders where they are missing, and told as JSON. The report has the rest.
$ retex-combine s.exr --batch ../t --mkdir --texture 'wall=rgb(1,0,0)' --progress json --report ../report 2>../log
$ without_times <../log
> {"row": 1, "line": 2, "output": "out/new/a.png", "status": "made", "seconds": S, "done": 1, "total": 3}
> {"row": 2, "line": 3, "output": "b,1.png", "status": "made", "seconds": S, "done": 2, "total": 3}
> {"row": 3, "line": 4, "output": "c.jpg", "status": "made", "seconds": S, "done": 3, "total": 3}
> {"total": 3, "made": 3, "failed": 0, "seconds": S}
$ without_times <../report
> {
>   "tool": "retex-combine", "version": "0.1.0", "table": "../t",
>   "status": "made", "total": 3, "made": 3, "failed": 0, "seconds": S,
>   "mistakes": [],
>   "rows": [
>     {"row": 1, "line": 2, "output": "out/new/a.png", "status": "made", "seconds": S, "textures": {"Floor": "brick.jpg", "Wall": "brick.jpg"}},
>     {"row": 2, "line": 3, "output": "b,1.png", "status": "made", "seconds": S, "textures": {"Floor": "rgb(0.5,1,1)", "Wall": "rgb(1,0,0)"}},
>     {"row": 3, "line": 4, "output": "c.jpg", "status": "made", "seconds": S, "textures": {"Wall": "rgb(1,0,0)"}}
>   ]
> }
$ new_files
> 0a1
> > b,1.png
> 1a3,4
> > c.jpg
> > out
= 1
$ retex-combine -q s.exr --texture floor=brick.jpg --texture:scale=2 wall=brick.jpg -o ../one.png
$ cmp out/new/a.png ../one.png
$ rm -r out b,1.png c.jpg
$ retex-combine -q s.exr --texture floor=brick.jpg -o ../one.png --progress json 2>&1 | without_times
> {"output": "../one.png", "status": "made", "seconds": S, "done": 1, "total": 1}
$ retex-combine -q s.exr -o ../one.png --progress xml
! retex-combine: error: --progress: expected json, not 'xml'
= 2

# The report of a table with mistakes, and of one that was only looked at.
$ printf 'output,floor\na.png,none.jpg\nb.png,brick.jpg\n' >../t
$ retex-combine s.exr --batch ../t --report ../report
! retex-combine: error: ../t:2: cannot read none.jpg: No such file or directory
= 2
$ without_times <../report
> {
>   "tool": "retex-combine", "version": "0.1.0", "table": "../t",
>   "status": "failed", "total": 2, "made": 0, "failed": 0, "seconds": S,
>   "mistakes": [
>     {"line": 2, "error": "cannot read none.jpg: No such file or directory"}
>   ],
>   "rows": [
>     {"row": 1, "line": 2, "output": "a.png", "status": "not made", "seconds": S},
>     {"row": 2, "line": 3, "output": "b.png", "status": "not made", "seconds": S}
>   ]
> }
$ printf 'output,floor\nb.png,brick.jpg\n' >../t
$ retex-combine -q s.exr --batch ../t --report ../report --dry-run
$ without_times <../report
> {
>   "tool": "retex-combine", "version": "0.1.0", "table": "../t",
>   "status": "checked", "total": 1, "made": 0, "failed": 0, "seconds": S,
>   "mistakes": [],
>   "rows": [
>     {"row": 1, "line": 2, "output": "b.png", "status": "checked", "seconds": S, "textures": {"Floor": "brick.jpg"}}
>   ]
> }
$ new_files

# It is an output as others are.
$ printf 'output,floor\nb.png,brick.jpg\n' >../t
+ for f in s.exr brick.jpg b.png ../t gone/r /dev/full; do
+     retex-combine -q s.exr --batch ../t --report $f
+     echo $?
+     rm -f b.png
+ done
> 2
> 2
> 2
> 2
> 2
> 2
! retex-combine: error: s.exr: --report would replace the set
! retex-combine: error: brick.jpg: --report would replace the texture
! retex-combine: error: b.png: the output of the table's line 2 and --report are the same file
! retex-combine: error: ../t: --report would replace the table
! retex-combine: error: --report: cannot write gone/r: No such file or directory
! retex-combine: error: --report: cannot write /dev/full: No space left on device
$ new_files
$ retex-combine -q s.exr --batch ../t --dry-run --report -
! retex-combine: error: --dry-run and --report cannot both be standard output
= 2

# Names that are no UTF-8, and of control characters.
$ printf 'output,floor\n"a\301\200\303\251\377\n""b.png","rgb(1,0,0)"\n' >../t
$ retex-combine -q s.exr --batch ../t --report ../report
$ grep -a output ../report | cut -d , -f 3
>  "output": "a��é�\n\"b.png"
$ rm a*

# Pictures that fail when they are made: the first ends the batch, unless --keep-going. A texture that could not be loaded
# is not taken for the next row's, one beside it is.
$ head -c 20000 brick.jpg >../cut.jpg
$ cat >../t <<'END'
+ output,floor,wall
+ a.png,brick.jpg
+ b.png,brick.jpg,../cut.jpg
+ again.png,,../cut.jpg
+ c.png,brick.jpg
+ /dev/full,brick.jpg
+ d.png,,brick.jpg
+ END
$ retex-combine s.exr --batch ../t --report ../report 2>&1 | sed 's/[0-9.]* s$/S/'
> retex-combine: a.png: Floor <- brick.jpg, 48 x 32, S
> retex-combine: error: ../t:3: ../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)
$ without_times <../report | sed 1,4d
>   "rows": [
>     {"row": 1, "line": 2, "output": "a.png", "status": "made", "seconds": S, "textures": {"Floor": "brick.jpg"}},
>     {"row": 2, "line": 3, "output": "b.png", "status": "failed", "seconds": S, "error": "../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)", "textures": {"Floor": "brick.jpg", "Wall": "../cut.jpg"}},
>     {"row": 3, "line": 4, "output": "again.png", "status": "not made", "seconds": S, "textures": {"Wall": "../cut.jpg"}},
>     {"row": 4, "line": 5, "output": "c.png", "status": "not made", "seconds": S, "textures": {"Floor": "brick.jpg"}},
>     {"row": 5, "line": 6, "output": "/dev/full", "status": "not made", "seconds": S, "textures": {"Floor": "brick.jpg"}},
>     {"row": 6, "line": 7, "output": "d.png", "status": "not made", "seconds": S, "textures": {"Wall": "brick.jpg"}}
>   ]
> }
$ new_files
> 0a1
> > a.png
= 1
$ rm a.png
$ for n in 1 2; do
+     retex-combine s.exr --batch ../t --keep-going --threads $n --progress json 2>../log
+     echo $?
+ done
> 2
> 2
$ without_times <../log
> {"row": 1, "line": 2, "output": "a.png", "status": "made", "seconds": S, "done": 1, "total": 6}
> retex-combine: error: ../t:3: ../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)
> {"row": 2, "line": 3, "output": "b.png", "status": "failed", "seconds": S, "error": "../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)", "done": 2, "total": 6}
> retex-combine: error: ../t:4: ../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)
> {"row": 3, "line": 4, "output": "again.png", "status": "failed", "seconds": S, "error": "../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)", "done": 3, "total": 6}
> {"row": 4, "line": 5, "output": "c.png", "status": "made", "seconds": S, "done": 4, "total": 6}
> retex-combine: error: ../t:6: cannot write /dev/full: No space left on device
> {"row": 5, "line": 6, "output": "/dev/full", "status": "failed", "seconds": S, "error": "cannot write /dev/full: No space left on device", "done": 5, "total": 6}
> {"row": 6, "line": 7, "output": "d.png", "status": "made", "seconds": S, "done": 6, "total": 6}
> retex-combine: error: 3 of 6 pictures failed
> {"total": 6, "made": 3, "failed": 3, "seconds": S}
$ new_files
> 0a1
> > a.png
> 1a3,4
> > c.png
> > d.png
= 1
$ retex-combine -q s.exr --texture floor=brick.jpg -o ../one.png
$ cmp c.png ../one.png
$ cmp a.png ../one.png
$ rm ?.png

# Files that go while the batch runs, which waits for the first image to be written.
$ mkfifo ../pipe
$ cp brick.jpg ../soon.jpg
$ mkdir out ../outside
$ cat >../t <<'END'
+ output,floor
+ a.png,../pipe
+ b.png,../soon.jpg
+ out/c.png,brick.jpg
+ d.png,brick.jpg
+ END
$ timeout 20 retex-combine -q s.exr --batch ../t --keep-going &
+ while_it_waits 'rm -r ../soon.jpg out'
+ wait $!
! retex-combine: error: ../t:3: cannot read ../soon.jpg: No such file or directory
! retex-combine: error: ../t:4: cannot write out/c.png: No such file or directory
! retex-combine: error: 2 of 4 pictures failed
= 2
$ new_files
> 0a1
> > a.png
> 1a3
> > d.png
= 1
$ rm ?.png

# Pictures stay below --batch-root, whatever they are called; they are named from there.
$ mkdir -p base/there basex
$ ln -s ../../outside base/link
$ ln -s ../../outside/x.png base/x.png
$ ln -s nowhere.png base/dangling.png
$ touch ../outside/x.png
$ printf '%s\n' output,floor ../d.png ../basex/e.png link/f.png x.png "$PWD/h.png" link/new/i.png there/../../j.png \
+     gone/../k.png >../t
$ retex-combine s.exr --batch ../t --batch-root base --mkdir 2>&1 | sed "s,$PWD,PWD,"
> retex-combine: error: ../t:2: ../d.png is not below base, as --batch-root requires
> retex-combine: error: ../t:3: ../basex/e.png is not below base, as --batch-root requires
> retex-combine: error: ../t:4: link/f.png is not below base, as --batch-root requires
> retex-combine: error: ../t:5: x.png is not below base, as --batch-root requires
> retex-combine: error: ../t:6: PWD/h.png is not below base, as --batch-root requires
> retex-combine: error: ../t:7: link/new/i.png is not below base, as --batch-root requires
> retex-combine: error: ../t:8: there/../../j.png is not below base, as --batch-root requires
> retex-combine: error: ../t:9: cannot write gone/../k.png: '..' in a folder that is not there
$ printf '%s\n' output,floor a.png ./there/../b.png new/c.png "$PWD/base/g.png" ../base/k.png dangling.png >../t
$ retex-combine -q s.exr --batch ../t --batch-root base/ --mkdir
$ find base | sort | tr '\n' ' '
> base base/a.png base/b.png base/dangling.png base/g.png base/k.png base/link base/new base/new/c.png base/there base/x.png
$ ls basex
$ rm -r base basex
$ printf 'output\na.png\n' >../t
$ retex-combine -q s.exr --batch ../t --batch-root base
! retex-combine: error: --batch-root base: no such folder
= 2
$ retex-combine -q s.exr --batch ../t --batch-root s.exr --mkdir
! retex-combine: error: --batch-root s.exr: no such folder
= 2
$ ln -s ../outside base
$ for root in base base/ base//; do retex-combine -q s.exr --batch ../t --batch-root $root --mkdir; done
! retex-combine: error: --batch-root base is a link; give the folder that it leads to
! retex-combine: error: --batch-root base/ is a link; give the folder that it leads to
! retex-combine: error: --batch-root base// is a link; give the folder that it leads to
= 2
$ ls ../outside/a.png && echo written
! ls: cannot access '../outside/a.png': No such file or directory
= 2
$ rm base
$ retex-combine -q s.exr --batch ../t --batch-root base/of/batch --mkdir --dry-run
$ retex-combine -q s.exr --batch ../t --batch-root base/of/batch --mkdir
$ find base | sort
> base
> base/of
> base/of/batch
> base/of/batch/a.png
$ rm -r base
# So do they where a folder becomes a link while the batch runs.
$ mkdir -p base/sub
$ cat >../t <<'END'
+ output,floor
+ a.png,../pipe
+ sub/b.png,brick.jpg
+ new/c.png,brick.jpg
+ sub/deep/e.png,brick.jpg
+ d.png,brick.jpg
+ END
$ timeout 20 retex-combine -q s.exr --batch ../t --keep-going --batch-root base --mkdir &
+ while_it_waits 'mv base/sub base/old; ln -s ../../outside base/sub; ln -s ../../outside base/new'
+ wait $!
+ echo $?
+ find base | sort | tr '\n' ' '
+ ls ../outside
+ rm -r base
+ new_files
> 2
> base base/a.png base/d.png base/new base/old base/sub x.png
! retex-combine: error: ../t:3: sub/b.png is not below base, as --batch-root requires
! retex-combine: error: ../t:4: new/c.png is not below base, as --batch-root requires
! retex-combine: error: ../t:5: sub/deep/e.png is not below base, as --batch-root requires
! retex-combine: error: 3 of 5 pictures failed

# A signal ends a batch, while it waits for its second row's image; the report has what was done until then.
$ printf '%s\n' output,floor a.png,brick.jpg b.png,../pipe >../t
$ retex-combine -q s.exr --batch ../t --report ../report --keep-going &
+ tool=$!
+ sh -c "sleep 20; kill -KILL $tool" 2>/dev/null &
+ late=$!
+ for k in $(seq 100); do
+     [ -e a.png ] && break
+     sleep .1
+ done
+ sleep .3
+ kill $tool
+ wait $tool 2>/dev/null
+ echo $?
+ kill $late 2>/dev/null
> 143
! retex-combine: error: ended by SIGTERM
$ without_times <../report
> {
>   "tool": "retex-combine", "version": "0.1.0", "table": "../t",
>   "status": "failed", "total": 2, "made": 1, "failed": 0, "seconds": S, "error": "ended by SIGTERM",
>   "mistakes": [],
>   "rows": [
>     {"row": 1, "line": 2, "output": "a.png", "status": "made", "seconds": S, "textures": {"Floor": "brick.jpg"}},
>     {"row": 2, "line": 3, "output": "b.png", "status": "not made", "seconds": S, "textures": {"Floor": "../pipe"}}
>   ]
> }
$ rm a.png
$ new_files

# The same bits at any number of threads and whatever is kept in memory.
$ printf '%s\n' output,floor,wall a.exr,brick.jpg b.exr,:scale=2:rotate=30\ brick.jpg,brick.jpg c.exr,,brick.jpg >../t
$ retex-combine -q s.exr --batch ../t
$ for o in '--threads 1 --memory 0' '--threads 2 --memory 0' '--threads 2'; do
+     retex-combine -q s.exr --batch ../t $o --batch-root out --mkdir
+     for f in a b c; do cmp $f.exr out/$f.exr; done
+     rm -r out
+ done
$ rm [abc].exr
$ new_files

# What several rows have on one target is filtered once, but not another placement, and not without memory. The bits are
# those of single pictures, also where memory is short. Seven textures are in several rows, of 96 rows of footprints
# each, and are wanted 28 times, twice in a row where the exposure is measured first; a colour alone is not filtered.
$ {
+     echo output,floor,wall,picture:auto-exposure
+     for f in '' ':rotate=20 '; do
+         for w in '' ':scale=3 ' ':flip=u '; do echo "f$((n += 1)).exr,${f}brick.jpg,${w}brick.jpg,yes"; done
+     done
+     for k in 7 8; do echo "f$k.exr,\"rgb(.1,.2,.3)\",:scale=5 brick.jpg,"; done
+     for k in 9 10; do echo "f$k.exr,\"rgb(.1,.2,.3) + :at=.5,.5:scale=2 brick.jpg\",:rotate=$k brick.jpg,"; done
+ } >../t
$ for m in 2048 1 0; do
+     retex-combine -v s.exr --batch ../t --batch-root m$m --mkdir --memory $m 2>&1 | grep ' found again, at most '
+ done
> retex-combine: textures that several pictures have: 672 rows of footprints filtered, 2016 found again, at most 0.2 MB kept
> retex-combine: textures that several pictures have: 672 rows of footprints filtered, 2016 found again, at most 0.2 MB kept
= 1
$ for k in $(seq 10); do
+     retex-combine -q s.exr --batch ../t --rows $k-$k --batch-root one --mkdir
+     cmp one/f$k.exr m2048/f$k.exr
+     cmp one/f$k.exr m1/f$k.exr
+     cmp one/f$k.exr m0/f$k.exr
+ done
$ rm -r one m2048 m1 m0
$ new_files

# A large table is checked at once, in little memory.
$ {
+     echo output,floor,wall
+     for k in $(seq 5000); do echo "$k.png,:rotate=$k brick.jpg,\"rgb(0,0,1)\""; done
+ } >../t
$ make_peak ../peak timeout 10 retex-combine s.exr --batch ../t --dry-run | wc -l
> 5000
$ awk '{ print ($1 < 64 ? "little" : $1) }' ../peak
> little
$ sed -i '$s/5000/1/' ../t
$ retex-combine s.exr --batch ../t
! retex-combine: error: ../t:5001: 1.png: the output of the table's line 2 and the output of the table's line 5001 are the same file
= 2

# These options are of a table.
$ for o in --dry-run --keep-going --mkdir '--batch-root .' '--report r.json'; do
+     retex-combine -q s.exr -o x.png $o
+     retex-render scenes/cornell-box/cornell-box.pov -o x.exr $o
+ done
! retex-combine: error: --dry-run needs a table of pictures: --batch
! retex-render: error: --dry-run needs a table of pictures: --variants
! retex-combine: error: --keep-going needs a table of pictures: --batch, or --frames
! retex-render: error: --keep-going needs a table of pictures: --variants, or --frames
! retex-combine: error: --mkdir needs a table of pictures: --batch
! retex-render: error: --mkdir needs a table of pictures: --variants
! retex-combine: error: --batch-root needs a table of pictures: --batch
! retex-render: error: --batch-root needs a table of pictures: --variants
! retex-combine: error: --report needs a table of pictures: --batch
! retex-render: error: --report needs a table of pictures: --variants
= 2
$ new_files

# retex-render --variants: its table is checked before the scene is read, its targets then; all is told together.
$ printf '%s\n' output,floor a/1.exr,none.jpg 2.exr,brick.jpg 2.exr '3.exr,rgb(1)' >../t
$ retex-render --size 8x6 --spp 1 --variants ../t none.pov
! retex-render: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-render: error: ../t:2: the folder of a/1.exr is not there; --mkdir makes it
! retex-render: error: ../t:4: 2.exr: the output of the table's line 3 and the output of the table's line 4 are the same file
! retex-render: error: ../t:5: colour 'rgb(1)': expected rgb(r,g,b) with three numbers
! retex-render: error: none.pov: cannot read none.pov: No such file or directory
= 2
$ printf '%s\n' output,sofa,floor,Floor 1.exr >../t
$ retex-render -t floor --size 8x6 --spp 1 --variants ../t scenes/cornell-box/cornell-box.pov
! retex-render: error: ../t:1: no target is called 'sofa'; the scene has floor; name it with -t
! retex-render: error: ../t:1: target `Floor` has two columns
= 2
$ printf '%s\n' output,sofa,stool,white 1.exr,none.jpg >../t
$ retex-render --size 8x6 --spp 1 --variants ../t scenes/cornell-box/cornell-box.pov
! retex-render: error: ../t:1: no texture, pigment, material or object `sofa` in the scene; there are: Floor, White, Red, Green, Lamp
! retex-render: error: ../t:1: no texture, pigment, material or object `stool` in the scene; there are: Floor, White, Red, Green, Lamp
! retex-render: error: ../t:2: cannot read none.jpg: No such file or directory
= 2
$ retex-render --size 8x6 --spp 1 -t white --variants ../t scenes/cornell-box/cornell-box.pov
! retex-render: error: ../t:1: no target is called 'sofa'; the scene has white; name it with -t
! retex-render: error: ../t:1: no target is called 'stool'; the scene has white; name it with -t
! retex-render: error: ../t:2: cannot read none.jpg: No such file or directory
= 2
$ new_files
$ cat >../t <<'END'
+ output,floor
+ 1.exr,none.jpg
+ 2.exr,brick.jpg
+ gone/3.exr
+ 4.exr,"rgb(1,0,0)"
+ END
$ retex-render --size 8x6 --spp 1 --variants ../t --keep-going scenes/cornell-box/cornell-box.pov 2>&1 |
+     sed 's/: [0-9.]* s$//'
> retex-render: error: ../t:2: cannot read none.jpg: No such file or directory
> retex-render: error: ../t:4: the folder of gone/3.exr is not there; --mkdir makes it
> retex-render: 2 pictures, 1 samples
> retex-render: error: 2 of 4 pictures failed
$ ls -A | diff ../before - | grep '^>'
> > 2.exr
> > 4.exr
$ rm 2.exr 4.exr
$ retex-render -q --size 8x6 --spp 1 --variants ../t --keep-going --dry-run scenes/cornell-box/cornell-box.pov
! retex-render: error: ../t:2: cannot read none.jpg: No such file or directory
! retex-render: error: ../t:4: the folder of gone/3.exr is not there; --mkdir makes it
! retex-render: error: 2 of 4 pictures failed
= 2
$ {
+     echo output,floor
+     for k in $(seq 17); do echo "out/$k.exr,\"rgb(0.$k,0.5,0)\""; done
+     echo 18.exr,../cut.jpg
+     echo /dev/full,
+     echo 19.exr
+ } >../t
$ retex-render --size 8x6 --spp 1 --variants ../t --mkdir --dry-run \
+     --replace white=brick.jpg scenes/cornell-box/cornell-box.pov | tail -4
> out/17.exr: floor <- rgb(0.17,0.5,0), white <- brick.jpg
> 18.exr: floor <- ../cut.jpg, white <- brick.jpg
> /dev/full: white <- brick.jpg
> 19.exr: white <- brick.jpg
$ new_files
$ retex-render --size 8x6 --spp 1 --variants ../t --mkdir --progress json scenes/cornell-box/cornell-box.pov 2>&1 |
+     grep -v stage | tail -3 | without_times
> retex-render: error: ../t:19: ../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)
> {"row": 18, "line": 19, "output": "18.exr", "status": "failed", "seconds": S, "error": "../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)", "done": 17, "total": 20}
> {"total": 20, "made": 16, "failed": 1, "seconds": S}
$ new_files
> 1a2
> > out
= 1
$ rm -r out
$ retex-render -q --size 8x6 --spp 1 --variants ../t --mkdir --keep-going --report ../report \
+     --threads 1 scenes/cornell-box/cornell-box.pov
! retex-render: error: ../t:19: ../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)
! retex-render: error: ../t:20: cannot write /dev/full: No space left on device
! retex-render: error: 2 of 20 pictures failed
= 2
$ tail -5 ../report | without_times
>     {"row": 18, "line": 19, "output": "18.exr", "status": "failed", "seconds": S, "error": "../cut.jpg: cannot read: the file is truncated (--accept-damaged reads it)", "textures": {"floor": "../cut.jpg"}},
>     {"row": 19, "line": 20, "output": "/dev/full", "status": "failed", "seconds": S, "error": "cannot write /dev/full: No space left on device", "textures": {}},
>     {"row": 20, "line": 21, "output": "19.exr", "status": "made", "seconds": S, "textures": {}}
>   ]
> }
$ ls out | wc -l
> 17
$ new_files
> 0a1
> > 19.exr
> 1a3
> > out
= 1
$ retex-render -q --size 8x6 --spp 1 --plain scenes/cornell-box/cornell-box.pov -o plain.exr
$ cmp plain.exr 19.exr
$ rm -r out plain.exr 19.exr
$ printf 'output,floor\n1.exr\n' >../t
$ echo '#include "none.inc"' >wrong.pov
$ echo 'A' >part.inc
$ for r in report here/wrong.pov here/part.inc; do
+     retex-render -q --size 8x6 --spp 1 --variants ../t --report ../$r wrong.pov
+ done
! retex-render: error: wrong.pov:1:10: cannot find the file `none.inc` in the scene's folder or the include path
! retex-render: error: ../here/wrong.pov: --report would replace the scene, wrong.pov
! retex-render: error: wrong.pov:1:10: cannot find the file `none.inc` in the scene's folder or the include path
= 2
$ without_times <../report
> {
>   "tool": "retex-render", "version": "0.1.0", "table": "../t",
>   "status": "failed", "total": 1, "made": 0, "failed": 0, "seconds": S, "error": "wrong.pov:1:10: cannot find the file `none.inc` in the scene's folder or the include path",
>   "mistakes": [],
>   "rows": [
>     {"row": 1, "line": 2, "output": "1.exr", "status": "not made", "seconds": S, "textures": {}}
>   ]
> }
$ cat wrong.pov part.inc
> #include "none.inc"
> A
$ rm wrong.pov part.inc
$ retex-render -q --size 8x6 --spp 1 --variants ../t --report ../report \
+     --replace floor=none.jpg scenes/cornell-box/cornell-box.pov
! retex-render: error: cannot read none.jpg: No such file or directory
= 2
$ without_times <../report | grep -v row
> {
>   "tool": "retex-render", "version": "0.1.0", "table": "../t",
>   "status": "failed", "total": 1, "made": 0, "failed": 0, "seconds": S, "error": "cannot read none.jpg: No such file or directory",
>   "mistakes": [],
>   ]
> }
$ printf '%s\n' output,floor sub/1.exr ../2.exr >../t
$ retex-render -q --size 8x6 --spp 1 --variants ../t --batch-root out --mkdir scenes/cornell-box/cornell-box.pov
! retex-render: error: ../t:3: cannot write ../2.exr: '..' in a folder that is not there
= 2
$ sed -i 3d ../t
$ retex-render -q --size 8x6 --spp 1 --variants ../t --batch-root out --mkdir scenes/cornell-box/cornell-box.pov
$ find out
> out
> out/sub
> out/sub/1.exr
$ retex-render -q --size 64x48 --spp 64 --progress json -t floor scenes/cornell-box/cornell-box.pov -o x.exr 2>&1 |
+     tail -1 | sed 's/[0-9.]*}/S}/'
> {"stage": "render", "fraction": 1.0000, "seconds": S}
