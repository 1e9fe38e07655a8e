/* See journal.h. The keys of a line are output, version, set, samples, options, textures, bytes, crc32 and
 * seconds, in this order. Its beginning up to "version" is the key, that up to "bytes" the sources. No string can
 * contain `, "` as these separators do, because quotes in strings have a backslash. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/file_sum.h>

#include "batch/journal.h"

enum { JOURNAL_BYTES_MAX = 1 << 30 };
#define BYTES_KEY ", \"bytes\": "

const char *const picture_state_names[PICTURE_STATES] = {"good", "missing", "unknown", "stale", "damaged"};

/* ---- reading ---- */

static int compare_lines(const void *a, const void *b)
{
    const JournalLine *x = a, *y = b;
    const int order = memcmp(x->text, y->text, x->key < y->key ? x->key : y->key);
    return order ? order : x->key != y->key ? (x->key < y->key ? -1 : 1) : (x->text > y->text) - (x->text < y->text);
}

static int has_same_key(const JournalLine *a, const JournalLine *b)
{
    return a->key == b->key && memcmp(a->text, b->text, a->key) == 0;
}

/* Cut the text into lines, and keep those that are complete. */
static int index_lines(BatchJournal *journal, RetexError *err)
{
    size_t capacity = 0, kept = 0;
    char *next;
    for (char *line = journal->text; (next = strchr(line, '\n')) != NULL; line = next + 1) {
        *next = '\0';
        const char *version = strstr(line, ", \"version\": ");
        if (!version || !strstr(version, BYTES_KEY) || next[-1] != '}')
            continue;
        if (journal->nlines == capacity) {
            capacity = capacity ? 2 * capacity : 1024;
            JournalLine *more = realloc(journal->lines, capacity * sizeof *more);
            if (!more)
                return retex_fail(err, RETEX_ENOMEM, "not enough memory for %s", journal->path);
            journal->lines = more;
        }
        journal->lines[journal->nlines++] = (JournalLine){line, (size_t)(version - line)};
    }
    if (journal->nlines)
        qsort(journal->lines, journal->nlines, sizeof *journal->lines, compare_lines);
    for (size_t i = 0; i < journal->nlines; i++)
        if (i + 1 == journal->nlines || !has_same_key(&journal->lines[i], &journal->lines[i + 1]))
            journal->lines[kept++] = journal->lines[i];
    journal->nlines = kept;
    return RETEX_OK;
}

static int read_text(BatchJournal *journal, int descriptor, RetexError *err)
{
    struct stat info;
    size_t used = 0;
    if (fstat(descriptor, &info) != 0 || !S_ISREG(info.st_mode))
        return retex_fail(err, RETEX_EIO, "%s is no regular file", journal->path);
    if (info.st_size > JOURNAL_BYTES_MAX)
        return retex_fail(err, RETEX_ELIMIT, "%s: more than the %d MB that a manifest may have", journal->path,
                          JOURNAL_BYTES_MAX >> 20);
    journal->text = malloc((size_t)info.st_size + 1);
    if (!journal->text)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for %s", journal->path);
    while (used < (size_t)info.st_size) {
        const ssize_t got = pread(descriptor, journal->text + used, (size_t)info.st_size - used, (off_t)used);
        if (got < 0 && errno != EINTR)
            return retex_fail(err, RETEX_EIO, "cannot read %s: %s", journal->path, strerror(errno));
        if (got == 0)
            break;
        used += got > 0 ? (size_t)got : 0;
    }
    journal->text[used] = '\0';
    if (used && journal->text[0] != '{')
        return retex_fail(err, RETEX_EFORMAT, "%s is no manifest of a batch", journal->path);
    return index_lines(journal, err);
}

int batch_journal_open(BatchJournal *journal, const char *path, int make, RetexError *err)
{
    *journal = (BatchJournal){.path = path};
    const int descriptor = open(path, (make ? O_RDWR | O_CREAT | O_APPEND : O_RDONLY) | O_CLOEXEC | O_NONBLOCK, 0666);
    if (descriptor < 0)
        return retex_fail(err, RETEX_EIO, "cannot open %s: %s", path, strerror(errno));
    journal->descriptor = descriptor + 1;
    const int code = read_text(journal, descriptor, err);
    if (code)
        batch_journal_close(journal);
    return code;
}

void batch_journal_close(BatchJournal *journal)
{
    if (journal->descriptor)
        close(journal->descriptor - 1);
    free(journal->text);
    free(journal->lines);
    *journal = (BatchJournal){0};
}

/* ---- locks ---- */

/* Locks of byte ranges, which need not exist in the file: byte 0 is for appending. Row r of a table is byte r of
 * the table's range of 2^31. A claim ends with the process, also on other machines that share the file system. */
static int lock(const BatchJournal *journal, int command, short type, off_t start, off_t length)
{
    struct flock range = {.l_type = type, .l_whence = SEEK_SET, .l_start = start, .l_len = length};
    int status;
    do
        status = fcntl(journal->descriptor - 1, command, &range);
    while (status != 0 && errno == EINTR);
    return status == 0 ? 0 : errno;
}

int batch_journal_claim(const BatchJournal *journal, uint32_t table, int first, int count, RetexError *err)
{
    const off_t start = (((off_t)(table >> 1) + 1) << 31) + first;
    const int code = count ? lock(journal, F_OFD_SETLK, F_WRLCK, start, count) : 0;
    if (code == EAGAIN || code == EACCES)
        return retex_fail(err, RETEX_EIO, "another process with %s makes some of these rows", journal->path);
    return code ? retex_fail(err, RETEX_EIO, "cannot lock %s: %s", journal->path, strerror(code)) : RETEX_OK;
}

