"""What the package uses of the public headers. Written by tools/python/interface.py."""
import ctypes
from ctypes import CFUNCTYPE, POINTER, c_char, c_char_p, c_double, c_float, c_int, c_long
from ctypes import c_size_t, c_uint, c_uint64, c_void_p
from typing import Any, Dict, List, Tuple


class RetexError(ctypes.Structure):
    _fields_ = [("code", c_int), ("line", c_int), ("column", c_int), ("file", c_char * 512), ("message", c_char * 1024)]


class RetexCut(ctypes.Structure):
    _fields_ = [("x", c_int), ("y", c_int), ("width", c_int), ("height", c_int), ("scaled_width", c_int),
                ("scaled_height", c_int)]


class RetexDenoiseParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("strength", c_float), ("radius", c_int), ("footprints", c_int), ("scalar", c_int),
                ("progress", CFUNCTYPE(None, c_void_p, c_double)), ("progress_context", c_void_p), ("near", c_char_p),
                ("budget", c_void_p), ("full_precision", c_int), ("denoiser", c_char_p), ("quality", c_char_p)]


class RetexDenoisePictureParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("layers", POINTER(c_char_p)), ("nlayers", c_int), ("other_half", c_char_p),
                ("variance", c_char_p), ("normal", c_char_p), ("albedo", c_char_p), ("position", c_char_p), ("depth",
                c_char_p), ("access", c_void_p), ("note", CFUNCTYPE(None, c_void_p, c_int, c_char_p)), ("note_context",
                c_void_p)]


class RetexDevelop(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("exposure", c_double), ("white_balance", c_double), ("auto_exposure", c_int)]


class RetexAdjustment(ctypes.Structure):
    _fields_ = [("kind", c_int), ("value", c_float * 3)]


class RetexTextureLayer(ctypes.Structure):
    _fields_ = [("image", c_char * 256), ("colorspace", c_char * 64), ("scale", c_double * 2), ("rotate", c_double),
                ("offset", c_double * 2), ("width", c_double * 2), ("flip", c_int * 2), ("has_at", c_int), ("at",
                c_double * 2), ("nadjustments", c_int), ("adjustments", RetexAdjustment * 9), ("metric", c_int)]


class RetexTextureSpec(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("target", c_char * 128), ("image", c_char * 1024), ("constant", c_int), ("color",
                c_float * 3), ("scale", c_double * 2), ("rotate", c_double), ("offset", c_double * 2), ("wrap", c_int *
                2), ("colorspace", c_char * 64), ("flip", c_int * 2), ("repeat", c_int), ("width", c_double * 2),
                ("uv_scale", c_double * 2), ("uv_min", c_double * 2), ("uv_max", c_double * 2), ("access", c_void_p),
                ("warn", CFUNCTYPE(None, c_void_p, c_char_p)), ("warn_context", c_void_p), ("is_light", c_int),
                ("budget", c_void_p), ("periodic", c_int * 2), ("finish", c_char * 1024), ("nfinishes", c_int),
                ("roughness", c_float * 4), ("nadjustments", c_int), ("adjustments", RetexAdjustment * 9), ("grout",
                c_double), ("grout_color", c_float * 3), ("vary", c_int), ("vary_seed", c_uint), ("tiles", (c_char *
                256) * 8), ("has_at", c_int), ("at", c_double * 2), ("normal", c_int), ("normal_tilt", c_double),
                ("nlayers", c_int), ("layers", RetexTextureLayer * 4), ("metric", c_int), ("unit", c_double)]


class RetexCombineParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("cross", c_int), ("y0", c_int), ("y1", c_int), ("x0", c_int), ("x1", c_int),
                ("parameters", POINTER(c_float)), ("terms_only", c_int), ("develop", POINTER(RetexDevelop)), ("kept",
                POINTER(c_void_p))]


class RetexImage(ctypes.Structure):
    _fields_ = [("width", c_int), ("height", c_int), ("channels", c_int), ("pixels", POINTER(c_float))]


class RetexReadParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("colorspace", c_char_p), ("max_pixels", c_long), ("access", c_void_p), ("budget",
                c_void_p), ("pixel_bytes", c_uint), ("warn", CFUNCTYPE(None, c_void_p, c_char_p)), ("warn_context",
                c_void_p)]


class RetexWriteParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("display", c_char_p), ("view", c_char_p), ("colorspace", c_char_p), ("quality",
                c_int), ("is_data", c_int), ("depth", c_int)]


class RetexPackParams(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("quality", c_int), ("lossless", c_int), ("warn", CFUNCTYPE(None, c_void_p,
                c_char_p)), ("warn_context", c_void_p), ("levels", c_int)]


