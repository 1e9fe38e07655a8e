# Messages that name what was probably meant: words much like others, a brace that is missing, an option that was
# forgotten.
$ for c in 'combine --txture a=b s.exr' 'combine --qual 3' 'combine --Texture a=b' 'render -spp 3' \
+     'render --lis-targets' 'render --sedd 3' 'info --josn' 'diff --fail-psrn 3' 'denoise --no-footprnts' \
+     'pack --loseless' 'sample --thread 3' 'render -Q' 'combine -O x' 'render --zzzzzz' 'render --s' 'render -z'; do
+     retex-$c
+ done
! retex-combine: error: unknown option --txture; is --texture meant?
! retex-combine: error: unknown option --qual; is --quality meant?
! retex-combine: error: unknown option --Texture; is --texture meant?
! retex-render: error: unknown option -s; is --spp meant?
! retex-render: error: unknown option --lis-targets; is --list-targets meant?
! retex-render: error: unknown option --sedd; is --seed meant?
! retex-info: error: unknown option --josn; is --json meant?
! retex-diff: error: unknown option --fail-psrn; is --fail-psnr meant?
! retex-denoise: error: unknown option --no-footprnts; is --no-footprints meant?
! retex-pack: error: unknown option --loseless; is --lossless meant?
! retex-sample: error: unknown option --thread; is --threads meant?
! retex-render: error: unknown option -Q; is -q meant?
! retex-combine: error: unknown option -O; is -o meant?
! retex-render: error: unknown option --zzzzzz; try --help
! retex-render: error: unknown option --s; try --help
! retex-render: error: unknown option -z; try --help
= 2

