/* Finishes and bumps at random, in the scene language. */
#ifndef LIB_RANDOM_TEXTURE_H
#define LIB_RANDOM_TEXTURE_H

#include <stdint.h>

extern uint32_t pick_state;

int pick(int count); /* 0 to count - 1 */
const char *pick_one(const char **list, int count);
/* One of some texts. */
#define PICK(...) pick_one((const char *[]){__VA_ARGS__}, (int)(sizeof((const char *[]){__VA_ARGS__}) / sizeof(char *)))

/* Appends a text and a blank. */
void add_text(char *text, const char *more);

/* Numbers up to 1: no more than that is asked for. rough: highlights are wide enough for a coarse integral. */
void random_finish(char *text, int rough);
void random_normal(char *text); /* mostly one, or none */

#endif
