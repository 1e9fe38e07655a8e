# shellcheck shell=sh
# The sentence at the head of a page with measured figures: by which command, build and machine. Sourced from the top of
# the repository.
figures_head() { # TARGET: the make target, unless make figures runs it
    commit=$(git rev-parse --short HEAD 2>/dev/null) || commit='an unknown state'
    git diff --quiet HEAD -- renderer tools oiio_plugins scenes 2>/dev/null || commit="$commit with changes"
    processor=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1)
    simd='without AVX2'
    ! grep -qw avx2 /proc/cpuinfo || simd='with AVX2'
    ! grep -qw avx512f /proc/cpuinfo || simd='with AVX-512'
    echo "\`${FIGURES_COMMAND:-make $1}\` made this page from commit $commit," \
        "on $(nproc) cores of ${processor:-an unknown processor} $simd."
}
