#!/bin/sh
# Runs the commands of docs/tutorial.md. The picture is smaller than the tutorial's, unless TUTORIAL_AS_WRITTEN=1.
# TUTORIAL_FOLDER=DIR works in DIR, which must be empty, and keeps it; with TUTORIAL_INSTALLED=DIR the tools are those in
# PATH, and the scenes are in DIR.
set -u
. tests/lib/tap.sh
. tests/lib/page_blocks.sh
page=$here/docs/tutorial.md
[ -z "${TUTORIAL_INSTALLED:-}" ] || PATH=${PATH#"$BUILD/bin:$BUILD/tests/bin:"}
smaller='s/--size 480x270/--size 160x90/g'
[ -z "${TUTORIAL_AS_WRITTEN:-}" ] || smaller=

folder=${TUTORIAL_FOLDER:-$work/folder}
scenes=${TUTORIAL_INSTALLED:-$here/scenes}
mkdir -p "$folder"
run_blocks "$page" "$folder" "$smaller"

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
