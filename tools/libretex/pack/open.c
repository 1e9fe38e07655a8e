/* Opening packs, as the source of a set that is read on demand. Everything is checked: each entry must be named by
 * the manifest and have the size that the index states. Memory is allocated only as the file's size justifies. */
#include "pack/open.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/laid.h>
#include <retex/set_file.h>

#include "base/params.h"
#include "io/checksum.h"
#include "exr/io.h"
#include "pack/pack.h"
#include "pack/strips.h"
#include "set/manifest.h"
#include "base/value_check.h"

/* NULL and pointers to NULL are fine. */
static void close_pack(RetexPack **result)
{
    RetexPack *pack = result ? *result : NULL;
    if (!pack)
        return;
    for (int i = 0; pack->parts && i < pack->nparts; i++)
        retex_pack_part_free(&pack->parts[i]);
    free(pack->parts);
    retex_zip_list_free(&pack->entries);
    retex_input_close(&pack->input);
    retex_input_close(&pack->whole);
    free(pack);
    *result = NULL;
}

/* --- opening --- */

/* An entry whole, its checksum compared, with a NUL behind it. */
static int read_entry(const RetexPack *pack, const char *name, uint64_t most, unsigned char **data, size_t *bytes,
                      RetexError *err)
{
    const RetexZipEntry *entry = retex_zip_list_find(&pack->entries, name);
    *data = NULL;
    if (!entry)
        return retex_pack_damaged(err, "it lacks", name);
    *data = entry->bytes <= most ? malloc((size_t)entry->bytes + 1) : NULL;
    if (!*data)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    *bytes = (size_t)entry->bytes;
    (*data)[*bytes] = 0;
    if (retex_input_read(pack->input, *data, *bytes, entry->offset) == (int64_t)*bytes &&
        retex_crc32(CRC32_OF_NONE, *data, *bytes) == entry->crc)
        return 0;
    free(*data);
    *data = NULL;
    return retex_input_check(pack->input, retex_pack_damaged(err, "the checksum is wrong of", name), err);
}

