/* Rows and checksums of parts as a file stores them, for hosts that write files themselves. */
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>
#include <retex/set_file.h>

#include "io/checksum.h"
#include "base/half.h"
#include "set/set.h"

void retex_image_stored_row(const RetexImage *image, RetexPixelType type, int y, void *samples)
{
    const size_t count = (size_t)image->width * (size_t)image->channels;
    const float *row = image->pixels + retex_image_index(image, 0, y);

    if (type == RETEX_HALF)
        retex_half_from_float(samples, row, count);
    else
        memcpy(samples, row, count * sizeof *row);
}

typedef struct ChecksumJob {
    RetexSet *set;
    int *failed; /* by part: 1 = out of memory */
} ChecksumJob;

/* Writes a sample's bytes in the byte order of files, least significant first. */
static void put_sample(unsigned char *to, const unsigned char *samples, size_t index, size_t bytes)
{
    uint32_t value = 0;
    uint16_t half;

    if (bytes == sizeof half) {
        memcpy(&half, samples + index * bytes, sizeof half);
        value = half;
    } else {
        memcpy(&value, samples + index * bytes, sizeof value);
    }
    for (size_t b = 0; b < bytes; b++)
        to[b] = (unsigned char)(value >> 8 * b);
}

/* Planes one after another, each from the top. */
static void checksum_part(void *context, int index, int thread)
{
    ChecksumJob *job = context;
    RetexPart *part = &job->set->parts[index];
    const size_t bytes = part->type == RETEX_HALF ? 2 : 4, width = (size_t)part->image.width,
                 channels = (size_t)part->image.channels;
    unsigned char *row = malloc(width * channels * bytes), *plane = malloc(width * bytes);
    uint32_t crc = CRC32_OF_NONE;

    (void)thread;
    job->failed[index] = !row || !plane;
    for (size_t c = 0; c < channels && !job->failed[index]; c++)
        for (int y = 0; y < part->image.height; y++) {
            retex_image_stored_row(&part->image, part->type, y, row);
            for (size_t x = 0; x < width; x++)
                put_sample(plane + x * bytes, row, x * channels + c, bytes);
            crc = retex_crc32(crc, plane, width * bytes);
        }
    part->crc = crc;
    free(row);
    free(plane);
}

int retex_set_checksum(RetexSet *set, int nthreads, RetexError *err)
{
    ChecksumJob job = {set, calloc((size_t)set->nparts + 1, sizeof *job.failed)};
    int code = job.failed ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory for checksums");

    for (int i = 0; i < set->nparts && !code; i++)
        if (!set->parts[i].image.pixels)
            code = retex_fail(err, RETEX_EINVAL, "part %s has no pixels", set->parts[i].name);
    if (!code)
        retex_parallel(nthreads, set->nparts, checksum_part, &job);
    for (int i = 0; i < set->nparts && !code; i++)
        if (job.failed[i])
            code = retex_fail(err, RETEX_ENOMEM, "no memory for checksums");
    free(job.failed);
    return code;
}

int retex_set_picture_manifest(const RetexSet *set, const RetexImage *picture, char **json, int nthreads,
                               RetexError *err)
{
    RetexSet shown = *set;
    shown.parts = malloc((size_t)set->nparts * sizeof *shown.parts);
    if (!shown.parts)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a manifest");
    memcpy(shown.parts, set->parts, (size_t)set->nparts * sizeof *shown.parts);
    shown.parts[0].image = *picture;
    shown.parts[0].type = RETEX_FLOAT;
    shown.nparts = 1;
    int code = retex_set_checksum(&shown, nthreads, err);
    shown.nparts = set->nparts;
    if (!code)
        code = retex_set_manifest(&shown, json, err);
    free(shown.parts);
    return code;
}
