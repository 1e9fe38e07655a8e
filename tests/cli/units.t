# Lengths with units, and what a scene unit is.
$ cp "$TESTS/finishes.pov" room.pov
$ cp "$SCENES/textures/brick.jpg" .
% render() { retex-render -q --size 48x36 --spp 8 -t Wall -t Floor room.pov "$@"; }
% # SET with a texture, or a layer on a colour, laid by OPTIONS: combine SET OPTIONS FILE.
% combine() { retex-combine -q $1 --texture:$2 Floor=brick.jpg -o $3; }
% layered() { retex-combine -q $1 --texture Floor=tan --texture:over:$2 Floor=brick.jpg -o $3; }
$ render -o m.exr
$ render --unit cm -o cm.exr
$ render --unit 1ft -o ft.exr
$ for s in m cm ft; do retex-info $s.exr | grep '^scene unit'; done
> scene unit     0.01 m
> scene unit     0.3048 m
$ retex-info --json cm.exr | grep -o '"unit":0.01'
> "unit":0.01

# A length is so many scene units as the set says.
$ combine m.exr width=0.6,.25:grout=.02:at=1.5,-.5 a.exr
$ for o in width=60cm,25cm:grout=20mm:at=150cm,-.5m width=600mm,250mm:grout=2cm:at=1.5m,-50cm; do
+     combine m.exr $o b.exr
+     cmp a.exr b.exr
+ done
$ combine m.exr width=60cm:grout=20mm b.exr
$ cmp a.exr b.exr | sed 's/differ:.*/differ/'
> a.exr b.exr differ
$ combine cm.exr width=0.6,.25:grout=.02:at=1.5,-.5 b.exr
$ cmp a.exr b.exr
$ combine cm.exr width=6mm,2.5mm:grout=.2mm:at=15mm,-5mm b.exr
$ retex-diff a.exr b.exr --fail-psnr 110 -q
$ combine ft.exr width=7.2in,3in:grout=.24in:at=1.5ft,-6in b.exr
$ retex-diff a.exr b.exr --fail-psnr 110 -q

# Also of layers, of colours, when rendering again, in packs and after denoising, of frames and tables, in texts.
$ layered m.exr width=.5:at=1,1 a.exr
$ layered cm.exr width=5mm:at=10mm,10mm b.exr
$ retex-diff a.exr b.exr --fail-psnr 110 -q
$ render --plain --unit cm --replace:width=6mm,2.5mm:grout=.2mm Floor=brick.jpg -o a.exr
$ render --plain --replace:width=.6,.25:grout=.02 Floor=brick.jpg -o b.exr
$ retex-diff a.exr b.exr --fail-psnr 60 -q
$ render --plain --unit cm --replace:width=.6,.25:grout=.02 Floor=brick.jpg -o a.exr
$ cmp a.exr b.exr
$ retex-pack -q cm.exr -o cm.retex
$ retex-info cm.retex | grep '^scene unit'
> scene unit     0.01 m
$ retex-denoise -q cm.exr -o d.exr
$ retex-info d.exr | grep '^scene unit'
> scene unit     0.01 m
$ retex-pack -q cm.exr --web room
$ grep -o '"unit":[0-9.]*' room/room.json
> "unit":0.01
$ printf 'output,Floor\nt.exr,:width=6mm:grout=.2mm brick.jpg\n' >t.csv
$ retex-combine -q cm.exr --batch t.csv
$ combine cm.exr width=6mm:grout=.2mm a.exr
$ cmp a.exr t.exr
$ retex-sample -q cm.exr --texture:width=6mm:grout=.2mm Floor=brick.jpg | retex-combine -q - -o b.exr
$ cmp a.exr b.exr

# What is no length.
$ for u in 0 -1cm cmm "" 1e10 1,2 nan; do render --unit "$u" -o x.exr; done
! retex-render: error: --unit: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not `0`
! retex-render: error: --unit: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not `-1cm`
! retex-render: error: --unit: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not `cmm`
! retex-render: error: --unit: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not ``
! retex-render: error: --unit: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not `1e10`
! retex-render: error: --unit: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not `1,2`
! retex-render: error: --unit: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not `nan`
= 2
$ combine m.exr width=60cm:grout=.02 x.exr
! retex-combine: error: texture options: all lengths have a unit, as in width=60cm:grout=4mm, or none
= 2
$ combine m.exr at=1m,1m x.exr
! retex-combine: error: texture options: at= with lengths needs width=
= 2
$ test -e x.exr
= 1
