#!/bin/sh
# Updates one reference, on a clean tree: update.sh golden/NAME | cli/NAME | oiio/NAME | fidelity/NAME. Prints the old
# and the new one.
set -eu
case=${1-}
if [ -z "$case" ]; then
    echo "which one? make check-update CASE=golden/NAME or CASE=cli/NAME" >&2
    exit 2
fi
if [ -n "$(git status --porcelain --untracked-files=no)" ]; then
    echo "the tree has changes that are not committed: commit them first, so that what made the reference is known" >&2
    exit 2
fi
suite=${case%%/*} name=${case#*/}
case $suite in
golden)
    folder=tests/golden/$name
    new=$(mktemp)
    trap 'rm -f "$new"' EXIT
    tests/lib/golden.sh --actual "$folder" "$new"
    [ -s "$new" ] || exit 1
    if [ -e "$folder/expected.exr" ]; then
        echo "before (A) and after (B):"
        "$BUILD/bin/retex-diff" --all-parts --allow-inf "$folder/expected.exr" "$new" || true
    else
        echo "before: none"
    fi
    cat "$new" >"$folder/expected.exr" # with the mode of new files, not of temporary ones
    ls -l "$folder/expected.exr"
    ;;
cli | oiio | fidelity)
    tests/lib/case.sh --update "$suite" "${name%.t}.t"
    git --no-pager diff -- "tests/$suite"
    ;;
*)
    echo "unknown suite '$suite'" >&2
    exit 2
    ;;
esac
