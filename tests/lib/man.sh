#!/bin/sh
# Runs the examples of a man page, in order, in one empty folder: man.sh man/TOOL.1. Prints TAP.
#
# An example is a literal display (.Bd -literal … .Ed, or a .Dl line) of the section EXAMPLES; a leading `$ ` is
# removed. Each must exit with 0, or with N if a comment line `.\" exit N` is before it. The folder has scenes/ (the
# scenes), room.exr (a set as rendered, with targets Floor and Wall), room.retex (its pack), oak.jpg and brick.jpg
# (textures), and a.exr and b.exr (two pictures that differ a little). Programs find the plugins of retex for
# OpenImageIO. After a comment line `.\" file NAME` the display is no example, but that file; pkg-config and the loader
# find the library of the build.
set -u
here=$(pwd)
page=$here/$1
case $BUILD in /*) build=$BUILD ;; *) build=$here/$BUILD ;; esac
PATH=$build/bin:$build/tests/bin:$PATH
LC_ALL=C
OIIO_LIBRARY_PATH=$build/plugins
export PATH LC_ALL OIIO_LIBRARY_PATH
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/here" "$folder/examples"

awk -v out="$folder/examples" -v here="$folder/here" '
    function line(text) {
        sub(/^\$ /, "", text); gsub(/\\&/, "", text); gsub(/\\-/, "-", text); gsub(/\\(e|\(rs)/, "\\", text)
        gsub(/\\\(aq/, "\047", text); gsub(/\\\(dq/, "\"", text); gsub(/\\\(ti/, "~", text); gsub(/\\\(ha/, "^", text)
        print text > file
    }
    function begin() {
        if (name) { file = here "/" name; name = ""; return }
        file = sprintf("%s/%03d", out, ++n); print want + 0 > (file ".exit"); want = 0
    }
    /^\.Sh / { inside = $2 == "EXAMPLES"; next }
    !inside { next }
    /^\.\\" exit [0-9]/ { want = $3; next }
    /^\.\\" file / { name = $3; next }
    /^\.Dl / { begin(); line(substr($0, 5)); next }
    /^\.Bd -literal/ { display = 1; begin(); next }
    /^\.Ed/ { display = 0; next }
    display && !/^\.\\"/ { line($0) }' "$page"

cat >"$folder/retex.pc" <<END
Name: retex
Description: the library of this build
Version: 0
Cflags: -I$here/tools/libretex/include
Libs: -L$build/lib -lretex
END
PKG_CONFIG_PATH=$folder LD_LIBRARY_PATH=$build/lib
export PKG_CONFIG_PATH LD_LIBRARY_PATH

cd "$folder/here" || exit 1
ln -s "$here/scenes" scenes
cp "$here/scenes/textures/brick.jpg" brick.jpg
cp "$here/scenes/living-room/textures/oak-planks.jpg" oak.jpg
make_set room.exr 64 48 denoise && retex-pack -q room.exr -o room.retex && make_picture a.exr noise=0.01 && make_picture b.exr || exit 1

number=0
for example in "$folder"/examples/???; do
    [ -e "$example" ] || continue
    number=$((number + 1))
    sh -e "$example" >../out 2>&1 </dev/null
    status=$?
    title=$(head -n 1 "$example")
    if [ "$status" = "$(cat "$example.exit")" ]; then
        printf "%s\n" "ok $number - $title"
    else
        printf "%s\n" "not ok $number - $title"
        echo "# exit status $status"
        sed 's/^/# /' ../out
    fi
done
if [ "$number" = 0 ]; then
    number=1
    echo "not ok 1 - ${1##*/} has no examples"
fi
echo "1..$number"
