#!/bin/sh
# Models of other people, imported, beside three.js, which reads the same files with decoders of its own.
#
#   make fidelity-models     into $BUILD/fidelity-models; with BENCH_DOCS=1 the page and its pictures go to docs/ too
#
# The models are not in the repository. models.csv lists them: where each is from, at which revision, its licence and its
# hash. $RETEX_MODELS, or ../shared/models, is a folder in which each has a folder of its name, with the file and those
# beside it that it names. Models that are not there, or are others, are told and left out. three.js is an npm package;
# it is installed below $BUILD/fidelity-models, and runs in Chromium. MODELS names some of them, MODELS_SPP the samples.
set -eu
. tests/figures/head.sh
build=${BUILD:-build}
from=${RETEX_MODELS:-${RETEX_SHARED:-../shared}/models} work=$(cd "$build" && pwd)/fidelity-models
PATH=$(cd "$build" && pwd)/bin:$PATH
three=0.187.0
if [ ! -d "$from" ]; then
    echo "fidelity-models: there is no $from: skipped" >&2
    exit
fi
figures_python fidelity-models
tools/setup.sh web >&2 || {
    echo "fidelity-models: chromium and python3-websocket are needed" >&2
    exit 1
}
mkdir -p "$work/scenes"
[ -d "$work/node_modules/three" ] || (cd "$work" && npm install --silent --no-save "three@$three" >&2)
cp tests/fidelity/table/models.html "$work/"
ln -sfn "$(cd "$from" && pwd)" "$work/models"
"$python" tests/fidelity/table/models.py "$work" "$(figures_head fidelity-models)" "${MODELS_SPP:-32}" ${MODELS:-}
if [ "${BENCH_DOCS:-0}" = 1 ]; then
    cp "$work/models.md" docs/
    cp "$work"/models-*.jpg docs/pictures/
fi
