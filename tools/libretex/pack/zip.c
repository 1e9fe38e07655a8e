/* ZIP files with stored entries, after PKWARE's APPNOTE; ZIP64 fields where 32 bits are too few. See zip.h. */
#include "pack/zip.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/checksum.h"

enum {
    LOCAL_BYTES = 30,
    CENTRAL_BYTES = 46,
    END_BYTES = 22,
    END64_BYTES = 56,
    LOCATOR64_BYTES = 20,
    EXTRA64_ID = 1,
    NAMES_ARE_UTF8 = 1 << 11,
    FIRST_DAY = 0x21, /* 1 January 1980 */
    ENTRIES_MAX = 65535
};
static const uint32_t LOCAL_MARK = 0x04034b50, CENTRAL_MARK = 0x02014b50, END_MARK = 0x06054b50;
static const uint32_t END64_MARK = 0x06064b50, LOCATOR64_MARK = 0x07064b50;
static const uint64_t MOST_32 = 0xffffffff;

static int damaged(RetexError *err, const char *what)
{
    return retex_fail(err, RETEX_EFORMAT, "the pack is damaged or truncated: %s", what);
}

void retex_zip_list_free(RetexZipList *list)
{
    free(list->entries);
    memset(list, 0, sizeof *list);
}

const RetexZipEntry *retex_zip_list_find(const RetexZipList *list, const char *name)
{
    for (int i = 0; i < list->count; i++)
        if (strcmp(list->entries[i].name, name) == 0)
            return &list->entries[i];
    return NULL;
}

static RetexZipEntry *append(RetexZipList *list, RetexError *err)
{
    if (list->count == list->capacity) {
        const int capacity = list->capacity ? 2 * list->capacity : 64;
        RetexZipEntry *entries = realloc(list->entries, (size_t)capacity * sizeof *entries);
        if (!entries) {
            retex_fail(err, RETEX_ENOMEM, "no memory for a pack's entries");
            return NULL;
        }
        list->entries = entries;
        list->capacity = capacity;
    }
    memset(&list->entries[list->count], 0, sizeof *list->entries);
    return &list->entries[list->count++];
}

/* --- writing --- */

static void put(unsigned char **at, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++, value >>= 8)
        *(*at)++ = (unsigned char)(value & 255);
}

static uint64_t capped_32(uint64_t value)
{
    return value < MOST_32 ? value : MOST_32;
}

/* Write the fields that local and central headers share: 'version needed' to 'extra field length'. */
static void put_common(unsigned char **at, const RetexZipEntry *entry, int extra_bytes)
{
    put(at, extra_bytes ? 45 : 10, 2);
    put(at, NAMES_ARE_UTF8, 2);
    put(at, 0, 4); /* compression method 0: stored; time 0: midnight */
    put(at, FIRST_DAY, 2);
    put(at, entry->crc, 4);
    put(at, capped_32(entry->bytes), 4);
    put(at, capped_32(entry->bytes), 4);
    put(at, strlen(entry->name), 2);
    put(at, (uint64_t)extra_bytes, 2);
}

static int write_counted(RetexOutput *output, const void *data, size_t bytes, uint64_t *written, RetexError *err)
{
    *written += bytes;
    return retex_output_write(output, data, bytes, err);
}

