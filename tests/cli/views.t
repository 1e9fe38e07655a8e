# How pictures are developed, and presets. tests/python/test_views.py compares the numbers with published formulas.
$ cp "$SCENES/textures/brick.jpg" .
$ mkdir textures presets
$ cp brick.jpg textures
% render() { retex-render -q --size 64x48 --spp 16 "$TESTS/finishes.pov" -t Floor -t Wall "$@"; }
$ render --lamps each -o set.exr
% near() { retex-diff "$1" "$2" --fail-psnr "$3" -q || echo "$1 $2 $3"; }

# The exposure that was found is told; it is the same for every number of threads.
$ retex-combine set.exr --auto-exposure --exposure 1 --view filmic -o a.png 2>&1 |
+     sed 's/exposure [+-][0-9.]*, [0-9.]* s$/exposure N/'
> retex-combine: a.png: original textures, picture:auto-exposure=yes;picture:exposure=1;picture:view=filmic, 64 x 48, auto-exposure N
$ for n in 1 2 7; do retex-combine -q set.exr --auto-exposure --threads $n -o $n.exr; done
$ cmp 1.exr 2.exr
$ cmp 1.exr 7.exr
$ retex-combine -q set.exr --exposure 1 -o a.exr
$ oiiotool set.exr --ch R,G,B --mulc 2 -d half -o b.exr
$ near a.exr b.exr 60
$ retex-combine -q set.exr --exposure 0 --view standard -o a.png
$ retex-combine -q set.exr -o b.png
$ cmp a.png b.png
$ retex-combine -q set.exr --white-balance 3000 -o a.exr
$ near a.exr set.exr 30
> a.exr set.exr 30

# It is the same by options, table, samples, packs, frames and presets. A row goes before options, options before a
# preset.
% look='--exposure .5 --white-balance 4000 --auto-exposure --view Neutral'
% edit='--texture:scale=2 Floor=brick.jpg --light *=.5'
$ retex-combine -q set.exr $edit $look -o a.png --save-preset presets/a.json
$ cat presets/a.json
> {
>   "retex-preset": 1,
>   "edit": "Floor=../brick.jpg;Floor.scale=2,2;light:*=0.5;picture:auto-exposure=yes;picture:exposure=0.5;picture:view=Neutral;picture:white-balance=4000"
> }
$ cat >t.csv <<'END'
+ output,Floor,light:*,picture:exposure,picture:white-balance,picture:auto-exposure,picture:view
+ b.png,:scale=2 brick.jpg,.5,.5,4000,yes,Neutral
+ c.png,:scale=2 brick.jpg,.5,1,,,
+ d.png,tan,,,,no,
+ END
$ retex-combine -q set.exr --batch t.csv --preset presets/a.json --exposure 3
$ cmp a.png b.png
$ retex-combine -q set.exr $edit --exposure 1 --white-balance 4000 --auto-exposure --view Neutral -o n.png
$ cmp n.png c.png
$ retex-combine -q set.exr --light '*=.5' --texture Floor=tan --exposure 3 --white-balance 4000 --view Neutral -o n.png
$ cmp n.png d.png
$ retex-combine -q set.exr --preset presets/a.json -o b.png
$ cmp a.png b.png
$ retex-sample -q set.exr --preset presets/a.json | retex-combine -q - --light '*=.5' $look -o b.png
$ cmp a.png b.png
$ retex-pack -q set.exr --lossless -o set.retex
$ retex-combine -q set.retex --preset presets/a.json -o b.png
$ cmp a.png b.png
$ retex-combine -q set.exr --frames 7 --preset presets/a.json -o f.%02d.png
$ cmp a.png f.07.png

# A preset may be moved with its images. Options go before it, a texture as a whole.
$ cd textures
+ retex-combine -q ../set.exr --texture:scale=3 Floor=brick.jpg --texture Wall=tan --exposure 1 -o ../a.png \
+     --save-preset ../presets/b.json
$ mkdir moved
$ mv presets textures moved
$ retex-combine -q set.exr --preset moved/presets/b.json -o b.png
$ cmp a.png b.png
$ retex-combine -q set.exr --preset moved/presets/b.json --texture floor=red --exposure 0 -o b.png --save-preset c.json
$ cat c.json
> {
>   "retex-preset": 1,
>   "edit": "Wall=rgb(0.6444797,0.45641103,0.26225066);floor=rgb(1,0,0);picture:exposure=0"
> }
$ retex-combine -q set.exr --texture Floor=red --texture Wall=tan -o a.png
$ cmp a.png b.png
$ retex-combine -q set.exr --preset - -o b.png <c.json
$ cmp a.png b.png

