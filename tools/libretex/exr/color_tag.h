/* Colour metadata of EXR files: chromaticities of the primaries and of white, and the interop ID of the Color Interop
 * Forum (attribute colorInteropID). Both are read, and written where they are known. */
#ifndef RETEX_EXR_COLOR_TAG_H
#define RETEX_EXR_COLOR_TAG_H

enum { RETEX_INTEROP_MAX = 64 }; /* bytes of an interop ID, with the final NUL */

typedef struct RetexColorTag {
    char interop[RETEX_INTEROP_MAX]; /* "" = none */
    int has_chromaticities;
    float chromaticities[8]; /* CIE x, y of red, green, blue and white */
} RetexColorTag;

extern const RetexColorTag retex_color_tag_rec709; /* scene-linear Rec.709, in which the library computes */
extern const RetexColorTag retex_color_tag_data;   /* values that are not colours */

/* The linear space of an interop ID; NULL where it is not known. */
const RetexColorTag *retex_color_tag_find(const char *interop);

/* The known linear space to which this matrix leads from scene-linear Rec.709, or NULL. */
const RetexColorTag *retex_color_tag_of_matrix(const double from_rec709[3][3]);

/* The matrix from linear colours of these chromaticities to Rec.709, adapting white (Bradford). Returns 1; 0 where they
 * are those of Rec.709 and nothing is to be done; -1 where they span no colour space. */
int retex_color_tag_to_rec709(const float chromaticities[8], double matrix[3][3]);

#endif
