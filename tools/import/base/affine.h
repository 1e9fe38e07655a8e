/* Transforms of the scene, in doubles. */
#ifndef RETEX_IMPORT_AFFINE_H
#define RETEX_IMPORT_AFFINE_H

#include <stdio.h>
#include <assimp/types.h>

#define PI 3.14159265358979323846

typedef struct Affine {
    double m[3][4]; /* of column vectors, as Assimp's: the last column is the translation */
} Affine;

extern const Affine affine_identity;
Affine affine_from(const struct aiMatrix4x4 *m);
int affine_is_finite(const Affine *a);
Affine affine_multiply(const Affine *a, const Affine *b); /* b first */
void affine_point(const Affine *a, const double p[3], double out[3]);
void affine_vector(const Affine *a, const double v[3], double out[3]);
/* The same map for points whose z has the other sign: from a right-handed space to POV-Ray's left-handed one. */
Affine affine_mirror_z(const Affine *a);
/* Programs make floors flat by a scale of 0 across them, which POV-Ray refuses: a little thickness is given to such a
 * transform. Returns 0 where it makes lines or points of things, which nobody sees. */
int affine_thicken(Affine *a);
/* Write as transforms of POV-Ray with a space before each; nothing for the identity. */
void affine_print(FILE *out, const Affine *a);
void vector_print(FILE *out, const char *before, const double v[3], const char *after);

#endif