# The expected error is of the picture before it is developed; other colour spaces have the exposure.
$ retex-combine -q set.exr --texture Floor=brick.jpg --error a.exr -o x.exr
$ retex-combine -q set.exr --texture Floor=brick.jpg --exposure 3 --auto-exposure --error b.exr -o x.exr
$ cmp a.exr b.exr
$ retex-combine -q set.exr --exposure 1 --colorspace ACEScg -o a.exr
$ retex-combine -q set.exr --colorspace ACEScg -o b.exr
$ oiiotool b.exr --mulc 2 -d half -o b.exr
$ near a.exr b.exr 60

# The views of a configuration of the user are its own.
$ cat >c.ocio <<'END'
+ ocio_profile_version: 2
+ roles: {default: lin, scene_linear: lin}
+ file_rules:
+   - !<Rule> {name: Default, colorspace: default}
+ displays:
+   One:
+     - !<View> {name: Plain, colorspace: lin}
+     - !<View> {name: Filmic, colorspace: half}
+ colorspaces:
+   - !<ColorSpace> {name: lin}
+   - !<ColorSpace>
+     name: half
+     to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
+ END
$ export OCIO=$PWD/c.ocio
+ retex-combine -q set.exr --view Filmic -o a.png
+ retex-combine -q set.exr --view Plain --exposure -1 -o b.png
+ cmp a.png b.png
+ retex-combine -q set.exr --view Neutral -o x.png
+ test -e x.png
! retex-combine: error: x.png: display One has no view 'Neutral'; there are Plain, Filmic
= 1

# retex-render puts the textures of a preset on targets without --replace.
$ retex-combine -q set.exr --texture:scale=2 Floor=brick.jpg --texture Wall=tan -o a.png --save-preset r.json
$ render --spp 2 --preset r.json -o a.exr
$ render --spp 2 --replace:scale=2 Floor=brick.jpg --replace Wall=tan -o b.exr
$ cmp a.exr b.exr
$ render --spp 2 --preset r.json --replace Wall=red -o a.exr
$ render --spp 2 --replace:scale=2 Floor=brick.jpg --replace Wall=red -o b.exr
$ cmp a.exr b.exr
$ retex-combine -q set.exr --texture Floor=tan --exposure 1 -o a.png --save-preset r.json
$ render --spp 1 --preset r.json -o a.exr
! retex-render: warning: only textures of --preset are rendered: what it says of lamps, finishes and the picture is left out
$ render --preset gone.json -o gone.exr
! retex-render: error: cannot read gone.json: No such file or directory
= 2
$ test -e gone.exr
= 1

# Of options the last counts, of others a preset has each once. A view does nothing to floats.
$ retex-combine -q set.exr --exposure 9 --exposure 1 --view Raw --view Filmic -o a.png
$ retex-combine -q set.exr --exposure 1 --view Filmic -o b.png
$ cmp a.png b.png
$ retex-combine -q set.exr -o a.exr
$ retex-combine set.exr --view Filmic -o b.exr 2>&1 | grep warning
> retex-combine: warning: an OpenEXR file stays scene-linear: --display and --view do nothing; --colorspace would
$ cmp a.exr b.exr

