#!/bin/sh
# Retextured frames of a pan do not flicker: the temporal error of denoised and retextured sets is at most that of frames
# rendered again and denoised alike. table/frames.sh makes the frames, and takes the converged ones from truths where no
# pixel changed; KEEP_TRUTHS=1 keeps new ones there. docs/frames.md has the figures of larger ones.
set -u
. tests/lib/tap.sh
need_pictures "the pans"
FRAMES_WORK=$work/frames FRAMES_HEIGHT=32 FRAMES_SPP=32 FRAMES_TRUTH_SPP=512 FRAMES_SEEDS=1 tests/fidelity/table/frames.sh 2>"$work/err" ||
    sed 's/^/# /' "$work/err"
# temporal SCENE FRAMES: the figure.
temporal() { awk -F, -v s="$1" -v f="$2" '$1 == s && $3 == f { print $4 }' "$work/frames/frames.csv"; }
for scene in cornell-box living-room; do
    again=$(temporal $scene 'again denoised') clean=$(temporal $scene 'retextured denoised')
    noisy=$(temporal $scene again) set=$(temporal $scene retextured)
    echo "# $scene: temporal error of frames rendered again $noisy, retextured $set; denoised $again, retextured $clean"
    result "$(at_most "${clean:-1}" "${again:-0}")" "$scene: denoised and retextured frames flicker at most as those rendered again"
    result "$(at_most "${set:-1}" "1.02 * ${noisy:-0}")" "$scene: as rendered, retextured frames flicker as those rendered again"
done
finish
