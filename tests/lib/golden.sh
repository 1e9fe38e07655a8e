#!/bin/sh
# Runs one golden test: golden.sh tests/golden/NAME, and prints TAP.
#
# The folder has three files. `command` is a shell script that writes actual.exr into the current folder, which is
# empty; $GOLDEN is the folder of the test, $SCENES that of the scenes. `expected.exr` is the reference, 64 to 128
# pixels a side. `tolerance` has options of retex-diff, each with its reason after a #. Without `tolerance` the picture
# must be the same to the bit. A missing reference is a failure. golden.sh --actual FOLDER FILE keeps the picture and
# does not compare it.
set -u
keep=
here=$(pwd)
if [ "$1" = --actual ]; then
    case $3 in /*) keep=$3 ;; *) keep=$here/$3 ;; esac
    set -- "$2"
fi
GOLDEN=$here/$1
SCENES=$here/scenes
LC_ALL=C
case $BUILD in /*) build=$BUILD ;; *) build=$here/$BUILD ;; esac
PATH=$build/bin:$build/tests/bin:$PATH
export PATH SCENES GOLDEN LC_ALL
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() {
    echo "not ok 1 - ${GOLDEN##*/}"
    echo "# $1"
    [ ! -e out ] || sed 's/^/# /' out
    echo 1..1
    exit 1
}
sh -e "$GOLDEN/command" >out 2>&1 </dev/null || fail "its command failed"
[ -e actual.exr ] || fail "its command made no actual.exr"
if [ -n "$keep" ]; then
    cp actual.exr "$keep"
    exit
fi
[ -e "$GOLDEN/expected.exr" ] || fail "there is no reference: make check-update CASE=golden/${GOLDEN##*/}"
options=
[ ! -e "$GOLDEN/tolerance" ] || options=$(sed 's/#.*//' "$GOLDEN/tolerance" | tr '\n' ' ')
# shellcheck disable=SC2086 # words wanted
retex-diff $options actual.exr "$GOLDEN/expected.exr" >>out 2>&1 || fail "differs from its reference"
echo "ok 1 - ${GOLDEN##*/}"
echo 1..1
