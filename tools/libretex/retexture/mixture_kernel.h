/* Weighted means of colours over rows of pixels. Private to libretex. */
#ifndef RETEX_RETEXTURE_MIXTURE_KERNEL_H
#define RETEX_RETEXTURE_MIXTURE_KERNEL_H

/* Add a share: its weights, one a pixel, and its colours (RGB; NULL: black) times them. */
void retex_mixture_add(float *restrict sum, float *restrict weights, const float *restrict w,
                       const float *restrict factor, int width);
/* Divide by the weights; black where there are none. */
void retex_mixture_divide(float *restrict sum, const float *restrict weights, int width);

/* The same with weights of every colour; those of the share have 1 or 3 channels. A colour that has no weight takes the
 * mean of those that have. With one weight a pixel these are the two above. */
void retex_mixture_add_colors(float *restrict sum, float *restrict weights, const float *restrict w, int channels,
                              const float *restrict factor, int width);
void retex_mixture_divide_colors(float *restrict sum, const float *restrict weights, int width);

#endif
