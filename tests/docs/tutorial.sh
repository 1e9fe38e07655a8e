#!/bin/sh
# Runs the commands of docs/tutorial.md: blocks of ```sh in order, in one shell; a block ```output after one is what it
# must print. The picture is smaller than the tutorial's, unless TUTORIAL_AS_WRITTEN=1. TUTORIAL_FOLDER=DIR works in
# DIR, which must be empty, and keeps it; with TUTORIAL_INSTALLED=DIR the tools are those in PATH, and the scenes are in DIR.
set -u
. tests/lib/tap.sh
page=$here/docs/tutorial.md
[ -z "${TUTORIAL_INSTALLED:-}" ] || PATH=${PATH#"$BUILD/bin:$BUILD/tests/bin:"}
smaller='s/--size 480x270/--size 160x90/g'
[ -z "${TUTORIAL_AS_WRITTEN:-}" ] || smaller=

# The N-th block goes to blocks/N, its server to blocks/N.server, what it prints to blocks/N.output.
mkdir "$work/blocks"
awk -v out="$work/blocks" '
    /^```sh$/ { file = sprintf("%s/%02d", out, ++n); next }
    /^```sh server$/ { file = sprintf("%s/%02d.server", out, ++n); next }
    /^```output$/ { file = sprintf("%s/%02d.output", out, n); next }
    /^```/ { file = ""; next }
    file { print > file }' "$page"

folder=${TUTORIAL_FOLDER:-$work/folder}
mkdir -p "$folder"

# One shell runs all blocks, as a reader's terminal does. It writes what each prints to N.out.
{
    echo 'set -e'
    for block in "$work"/blocks/??; do
        echo "exec >'$block.out' 2>'$block.err'"
        sed "$smaller" "$block"
        echo ": >'$block.done'"
    done
} >"$work/all"
(cd "$folder" && scenes=${TUTORIAL_INSTALLED:-$here/scenes} sh "$work/all" </dev/null)

for block in "$work"/blocks/??; do
    title=$(head -n 1 "$block")
    good=$([ -e "$block.done" ] && echo 1)
    if [ -n "$good" ] && [ -e "$block.output" ] && ! cmp -s "$block.output" "$block.out"; then
        good=
        diff "$block.output" "$block.out" | sed 's/^/# /'
    fi
    [ -n "$good" ] || sed 's/^/# /' "$block.err" 2>/dev/null
    result "${good:-0}" "$title"
done

# The server: on a free port, and until its page and what the page asks for first have been read.
for server in "$work"/blocks/??.server; do
    port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("", 0)); print(s.getsockname()[1])')
    (cd "$folder/my-room" && exec timeout 20 sh -c "exec $(sed "s/8000/$port/" "$server")") >/dev/null 2>&1 &
    pid=$!
    answer=$(curl -s --retry 40 --retry-delay 1 --retry-connrefused "http://localhost:$port/room.json" | head -c 9)
    page_there=$(curl -s "http://localhost:$port/" | grep -c '<retex-room')
    kill $pid
    result "$([ -n "$answer" ] && [ "$page_there" -ge 1 ] && echo 1)" "$(cat "$server")"
done

# Pictures that the text compares differ; those of the folder and of the table are all there.
cd "$folder/my-room" || exit 1
differ=1
for pair in 'walnut.jpg room.jpg' 'blue.jpg room.jpg' 'damask.jpg small-damask.jpg' 'noisy.jpg room.jpg' \
    'rooms/walnut.jpg rooms/both.jpg' 'marble.jpg walnut.jpg'; do
    # shellcheck disable=SC2086 # words wanted
    retex-diff $pair >/dev/null
    [ $? = 1 ] || { echo "# $pair"; differ=; }
done
result "${differ:-0}" "the pictures differ from each other"
count=$(find floors rooms -name '*.jpg' | wc -l)
result "$([ "$count" = $(($(find scenes/textures -name '*.jpg' | wc -l) + 3)) ] && echo 1)" "one picture for each texture and row"
same from-pack.jpg walnut.jpg 30 "the pack gives the set's picture" 1
# Exactly once each: the folder's name in the loop, the tool's default in the table.
result "$(cmp -s rooms/walnut.jpg walnut.jpg && cmp -s floors/walnut-herringbone.jpg walnut.jpg && echo 1)" \
    "the loop, the table and the single command give the same bytes"
finish
