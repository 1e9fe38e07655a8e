#!/bin/sh
# Runs one file of command-line cases: case.sh SUITE FILE (tests/SUITE/FILE), in a fresh folder, and prints TAP.
#
# A file is a list of blocks. Lines of a block begin with
#     $  a command for sh; the next lines are its exact result
#     +  the command's next line
#     >  a line of its standard output
#     !  a line of its standard error
#     =  its exit status, if it is not 0
#     %  a line of shell that all commands below begin with: functions, variables, a folder
# A block that expects nothing ends at the first command that fails, in a loop too.
# Empty lines and lines with # are comments. Files of earlier commands remain for later ones. $SCENES is the folder of
# scenes, $TESTS that of the suite. A block with the command `skip-without COMMAND why` skips the rest of the file if
# COMMAND is not installed, a block with `skip-unless COMMAND` if COMMAND fails. Programs of suite oiio find the plugins
# of retex. case.sh --update SUITE FILE writes the present results of the commands into the file.
set -u
update=
[ "$1" != --update ] || { update=1; shift; }
here=$(pwd)
file=$here/tests/$1/$2
SCENES=$here/scenes
TESTS=$here/tests/$1
LC_ALL=C
case $BUILD in /*) build=$BUILD ;; *) build=$here/$BUILD ;; esac
PATH=$build/bin:$build/tests/bin:$PATH
export PATH SCENES TESTS LC_ALL
[ "$1" != oiio ] || export OIIO_LIBRARY_PATH="$build/plugins"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/here"
cd "$folder/here" || exit 1

number=0 skipping= functions=
newline='
'

# Run $command and print its block into ../actual.
run() {
    if grep -q '^[>!=]' ../expected; then
        sh -c "$functions$command"
    else
        sh -ec "$functions$command"
    fi >../out 2>../err </dev/null
    status=$?
    {
        printf '%s\n' "$command" | sed '1s/^/$ /; 1!s/^/+ /; s/^+ $/+/'
        sed -e '$a\' ../out | sed 's/^/> /; s/ $//'
        sed -e '$a\' ../err | sed 's/^/! /; s/ $//'
        [ "$status" = 0 ] || echo "= $status"
    } >../actual
}

# The block read so far is complete: run it and compare.
finish() {
    [ -n "$command" ] || return 0
    number=$((number + 1))
    name=${command%%"$newline"*}
    case $command in
    skip-without\ *)
        # shellcheck disable=SC2086 # words wanted
        set -- $command
        command -v "$2" >/dev/null || skipping="$2 is not on this machine"
        cp ../expected ../actual
        ;;
    skip-unless\ *)
        sh -c "$functions${command#skip-unless }" >/dev/null 2>&1 </dev/null ||
            skipping="${command#skip-unless } fails here"
        cp ../expected ../actual
        ;;
    *) [ -n "$skipping" ] || run ;;
    esac
    if [ -n "$skipping" ]; then
        [ -z "$update" ] || cat ../expected >>../updated
        printf '%s\n' "ok $number - $name # SKIP $skipping"
    elif [ -n "$update" ]; then
        cat ../actual >>../updated
    elif cmp -s ../expected ../actual; then
        printf '%s\n' "ok $number - $name"
    else
        printf '%s\n' "not ok $number - $name"
        diff -u ../expected ../actual | sed '1,3d; s/^/# /'
    fi
    command=
}

command=
while IFS= read -r line || [ -n "$line" ]; do
    case $line in
    '$ '*)
        finish
        command=${line#'$ '}
        printf '%s\n' "$line" >../expected
        ;;
    '+'*)
        printf '%s\n' "$line" >>../expected
        line=${line#+}
        command=$command$newline${line#' '}
        ;;
    '>'* | '!'* | '='*) printf '%s\n' "$line" >>../expected ;;
    *)
        finish
        [ -z "$update" ] || printf '%s\n' "$line" >>../updated
        case $line in '%'*)
            line=${line#%}
            functions=$functions${line#' '}$newline
            ;;
        esac
        ;;
    esac
done <"$file"
finish
echo "1..$number"
[ -z "$update" ] || cp ../updated "$file"
