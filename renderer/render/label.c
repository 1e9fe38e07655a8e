/* See label.h. */
#include <string.h>
#include "render/label.h"

enum { LETTER_WIDTH = 3, LETTER_HEIGHT = 5, ADVANCE = 4, LARGEST = 4 };

/* Rows of three dots from the top, an octal digit each. */
static const char letters[] = "0123456789.";
static const unsigned short dots[] = {075557, 026227, 071747, 071717, 055711, 074717,
                                      074757, 071244, 075757, 075717, 000002};

static int dot(const char *text, int column, int row)
{
    const int letter = column / ADVANCE, x = column % ADVANCE;
    if (column < 0 || row < 0 || row >= LETTER_HEIGHT || x >= LETTER_WIDTH || letter >= (int)strlen(text))
        return 0;
    const char *found = strchr(letters, text[letter]);
    return found ? dots[found - letters] >> (3 * (LETTER_HEIGHT - 1 - row) + LETTER_WIDTH - 1 - x) & 1 : 0;
}

static void set(RetexImage *image, int x, int y, float value)
{
    if (x < 0 || y < 0 || x >= image->width || y >= image->height)
        return;
    for (int c = 0; c < 3; c++)
        image->pixels[retex_image_index(image, x, y) + (size_t)c] = value;
}

void label_draw(RetexImage *image, const char *text, int x, int y, int half_side)
{
    const int columns = ADVANCE * (int)strlen(text) - 1;
    int scale = 2 * half_side / (columns + 2);
    if (scale < 1)
        return;
    scale = scale < LARGEST ? scale : LARGEST;
    const int left = x - scale * columns / 2, top = y - scale * LETTER_HEIGHT / 2;
    for (int j = -1; j <= scale * LETTER_HEIGHT; j++)
        for (int i = -1; i <= scale * columns; i++) {
            int edge = 0;
            for (int n = 0; n < 9; n++) {
                const int u = i + n % 3 - 1, v = j + n / 3 - 1;
                edge |= u >= 0 && v >= 0 && dot(text, u / scale, v / scale);
            }
            if (edge)
                set(image, left + i, top + j, i >= 0 && j >= 0 && dot(text, i / scale, j / scale) ? 1 : 0);
        }
}
