# retex-serve: maps of finishes and normal maps, laid textures and layers, beside retex-combine's pictures; serve.py
# has the checks.
% render() { retex-render -q --size 48x36 --spp 4 room.pov -t Floor -t Wall "$@"; }
$ mkdir -p rooms textures/wood textures/tiles
$ cp "$TESTS/finishes.pov" room.pov
$ cp "$SCENES/textures/brick.jpg" .
$ render --finish Floor=matt,satin,polished -o three.exr
$ render --finish Floor=polished,matt -o two.exr
$ render --finish Wall=normals -o walls.exr
$ for s in three two walls; do retex-pack -q $s.exr -o rooms/$s.retex; done
$ cp "$SCENES/living-room/textures/oak-planks.jpg" textures/oak.jpg
$ cp textures/oak.jpg textures/wood/wood_diff.jpg
$ cat >maps.py <<'END'
+ import struct, sys
+ for name, dark in ("gloss", 16), ("other", 4):
+     pixels = b"".join(bytes([0 if (x // dark + y // 8) % 2 else 200 - x] * 3) for y in range(32) for x in range(32))
+     file = struct.pack("<IHHI", 54 + len(pixels), 0, 0, 54)
+     picture = struct.pack("<IiiHHIIiiII", 40, 32, 32, 1, 24, 0, len(pixels), 0, 0, 0, 0)
+     open(name + ".bmp", "wb").write(b"BM" + file + picture + pixels)
+ END
$ /usr/bin/python3 maps.py
$ cp gloss.bmp textures
$ cp gloss.bmp textures/wood/wood_rough.bmp
$ cp textures/oak.jpg textures/tiles/tiles_diff.jpg
$ cp gloss.bmp textures/tiles/tiles_nor_gl.bmp
% serve() { /usr/bin/python3 "$TESTS/serve.py" "$@"; }
$ serve finishes normals laid new_maps
> finishes
> normals
> laid
> new_maps
