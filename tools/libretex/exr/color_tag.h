/* What EXR files say of their colours: chromaticities of the primaries and of white, and the interop ID of the Color
 * Interop Forum (attribute colorInteropID). Both are written wherever they are known, and read. */
#ifndef RETEX_EXR_COLOR_TAG_H
#define RETEX_EXR_COLOR_TAG_H

enum { RETEX_INTEROP_MAX = 64 }; /* bytes of an interop ID, with the final NUL */

typedef struct RetexColorTag {
    char interop[RETEX_INTEROP_MAX]; /* "" = none */
    int has_chromaticities;
    float chromaticities[8]; /* CIE x, y of red, green, blue and white */
} RetexColorTag;

extern const RetexColorTag retex_color_tag_rec709; /* scene-linear, what is computed in here */
extern const RetexColorTag retex_color_tag_data;   /* numbers that are no colours */

/* The linear space of that interop ID; NULL: it is none of those known. */
const RetexColorTag *retex_color_tag_find(const char *interop);

/* The known linear space that this matrix leads to from scene-linear Rec.709, or NULL. */
const RetexColorTag *retex_color_tag_of_matrix(const double from_rec709[3][3]);

/* The matrix from linear colours of these chromaticities to Rec.709, white becoming white (Bradford). 0: they are those
 * of Rec.709, nothing is to be done; -1: they are no space of colours. */
int retex_color_tag_to_rec709(const float chromaticities[8], double matrix[3][3]);

#endif