# What is refused.
$ head -c 9999 set.exr >begin.exr
$ for o in '--exposure 31' '--exposure x' '--white-balance 500' '--view Filmy' '--view Filmic --colorspace sRGB' \
+     '--solve red --exposure 1' '--solve red --save-preset y.json' '--save-preset gone/x.json' '--preset gone.json' \
+     '--preset begin.exr' '--save-preset x.png' '--preset moved --save-preset y.json' '--texture picture:exposure=1'; do
+     retex-combine set.exr $o -o x.png
+ done
! retex-combine: error: exposure '31': expected stops, -30 to 30, as in 0.5
! retex-combine: error: exposure 'x': expected stops, -30 to 30, as in 0.5
! retex-combine: error: white-balance '500': expected kelvins, 1000 to 25000, as in 4000
! retex-combine: error: x.png: display sRGB has no view 'Filmy'; there are Standard, Filmic, Neutral, Raw
! retex-combine: error: --colorspace excludes --display and --view
! retex-combine: error: --solve excludes --exposure, --auto-exposure and --white-balance
! retex-combine: error: --solve excludes --batch, --frames, --error and --save-preset
! retex-combine: error: cannot write gone/x.json: No such file or directory
! retex-combine: error: cannot read gone.json: No such file or directory
! retex-combine: error: begin.exr:1:1: not a preset, which is JSON
! retex-combine: error: x.png: --save-preset and the output are the same file
! retex-combine: error: cannot read moved: Is a directory
! retex-combine: error: texture 'picture:exposure': the name of a target cannot begin so
= 2
$ test -e x.png
= 1
$ rm -f x.exr
$ for j in '{' '[]' '{"retex-preset": 2}' '{"retex-preset": "1", "edit": ""}' '{"retex-preset": 1}' \
+     '{"retex-preset": 1, "edit": "Floor"}' '{"retex-preset": 1, "edit": "Floor=red", "edit": ""}' \
+     '{"retex-preset": 1, "edit": "Flor=red"}' '{"retex-preset": 1, "edit": "Floor=gone.png"}' \
+     '{"retex-preset": 1, "edit": "picture:exposure=99"}'; do
+     echo "$j" >moved/x.json
+     retex-combine set.exr --preset moved/x.json -o x.png
+     retex-sample -q set.exr --preset moved/x.json -o x.exr 2>/dev/null
+ done
! retex-combine: error: moved/x.json:2: not a preset, which is JSON
! retex-combine: error: moved/x.json is not a preset: it has no number "retex-preset"
! retex-combine: error: moved/x.json is a preset of version 2; this program reads version 1
! retex-combine: error: moved/x.json is not a preset: it has no number "retex-preset"
! retex-combine: error: moved/x.json is not a preset: it has no text "edit"
! retex-combine: error: moved/x.json: `Floor`: expected TARGET=IMAGE, TARGET.OPTION=VALUE, light:LAMP=VALUE, finish:TARGET=NAME or picture:KEY=VALUE
! retex-combine: error: moved/x.json:1:47: not a preset, which is JSON
! retex-combine: error: no target is called 'Flor'; the set has Floor, Wall; is Floor meant?
! retex-combine: error: cannot read moved/gone.png: No such file or directory
! retex-combine: error: moved/x.json: exposure '99': expected stops, -30 to 30, as in 0.5
= 2
$ head -c 2000000 /dev/zero | tr '\0' ' ' >x.json
$ retex-combine set.exr --preset x.json -o x.png
! retex-combine: error: x.json is not a preset: it has more than 1 MB
= 2
$ retex-combine set.exr --preset x.json --save-preset x.json -o x.png
! retex-combine: error: x.json: --save-preset would replace the preset
= 2
$ test -e x.png -o -e x.exr
= 1
$ cat >t.csv <<'END'
+ output,picture:view,picture:exposure,picture:exposure,picture:exposur
+ x.png,Filmy,1
+ y.png,,99,,1
+ z.png,Filmy,99
+ z.xyz,Raw
+ END
$ retex-combine set.exr --batch t.csv
! retex-combine: error: t.csv:1: 'picture:exposure' has two columns
! retex-combine: error: t.csv:2: display sRGB has no view 'Filmy'; there are Standard, Filmic, Neutral, Raw
! retex-combine: error: t.csv:3: exposure '99': expected stops, -30 to 30, as in 0.5
! retex-combine: error: t.csv:3: `picture:exposur`: expected exposure, white-balance, auto-exposure or view; is exposure meant?
! retex-combine: error: t.csv:4: exposure '99': expected stops, -30 to 30, as in 0.5
! retex-combine: error: t.csv:5: z.xyz: no picture format that can be written has the ending .xyz; these have: .png .jpg .pfm .tif .exr .hdr .bmp .tga .webp .avif .jxl .heic .jp2 .j2k .dpx .gif .ppm .pnm .sgi .ico .iff .rla .fits
= 2
$ printf 'output,picture:view\nx.png,Raw\n' >t.csv
$ retex-combine set.exr --batch t.csv --colorspace sRGB
! retex-combine: error: t.csv:1: --colorspace excludes a column picture:view
= 2
$ test -e x.png
= 1

# A preset of a stranger is data: it has no options of the tool, and names no output.
$ for edit in 'picture:output=y.png' 'picture:save-preset=y.json' '--save-preset=y.json' 'Floor=--help' 'Floor=$(id).png'; do
+     printf '{"retex-preset": 1, "edit": "%s"}' "$edit" >gift.json
+     retex-combine -q set.exr --preset gift.json -o x.png || echo $?
+ done
> 2
> 2
> 2
> 2
> 2
! retex-combine: error: gift.json: `picture:output`: expected exposure, white-balance, auto-exposure or view
! retex-combine: error: gift.json: `picture:save-preset`: expected exposure, white-balance, auto-exposure or view
! retex-combine: error: no target is called '--save-preset'; the set has Floor, Wall
! retex-combine: error: cannot read --help: No such file or directory
! retex-combine: error: cannot read $(id).png: No such file or directory
$ ls | grep '^y' || true