# Names by which other programs know an option, and other tools of retex.
$ for o in samples width height resolution bounces crop-window output-file out input scene jobs nthreads memory-limit \
+     timeout include-path define debug silent usage texture frame-start batch just-print continue denoiser aovs; do
+     retex-render --$o 3
+ done
! retex-render: error: unknown option --samples; is --spp meant?
! retex-render: error: unknown option --width; is --size WxH meant?
! retex-render: error: unknown option --height; is --size WxH meant?
! retex-render: error: unknown option --resolution; is --size WxH meant?
! retex-render: error: unknown option --bounces; is --max-depth meant?
! retex-render: error: unknown option --crop-window; is --crop X,Y,W,H meant?
! retex-render: error: unknown option --output-file; is --output meant?
! retex-render: error: unknown option --out; is --output meant?
! retex-render: error: unknown option --input; what it reads is named without an option: retex-render [options] SCENE.pov|FILE.ini
! retex-render: error: unknown option --scene; what it reads is named without an option: retex-render [options] SCENE.pov|FILE.ini
! retex-render: error: unknown option --jobs; is --threads meant?
! retex-render: error: unknown option --nthreads; is --threads meant?
! retex-render: error: unknown option --memory-limit; is --max-memory meant?
! retex-render: error: unknown option --timeout; is --max-time meant?
! retex-render: error: unknown option --include-path; is --include meant?
! retex-render: error: unknown option --define; is --declare meant?
! retex-render: error: unknown option --debug; is --verbose meant?
! retex-render: error: unknown option --silent; is --quiet meant?
! retex-render: error: unknown option --usage; is --help meant?
! retex-render: error: unknown option --texture; is --replace meant?
! retex-render: error: unknown option --frame-start; is --frames A-B meant?
! retex-render: error: unknown option --batch; is --variants meant?
! retex-render: error: unknown option --just-print; is --dry-run meant?
! retex-render: error: unknown option --continue; is --resume meant?
! retex-render: error: unknown option --denoiser; is --denoise meant?
! retex-render: error: unknown option --aovs; is --aov meant?
= 2
$ for o in t target replace map variants input set samples spp width jobs force format frame; do
+     retex-combine --$o x=y s.exr
+ done
! retex-combine: error: unknown option --t; is --texture NAME=IMAGE meant?
! retex-combine: error: unknown option --target; is --texture NAME=IMAGE meant?
! retex-combine: error: unknown option --replace; is --texture meant?
! retex-combine: error: unknown option --map; is --texture meant?
! retex-combine: error: unknown option --variants; is --batch meant?
! retex-combine: error: unknown option --input; what it reads is named without an option: retex-combine SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE
! retex-combine: error: unknown option --set; what it reads is named without an option: retex-combine SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE
! retex-combine: error: unknown option --samples; what it reads is named without an option: retex-combine SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE
! retex-combine: error: unknown option --spp; retex-render decides this when it renders
! retex-combine: error: unknown option --width; is --size WxH meant?
! retex-combine: error: unknown option --jobs; is --threads meant?
! retex-combine: error: unknown option --force; a file that exists is replaced when the new one is complete
! retex-combine: error: unknown option --format; the format follows the ending of the output's name
! retex-combine: error: unknown option --frame; is --frames A-B meant?
= 2
$ for c in 'combine -t floor=oak.jpg' 'sample -t floor' 'denoise -t floor' 'combine -i s.exr' 'render -i s.pov' \
+     'combine -j8' 'render -W640' 'render -y' 'import -t x' 'import --force' 'pack --input s.exr' 'info -i s.exr' \
+     'diff --tolerance .1' 'serve -p 80' 'serve --host x' 'pack --texture a=b' 'denoise --samples 3' \
+     'info --display x' 'combine -f' 'render -n'; do
+     retex-$c
+ done
! retex-combine: error: unknown option -t; is --texture NAME=IMAGE meant?
! retex-sample: error: unknown option -t; is --texture NAME=IMAGE meant?
! retex-denoise: error: unknown option -t; targets are chosen when retex-render renders
! retex-combine: error: unknown option -i; what it reads is named without an option: retex-combine SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE
! retex-render: error: unknown option -i; what it reads is named without an option: retex-render [options] SCENE.pov|FILE.ini
! retex-combine: error: unknown option -j; is --threads meant?
! retex-render: error: unknown option -W; is --size WxH meant?
! retex-render: error: unknown option -y; a file that exists is replaced when the new one is complete
! retex-import: error: unknown option -t; targets are chosen when retex-render renders
! retex-import: error: no model given
! retex-pack: error: unknown option --input; what it reads is named without an option: retex-pack SET [--quality 1..100 | --lossless] -o FILE.retex
! retex-info: error: unknown option -i; what it reads is named without an option: retex-info SET [--json] [--check] [--layers FILE.exr] [-o FILE]
! retex-diff: error: unknown option --tolerance; is --fail-abs meant?
! retex-serve: error: unknown option -p; is --port meant?
! retex-serve: error: unknown option --host; is --listen meant?
! retex-pack: error: unknown option --texture; retex-sample and retex-combine put textures on a set
! retex-denoise: error: unknown option --samples; what it reads is named without an option: retex-denoise SET [--strength F] [--radius N] [--other-half FILE] -o SET
! retex-info: error: unknown option --display; retex-combine makes pictures for a display
! retex-combine: error: unknown option -f; a file that exists is replaced when the new one is complete
! retex-render: error: unknown option -n; is --dry-run meant?
= 2
$ for t in diff pack sample combine denoise info render; do
+     retex-$t --help >long
+     retex-$t -h | cmp - long
+     retex-$t -V
+ done
> retex-diff 0.1.0
> retex-pack 0.1.0
> retex-sample 0.1.0
> retex-combine 0.1.0
> retex-denoise 0.1.0
> retex-info 0.1.0
> retex-render 0.1.0
# Targets, layouts, AOVs and options of textures.
$ make_set s.exr 48 32
$ cp "$SCENES/textures/brick.jpg" t.jpg
$ cat >box.pov <<'END'
+ camera { location -4*z }
+ light_source { -9*z rgb 1 }
+ #declare Floor = texture { pigment { rgb 1 } }
+ #declare White = pigment { rgb 1 }
+ plane { y, -1 texture { Floor } }
+ sphere { 0, 1 pigment { White } }
+ END
$ for x in 'flor=t.jpg' 'Wal=t.jpg' 'Sofa=t.jpg'; do
+     retex-combine s.exr --texture $x -o x.png
+     retex-sample s.exr --texture $x -o x.exr
+ done
! retex-combine: error: no target is called 'flor'; the set has Floor, Wall; is Floor meant?
! retex-sample: error: no target is called 'flor'; the set has Floor, Wall; is Floor meant?
! retex-combine: error: no target is called 'Wal'; the set has Floor, Wall; is Wall meant?
! retex-sample: error: no target is called 'Wal'; the set has Floor, Wall; is Wall meant?
! retex-combine: error: no target is called 'Sofa'; the set has Floor, Wall
! retex-sample: error: no target is called 'Sofa'; the set has Floor, Wall
= 2
$ for x in scal=2 rotat=30 warp=mirror colourspace=sRGB zzz=1; do
+     retex-combine s.exr --texture:$x floor=t.jpg -o x.png
+ done
! retex-combine: error: no texture option is called 'scal'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize; is scale meant?
! retex-combine: error: no texture option is called 'rotat'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize; is rotate meant?
! retex-combine: error: no texture option is called 'warp'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize; is wrap meant?
! retex-combine: error: no texture option is called 'colourspace'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize; is colorspace meant?
! retex-combine: error: no texture option is called 'zzz'; there are scale, rotate, offset, flip, wrap, repeat, width, colorspace, finish, normal, grout, groutcolor, vary, tiles, at, hue, saturation, gain, gamma, contrast, blur, invert, tint, colorize
= 2
$ for x in dpeth depth,nromal smell; do retex-render --size 8x6 --aov $x box.pov -o x.exr; done 2>&1 |
+     sed 's/expected beauty, [a-z_, ]*, not/expected LIST, not/'
> retex-render: error: --aov: expected LIST, not `dpeth`; is depth meant?
> retex-render: error: --aov: expected LIST, not `nromal`; is normal meant?
> retex-render: error: --aov: expected LIST, not `smell`
$ for x in '--layout footprnts' '--layout papre' '--layout cubist' '--filter bx' '--control-mode unbaised' '-t flor' \
+     '-t Wihte' '-t sofa' '-t Floor --replace flor=t.jpg'; do
+     retex-render --size 8x6 $x box.pov -o x.exr
+ done
! retex-render: error: --layout: expected footprints or paper, not `footprnts`; is footprints meant?
! retex-render: error: --layout: expected footprints or paper, not `papre`; is paper meant?
! retex-render: error: --layout: expected footprints or paper, not `cubist`
! retex-render: error: --filter: expected box or gaussian, not `bx`
! retex-render: error: --control-mode: expected unbiased, halves or biased, not `unbaised`; is unbiased meant?
! retex-render: error: no texture, pigment, material or object `flor` in the scene; similar: Floor
! retex-render: error: no texture, pigment, material or object `Wihte` in the scene; similar: White
! retex-render: error: no texture, pigment, material or object `sofa` in the scene; there are: Floor, White
! retex-render: error: --replace: no target is called 'flor'; the scene has Floor; is Floor meant?
= 2
$ printf 'output,flor\nx.png,t.jpg\n' | retex-render -t Floor --variants - box.pov
! retex-render: error: standard input:1: no target is called 'flor'; the scene has Floor; is Floor meant?
= 2
# Of a crop its own pixels count.
$ retex-render -q --max-pixels 600 --size 100x100 --crop 0,0,100,5 --spp 1 box.pov -o x.exr && rm x.exr
$ retex-render -q --max-pixels 400 --size 100x100 --crop 0,0,5,100 --spp 1 box.pov -o x.exr
! retex-render: error: 5x100 pixels are more than the 400 of --max-pixels
= 2
$ retex-diff s.exr s.exr --part beuaty; retex-diff s.exr s.exr --part zzzzzzz
! retex-diff: error: neither file has a part 'beuaty'; is beauty meant?
! retex-diff: error: neither file has a part 'zzzzzzz'
= 2
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

