/* The beauty and the AOVs of a render as separate files, as programs that edit or denoise pictures take them. */
#ifndef RENDERER_RENDER_AOV_FILES_H
#define RENDERER_RENDER_AOV_FILES_H

#include <retex/set.h>

/* Make the folder, if there is none, and see whether it takes files. */
int aov_files_check(const char *folder, RetexError *err);
/* The k-th file that aov_files_write may write; 0 behind the last one. */
int aov_files_path(char *path, size_t size, const char *folder, int k);
/* Write the beauty and each AOV of the set as NAME.exr, with its values as halves, and as NAME.png, to look at: the
 * beauty through the display transform, AOVs as their RetexAovShown says, colours sRGB-encoded. */
int aov_files_write(const RetexSet *set, const char *folder, int nthreads, RetexError *err);

#endif