/* ---- one picture ---- */

static const char *find_line(const BatchJournal *journal, const char *sources)
{
    const char *version = strstr(sources, ", \"version\": ");
    const JournalLine wanted = {sources, (size_t)(version - sources)};
    size_t low = 0, high = journal->nlines;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const JournalLine *line = &journal->lines[middle];
        if (has_same_key(line, &wanted))
            return line->text;
        const size_t shorter = line->key < wanted.key ? line->key : wanted.key;
        const int order = memcmp(line->text, sources, shorter);
        if (order ? order < 0 : line->key < wanted.key)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

/* Whether both lines have the same value of a key; it ends where the next key begins. */
static int has_same_value(const char *line, const char *sources, const char *key, const char *next)
{
    const char *a = strstr(line, key), *b = strstr(sources, key);
    const char *a_end = a ? strstr(a, next) : NULL, *b_end = b ? strstr(b, next) : NULL;
    if (a && !a_end)
        a_end = a + strlen(a);
    if (b && !b_end)
        b_end = b + strlen(b);
    return a && b && a_end - a == b_end - b && memcmp(a, b, (size_t)(a_end - a)) == 0;
}

/* What differs in the sources, in words. */
static const char *explain(const char *line, const char *sources)
{
    static const struct {
        const char *key, *next, *reason;
    } parts[] = {{", \"version\": ", ", \"set\": ", "another version of the program made it"},
                 {", \"set\": ", ", \"samples\": ", "the set has changed"},
                 {", \"samples\": ", ", \"options\": ", "the samples have changed"},
                 {", \"options\": ", ", \"textures\": ", "the options have changed"}};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (!has_same_value(line, sources, parts[i].key, parts[i].next))
            return parts[i].reason;
    return "its row or an image of it has changed";
}

PictureState batch_journal_state(const BatchJournal *journal, const char *sources, const char *path, int checksum,
                                  char *reason, size_t size)
{
    const char *line = find_line(journal, sources), *made;
    const size_t length = strlen(sources);
    struct stat info;
    RetexFileSum sum;
    RetexError err = {0};
    uint64_t bytes = 0;
    uint32_t crc = 0;
    reason[0] = '\0';
    if (stat(path, &info) != 0)
        return PICTURE_MISSING;
    if (!line)
        return PICTURE_UNKNOWN;
    if (strncmp(line, sources, length) != 0) {
        snprintf(reason, size, "%s", explain(line, sources));
        return PICTURE_STALE;
    }
    made = line + length;
    if (sscanf(made, BYTES_KEY "%" SCNu64 ", \"crc32\": \"%" SCNx32, &bytes, &crc) != 2)
        return PICTURE_UNKNOWN;
    if ((uint64_t)info.st_size != bytes)
        snprintf(reason, size, "%jd bytes instead of %" PRIu64, (intmax_t)info.st_size, bytes);
    else if (checksum && retex_file_sum(&sum, path, NULL, &err))
        snprintf(reason, size, "%s", err.message);
    else if (checksum && (sum.crc != crc || sum.bytes != bytes))
        snprintf(reason, size, "its checksum is wrong");
    return reason[0] ? PICTURE_DAMAGED : PICTURE_GOOD;
}

static int write_all(int descriptor, const char *text, size_t bytes)
{
    while (bytes) {
        const ssize_t written = write(descriptor, text, bytes);
        if (written < 0 && errno != EINTR)
            return errno;
        if (written == 0)
            return EIO;
        text += written > 0 ? written : 0;
        bytes -= written > 0 ? (size_t)written : 0;
    }
    return 0;
}

/* Append text. A line that a process left unfinished is ended first. */
static int append(const BatchJournal *journal, const char *text, size_t bytes)
{
    const int descriptor = journal->descriptor - 1;
    struct stat info;
    char last = '\n';
    if (fstat(descriptor, &info) != 0)
        return errno;
    if (info.st_size > 0 && pread(descriptor, &last, 1, info.st_size - 1) < 0)
        return errno;
    const int code = last == '\n' ? 0 : write_all(descriptor, "\n", 1);
    return code ? code : write_all(descriptor, text, bytes);
}

int batch_journal_add(const BatchJournal *journal, const char *sources, const char *path, double seconds,
                       RetexError *err)
{
    struct stat info;
    RetexFileSum sum;
    char *line = NULL;
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode))
        return RETEX_OK;
    int code = retex_file_sum(&sum, path, NULL, err);
    if (code)
        return code;
    const int length = asprintf(&line, "%s" BYTES_KEY "%" PRIu64 ", \"crc32\": \"%08" PRIx32 "\", \"seconds\": %.4f}\n",
                                sources, sum.bytes, sum.crc, seconds);
    if (length < 0)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a line of %s", journal->path);
    code = lock(journal, F_OFD_SETLKW, F_WRLCK, 0, 1);
    if (!code) {
        code = append(journal, line, (size_t)length);
        lock(journal, F_OFD_SETLK, F_UNLCK, 0, 1);
    }
    free(line);
    return code ? retex_fail(err, RETEX_EIO, "cannot write %s: %s", journal->path, strerror(code)) : RETEX_OK;
}