static uint32_t little(const unsigned char *at)
{
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* Places of slices first..first+count of a part, which are one entry of the zip. *used counts entries. */
static int place_slices(RetexPack *pack, int part, int planes, int first, int count, int *used, RetexError *err)
{
    RetexPackPart *p = &pack->parts[part];
    char name[RETEX_PACK_NAME_MAX];
    uint64_t total = 0;
    for (int i = first; i < first + count; i++)
        total += p->bytes[i];
    retex_pack_file_name(name, sizeof name, pack->set, part, planes);
    const RetexZipEntry *entry = retex_zip_list_find(&pack->entries, name);
    if ((!entry && total > 0) || (entry && entry->bytes != total))
        return retex_pack_damaged(err, entry ? "the index does not fit" : "it lacks", name);
    *used += entry != NULL;
    total = entry ? entry->offset : 0;
    for (int i = first; i < first + count; i++) {
        p->offsets[i] = total;
        total += p->bytes[i];
    }
    return 0;
}

/* The entries of smaller sets. *used counts entries. */
static int find_levels(RetexPack *pack, int *used, RetexError *err)
{
    for (int i = 0; i < pack->levels.count; i++) {
        char name[RETEX_PACK_NAME_MAX];
        retex_pack_level_name(name, sizeof name, pack->levels.of[i]);
        pack->level_entries[i] = retex_zip_list_find(&pack->entries, name);
        if (!pack->level_entries[i])
            return retex_pack_damaged(err, "it lacks", name);
        ++*used;
    }
    return 0;
}

static int read_index(RetexPack *pack, RetexError *err)
{
    unsigned char *index;
    size_t bytes, expected = 0, at = 0;
    for (int i = 0; i < pack->nparts; i++)
        expected += (size_t)pack->parts[i].nslices * RETEX_PACK_INDEX_ENTRY_BYTES;
    int code = read_entry(pack, RETEX_PACK_INDEX_NAME, expected, &index, &bytes, err), used = 2;
    if (!code && bytes != expected)
        code = retex_pack_damaged(err, "the size is wrong of", RETEX_PACK_INDEX_NAME);
    for (int i = 0; !code && i < pack->nparts; i++) {
        RetexPackPart *p = &pack->parts[i];
        p->offsets = calloc((size_t)p->nslices + 1, sizeof *p->offsets);
        if (!p->offsets)
            code = retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
        for (int k = 0; !code && k < p->nslices; k++, at += RETEX_PACK_INDEX_ENTRY_BYTES) {
            p->bytes[k] = little(index + at);
            p->crcs[k] = little(index + at + 4);
        }
        const int jpeg = p->codec == RETEX_PACK_JPEG ? 1 + p->nstrips : 0;
        if (!code && jpeg)
            code = place_slices(pack, i, 0, 0, jpeg, &used, err);
        if (!code && p->nslices > jpeg)
            code = place_slices(pack, i, 1, jpeg, p->nslices - jpeg, &used, err);
    }
    free(index);
    if (!code && pack->parts[0].codec != RETEX_PACK_JPEG) /* a lossless pack's picture is for viewers only */
        used += retex_zip_list_find(&pack->entries, RETEX_PACK_PICTURE_NAME) != NULL;
    if (!code)
        code = find_levels(pack, &used, err);
    if (!code && used != pack->entries.count)
        code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: it has entries that its manifest does not know");
    return code;
}

/* What the parts will need in memory, and what could be behind that at most: a slice of a few bytes holds a strip. */
static int check_sizes(const RetexPack *pack, RetexError *err)
{
    uint64_t memory = 0, slices = 0;
    for (int i = 0; i < pack->nparts; i++) {
        const RetexPackPart *p = &pack->parts[i];
        memory += (uint64_t)p->width * (uint64_t)p->height * (uint64_t)p->channels * sizeof(float);
        slices += (uint64_t)p->nslices;
    }
    if (memory > RETEX_EXR_MEMORY_MAX)
        return retex_fail(err, RETEX_ELIMIT, "the pack's images are too large");
    if (slices * RETEX_PACK_INDEX_ENTRY_BYTES > retex_input_size(pack->input))
        return retex_fail(err, RETEX_EFORMAT, "the pack is damaged: it is too small for what it should hold");
    return 0;
}

/* The set that the manifest describes, its parts without pixels. */
static int read_set(RetexSet **set, const char *manifest, RetexError *err)
{
    int code = retex_manifest_read(manifest, "the pack", set, NULL, err);
    if (!code && (*set)->is_samples)
        code = retex_fail(err, RETEX_EFORMAT, "the pack is damaged: its manifest describes no set");
    return code;
}

static int open_parts(RetexPack *pack, RetexSet *set, const char *manifest, RetexError *err)
{
    pack->set = set;
    pack->nparts = set->nparts;
    pack->parts = calloc((size_t)set->nparts + 1, sizeof *pack->parts);
    int code = pack->parts ? retex_pack_parse(pack->parts, set, manifest, err)
                           : retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    if (!code)
        code = check_sizes(pack, err);
    return code ? code : read_index(pack, err);
}

static int open_pack(RetexPack *pack, RetexSet **set, RetexError *err)
{
    unsigned char *manifest = NULL;
    size_t bytes;
    int code = retex_zip_list_read(&pack->entries, pack->input, err);
    if (!code)
        code = read_entry(pack, RETEX_PACK_MANIFEST_NAME, RETEX_PACK_MANIFEST_MAX, &manifest, &bytes, err);
    if (!code && strlen((char *)manifest) != bytes)
        code = retex_pack_damaged(err, "no text is in", RETEX_PACK_MANIFEST_NAME);
    if (!code)
        code = read_set(set, (char *)manifest, err);
    if (!code)
        code = retex_pack_levels_of(&pack->levels, (char *)manifest, err);
    if (!code)
        code = open_parts(pack, *set, (char *)manifest, err);
    pack->has_promise = !code && retex_pack_promise_of(&pack->promise, (char *)manifest);
    free(manifest);
    return code;
}

int retex_pack_promise(RetexPackPromise *promise, const RetexSet *set, RetexError *err)
{
    const RetexPack *pack = retex_pack_of(set);
    if (!pack || !pack->has_promise)
        return retex_fail(err, RETEX_ENOTFOUND, "the set is not that of an open pack that says what it promises");
    *promise = pack->promise;
    return 0;
}

/* --- as the source of a set's parts --- */

static void source_close(RetexSetSource *source)
{
    RetexPack *pack = (RetexPack *)(void *)source;
    close_pack(&pack);
}

static int reader_open(RetexSetSource *source, void **reader, RetexError *err)
{
    RetexPackScratch *scratch = NULL;
    int code = retex_pack_scratch_create(&scratch, (const RetexPack *)(const void *)source, err);
    *reader = scratch;
    return code;
}

static void reader_close(void *reader)
{
    RetexPackScratch *scratch = reader;
    retex_pack_scratch_close(&scratch);
}

static int read_row(void *reader, int part, int y, const float **row, RetexRowSpan *span, RetexError *err)
{
    RetexPackScratch *scratch = reader;
    const RetexPack *pack = retex_pack_of_scratch(scratch);
    int code = retex_pack_row(scratch, part, y, row, span, err);
    if (!code && *row)
        code = retex_check_row_values(&pack->set->parts[part], *row, span->begin, span->end, y, err);
    if (code && err && !err->file[0])
        snprintf(err->file, sizeof err->file, "%s", retex_input_name(pack->input));
    return code;
}

static const RetexSetSource pack_methods = {source_close, reader_open, reader_close, read_row, NULL, 1};

RetexPack *retex_pack_of(const RetexSet *set)
{
    RetexSetSource *source = set->nparts ? set->parts[0].source : NULL;
    return source && source->close == source_close ? (RetexPack *)(void *)source : NULL;
}

int retex_pack_open(RetexSet **set, RetexInput **input, RetexError *err)
{
    RetexPack *pack = calloc(1, sizeof *pack);
    *set = NULL;
    if (!pack)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a pack");
    pack->input = *input;
    *input = NULL;
    const int code = retex_input_check(pack->input, open_pack(pack, set, err), err);
    if (!code) {
        RetexSetSource *source = &pack->methods;
        *source = pack_methods;
        for (int i = 0; i < (*set)->nparts; i++)
            retex_part_set_source(&(*set)->parts[i], source, i);
        retex_source_release(&source);
        return 0;
    }
    if (err)
        snprintf(err->file, sizeof err->file, "%s", retex_input_name(pack->input));
    close_pack(&pack);
    retex_set_close(set);
    return code;
}

uint64_t retex_pack_part_bytes(const RetexPack *pack, int part)
{
    uint64_t bytes = 0;
    for (int i = 0; i < pack->parts[part].nslices; i++)
        bytes += pack->parts[part].bytes[i];
    return bytes;
}

/* --- smaller sets --- */

int retex_pack_level(RetexPackLevel *level, const RetexSet *set, int index)
{
    const RetexPack *pack = retex_pack_of(set);
    if (!pack || index < 0 || index >= pack->levels.count)
        return 0;
    const int scale = pack->levels.of[index];
    const RetexPackLevel own = {.width = (set->width + scale - 1) / scale,
                                .height = (set->height + scale - 1) / scale,
                                .scale = scale,
                                .bytes = pack->level_entries[index]->bytes};
    (void)RETEX_PARAMS_RETURN(level, &own, NULL);
    return 1;
}

/* A span in pixels of a level that is `scale` times smaller: 0 where it begins or ends within one of them. */
static int reduce_span(int *begin, int *length, int whole, int scale)
{
    const int end = *begin + *length;
    if (*begin % scale || (end % scale && end != whole))
        return 0;
    *begin /= scale;
    *length = (end + scale - 1) / scale - *begin;
    return 1;
}

#define RETEX_PACK_LARGE 3 /* times as many pixels to a side, from which any picture can be averaged */

int retex_set_find_level(const RetexSet *set, const RetexCut *cut, RetexCut *own)
{
    RetexPackLevel level = {.size = sizeof level};
    int found = -1;
    *own = *cut;
    for (int i = 0; retex_pack_level(&level, set, i); i++) {
        RetexCut at = *cut;
        if (!reduce_span(&at.x, &at.width, set->width, level.scale) ||
            !reduce_span(&at.y, &at.height, set->height, level.scale))
            continue;
        const int same = at.width == cut->scaled_width && at.height == cut->scaled_height;
        const int whole = at.width * level.scale == cut->width && at.height * level.scale == cut->height &&
                          at.width % cut->scaled_width == 0 && at.height % cut->scaled_height == 0;
        const int large =
            at.width / RETEX_PACK_LARGE >= cut->scaled_width && at.height / RETEX_PACK_LARGE >= cut->scaled_height;
        if (same || whole || large)
            found = i, *own = at;
    }
    return found;
}

/* Open a smaller set as it lies in the pack's input, which is `whole`. */
static int open_level(RetexSet **result, const RetexPack *pack, const RetexInput *whole, int index, RetexError *err)
{
    const RetexZipEntry *entry = pack->level_entries[index];
    RetexPackLevel level = {.size = sizeof level};
    RetexInput *window = NULL;
    char name[512 + RETEX_PACK_NAME_MAX];
    retex_pack_level(&level, pack->set, index);
    snprintf(name, sizeof name, "%s: %s", retex_input_name(whole), entry->name);
    int code = retex_input_window(&window, whole, entry->offset, entry->bytes, name, err);
    if (!code)
        code = retex_pack_open(result, &window, err);
    retex_input_close(&window);
    const RetexSet *set = *result;
    if (!code && (set->width != level.width || set->height != level.height || set->id != pack->set->id ||
                  set->ntargets != pack->set->ntargets || retex_pack_of(set)->levels.count))
        code = retex_pack_damaged(err, "it has another set as", entry->name);
    if (code)
        retex_set_close(result);
    return code;
}

int retex_set_take_level(RetexSet **set, int index, RetexError *err)
{
    RetexPackLevel known = {.size = sizeof known};
    if (!retex_pack_level(&known, *set, index)) {
        retex_set_close(set);
        return retex_fail(err, RETEX_EINVAL, "the set has no level of number %d", index);
    }
    RetexPack *pack = retex_pack_of(*set);
    RetexInput *whole = pack->input;
    RetexSet *level = NULL;
    const int code = open_level(&level, pack, whole, index, err);
    if (!code) {
        pack->input = NULL;
        retex_pack_of(level)->whole = whole;
    }
    retex_set_close(set);
    *set = level;
    return code;
}

/* --- all of it --- */

/* Every byte of every entry, whether the index knows it or not. */
static int verify_entries(const RetexPack *pack, RetexError *err)
{
    int code = 0;
    for (int i = 0; !code && i < pack->entries.count; i++) {
        unsigned char *data;
        size_t bytes;
        code = read_entry(pack, pack->entries.entries[i].name, UINT64_MAX, &data, &bytes, err);
        free(data);
    }
    return code;
}

static int keeps_bits(const RetexPackPart *p)
{
    int exact = p->codec != RETEX_PACK_JPEG;
    for (int c = 0; p->codec == RETEX_PACK_PLANES && c < p->channels; c++)
        exact = exact && p->maps[c].kind == RETEX_PACK_MAP_BITS;
    return exact;
}

int retex_pack_verify(RetexSet *set, int nthreads, RetexError *err)
{
    RetexPack *pack = retex_pack_of(set);
    char *exact = malloc((size_t)set->nparts + 1);
    int code = exact ? verify_entries(pack, err) : retex_fail(err, RETEX_ENOMEM, "no memory to check a pack");
    for (int i = 0; !code && i < pack->levels.count; i++) {
        RetexSet *level = NULL;
        code = open_level(&level, pack, pack->input, i, err);
        if (!code)
            code = retex_pack_verify(level, nthreads, err);
        retex_set_close(&level);
    }
    for (int i = 0; !code && i < set->nparts; i++)
        exact[i] = (char)keeps_bits(&pack->parts[i]);
    if (!code)
        code = retex_set_load(set, nthreads, err);
    for (int i = 0; !code && i < set->nparts; i++) {
        uint32_t crc = set->parts[i].crc;
        if (exact[i])
            code = retex_pack_samples_crc(&crc, &set->parts[i], err);
        if (!code && crc != set->parts[i].crc)
            code = retex_pack_damaged(err, "the checksum is wrong of part", set->parts[i].name);
    }
    free(exact);
    return code;
}

int retex_pack_probe(const void *data, size_t bytes)
{
    return bytes >= 4 && memcmp(data, "PK\3\4", 4) == 0;
}
