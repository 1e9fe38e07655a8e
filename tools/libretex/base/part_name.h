/* Names of a set's parts and channels. Private to libretex. */
#ifndef RETEX_BASE_PART_NAME_H
#define RETEX_BASE_PART_NAME_H

enum { RETEX_SET_PARTS_MAX = 1536 }; /* with 512 sample images still below the 2048 parts that readers of EXR files
                                        accept */

int retex_name_is_valid(const char *name);        /* of a part: 1..127 letters, digits, '_', '-' */
int retex_letters_are_valid(const char *letters); /* 1..7 different capital letters */

#endif
