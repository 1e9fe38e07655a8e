/* See called.h. */
#include <ctype.h>
#include <string.h>

#include "import/sense/called.h"

static const char *const floor_words[] = {
    "floor", "floors", "flooring", "ground", "parquet", "parquetry", "laminate", "linoleum", "boden",
    "fussboden", "fußboden", "parkett", "estrich", "laminat", "dielen", "sol", "plancher", "piso", "pisos",
    "suelo", "chao", "chão", "pavimento", "vloer", "golv", "gulv", "podlaha", "podloga", "podłoga", "lattia",
    "zemin", "pol", "yuka", "floorboard", "floorboards", "tatami", NULL};
static const char *const no_floor_words[] = {
    "lamp", "light", "ceiling", "roof", "rug", "table", "desk", "bed", "sofa", "couch", "shelf", "decke",
    "dach", "tisch", "bett", "teppich", "seat", "mat", "counter", "countertop", "worktop", "shadow", NULL};
static const char *const wall_words[] = {
    "wall", "walls", "wallpaper", "wand", "waende", "wände", "mur", "murs", "mural", "pared", "paredes",
    "parete", "pareti", "parede", "muro", "muros", "muur", "vegg", "vagg", "vägg", "sciana", "ściana", "stena",
    "seina", "duvar", "kabe", "tapete", NULL};
static const char *const no_wall_words[] = {
    "door", "doors", "window", "windows", "curtain", "curtains", "wardrobe", "closet", "cupboard", "cabinet",
    "fridge", "picture", "painting", "frame", "glass", "tv", "screen", "monitor", "bookshelf", "shelf",
    "shelves", "fenster", "tuer", "tür", "schrank", "vorhang", "blind", "blinds", "ceiling", "floor",
    "whiteboard", "poster", "art", "bed", "sofa", "mirror", "board", "lamp", "light", "clock", NULL};

static int is_letter(unsigned char c)
{
    return isalpha(c) || c >= 0x80;
}

/* The next word of a name: letters of one case, or a capital and small ones. Returns what follows; NULL at the end. */
static const char *next_word(const char *at, char word[32])
{
    size_t n = 0;
    while (*at && !is_letter((unsigned char)*at))
        at++;
    if (!*at)
        return NULL;
    for (; is_letter((unsigned char)*at); at++) {
        const int begins = isupper((unsigned char)at[0]) && n > 0 &&
                           (islower((unsigned char)at[-1]) || islower((unsigned char)at[1]));
        if (begins)
            break;
        if (n < 31)
            word[n++] = (char)tolower((unsigned char)*at);
    }
    word[n] = '\0';
    return at;
}

static int has_word(const char *name, const char *const *words)
{
    char word[32];
    while ((name = next_word(name, word)))
        for (int k = 0; words[k]; k++)
            if (strcmp(word, words[k]) == 0)
                return 1;
    return 0;
}

static int called(const char *const names[3], const char *const *words, const char *const *others)
{
    for (int k = 0; k < 3; k++)
        if (has_word(names[k], others))
            return -1;
        else if (has_word(names[k], words))
            return 1;
    return 0;
}

int called_floor(const char *const names[3])
{
    return called(names, floor_words, no_floor_words);
}

int called_wall(const char *const names[3])
{
    return called(names, wall_words, no_wall_words);
}
