/* See noise.h. */
#include "set/noise.h"

#include <string.h>

#include <retex/host/denoise_data.h>

#include "set/parts.h"
#include "set/rows.h"

int retex_set_add_noise(float *rows, const RetexSet *set, int y0, int y1, RetexError *err)
{
    const size_t length = 3 * (size_t)set->width;
    RetexRowReader *reader;
    int code = retex_row_reader_open(&reader, set, NULL, err);
    for (int i = 1; i < set->nparts && !code; i++) {
        const RetexPart *part = &set->parts[i];
        const float share = strcmp(part->name, RETEX_NOISE_PREFIX RETEX_SIGNAL_INDEP) == 0 ? 1 : 0.5f;
        if (!retex_part_is_denoise_data(set, i) || !retex_name_is_noise(part->name) || part->image.channels != 3)
            continue;
        for (int y = y0; y < y1 && !code; y++) {
            const float *row;
            code = retex_row_reader_get(reader, i, y, &row, err);
            for (size_t k = 0; k < length && !code && row; k++)
                rows[(size_t)(y - y0) * length + k] += share * row[k];
        }
    }
    retex_row_reader_close(&reader);
    return code;
}
