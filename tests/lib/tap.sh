# Sourced by shell tests, in the repository's root. Sets the path of the tools, makes a folder $work, and prints TAP.
export LC_ALL=C
here=$(pwd)
case $BUILD in /*) ;; *) BUILD=$here/$BUILD ;; esac
PATH=$BUILD/bin:$BUILD/tests/bin:$PATH
scenes=$here/scenes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
number=0

# result CONDITION NAME: one line of TAP. It is ok if the command CONDITION prints 1.
result() {
    number=$((number + 1))
    if [ "$1" = 1 ]; then echo "ok $number - $2"; else echo "not ok $number - $2"; fi
}
# skip NAME WHY: one skipped test.
skip() {
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}
# need_pictures NAME: ends the test with one that is skipped if Python cannot read pictures.
need_pictures() {
    /usr/bin/python3 -c 'import numpy, OpenImageIO' 2>/dev/null && return
    skip "$1" "python3-numpy or python3-openimageio is not installed"
    finish
    exit
}
# finish: prints the plan. To be called last.
finish() { echo "1..$number"; }

at_least() { awk "BEGIN { print ($1 >= $2) }"; }
at_most() { awk "BEGIN { print ($1 <= $2) }"; }
# figure A B KEY: a figure of retex-diff.
figure() {
    retex-diff --json "$1" "$2" | tr ',{}' '\n\n\n' | awk -F: -v key="\"$3\"" 'index($1, key) { print $2 + 0 }'
}
# same A B DECIBELS NAME: compares a retextured picture with its reference: at least DECIBELS dB, relMSE below 1e-4.
same() {
    psnr=$(figure "$1" "$2" psnr) relmse=$(figure "$1" "$2" relmse)
    echo "# $4: $psnr dB, relMSE $relmse"
    result "$([ "$(at_least "${psnr:-0}" "$3")$(at_most "${relmse:-1}" "${5:-1e-4}")" = 11 ] && echo 1)" "$4"
}
