#!/bin/sh
# Sample scenes of POV-Ray, as Debian's povray-examples has them, are read: each line of examples.txt says how. `clear`:
# in full, nothing reported as not supported; `reported`: all is understood, what is left out is reported; `stops`: what
# is left out would make a wrong picture, and --lenient is needed. A scene that is read better is no failure but told, so
# that the list can be brought up to date.
set -u
. tests/lib/tap.sh
folder=/usr/share/povray-3.7/scenes
if [ ! -e "$folder/radiosity/cornell.pov" ]; then
    skip "sample scenes" "Debian's povray-examples is not installed"
    finish
    exit
fi
grep -v '^#' tests/long/examples.txt >"$work/list"
while read -r expected name options; do
    # Some include files of their own folder, and some would like to write there.
    cd "$folder/$(dirname "$name")" || exit 1
    # shellcheck disable=SC2086 # words wanted
    timeout 120 retex-render --list-targets --size 8x6 $options "$(basename "$name")" >"$work/out" 2>"$work/err" \
        </dev/null
    status=$?
    cd "$here" || exit 1
    found=clear
    ! grep -q 'is not supported' "$work/err" || found=reported
    [ $status = 0 ] || found="status $status: $(grep -m 1 'error:' "$work/err")"
    [ "$status" != 2 ] || ! grep -q 'error: .*with --lenient' "$work/err" || found=stops
    case "$expected $found" in
    'reported clear' | 'stops clear' | 'stops reported') echo "# $name is $found by now" ;;
    esac
    case "$expected $found" in
    'clear clear' | 'reported reported' | 'reported clear' | 'stops stops' | 'stops reported' | 'stops clear')
        result 1 "$name"
        ;;
    *)
        result 0 "$name"
        echo "# expected $expected, found $found"
        ;;
    esac
done <"$work/list"
finish
