# shellcheck shell=sh
# What the makers of pages with measured figures share; sourced from the top of the repository.

# The sentence at the head of a page: by which command, build and machine.
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

# The Python interpreter for figures, in $python, with what it needs.
figures_python() { # NAME: of the make target, for the message
    export PYTHONDONTWRITEBYTECODE=1
    python=${PYTHON:-/usr/bin/python3}
    "$python" -c 'import numpy, OpenImageIO' 2>/dev/null || {
        echo "$1: $python needs numpy and OpenImageIO (python3-numpy, python3-openimageio)" >&2
        exit 1
    }
}

# Pictures that other settings made are not to be taken for these: stops where the folder has such.
figures_settings() { # NAME FOLDER SETTINGS
    [ -e "$2/settings" ] || echo "$3" >"$2/settings"
    if [ "$(cat "$2/settings")" != "$3" ]; then
        echo "$1: $2 has pictures of $(cat "$2/settings"), not of $3: remove it" >&2
        exit 1
    fi
}