# An option that was forgotten: nothing is written.
$ for c in 'combine s.exr x.png' 'combine s.exr x.exr' 'combine s.exr t.jpg' 'combine s.exr s.exr' \
+     'combine s.exr floor=t.jpg -o x.png' 'combine s.exr none.exr -o x.png' 'combine s.exr a.exr x.png' \
+     'denoise s.exr x.exr' 'denoise s.exr y.exr -o x.exr' 'denoise s.exr y.exr --output=x.exr' \
+     'sample s.exr --texture floor=t.jpg x.exr' 'sample s.exr floor=t.jpg' 'pack s.exr x.retex' \
+     'render box.pov x.exr' 'render Floor box.pov' 'render box.pov box.pov' 'render box.pov floor=t.jpg -o x.png'; do
+     retex-$c >out || wc -c <out
+ done
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
> 0
! retex-combine: error: cannot read x.png: No such file or directory; is -o x.png meant?
! retex-combine: error: cannot read x.exr: No such file or directory; is -o x.exr meant?
! retex-combine: error: t.jpg is not a set: neither an OpenEXR file nor a pack; is -o t.jpg meant?
! retex-combine: error: s.exr holds a set, no samples
! retex-combine: error: cannot read floor=t.jpg: No such file or directory; is --texture floor=t.jpg meant?
! retex-combine: error: cannot read none.exr: No such file or directory
! retex-combine: error: one set and its samples are enough; is -o x.png meant?
! retex-denoise: error: one set is enough; is -o x.exr meant?
! retex-denoise: error: one set is enough; what is 'y.exr'?
! retex-denoise: error: one set is enough; what is 'y.exr'?
! retex-sample: error: one set is enough; is -o x.exr meant?
! retex-sample: error: one set is enough; is --texture floor=t.jpg meant?
! retex-pack: error: one input is enough; is -o x.retex meant?
! retex-render: error: one scene at a time: `box.pov` and `x.exr`; is -o x.exr meant?
! retex-render: error: one scene at a time: `Floor` and `box.pov`; is -t Floor meant?
! retex-render: error: one scene at a time: `box.pov` and `box.pov`
! retex-render: error: one scene at a time: `box.pov` and `floor=t.jpg`; is --replace floor=t.jpg meant?
$ ls x.*
! ls: cannot access 'x.*': No such file or directory
= 2

