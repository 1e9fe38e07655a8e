#!/bin/sh
# docs/web.md as a newcomer follows it, to a photograph of one's own on the floor in the browser, a page of one's own, and a
# package by npm. The room is rendered small. RETEX_NEWCOMER=whole renders it as the docs say, and clones and builds first;
# the processor time of each step is printed.
set -u
. tests/web/room.sh
needs_browser "a newcomer's first room"
tests=$here/tests/web
cp "$scenes/textures/travertine.jpg" "$work/photo.jpg"
commands() { sed -n '/^    make/,/^$/s/^    //p' "$here/docs/web.md"; }
result "$([ "$(commands | wc -l)" = 4 ] && echo 1)" "the docs' first block has four commands"

# step NAME COMMAND…: run, and print the processor time that it took.
step() {
    name=$1
    shift
    times >"$work/before"
    begin=$(date +%s)
    "$@" >"$work/said" 2>&1
    code=$?
    times >"$work/after"
    tail -qn 1 "$work/before" "$work/after" | tr 'ms' '  ' | awk -v name="$name" -v clock=$(($(date +%s) - begin)) \
        '{ t[NR] = 60 * ($1 + $3) + $2 + $4 } END { printf "# %s: %.0f s of processor time, %d s by the clock\n", name, t[2] - t[1], clock }'
    [ "$code" = 0 ] || sed 's/^/# /' "$work/said"
    result "$([ "$code" = 0 ] && echo 1)" "$name"
}
scene=$scenes/living-room/living-room.pov
if [ "${RETEX_NEWCOMER:-}" = whole ]; then
    step "git clone" git clone -q "$here" "$work/clone"
    cd "$work/clone" || exit 1
    # shellcheck disable=SC2046 # the words of the docs
    step "$(commands | sed -n '1s/ &&.*//p')" env CCACHE_DISABLE=1 BUILD=build $(commands | sed -n '1s/ &&.*//p')
    PATH=$work/clone/build/bin:$PATH
    cd "$work" || exit 1
    size='--size 960x540 --spp 32'
else
    cd "$work" || exit 1
    size='--size 192x108 --spp 16'
fi
commands | sed -n 2p | sed "s|--size [0-9x]* --spp [0-9]*|$size|; s|scenes/living-room/living-room.pov|'$scene'|" >render.sh
commands | sed -n 3p >pack.sh
step "retex-render $size" sh ./render.sh
step "$(cat pack.sh)" sh ./pack.sh
# The server of the docs, on free ports: of the room, and of the folder beside it.
serve() {
    (cd "$1" && exec python3 -u -m http.server 0 --bind 127.0.0.1) >"$2" 2>&1 &
    for _ in 1 2 3 4 5 6 7 8 9 10; do
        grep -qs 'port [0-9]' "$2" && return
        sleep 1
    done
}
result "$(commands | sed -n 4p | grep -cx '(cd room && python3 -m http.server)')" "the docs serve the folder"
serve room served-room
room_server=$!
serve . served-own
own_server=$!
port_of() { sed -n 's/.* port \([0-9]*\) .*/\1/p' "$1"; }
{
    sed -n '/^    <!doctype html>/,/^$/s/^    //p' "$here/docs/web.md"
    echo '<script type="module">const save = () => {};'
    sed -n '/^    const room = document/,/^$/s/^    //p' "$here/docs/web.md"
    echo '</script>'
} >own.html
cp photo.jpg oak.jpg
cp photo.jpg slate.jpg
step "the photograph on the floor, and a page of one's own" timeout 300 /usr/bin/python3 -B "$tests/newcomer.py" \
    "http://127.0.0.1:$(port_of served-room)/" "http://127.0.0.1:$(port_of served-own)/own.html" "$work" "$work/photo.jpg"
sed -n '/^#/p; s/^ok [0-9]* - /# /p' said
result "$([ "$(grep -c '^ok' said)" = 3 ] && ! grep -q '^not ok' said && echo 1)" "all that the pages must do"
kill "$room_server" "$own_server"
if command -v npm >/dev/null; then
    (cd room && npm pack --silent --cache "$work/npm") >packed 2>said
    tar tzf "room/$(tail -n 1 packed)" | sort | tr '\n' ' ' >held
    result "$([ "$(cat held)" = 'package/README.md package/package.json package/retex-room.d.ts package/retex-room.js ' ] && echo 1)" "npm pack: $(cat held)"
else
    skip "npm pack" "there is no npm"
fi
finish