int retex_zip_entry_write(RetexOutput *output, RetexZipList *list, const char *name, const void *const *slices,
                          const size_t *bytes, int count, uint64_t *written, RetexError *err)
{
    unsigned char header[LOCAL_BYTES + RETEX_PACK_NAME_MAX + 20], *at = header;
    RetexZipEntry *entry = append(list, err);
    if (!entry)
        return RETEX_ENOMEM;
    snprintf(entry->name, sizeof entry->name, "%s", name);
    entry->crc = CRC32_OF_NONE;
    for (int i = 0; i < count; i++) {
        entry->crc = retex_crc32(entry->crc, slices[i], bytes[i]);
        entry->bytes += bytes[i];
    }
    const int wide = entry->bytes >= MOST_32;
    put(&at, LOCAL_MARK, 4);
    put_common(&at, entry, wide ? 20 : 0);
    memcpy(at, name, strlen(name));
    at += strlen(name);
    if (wide) {
        put(&at, EXTRA64_ID, 2);
        put(&at, 16, 2);
        put(&at, entry->bytes, 8);
        put(&at, entry->bytes, 8);
    }
    entry->offset = *written + (uint64_t)(at - header);
    int code = write_counted(output, header, (size_t)(at - header), written, err);
    for (int i = 0; !code && i < count; i++)
        code = write_counted(output, slices[i], bytes[i], written, err);
    return code;
}

/* Offset of an entry's local header, as the central directory gives it. */
static uint64_t header_place(const RetexZipEntry *entry)
{
    return entry->offset - LOCAL_BYTES - strlen(entry->name) - (entry->bytes >= MOST_32 ? 20 : 0);
}

static int write_central(RetexOutput *output, const RetexZipEntry *entry, uint64_t *written, RetexError *err)
{
    unsigned char header[CENTRAL_BYTES + RETEX_PACK_NAME_MAX + 28], *at = header;
    const uint64_t place = header_place(entry);
    const int wide = entry->bytes >= MOST_32, far = place >= MOST_32, extra = 16 * wide + 8 * far;
    put(&at, CENTRAL_MARK, 4);
    put(&at, wide || far ? 45 : 10, 2);
    put_common(&at, entry, extra ? extra + 4 : 0);
    put(&at, 0, 10); /* comment, disk, attributes */
    put(&at, capped_32(place), 4);
    memcpy(at, entry->name, strlen(entry->name));
    at += strlen(entry->name);
    if (extra) {
        put(&at, EXTRA64_ID, 2);
        put(&at, (uint64_t)extra, 2);
    }
    for (int i = 0; i < 2 * wide; i++)
        put(&at, entry->bytes, 8);
    if (far)
        put(&at, place, 8);
    return write_counted(output, header, (size_t)(at - header), written, err);
}

int retex_zip_directory_write(RetexOutput *output, const RetexZipList *list, uint64_t *written, RetexError *err)
{
    unsigned char end[END64_BYTES + LOCATOR64_BYTES + END_BYTES], *at = end;
    const uint64_t begin = *written;
    int code = 0;
    for (int i = 0; !code && i < list->count; i++)
        code = write_central(output, &list->entries[i], written, err);
    if (code)
        return code;
    const uint64_t bytes = *written - begin, count = (uint64_t)list->count;
    if (begin >= MOST_32 || bytes >= MOST_32) {
        put(&at, END64_MARK, 4);
        put(&at, END64_BYTES - 12, 8);
        put(&at, 45, 2);
        put(&at, 45, 2);
        put(&at, 0, 8);
        put(&at, count, 8);
        put(&at, count, 8);
        put(&at, bytes, 8);
        put(&at, begin, 8);
        put(&at, LOCATOR64_MARK, 4);
        put(&at, 0, 4);
        put(&at, begin + bytes, 8);
        put(&at, 1, 4);
    }
    put(&at, END_MARK, 4);
    put(&at, 0, 4);
    put(&at, count, 2);
    put(&at, count, 2);
    put(&at, capped_32(bytes), 4);
    put(&at, capped_32(begin), 4);
    put(&at, 0, 2);
    return write_counted(output, end, (size_t)(at - end), written, err);
}

/* --- reading --- */

static uint64_t get(const unsigned char *at, int bytes)
{
    uint64_t value = 0;
    for (int i = bytes; i-- > 0;)
        value = value << 8 | at[i];
    return value;
}

static int read_all(const RetexInput *input, void *buffer, size_t bytes, uint64_t offset)
{
    return retex_input_read(input, buffer, bytes, offset) == (int64_t)bytes;
}