$ for c in 'denoise s.exr -o --radius 3' 'render box.pov -o --plain' 'render box.pov --stats --size 8x6' \
+     'combine s.exr -o --texture:scale=2 floor=t.jpg' 'combine s.exr -o'; do
+     retex-$c >out || wc -c <out
+ done
> 0
> 0
> 0
> 0
> 0
! retex-denoise: error: --output needs an argument, FILE, before --radius
! retex-render: error: --output needs an argument, FILE, before --plain
! retex-render: error: --stats needs an argument, FILE.json, before --size
! retex-combine: error: --output needs an argument, FILE, before --texture:scale=2
! retex-combine: error: --output needs an argument: FILE
$ ls -- --*
! ls: cannot access '--*': No such file or directory
= 2

# Names in scenes: declared ones, keywords and directives.
% # A scene of a few declared names, with $1 from line 9 on.
% try() {
%     cat >m.pov <<'END'
% #version 3.7; global_settings { assumed_gamma 1 }
% camera { location -4*z look_at 0 }
% light_source { -9*z rgb 1 }
% #declare Oak = texture { pigment { rgb 1 } }
% #declare Table = box { 0, 1 }
% #declare Crimson = rgb 1;
% #declare Shiny = finish { phong 1 }
% #macro Chair(A) sphere { 0, A } #end
% END
%     printf "$1\n" >>m.pov
%     retex-render -q --size 8x6 --spp 1 m.pov -o m.exr
% }
$ for x in 'sphere { 0, 1 texture { Oka } }' 'sphere { 0, 1 texture { oak } }' 'object { Tabel }' \
+     'sphere { 0, 1 pigment { color Crimsn } }' 'sphere { 0, 1 finish { Shinny } }' 'Chiar(1)' \
+     '#declare B = Crimsno * 2;' '#declare D = Tabl' 'spheer { 0, 1 }' 'sphere { 0, 1 pigmnet { rgb 1 } }' \
+     'sphere { 0, 1 pigment { colour rgbb 1 } }' 'sphere { 0, 1 pigment { chcker } }' 'sphere { 0, 1 transltae x }' \
+     'sphere { 0, sni(1) }' 'camera { locaton 1 }' 'global_settings { max_trace_levl 5 }' '#dclare A = 1;' \
+     '#warnin "x"' '#zzzzzzz 1' 'Zzzzzzz'; do
+     try "$x"
+ done
! retex-render: error: m.pov:9:25: expected a colour, a pattern, a transform or the end of the pigment, found `Oka`, which is not declared; is `Oak` meant?
! retex-render: error: m.pov:9:25: expected a colour, a pattern, a transform or the end of the pigment, found `oak`, which is not declared; is `Oak` meant?
! retex-render: error: m.pov:9:10: expected an object, found `Tabel`, which is not declared; is `Table` meant?
! retex-render: error: m.pov:9:31: expected a color, found `Crimsn`, which is not declared; is `Crimson` meant?
! retex-render: error: m.pov:9:24: expected a finish keyword or }, found `Shinny`, which is not declared; is `Shiny` meant?
! retex-render: error: m.pov:9:1: expected an object, a light, a camera or a directive, found `Chiar`, which is not declared; is `Chair` meant?
! retex-render: error: m.pov:9:14: expected a value, found `Crimsno`, which is not declared; is `Crimson` meant?
! retex-render: error: m.pov:9:14: expected a value, found `Tabl`, which is not declared; is `Table` meant?
! retex-render: error: m.pov:9:1: expected an object, a light, a camera or a directive, found `spheer`, which is not declared; is `sphere` meant?
! retex-render: error: m.pov:9:15: expected an object modifier or }, found `pigmnet`, which is not declared; is `pigment` meant?
! retex-render: error: m.pov:9:32: expected a color, found `rgbb`, which is not declared; is `rgb` meant?
! retex-render: error: m.pov:9:25: expected a colour, a pattern, a transform or the end of the pigment, found `chcker`, which is not declared; is `checker` meant?
! retex-render: error: m.pov:9:15: expected an object modifier or }, found `transltae`, which is not declared; is `translate` meant?
! retex-render: error: m.pov:9:13: expected a number, found `sni`, which is not declared; is `sin` meant?
! retex-render: error: m.pov:9:10: expected a camera modifier or }, found `locaton`, which is not declared; is `location` meant?
! retex-render: error: m.pov:9:19: expected a global setting or }, found `max_trace_levl`, which is not declared; is `max_trace_level` meant?
! retex-render: error: m.pov:9:1: there is no directive `#dclare`; is `#declare` meant?
! retex-render: error: m.pov:9:1: there is no directive `#warnin`; is `#warning` meant?
! retex-render: error: m.pov:9:1: there is no directive `#zzzzzzz`
! retex-render: error: m.pov:9:1: expected an object, a light, a camera or a directive, found `Zzzzzzz`, which is not declared
= 2

