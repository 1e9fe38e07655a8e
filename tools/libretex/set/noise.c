/* See noise.h. */
#include "set/noise.h"

#include <string.h>

#include <retex/host/denoise_data.h>

#include "set/parts.h"
#include "set/rows.h"
#include "set/signals.h"

/* Whether a part is noise of light that other signals have as well: of a lamp's. */
static int is_of_lamp(const RetexSignals *signals, int part)
{
    for (int k = 0; k < signals->count; k++)
        if (signals->of[k].noise == part)
            return signals->of[k].lamp >= 0;
    return 0;
}

int retex_set_add_noise(float *rows, const RetexSet *set, int y0, int y1, RetexError *err)
{
    const size_t length = 3 * (size_t)set->width;
    RetexRowReader *reader;
    RetexSignals signals;
    int code = retex_signals_sort(&signals, set, err);
    if (code)
        return code;
    code = retex_row_reader_open(&reader, set, err);
    for (int i = 1; i < set->nparts && !code; i++) {
        const RetexPart *part = &set->parts[i];
        const float share = strcmp(part->name, RETEX_NOISE_PREFIX RETEX_SIGNAL_INDEP) == 0 ? 1 : 0.5f;
        if (!retex_part_is_denoise_data(set, i) || !retex_name_is_noise(part->name) || part->image.channels != 3 ||
            is_of_lamp(&signals, i))
            continue;
        for (int y = y0; y < y1 && !code; y++) {
            const float *row;
            code = retex_row_reader_get(reader, i, y, &row, err);
            for (size_t k = 0; k < length && !code && row; k++)
                rows[(size_t)(y - y0) * length + k] += share * row[k];
        }
    }
    retex_row_reader_close(&reader);
    retex_signals_close(&signals);
    return code;
}
