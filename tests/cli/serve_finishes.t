# retex-serve: maps of finishes and normal maps, laid textures and layers, beside retex-combine's pictures; serve.py
# has the checks.
% render() { retex-render -q --size 48x36 --spp 4 room.pov -t Floor -t Wall "$@"; }
$ mkdir -p rooms textures/wood textures/tiles
$ cp "$TESTS/finishes.pov" room.pov
$ oiiotool "$SCENES/textures/brick.jpg" --resize 192x192 -o brick.jpg
$ render --finish Floor=matt,satin,polished -o three.exr
$ render --finish Floor=polished,matt -o two.exr
$ render --finish Wall=normals -o walls.exr
$ for s in three two walls; do retex-pack -q $s.exr -o rooms/$s.retex; done
$ oiiotool "$SCENES/living-room/textures/oak-planks.jpg" --resize 192x192 -o textures/oak.jpg
$ cp textures/oak.jpg textures/wood/wood_diff.jpg
$ cat >maps.py <<'END'
+ import struct, zlib
+ def chunk(kind, data):
+     return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
+ for name, dark in ("gloss", 16), ("other", 4): # files of the same size
+     pixels = b"".join(b"\0" + b"".join(bytes([0 if (x // dark + y // 8) % 2 else 200 - x] * 3) for x in range(32))
+                       for y in range(32))
+     file = chunk(b"IHDR", struct.pack(">IIBBBBB", 32, 32, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(pixels, 0))
+     open(name + ".png", "wb").write(b"\x89PNG\r\n\x1a\n" + file + chunk(b"IEND", b""))
+ END
$ /usr/bin/python3 maps.py
$ cp gloss.png textures
$ cp gloss.png textures/wood/wood_rough.png
$ cp textures/oak.jpg textures/tiles/tiles_diff.jpg
$ cp gloss.png textures/tiles/tiles_nor_gl.png
% serve() { /usr/bin/python3 "$TESTS/serve.py" "$@"; }
$ serve finishes normals laid new_maps
> finishes
> normals
> laid
> new_maps
