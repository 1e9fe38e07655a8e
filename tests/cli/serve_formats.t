# AVIF and JPEG XL, by retex-serve and with transparency by retex-combine; serve_formats.py has the checks.
$ mkdir rooms textures
$ retex-render -q --size 240x180 --spp 4 "$SCENES/cornell-box/cornell-box.pov" -t floor -o raw.exr
$ retex-pack -q raw.exr -o rooms/room.retex
$ cp "$SCENES/living-room/textures/oak-planks.jpg" textures/oak.jpg
$ /usr/bin/python3 "$TESTS/serve_formats.py" qualities colours negotiated odd_sizes
> qualities
> colours
> negotiated
> odd_sizes

# Larger ones are encoded by another process, which the deadline ends.
$ retex-render -q --size 640x480 --spp 2 "$SCENES/cornell-box/cornell-box.pov" -t floor -o raw.exr
$ retex-pack -q raw.exr -o rooms/large.retex
$ /usr/bin/python3 "$TESTS/serve_formats.py" large
> large
$ printf '#!/bin/sh\nexec sleep 98765\n' >endless && chmod +x endless
$ RETEX_DECODER=$PWD/endless /usr/bin/python3 "$TESTS/serve_formats.py" late
> late
$ retex-combine -q rooms/room.retex --texture floor=textures/oak.jpg -o x.avif
$ retex-combine -q rooms/room.retex --texture floor=textures/oak.jpg --depth 16 -o x.jxl
! retex-combine: error: x.jxl: this format has 8 bits; try .png or .tif
= 2
