#!/bin/sh
# The figures in texts are those of the pages; and quote.py finds each way in which they may not be.
set -u
. tests/lib/tap.sh
mkdir "$work/tests" "$work/as-is"
cp -r tests/figures tests/times.txt "$work/tests"
cp -r --parents README.md CONTRIBUTING.md tests/README.md docs man "$work/as-is"
quote() { /usr/bin/python3 -B tests/figures/quote.py "$@" >found; }
cd "$work" || exit 1
# again: the texts as they are, the pages' figures beside them.
again() { rm -rf README.md docs man && cp -r as-is/* .; }

again
quote --check
status=$?
sed 's/^/# /' found
result "$([ $status = 0 ] && ! [ -s found ] && echo 1)" "all texts have the figures of the pages"

# finds FILE EDIT MESSAGE [LINES]: of that file, edited by sed, quote.py prints the message, in so many lines as it says
# (1), and exits with 1.
finds() {
    again
    sed -i -E "$2" "$1"
    quote --check
    status=$?
    result "$([ "$status $(wc -l <found)" = "1 ${4:-1}" ] && grep -qE "$3" found && echo 1)" "found: $3"
}
finds README.md 's/(denoised and packed \| )[0-9.]+ MB/\1123 MB/' \
    '^README.md:[0-9]+: post_size one pack: the text has 123 MB, the page [0-9.]+ MB$'
finds man/retex-pack.1 's/(often closer, by up to )[0-9.]+ dB/\199 dB/' \
    '^man/retex-pack.1:[0-9]+: pack_gains rendered 90: the text has 99 dB, the page [0-9.]+ dB$'
finds README.md 's/plain picture, one target/picture/' \
    '^README.md: no longer has: plain picture, one target \| \{overhead 1\} \| \[overhead\]$' 2
finds docs/faq.md 's/^- (A set takes.*two)$/- \1. \1/' \
    '^docs/faq.md: has more than once: A set takes \{overhead 1\} more time'
finds docs/serve.csv 's/^(304,processor_ms),.*/\1,9/' \
    '^docs/serve.md:[0-9]+: serve_cost 304: the text has .* the page 9 ms$'
finds tests/README.md 's/[0-9]+ minutes/99 minutes/' '^tests/README.md:[0-9]+: tests_take check: the text has 99 minutes, the page [0-9]+ minutes$'
finds docs/serve.csv '/^304,/d' '^docs/serve.md:[0-9]+: serve_cost 304: .*has no row with'

finds docs/faq.md 's/(One core makes)/It takes 3.5 s. \1/' '^docs/faq.md:[0-9]+: no page makes the figure 3.5 s: '
finds man/retex-serve.1 's/default 2048 MB/default 2049 MB/' '^man/retex-serve.1:[0-9]+: no page makes the figure 2049 MB: ' 2
finds docs/web.md 's/requires 38 dB/asks for 38 dB/' '^given.txt: no text has: requires 38 dB' 2
again
sed -i '/^? common knowledge/,$d' tests/figures/given.txt
quote --check
result "$(grep -c '^docs/faq.md:[0-9]*: no page makes the figure 50 percent' found)" "a figure is given by its excerpt alone"
cp "$OLDPWD/tests/figures/given.txt" tests/figures/
again
fmt -w 60 as-is/docs/serve.md >docs/serve.md
result "$(quote --check && echo 1)" "lines may be broken elsewhere"

again
sed -i -E 's/(1080x1080 in) [0-9.]+ s with [0-9]+ MB/\1 12 s with 1.5 GB/' docs/faq.md
result "$(cmp -s docs/faq.md as-is/docs/faq.md || echo 1)" "a text has other figures"
quote --update
result "$(cmp docs/faq.md as-is/docs/faq.md && ! [ -s found ] && echo 1)" "--update writes figures into the text"
sed -i 's/one target/a target/' README.md
result "$(quote --update || grep -c '^README.md: no longer has: plain picture' found)" "--update tells what it cannot write"
finish
