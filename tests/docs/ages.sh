#!/bin/sh
# ages.py finds pages that are older than their subject, in a repository made for it.
set -u
. tests/lib/tap.sh
mkdir -p "$work/tests/figures" "$work/docs" "$work/subject" "$work/other"
cp tests/figures/ages.py "$work/tests/figures"
cd "$work" || exit 1
git() { command git -c user.name=retex -c user.email=retex@localhost -c init.defaultBranch=main "$@" >/dev/null; }
commits() { # COUNT FOLDER
    for _ in $(seq "$1"); do
        echo "$1" >>"$2/file"
        git add -A
        git commit -m change
    done
}
page() { # TEXT, with COMMIT for that of HEAD
    echo "made this page from $1." | sed "s/COMMIT/$(command git rev-parse --short HEAD)/" >docs/speed.md
    git add -A
    git commit -m page
}
says() { # MESSAGE, or nothing; NAME
    /usr/bin/python3 -B tests/figures/ages.py >found
    status=$?
    if [ -z "$1" ]; then good=$([ "$status" = 0 ] && ! [ -s found ] && echo 1); else
        good=$([ "$status $(wc -l <found)" = '1 1' ] && grep -qE "$1" found && echo 1)
    fi
    [ -n "$good" ] || sed 's/^/# /' found
    result "${good:-0}" "$2"
}
echo 'speed | bench | 3 | subject | kept |' >tests/figures/pages.txt
git init
touch docs/speed.md
commits 1 subject
page 'commit COMMIT'
commits 60 other
says '' "a page whose subject nobody touched is not old"
commits 25 subject
says '' "25 changes are no age, with others between them"
echo more >>subject/file
says '26 changes of subject ago' "a change that is not committed counts as another one"
command git checkout -q subject
commits 1 subject
says '^docs/speed.md was made from commit [0-9a-f]+, 26 changes of subject ago: make figures PAGES=speed$' "26 changes are"
page 'commit COMMIT with changes'
says 'with changes: of no commit$' "a page of no commit"
page 'commit 0123456789abcdef'
says 'which HEAD does not stand on$' "a page of a commit that is not there"
page 'yesterday'
says 'does not say from which commit' "a page that does not say its commit"
page 'commit COMMIT'
echo 'speed | bench | 3 | gone | kept | | material' >tests/figures/pages.txt
says '' "a page whose material is not there"
mkdir material
says 'there is no gone$' "the same with its material"
echo 'speed | bench | 3 | gone | kept |' >tests/figures/pages.txt
says '^tests/figures/pages.txt: speed: there is no gone$' "a subject that is not there"
echo 'speed | bench | 3 | subject | kept |' >tests/figures/pages.txt
rm docs/speed.md
says "^there is no docs/speed.md: make figures PAGES=speed$" "a page that is not there"
finish
