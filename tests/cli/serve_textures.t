# retex-serve: thumbnails of textures; serve_textures.py has the checks.
$ mkdir rooms textures uploads
$ make_set raw.exr 64 48
$ retex-pack -q raw.exr -o rooms/textures.retex
$ make_picture outside.png size=8x8
$ /usr/bin/python3 "$TESTS/serve_textures.py" thumbnails formats refusals rooms sent
> thumbnails
> formats
> refusals
> rooms
> sent

# A configuration whose display has a look of its own: the images look as their files do.
$ cat >look.ocio <<'END'
+ ocio_profile_version: 2
+ roles: {default: lin, scene_linear: lin}
+ displays: {d: [!<View> {name: v, colorspace: dark}]}
+ colorspaces:
+   - !<ColorSpace> {name: lin}
+   - !<ColorSpace> {name: dark, from_scene_reference: !<MatrixTransform> {matrix: [.1,0,0,0, 0,.1,0,0, 0,0,.1,0, 0,0,0,1]}}
+   - !<ColorSpace> {name: sRGB, to_scene_reference: !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055}}
+ END
$ OCIO=look.ocio /usr/bin/python3 "$TESTS/serve_textures.py" thumbnails
> thumbnails
