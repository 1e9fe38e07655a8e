#!/bin/sh
# The options of the tools: what --help lists, what the man page has, and whether the tool takes it. Prints nothing where
# all agree.
pages=$TESTS/../../man
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

# Of --help: flags one a line, -x or --name.
of_help() { # FILE
    sed -n 's/^  \(-.\), \(--[a-z-]*\).*/\1\n\2/p; s/^      \(--[a-z-]*\).*/\1/p' "$1" | sort -u
}

# PAGE PATTERN: flags of the lines that the pattern matches; `Fl q , v` has two of them, `Fl -size Ar W` one.
of_page() {
    awk -v pattern="$2" '$0 ~ pattern {
        flag = 0
        for (i = 1; i <= NF; i++)
            if ($i == "Fl" || $i == ".Fl")
                flag = 1
            else if ($i ~ /^(Ar|Cm|Ns|Op|Oo|Oc|Xr|Ql|Sq|Pa|Li)$/)
                flag = 0
            else if (flag && $i ~ /^-?[A-Za-z][a-z-]*$/)
                print "-" $i
    }' "$1" | sort -u
}

for page in "$pages"/retex-*.1; do
    tool=$(basename "$page" .1)
    "$tool" --help >"$work/text"
    of_help "$work/text" >"$work/$tool.help"
    [ -s "$work/$tool.help" ] || echo "$tool --help lists nothing"
    of_page "$page" '^[.]It Fl' >"$work/man"
    comm -23 "$work/$tool.help" "$work/man" | sed "s/.*/$tool.1 lacks &, which --help lists/"
    comm -13 "$work/$tool.help" "$work/man" | sed "s/.*/$tool --help lacks &, which the man page has/"

    # In the synopsis letters may stand together: -qv.
    sed '/^[.]Sh DESCRIPTION/,$d' "$page" >"$work/synopsis"
    of_page "$work/synopsis" '^[.](Op )?Fl|[ ]Fl[ ]' | while read -r flag; do
        case $flag in
        --*) echo "$flag" ;;
        *) echo "${flag#-}" | sed 's/./-&\n/g' | sed '/^$/d' ;;
        esac
    done | sort -u | comm -23 - "$work/$tool.help" | sed "s/.*/the synopsis of $tool.1 has &, which there is not/"

    while read -r option; do
        # The second file is not there: a server does not start.
        timeout 20 "$tool" "$option" nowhere/1 nowhere/2 >"$work/out" 2>&1 </dev/null
        [ $? != 124 ] || echo "$tool $option does not end"
        grep 'error: .*\(unknown option\|takes no\)' "$work/out" | sed "s/^/$tool --help lists $option, but: /"
    done <"$work/$tool.help"
done

# The AOVs of retex-render, by its own message, are those that the page describes.
retex-render --aov '?' scene.pov 2>&1 | sed -n 's/.*: expected \(.*\), not .*/\1/p' | tr -d , | tr ' ' '\n' | sort >"$work/aovs"
[ -s "$work/aovs" ] || echo "retex-render --aov '?' lists nothing"
sed -n '/^[.]It Fl -aov Ar/,/^[.]It Fl -aov-dir/s/^[.]Cm //p' "$pages/retex-render.1" | tr -s ' ,.' '\n' | sed '/^$/d' |
    sort -u >"$work/man"
comm -3 "$work/aovs" "$work/man" | sed 's/.*/retex-render.1 and the AOVs there are differ by &/'

# An option that a page speaks of is one that there is, in a tool or, in retex-oiio(7), in oiiotool.
{
    cat "$work"/*.help
    echo --tocolorspace
} | sort -u >"$work/all"
for page in "$pages"/*.[0-9]; do
    of_page "$page" '^[.]Fl -|[ ]Fl -' | grep -e -- | comm -23 - "$work/all" |
        sed "s/.*/${page##*\/} speaks of &, which no tool has/"
done
