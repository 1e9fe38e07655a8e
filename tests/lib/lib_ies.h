/* Light distributions that a test writes: files of IES LM-63. */
#ifndef LIB_IES_H
#define LIB_IES_H

/* Luminous intensity by vertical and horizontal angle, in degrees. */
typedef double TestIntensity(double vertical, double horizontal);

/* Angles from first to last, evenly. */
typedef struct TestAngles {
    double first, last;
    int count;
} TestAngles;

/* Write a file into the test's folder (lib_folder.h); returns its path, valid as long as test_in_folder's. */
const char *test_ies(const char *name, TestAngles vertical, TestAngles horizontal, TestIntensity *intensity);
/* The same of any text. */
const char *test_ies_text(const char *name, const char *text);

#endif
