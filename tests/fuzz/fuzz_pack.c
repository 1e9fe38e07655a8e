/* Packs. An input is either a pack as it is, which the zip's own checksums protect well, or a list of entries that a
 * zip is made of here: `E`, then for each entry its name, a line end, its length in 4 bytes, its data. If the letter
 * is `F` the index's lengths and checksums are put right before, so that decoders are reached. What is accepted is
 * recombined. */
#include <retex/combine.h>
#include <retex/pack.h>
#include <retex/laid.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zip.h>
#include <zlib.h>

#include "lib_pack_read.h"
#include "lib_fuzz.h"
#include "lib_test.h"
#include "set/manifest.h"
#include "pack/format.h"
#include "pack/zip.h"

enum { ENTRIES_MAX = 256 };

typedef struct Entry {
    char name[RETEX_PACK_NAME_MAX];
    unsigned char *data;
    size_t size;
} Entry;

static void add_entry(unsigned char *list, size_t *used, const char *name, zip_t *zip, zip_uint64_t index, size_t size)
{
    zip_file_t *entry = zip_fopen_index(zip, index, 0);
    size_t length = strlen(name);
    if (!entry || *used + length + 5 + size > FUZZ_LARGEST)
        abort();
    memcpy(list + *used, name, length);
    list[*used + length] = '\n';
    for (int i = 0; i < 4; i++)
        list[*used + length + 1 + (size_t)i] = (unsigned char)(size >> 8 * i);
    if (zip_fread(entry, list + *used + length + 5, size) != (zip_int64_t)size)
        abort();
    zip_fclose(entry);
    *used += length + 5 + size;
}

/* A pack as it is, and as a list of entries. */
static void give(const RetexSet *set, int lossless, int quality)
{
    RetexPackParams params = RETEX_PACK_INIT;
    RetexError err = {0};
    zip_error_t error;
    size_t size, used = 1;
    char name[64];
    unsigned char *bytes = malloc(FUZZ_LARGEST), *list = malloc(FUZZ_LARGEST);
    snprintf(name, sizeof name, "fuzz_pack-%d.tmp.retex", (int)getpid());
    params.lossless = lossless;
    params.quality = quality;
    test_must(retex_pack_write(set, name, &params, NULL, 1, &err), &err);
    FILE *in = fopen(name, "rb");
    if (!in || !bytes || !list)
        abort();
    size = fread(bytes, 1, FUZZ_LARGEST, in);
    fclose(in);
    unlink(name);
    fuzz_seed(bytes, size);
    zip_error_init(&error);
    zip_t *zip = zip_open_from_source(zip_source_buffer_create(bytes, size, 0, &error), ZIP_RDONLY, &error);
    for (zip_uint64_t i = 0; zip && i < (zip_uint64_t)zip_get_num_entries(zip, 0); i++) {
        zip_stat_t stat;
        if (zip_stat_index(zip, i, 0, &stat) == 0)
            add_entry(list, &used, stat.name, zip, i, stat.size);
    }
    list[0] = 'E';
    fuzz_seed(list, used);
    for (int i = 0; i < 4; i++) { /* most of the time decoders are what is wanted */
        list[0] = 'F';
        fuzz_seed(list, used);
    }
    zip_discard(zip);
    free(bytes);
    free(list);
}

static void begin(void)
{
    RetexSet *set = test_set(12, 8, 1), *odd = test_set(17, 3, 2);
    give(set, 0, 98);
    give(set, 0, 20);
    give(odd, 0, 98);
    give(odd, 1, 98);
    test_make_footprints(odd);
    give(odd, 0, 98);
    const RetexImage *depth = &set->parts[retex_set_find_part(set, "depth")].image;
    for (int i = 0; i < 12 * 8; i++)
        depth->pixels[i] = 2;
    give(set, 1, 98); /* with a palette */
    retex_set_close(&set);
    retex_set_close(&odd);
}

static int read_entries(Entry *entries, const unsigned char *bytes, size_t size)
{
    int count = 0;
    for (size_t i = 1; i < size && count < ENTRIES_MAX; count++) {
        Entry *e = &entries[count];
        const unsigned char *line = memchr(bytes + i, '\n', size - i);
        if (!line || (size_t)(bytes + size - line) < 5)
            break;
        snprintf(e->name, sizeof e->name, "%.*s", (int)(line - bytes - (ptrdiff_t)i), (const char *)bytes + i);
        e->size = line[1] | (size_t)line[2] << 8 | (size_t)line[3] << 16 | (size_t)line[4] << 24;
        i = (size_t)(line + 5 - bytes);
        if (e->size > size - i)
            e->size = size - i;
        e->data = malloc(e->size + 1);
        if (!e->data)
            abort();
        memcpy(e->data, bytes + i, e->size);
        i += e->size;
    }
    return count;
}

static Entry *find_entry(Entry *entries, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(entries[i].name, name) == 0)
            return &entries[i];
    return NULL;
}

