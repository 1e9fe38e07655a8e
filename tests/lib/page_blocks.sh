# shellcheck shell=sh
# Sourced by tests of pages whose commands are run, after tap.sh.

# run_blocks PAGE FOLDER SED: runs the blocks of ```sh of a page in order, in one shell in FOLDER, where $scenes is what
# it is here; a block ```output after one is what it must print. SED changes them before: pictures may be smaller. Each is
# a test, named by its first line. The N-th is in $work/blocks/N, what it printed in N.out and N.err, a block of a server,
# ```sh server, in N.server.
run_blocks() {
    mkdir "$work/blocks"
    awk -v out="$work/blocks" '
        /^```sh$/ { file = sprintf("%s/%02d", out, ++n); next }
        /^```sh server$/ { file = sprintf("%s/%02d.server", out, ++n); next }
        /^```output$/ { file = sprintf("%s/%02d.output", out, n); next }
        /^```/ { file = ""; next }
        file { print > file }' "$1"
    {
        echo 'set -e'
        for block in "$work"/blocks/??; do
            echo "exec >'$block.out' 2>'$block.err'"
            sed "$3" "$block"
            echo ": >'$block.done'"
        done
    } >"$work/all"
    (cd "$2" && scenes=$scenes sh "$work/all" </dev/null)
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
}