typedef struct Directory {
    uint64_t begin, bytes, end; /* end: where the end records begin */
    int count;
} Directory;

/* Find the central directory. The end record must be the last bytes of the file, so a ZIP comment is refused. */
static int find_directory(Directory *directory, const RetexInput *input, RetexError *err)
{
    unsigned char end[END_BYTES], wide[END64_BYTES + LOCATOR64_BYTES];
    const uint64_t size = retex_input_size(input);
    if (size < END_BYTES || !read_all(input, end, END_BYTES, size - END_BYTES) || get(end, 4) != END_MARK)
        return damaged(err, "its directory is missing");
    *directory = (Directory){get(end + 16, 4), get(end + 12, 4), size - END_BYTES, (int)get(end + 10, 2)};
    int ok = get(end + 4, 4) == 0 && get(end + 8, 2) == get(end + 10, 2) && get(end + 20, 2) == 0;
    if (ok && (directory->begin == MOST_32 || directory->bytes == MOST_32)) {
        ok = directory->end > sizeof wide && read_all(input, wide, sizeof wide, directory->end - sizeof wide) &&
             get(wide, 4) == END64_MARK && get(wide + END64_BYTES, 4) == LOCATOR64_MARK;
        directory->bytes = get(wide + 40, 8);
        directory->begin = get(wide + 48, 8);
        directory->end -= sizeof wide;
    }
    ok = ok && directory->bytes <= directory->end && directory->begin == directory->end - directory->bytes &&
         directory->bytes >= (uint64_t)directory->count * CENTRAL_BYTES &&
         directory->bytes <= (uint64_t)directory->count * (CENTRAL_BYTES + RETEX_PACK_NAME_MAX + 1024);
    return ok ? 0 : damaged(err, "its directory is not sound");
}

/* Parse the directory's entry at *at. entry->offset gets the offset of the local header. */
static int parse_central(RetexZipEntry *entry, const unsigned char **at, const unsigned char *end, RetexError *err)
{
    const unsigned char *p = *at;
    if (end - p < CENTRAL_BYTES || get(p, 4) != CENTRAL_MARK)
        return damaged(err, "its directory is not sound");
    const size_t name = (size_t)get(p + 28, 2), extra = (size_t)get(p + 30, 2), comment = (size_t)get(p + 32, 2);
    if ((size_t)(end - p) < CENTRAL_BYTES + name + extra + comment || name == 0 || name >= RETEX_PACK_NAME_MAX ||
        memchr(p + CENTRAL_BYTES, 0, name))
        return damaged(err, "an entry has no proper name");
    if ((get(p + 8, 2) & ~(uint64_t)NAMES_ARE_UTF8) || get(p + 10, 2) != 0)
        return damaged(err, "an entry is not stored plainly");
    memcpy(entry->name, p + CENTRAL_BYTES, name);
    entry->crc = (uint32_t)get(p + 16, 4);
    entry->bytes = get(p + 24, 4);
    entry->offset = get(p + 42, 4);
    uint64_t packed = get(p + 20, 4);
    const unsigned char *field = p + CENTRAL_BYTES + name, *fields_end = field + extra;
    while (fields_end - field >= 4 && get(field + 2, 2) <= (uint64_t)(fields_end - field - 4)) {
        const unsigned char *value = field + 4, *value_end = value + get(field + 2, 2);
        uint64_t *wide[3] = {&entry->bytes, &packed, &entry->offset};
        for (int i = 0; get(field, 2) == EXTRA64_ID && i < 3; i++)
            if (*wide[i] == MOST_32 && value_end - value >= 8) {
                *wide[i] = get(value, 8);
                value += 8;
            }
        field = value_end;
    }
    *at = p + CENTRAL_BYTES + name + extra + comment;
    return packed == entry->bytes ? 0 : damaged(err, "an entry is not stored plainly");
}