static void put_number(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

/* The index's words on slices that are an entry: the last one gets what is left, all their checksums. */
static void put_right(unsigned char *index, const Entry *entry, int slices)
{
    size_t begin = 0;
    for (int k = 0; entry && k < slices; k++, index += RETEX_PACK_INDEX_ENTRY_BYTES) {
        size_t bytes = index[0] | (size_t)index[1] << 8 | (size_t)index[2] << 16 | (size_t)index[3] << 24;
        if (k == slices - 1 || bytes > entry->size - begin)
            bytes = entry->size - begin;
        put_number(index, (uint32_t)bytes);
        put_number(index + 4, (uint32_t)crc32_z(0, entry->data + begin, bytes));
        begin += bytes;
    }
}

static void put_parts_right(unsigned char *index, size_t size, const RetexSet *set, const RetexPackPart *parts,
                            Entry *entries, int count)
{
    char name[RETEX_PACK_NAME_MAX];
    size_t at = 0;
    for (int i = 0; i < set->nparts; i++) {
        const int jpeg = parts[i].codec == RETEX_PACK_JPEG ? 1 + parts[i].nstrips : 0,
                  slices[2] = {jpeg, parts[i].nslices - jpeg};
        for (int planes = 0; planes < 2; planes++) {
            retex_pack_file_name(name, sizeof name, set, i, planes);
            if (size - at < (size_t)slices[planes] * RETEX_PACK_INDEX_ENTRY_BYTES)
                return;
            put_right(index + at, find_entry(entries, count, name), slices[planes]);
            at += (size_t)slices[planes] * RETEX_PACK_INDEX_ENTRY_BYTES;
        }
    }
}

static void put_all_right(Entry *entries, int count)
{
    Entry *manifest = find_entry(entries, count, RETEX_PACK_MANIFEST_NAME),
          *index = find_entry(entries, count, RETEX_PACK_INDEX_NAME);
    RetexSet *set = NULL;
    if (!manifest || !index)
        return;
    char *json = strndup((char *)manifest->data, manifest->size);
    if (json) {
        retex_manifest_seal(json);
        memcpy(manifest->data, json, strlen(json));
    }
    if (json && retex_manifest_read(json, "fuzz", &set, NULL, NULL) == 0) {
        RetexPackPart *parts = calloc((size_t)set->nparts + 1, sizeof *parts);
        if (parts && retex_pack_parse(parts, set, json, NULL) == 0)
            put_parts_right(index->data, index->size, set, parts, entries, count);
        for (int i = 0; parts && i < set->nparts; i++)
            retex_pack_part_free(&parts[i]);
        free(parts);
    }
    free(json);
    retex_set_close(&set);
}

/* ---- a zip of plainly stored entries ---- */

static void put(unsigned char **at, size_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        *(*at)++ = (unsigned char)(value >> 8 * i);
}

static void put_bytes(unsigned char **at, const void *bytes, size_t size)
{
    memcpy(*at, bytes, size);
    *at += size;
}

/* What the local and the central header of an entry share. */
static void put_header(unsigned char **at, const Entry *entry)
{
    put(at, 10, 2); /* version needed; flags, method, time: 0; date: the first there is */
    put(at, 0, 6);
    put(at, 0x21, 2);
    put(at, crc32_z(0, entry->data, entry->size), 4);
    put(at, entry->size, 4);
    put(at, entry->size, 4);
    put(at, strlen(entry->name), 2);
    put(at, 0, 2);
}

/* The list as a zip, in new memory. */
static unsigned char *make_zip(const unsigned char *list, size_t list_size, size_t *size)
{
    static Entry entries[ENTRIES_MAX];
    size_t places[ENTRIES_MAX], room = 22;
    int count = read_entries(entries, list, list_size);
    if (list[0] == 'F')
        put_all_right(entries, count);
    for (int i = 0; i < count; i++)
        room += 30 + 46 + 2 * strlen(entries[i].name) + entries[i].size;
    unsigned char *zip = malloc(room), *at = zip;
    if (!zip)
        abort();
    for (int i = 0; i < count; i++) {
        places[i] = (size_t)(at - zip);
        put_bytes(&at, "PK\3\4", 4);
        put_header(&at, &entries[i]);
        put_bytes(&at, entries[i].name, strlen(entries[i].name));
        put_bytes(&at, entries[i].data, entries[i].size);
    }
    size_t directory = (size_t)(at - zip);
    for (int i = 0; i < count; i++) {
        put_bytes(&at, "PK\1\2", 4);
        put(&at, 10, 2);
        put_header(&at, &entries[i]);
        put(&at, 0, 4); /* comment, disk */
        put(&at, 0, 2);
        put(&at, 0, 4);
        put(&at, places[i], 4);
        put_bytes(&at, entries[i].name, strlen(entries[i].name));
        free(entries[i].data);
    }
    size_t directory_size = (size_t)(at - zip) - directory;
    put_bytes(&at, "PK\5\6\0\0\0\0", 8);
    put(&at, (size_t)count, 2);
    put(&at, (size_t)count, 2);
    put(&at, directory_size, 4);
    put(&at, directory, 4);
    put(&at, 0, 2);
    *size = (size_t)(at - zip);
    return zip;
}

static int run(const unsigned char *bytes, size_t size)
{
    RetexSet *set = NULL;
    RetexImage picture = {0};
    int is_list = size && (bytes[0] == 'E' || bytes[0] == 'F');
    unsigned char *zip = is_list ? make_zip(bytes, size, &size) : NULL;
    int code = pack_read(zip ? zip : bytes, size, &set, 1, NULL);
    fuzz_must(!code == (set != NULL), "a set and a failure exclude each other");
    if (set)
        retex_combine(&picture, set, NULL, NULL, 1, NULL);
    retex_image_free(&picture);
    retex_set_close(&set);
    free(zip);
    return !code;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"pack", 0, begin, run};
    return fuzz_main(&driver, argc, argv);
}
