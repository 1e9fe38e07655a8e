# shellcheck shell=sh
# Sourced by the tests of retex-import that compare models with a scene in POV-Ray's words, import_reference.pov.

# first_hits SCENE FILE: the scene's surfaces that are seen first.
first_hits() { retex-render -q --plain --spp 1 --size 96x72 --aov depth,albedo,normal,uv "$1" -o "$2"; }

# reference: reference.exr.
reference() {
    cp "$TESTS/import_reference.pov" reference.pov
    first_hits reference.pov reference.exr
}

# look MODEL OPTION…: the model, seen by the camera of the reference, as MODEL's name with .exr.
look() {
    retex-import --exposure 0 -q "$@" -o scene || return
    grep '^camera' reference.pov >>scene/scene.pov
    first_hits scene/scene.pov "${1%.*}.exr"
    rm -r scene
}

# same FILE FILE: whether the same is seen first; prints what differs.
same() {
    for part in albedo depth uv; do
        retex-diff -q --part $part --allow-inf --fail-abs 0.0005 "$1" "$2" || echo $part differs
    done
}