# A brace that is missing: where its opening one stands.
$ for x in 'union { sphere { 0, 1 }' 'union {\n sphere { 0, 1 pigment { rgb 1 }\n box { 0, 1 }\n}' \
+     'union {\n sphere { 0, 1 pigment { rgb 1 \n}\n box { 0, 1 }\n}' 'global_settings { radiosity {\n a { b c \n' \
+     '#declare A = texture {\n pigment { rgb 1\n#declare B = 1;\nsphere { 0, 1 }' \
+     '#declare F = function(x) {\n x + 1 \n sphere { 0, 1 }' '#declare A = array[2] {\n 1, 2\n sphere { 0, 1 }' \
+     'mesh {\n triangle { x, y, z }\n sphere { 0, 1 }' 'sphere { 0, 1 texture { Oak }' 'sphere { 0, 1 box }' \
+     '#macro M() sphere { 0, 1\n#end\nM()\nbox { 0, 1 }'; do
+     try "$x"
+ done
! retex-render: error: m.pov:10:1: expected an object modifier or }, found the end of the file; the `{` of line 9 is not closed
! retex-render: error: m.pov:11:2: expected an object modifier or }, found `box`; the `{` of line 10 is not closed
! retex-render: error: m.pov:12:2: expected an object modifier or }, found `box`; the `{` of line 10 is not closed
! retex-render: error: m.pov:12:1: expected `}`, found the end of the file; the `{` of line 10 is not closed
! retex-render: error: m.pov:12:1: expected a colour, a pattern, a transform or the end of the pigment, found `sphere`; the `{` of line 10 is not closed
! retex-render: error: m.pov:11:2: expected `}`, found `sphere`; the `{` of line 9 is not closed
! retex-render: error: m.pov:11:2: expected `}`, found `sphere`; the `{` of line 9 is not closed
! retex-render: error: m.pov:11:2: expected an object modifier or }, found `sphere`; the `{` of line 9 is not closed
! retex-render: error: m.pov:10:1: expected an object modifier or }, found the end of the file; the `{` of line 9 is not closed
! retex-render: error: m.pov:9:15: expected an object modifier or }, found `box`
! retex-render: error: m.pov:12:1: expected an object modifier or }, found `box`; the `{` of line 9 is not closed
= 2
$ for x in '#declare Sofa = union {\n box { 0, 1 }\n\nobject { Sofa }' \
+     '#declare Chairs = union {\n box { 0, 1 }\n#declare Other = sphere { 0, 1 }\nobject { Other }\nobject { Chairs translate x }' '#declare N = N + 1;'; do
+     try "$x"
+ done
! retex-render: error: m.pov:12:10: expected an object, found `Sofa`, whose declaration of line 9 has not ended
! retex-render: error: m.pov:13:10: expected an object, found `Chairs`, whose declaration of line 9 has not ended
! retex-render: error: m.pov:9:14: expected a value, found `N`, whose declaration of line 9 has not ended
= 2
$ printf 'sphere { 0, 1\n  pigment { rgb 1 }\n' >open.inc; try '#include "open.inc"\nbox { 0, 1 }'
! retex-render: error: m.pov:10:1: expected an object modifier or }, found `box`; the `{` of open.inc:1 is not closed
= 2

