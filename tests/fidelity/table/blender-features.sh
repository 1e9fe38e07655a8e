#!/bin/sh
# Features of Blender, each in a scene of its own, exported and beside Cycles' picture: make fidelity-blender. With
# BENCH_DOCS=1 the page goes to docs/ too. The figures are those of tests/long/blender-features.sh, which fails where a
# difference is not told; here they only become a page.
set -eu
. tests/figures/head.sh
build=${BUILD:-build} work=${BUILD:-build}/fidelity-blender
PATH=$(cd "$build" && pwd)/bin:$PATH
if ! command -v blender >/dev/null; then
    echo "fidelity-blender: there is no blender: skipped" >&2
    exit
fi
mkdir -p "$work"
sh tests/long/blender-features.sh >"$work/features.tap"
{
    cat <<END
# Blender, feature by feature

\`tests/long/blender-features.sh\` makes a scene for each feature, renders it by Cycles, exports it by the
[add-on](blender.md) and renders it here, both with 64 samples at 160x120. Compared are the means of 8 x 6 regions, which
have some noise. The last column is what the export tells of that it leaves out.
$(figures_head fidelity-blender)

| feature | regions differ: median | most | within 5 % | told |
|---|---|---|---|---|
END
    sed -n 's/^# |/|/p' "$work/features.tap"
} >"$work/blender-features.md"
[ "${BENCH_DOCS:-}" != 1 ] || cp "$work/blender-features.md" docs/
