# A program of an older release, whose parameter structs are shorter than the library's: nothing beyond them is read or
# written, and what they lack has its default.
$ make_set room.exr 48 32 3
$ oiiotool --pattern fill:topleft=1,0,0:topright=0,1,0:bottomleft=0,0,1:bottomright=1,1,1 16x16 3 -d uint8 -o wood.png
$ "$TESTS/../install/older.sh" "$(dirname "$(command -v retex-diff)")/../lib"
> retex_limits_set: ok
> retex_limits_environment: ok
> retex_budget_set_limits: 4711 pixels
> retex_limits_safe: 60 seconds
> retex_access_check: ok
> retex_access_open: ok
> retex_access_open_folder: ok
> retex_file_sum: ok
> retex_image_read_check: ok
> retex_image_read: ok
> retex_image_write_check: ok
> retex_image_format_check: ok
> retex_image_write: ok
> retex_diff: ok
> retex_picture_open: ok
> retex_picture_open_memory: ok
> retex_image_alloc: ok
> retex_picture_encode: ok
> retex_edit_create: ok
> retex_edit_option: ok
> retex_edit_option: ok
> retex_edit_set: ok
> retex_edit_develop: ok
> retex_edit_develop: 2
> retex_edit_add: ok
> retex_edit_options_text: ok
> retex_edit_image_text: wood.png of scale=3,3
> retex_texture_spec_needs_scale: 0
> retex_texture_file: ok
> retex_texture_load: ok
> retex_texture_spec_unplace: scale 1
> retex_texture_specs_alike: 1
> retex_texture_layer_get: ''
> retex_texture_layer_set: ok
> retex_texture_spec_join: ok
> retex_textures_check: ok
> retex_textures_load: ok
> retex_textures_place: ok
> retex_retexture: ok
> retex_auto_exposure: ok
> retex_estimate_error: ok
> retex_kept_samples_create: ok
> retex_sample_textures: ok
> retex_set_refer: ok
> retex_set_write_samples: ok
> retex_set_open_any: ok
> retex_set_open_referred: ok
> retex_sample: ok
> retex_combine: ok
> retex_image_write: ok
> retex_texture_create: ok
> retex_combine: ok
> retex_solve: ok
> retex_is_picture: 1
> retex_set_read_light_groups: ./older.exr has no light groups: no layer Combined_NAME
> retex_denoise_picture: ok
> retex_set_get_info: 48 x 32, paper, lib_test
> retex_set_describe: ok
> retex_set_describe: older
> retex_set_write: ok
> retex_pack_level: 0
> retex_pack_write: ok
> retex_web_write: this set cannot be written for browsers: its layout is not footprints
> retex_denoise: the set lacks the part guide_normal: it was rendered or packed without what denoising needs, or is denoised already
> 11 files were opened
$ retex-combine -q room.exr --texture Wall='rgb(0.1,0.2,0.3)' --texture:scale=3 Floor=wood.png -o expected.exr && cmp expected.exr older.exr