# An element that the frame of an animation chooses.
$ d='#declare A = array[3] { 1, 2, 3 }'
+ for x in 'sphere { 0, A[frame_number-1] }' 'sphere { 0, A[clock-1] }' 'sphere { 0, A[frame_number+clock-1] }' \
+     '#declare N = frame_number - 1; sphere { 0, A[N] }' 'sphere { 0, A[3] }' 'sphere { 0, A[-1] }' \
+     '#if (clock = 0) #end sphere { 0, A[3] }' '#if (clock = 0) #end sphere { 0, A[-1] }'; do
+     try "$d$x"
+ done
! retex-render: error: m.pov:9:62: index -1 is outside of an array of 3 elements; `frame_number` is 0: -D frame_number=1 sets it
! retex-render: error: m.pov:9:55: index -1 is outside of an array of 3 elements; `clock` is 0: -D clock=1 sets it
! retex-render: error: m.pov:9:68: index -1 is outside of an array of 3 elements; `frame_number` is 0: -D frame_number=1 sets it
! retex-render: error: m.pov:9:80: index -1 is outside of an array of 3 elements; `frame_number` is 0: -D frame_number=1 sets it
! retex-render: error: m.pov:9:49: index 3 is outside of an array of 3 elements
! retex-render: error: m.pov:9:50: index -1 is outside of an array of 3 elements
! retex-render: error: m.pov:9:70: index 3 is outside of an array of 3 elements
! retex-render: error: m.pov:9:71: index -1 is outside of an array of 3 elements; `clock` is 0: -D clock=1 sets it
= 2
$ printf 'light_source { -9*z rgb 1 }#declare A = array[3] { 1, 2, 3 } sphere { 0, A[frame_number-1] }' >m.pov
$ for n in 1 9; do retex-render -q --size 8x6 --spp 1 -D frame_number=$n m.pov -o m.exr; done
! retex-render: error: m.pov:1:90: index 8 is outside of an array of 3 elements; `frame_number` is 9: -D frame_number=1 sets it
= 2
