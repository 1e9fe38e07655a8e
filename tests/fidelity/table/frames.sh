#!/bin/sh
# Whether retextured frames of an animation flicker: sets of a pan, denoised and retextured, against the frames rendered
# again and denoised alike.
#
#   make fidelity-frames    an hour on two cores, into $BUILD/fidelity-frames; with BENCH_DOCS=1 the page, its figures
#                           and its picture go to docs/ and docs/pictures/ too
#
# Two scenes of scenes/pan-*.pov, 12 frames each; every frame has noise of its own, its seed. Converged frames are
# rendered with the new textures. frames.py computes the figures. What is there from an earlier run is not made again.
#
# FRAMES_SCENES, FRAMES_HEIGHT, FRAMES_SPP, FRAMES_TRUTH_SPP and FRAMES_SEEDS choose less, or more; FRAMES_WORK is another
# folder.
set -eu
. tests/fidelity/table/lib.sh
work=${FRAMES_WORK:-$build/fidelity-frames}
scenes=${FRAMES_SCENES:-cornell-box living-room} height=${FRAMES_HEIGHT:-120} spp=${FRAMES_SPP:-64}
truth_spp=${FRAMES_TRUTH_SPP:-1024} seeds=${FRAMES_SEEDS:-1} frames=12
figures_python fidelity-frames
mkdir -p "$work"

settings="$height $spp $truth_spp"
figures_settings fidelity-frames "$work" "$settings"

size() {
    case $1 in living-room) echo $((height * 4 / 3))x$((height * 3 / 4)) ;; *) echo "${height}x$height" ;; esac
}
# The options before the new texture of each target: --texture of retex-combine, --replace of retex-render.
textures() { # SCENE OPTION
    case $1 in
    living-room) echo "$2 Floor=scenes/textures/terrazzo.jpg $2 Wall=scenes/textures/brick.jpg" ;;
    *) echo "$2 Floor=scenes/textures/brick.jpg" ;;
    esac
}
targets() {
    case $1 in living-room) echo '-t Floor -t Wall' ;; *) echo '-t Floor' ;; esac
}
render() { # SCENE OPTION…
    scene=$1
    shift
    retex-render -q --resume --frames 1-$frames -I "scenes/$scene" --size "$(size "$scene")" "$@" \
        "$here/scenes/pan-$scene.pov"
}
# The converged frames, one below the other, as the truths of lib.sh: $work/truth/pan-SCENE-HEIGHT.exr.
converged_frames() { # SCENE
    name=pan-$1-$height seen=$work/key/$1 new=$work/truth.new/$1
    mkdir -p "$work/key" "$work/truth" "$work/truth.new"
    # shellcheck disable=SC2046 # words wanted
    render "$1" --size 12x9 --spp 16 --seed 1000 $(textures "$1" --replace) -o "$seen-%02d.exr"
    oiiotool "$seen"-??.exr --mosaic 1x$frames -o "$seen.exr"
    kept=$(truth_file "$name" "$seen.exr" "$(size "$1") $truth_spp")
    ln -sfn "$kept" "$work/truth/$name.exr"
    [ ! -e "$kept" ] || return 0
    # shellcheck disable=SC2046
    render "$1" --spp "$truth_spp" --seed 5000 $(textures "$1" --replace) -o "$new-%02d.exr"
    oiiotool "$new"-??.exr --ch R,G,B --mosaic 1x$frames -d half -o "$new.exr"
    store_truth "$name" "$new.exr" "$kept"
    rm -r "$work/truth.new"
}

for scene in $scenes; do
    echo "fidelity-frames: $scene" >&2
    converged_frames "$scene"
    for seed in $seeds; do
        name=$work/$scene-seed$seed
        # shellcheck disable=SC2046
        {
            render "$scene" --spp "$spp" --seed $((seed * 100)) $(targets "$scene") -o "$name-set-%02d.exr"
            render "$scene" --spp "$spp" --seed $((seed * 100)) $(targets "$scene") --denoise -o "$name-clean-%02d.exr"
            again="$(textures "$scene" --replace) --spp $spp --seed $((seed * 100 + 50))"
            render "$scene" $again -o "$name-again-%02d.exr"
            render "$scene" $again --denoise -o "$name-rival-%02d.exr"
            for kind in set clean; do
                retex-combine -q "$name-$kind-%02d.exr" --frames 1-$frames $(textures "$scene" --texture) \
                    -o "$name-$kind-retextured-%02d.exr"
            done
        }
    done
done

# shellcheck disable=SC2086
"$python" "$here/table/frames.py" "$work" $frames "$(figures_head fidelity-frames)" "$settings" "$scenes" "$seeds" \
    >"$work/frames.md"
if [ -n "${BENCH_DOCS:-}" ]; then
    cp "$work/frames.md" "$work/frames.csv" docs/
    cp "$work/frames.jpg" docs/pictures/frames.jpg
fi
