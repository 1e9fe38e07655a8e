# make install into a folder with a space, and a program of somebody else that uses what is there.

# A build with sanitizers would need them in every program.
$ skip-unless ! nm -D "$(dirname "$(command -v retex-diff)")/../lib/libretex.so.2" | grep -q 'asan\|tsan'
$ "$TESTS/../install/stage.sh" install "$PWD/a stage" '/opt/retex tools'
$ make_set room.exr 48 32 3
$ oiiotool --pattern fill:topleft=1,0,0:topright=0,1,0:bottomleft=0,0,1:bottomright=1,1,1 16x16 3 -d uint8 -o wood.png \
+     -o wood.tif
$ retex-combine -q room.exr --texture Floor=wood.png -o expected.exr

# The staged tools run, and find what they need, wherever the folder is.
$ 'a stage/opt/retex tools/bin/retex-combine' -q room.exr --texture Floor=wood.tif -o actual.tif && echo done
> done

# pkg-config finds folders from where its file is.
$ PKG_CONFIG_PATH='a stage/opt/retex tools/lib/pkgconfig' pkg-config --modversion retex
> 0.1.0
$ "$TESTS/../install/compile.sh" 'a stage/opt/retex tools/lib/pkgconfig' "$TESTS/../install/outsider.c" outsider
$ readelf -d outsider | grep -c 'NEEDED.*libretex.so.2'
> 1
$ LD_LIBRARY_PATH='a stage/opt/retex tools/lib' ./outsider room.exr Floor=wood.png actual.exr &&
+     cmp expected.exr actual.exr

# A TIFF needs the bridge, which is beside the library, and nowhere else.
$ mkdir elsewhere && cd elsewhere &&
+     LD_LIBRARY_PATH='../a stage/opt/retex tools/lib' ../outsider ../room.exr Floor=../wood.tif ../actual.exr &&
+     cmp ../expected.exr ../actual.exr
$ mv 'a stage/opt/retex tools/lib/libretex-oiio.so' away.so
$ LD_LIBRARY_PATH='a stage/opt/retex tools/lib' ./outsider room.exr Floor=wood.tif actual.exr
! outsider: wood.tif: this needs OpenImageIO, which cannot be loaded: libretex-oiio.so: cannot open shared object file: No such file or directory
= 2
$ mv away.so 'a stage/opt/retex tools/lib/libretex-oiio.so'

# The static library, in a copy of the tree without the shared one.
$ cp -r 'a stage/opt/retex tools' 'moved here' && rm 'moved here'/lib/libretex.so*
$ "$TESTS/../install/compile.sh" 'moved here/lib/pkgconfig' "$TESTS/../install/outsider.c" outsider-static --static
$ readelf -d outsider-static | grep -c 'NEEDED.*libretex.so.2'
> 0
= 1
$ RETEX_BRIDGE='moved here/lib/libretex-oiio.so' ./outsider-static room.exr Floor=wood.tif actual.exr &&
+     cmp expected.exr actual.exr

# The library exports what the public headers declare, under a version for all and one for hosts, and nothing else.
$ python3 "$TESTS/../install/symbols.py" 'a stage/opt/retex tools/lib/libretex.so.2' 'a stage/opt/retex tools/include'
> some RETEX_2
> some RETEX_HOST_2

# The plugins find the bridge, which lies two folders above them.
$ retex-pack -q room.exr -o room.retex
$ OIIO_LIBRARY_PATH='a stage/opt/retex tools/lib/retex/plugins' oiiotool 'room.retex?Floor=wood.tif' -o plugin.exr &&
+     retex-combine -q room.retex --texture Floor=wood.tif -o pack.exr &&
+     retex-diff pack.exr plugin.exr --fail-abs 0.0002 >/dev/null && echo same
> same

# The unit runs the program that is installed.
$ grep ExecStart 'a stage/opt/retex tools/lib/systemd/system/retex-serve.service'
> ExecStart="/opt/retex tools/bin/retex-serve" --memory 1200 --port ${PORT} --trusted-proxy 127.0.0.1 --textures ${TEXTURES} ${ROOMS}

# Nothing is left.
$ "$TESTS/../install/stage.sh" uninstall "$PWD/a stage" '/opt/retex tools' && find 'a stage'
> a stage
> a stage/opt
> a stage/opt/retex tools