#: Arguments and result of each call.
CALLS: Dict[str, Tuple[List[Any], Any]] = {
    "retex_color_parse": ([POINTER(c_float), c_char_p, POINTER(RetexError)], c_int),
    "retex_cut_fit": ([POINTER(RetexCut), c_int, c_int, POINTER(c_int), c_int, c_int, POINTER(RetexError)], c_int),
    "retex_denoise": ([c_void_p, POINTER(RetexDenoiseParams), c_void_p, c_int, POINTER(RetexError)], c_int),
    "retex_denoise_has_data": ([c_void_p], c_int),
    "retex_denoise_picture": ([c_char_p, c_char_p, POINTER(RetexDenoisePictureParams), POINTER(RetexDenoiseParams),
        c_int, POINTER(RetexError)], c_int),
    "retex_edit_close": ([POINTER(c_void_p)], None),
    "retex_edit_count": ([c_void_p], c_int),
    "retex_edit_create": ([POINTER(c_void_p), POINTER(RetexError)], c_int),
    "retex_edit_develop": ([c_void_p, POINTER(RetexDevelop), POINTER(RetexError)], c_int),
    "retex_edit_image_text": ([POINTER(RetexTextureSpec), c_char_p, c_size_t], None),
    "retex_edit_lights": ([c_void_p], c_int),
    "retex_edit_option": ([c_void_p, c_char_p, c_char_p, POINTER(RetexError)], c_int),
    "retex_edit_options_text": ([POINTER(RetexTextureSpec), POINTER(c_void_p), POINTER(RetexError)], c_int),
    "retex_edit_parameters": ([c_void_p, c_void_p, POINTER(c_float), POINTER(RetexError)], c_int),
    "retex_edit_parse": ([c_void_p, c_char_p, POINTER(RetexError)], c_int),
    "retex_edit_set": ([c_void_p, c_char_p, c_char_p, POINTER(RetexError)], c_int),
    "retex_edit_solo": ([c_void_p, c_char_p, POINTER(RetexError)], c_int),
    "retex_edit_text": ([c_void_p, c_int, POINTER(c_void_p), POINTER(RetexError)], c_int),
    "retex_edit_texture": ([c_void_p, c_int], POINTER(RetexTextureSpec)),
    "retex_edit_view": ([c_void_p], c_char_p),
    "retex_estimate_error": ([c_void_p, POINTER(c_void_p), POINTER(RetexCombineParams), c_void_p, c_void_p, c_int,
        POINTER(RetexError)], c_int),
    "retex_image_alloc": ([POINTER(RetexImage), c_int, c_int, c_int, POINTER(RetexError)], c_int),
    "retex_image_free": ([POINTER(RetexImage)], None),
    "retex_image_keep_rows": ([c_void_p, c_int, c_int, POINTER(c_float), POINTER(RetexError)], c_int),
    "retex_image_read": ([POINTER(RetexImage), c_char_p, POINTER(RetexReadParams), c_int, POINTER(RetexError)], c_int),
    "retex_image_write": ([POINTER(RetexImage), c_char_p, POINTER(RetexWriteParams), c_int, POINTER(RetexError)],
        c_int),
    "retex_pack_write": ([c_void_p, c_char_p, POINTER(RetexPackParams), POINTER(c_size_t), c_int, POINTER(RetexError)],
        c_int),
    "retex_picture_close": ([POINTER(c_void_p), c_int, POINTER(RetexError)], c_int),
    "retex_picture_open_memory": ([POINTER(c_void_p), c_char_p, c_int, c_int, c_int, POINTER(RetexWriteParams),
        POINTER(RetexError)], c_int),
    "retex_picture_rows": ([c_void_p, c_int, c_int, POINTER(c_float), POINTER(RetexError)], c_int),
    "retex_picture_take": ([POINTER(c_void_p), POINTER(c_void_p), POINTER(c_size_t), POINTER(RetexError)], c_int),
    "retex_preset_read": ([c_void_p, c_char_p, POINTER(RetexError)], c_int),
    "retex_preset_write": ([c_void_p, c_char_p, POINTER(RetexError)], c_int),
    "retex_retexture": ([c_void_p, POINTER(c_void_p), POINTER(RetexCombineParams), c_void_p, c_void_p, c_int,
        POINTER(RetexError)], c_int),
    "retex_sample_textures": ([c_void_p, POINTER(c_void_p), POINTER(RetexTextureSpec), c_int, c_char_p, c_int,
        POINTER(RetexError)], c_int),
    "retex_set_close": ([POINTER(c_void_p)], None),
    "retex_set_find_target": ([c_void_p, c_char_p], c_int),
    "retex_set_lay": ([c_void_p, c_void_p, POINTER(RetexError)], c_int),
    "retex_set_lift": ([c_void_p, c_int], None),
    "retex_set_load": ([c_void_p, c_int, POINTER(RetexError)], c_int),
    "retex_set_manifest": ([c_void_p, POINTER(c_void_p), POINTER(RetexError)], c_int),
    "retex_set_open": ([c_char_p, POINTER(c_void_p), c_int, POINTER(RetexError)], c_int),
    "retex_set_open_any": ([c_char_p, POINTER(c_void_p), c_int, POINTER(RetexError)], c_int),
    "retex_set_preload": ([c_void_p, POINTER(c_int), c_uint64, c_int, POINTER(RetexError)], c_int),
    "retex_set_write": ([c_void_p, c_char_p, c_void_p, c_int, POINTER(RetexError)], c_int),
    "retex_set_write_samples": ([c_void_p, c_char_p, c_void_p, c_int, POINTER(RetexError)], c_int),
    "retex_shrink_close": ([POINTER(c_void_p)], None),
    "retex_shrink_open": ([POINTER(c_void_p), POINTER(RetexCut), c_int, POINTER(RetexError)], c_int),
    "retex_shrink_rows": ([c_void_p, c_int, c_int, POINTER(c_float), POINTER(RetexError)], c_int),
    "retex_shrink_take": ([POINTER(c_void_p), POINTER(RetexImage), c_int, POINTER(RetexError)], c_int),
    "retex_texture_bytes": ([c_void_p], c_uint64),
    "retex_texture_close": ([POINTER(c_void_p)], None),
    "retex_texture_create": ([POINTER(c_void_p), POINTER(RetexImage), POINTER(RetexTextureSpec), c_int,
        POINTER(RetexError)], c_int),
    "retex_texture_layer_get": ([POINTER(RetexTextureSpec), POINTER(RetexTextureSpec), c_int], None),
    "retex_textures_load": ([POINTER(c_void_p), c_void_p, POINTER(RetexTextureSpec), c_int, c_int, POINTER(RetexError)],
        c_int),
    "retex_textures_move": ([c_void_p, c_void_p, c_int, POINTER(RetexError)], c_int),
}
