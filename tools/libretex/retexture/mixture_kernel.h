/* Weighted means of colours over rows of pixels. Private to libretex. */
#ifndef RETEX_RETEXTURE_MIXTURE_KERNEL_H
#define RETEX_RETEXTURE_MIXTURE_KERNEL_H

/* Add a share: sum += w * factor and weights += w, with one weight a pixel; factor is RGB, NULL: black. */
void retex_mixture_add(float *restrict sum, float *restrict weights, const float *restrict w,
                       const float *restrict factor, int width);
/* Divide the sum by the weights; black where the weight is 0. */
void retex_mixture_divide(float *restrict sum, const float *restrict weights, int width);

/* The same with a weight for each colour; w has 1 or 3 channels. A colour without weight takes the mean of the colours
 * that have weight. With one weight a pixel the results are those of the two functions above. */
void retex_mixture_add_colors(float *restrict sum, float *restrict weights, const float *restrict w, int channels,
                              const float *restrict factor, int width);
void retex_mixture_divide_colors(float *restrict sum, const float *restrict weights, int width);

#endif
