/* Reading a picture that is no set: its layers, guides and noise. Private to libretex. */
#ifndef RETEX_FILES_PICTURE_INPUT_H
#define RETEX_FILES_PICTURE_INPUT_H

#include <retex/denoise_picture.h>

#include "files/picture_guides.h"
#include "files/picture_layers.h"

/* An open file. */
typedef struct RetexPictureFile {
    RetexInput *input;
    RetexExr *exr;
    RetexPictureLayers layers;
} RetexPictureFile;

/* A picture, and the second render of it, if there is one. */
typedef struct RetexPictureInput {
    RetexDenoisePictureParams params;
    RetexPictureFile file, other;
    int beauty; /* layer, or -1 */
    int width, height, nthreads;
    int halves_differ; /* 1: somewhere */
    RetexPictureGuides guides;
} RetexPictureInput;

/* Open what params say; to be closed in any case. The caller finds the beauty, and the size. */
int retex_picture_input_open(RetexPictureInput *p, const char *path, RetexError *err);
void retex_picture_input_close(RetexPictureInput *p);

/* Tell whoever listens. important: see RetexPictureNote. */
RETEX_PRINTF(3, 4) void retex_picture_note(const RetexPictureInput *p, int important, const char *format, ...);
/* Tell where the noise is known from. */
void retex_picture_note_noise(const RetexPictureInput *p);
/* How messages call a layer. */
const char *retex_picture_input_text(const RetexPictureInput *p, int layer);

/* A layer to be filtered has floats and the picture's size. */
int retex_picture_check_layer(const RetexPictureInput *p, int layer, RetexError *err);
/* Read a layer; one channel becomes three equal ones. */
int retex_picture_read_layer(RetexImage *image, const RetexPictureFile *file, int layer, int nthreads, RetexError *err);
/* The same of light: values that are no numbers are refused, or repaired. */
int retex_picture_read_checked(RetexImage *image, const RetexPictureInput *p, const RetexPictureFile *file, int layer,
                               RetexError *err);
int retex_picture_load_guides(RetexPictureInput *p, RetexError *err);
/* The noise of a layer that was read, as half of the difference of two halves; image becomes the mean of both. */
int retex_picture_find_noise(RetexImage *image, RetexImage *noise, RetexPictureInput *p, int layer, int with_albedo,
                             RetexError *err);
/* The same of an image of one render, from its pixels; seed: of the numbers that are drawn. */
int retex_picture_estimate_noise(RetexImage *noise, const RetexImage *image, const RetexPictureInput *p, int seed,
                                 int with_albedo, RetexError *err);
/* After all layers were read: two files of one render are refused. */
int retex_picture_check_halves(const RetexPictureInput *p, RetexError *err);

#endif