/* Change entry->offset from the local header to the data. The header must agree with the directory. */
static int check_local(RetexZipEntry *entry, const RetexInput *input, uint64_t end, RetexError *err)
{
    unsigned char header[LOCAL_BYTES + RETEX_PACK_NAME_MAX];
    const size_t name = strlen(entry->name);
    int ok = entry->offset < end && end - entry->offset >= LOCAL_BYTES + name &&
             read_all(input, header, LOCAL_BYTES + name, entry->offset) && get(header, 4) == LOCAL_MARK &&
             get(header + 6, 2) <= NAMES_ARE_UTF8 && get(header + 8, 2) == 0 && get(header + 14, 4) == entry->crc &&
             get(header + 22, 4) == capped_32(entry->bytes) && get(header + 26, 2) == name &&
             memcmp(header + LOCAL_BYTES, entry->name, name) == 0;
    if (ok) {
        entry->offset += LOCAL_BYTES + name + get(header + 28, 2);
        ok = entry->offset <= end && entry->bytes <= end - entry->offset;
    }
    return ok ? 0 : damaged(err, "an entry's header is not sound");
}

static int by_offset(const void *a, const void *b)
{
    const RetexZipEntry *x = a, *y = b;
    return (x->offset > y->offset) - (x->offset < y->offset);
}

static int by_name(const void *a, const void *b)
{
    return strcmp((*(const RetexZipEntry *const *)a)->name, (*(const RetexZipEntry *const *)b)->name);
}

static int names_differ(const RetexZipList *list, RetexError *err)
{
    const RetexZipEntry **sorted = malloc(((size_t)list->count + 1) * sizeof *sorted);
    int differ = 1;
    if (!sorted)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a pack's entries");
    for (int i = 0; i < list->count; i++)
        sorted[i] = &list->entries[i];
    qsort(sorted, (size_t)list->count, sizeof *sorted, by_name);
    for (int i = 1; i < list->count; i++)
        differ = differ && strcmp(sorted[i - 1]->name, sorted[i]->name) != 0;
    free(sorted);
    return differ ? 0 : damaged(err, "two entries have the same name");
}

static int parse_directory(RetexZipList *list, const Directory *directory, const unsigned char *bytes,
                           const RetexInput *input, RetexError *err)
{
    const unsigned char *at = bytes, *end = bytes + directory->bytes;
    int code = 0;
    for (int i = 0; !code && i < directory->count; i++) {
        RetexZipEntry *entry = append(list, err);
        code = entry ? parse_central(entry, &at, end, err) : RETEX_ENOMEM;
        if (!code)
            code = check_local(entry, input, directory->begin, err);
    }
    if (!code && at != end)
        code = damaged(err, "its directory is not sound");
    if (code)
        return code;
    if (list->count)
        qsort(list->entries, (size_t)list->count, sizeof *list->entries, by_offset);
    for (int i = 1; i < list->count; i++) {
        const RetexZipEntry *before = &list->entries[i - 1], *entry = &list->entries[i];
        if (entry->offset - before->offset < before->bytes + LOCAL_BYTES + strlen(entry->name))
            return damaged(err, "its entries overlap");
    }
    return names_differ(list, err);
}

int retex_zip_list_read(RetexZipList *list, const RetexInput *input, RetexError *err)
{
    Directory directory = {0};
    memset(list, 0, sizeof *list);
    int code = find_directory(&directory, input, err);
    if (code)
        return code;
    unsigned char *bytes = malloc(directory.bytes + 1);
    if (!bytes)
        return retex_fail(err, RETEX_ENOMEM, "no memory for a pack's directory");
    code = read_all(input, bytes, directory.bytes, directory.begin)
               ? parse_directory(list, &directory, bytes, input, err)
               : damaged(err, "its directory cannot be read");
    free(bytes);
    if (code)
        retex_zip_list_free(list);
    return code;
}
