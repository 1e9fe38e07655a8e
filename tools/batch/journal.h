/* The journal of a batch: a text file with a line of JSON for each picture that was made: what it was made from, and
 * its checksum. --resume and --verify compare it with the pictures and their sources.
 *
 * Lines are only appended, each under a lock, so that many processes can share a journal, and several
 * journals can be joined. The last line of an output counts. A line that is cut off counts as absent. Lines are
 * compared as text, so that they have to stay as they were written. */
#ifndef RETEX_BATCH_JOURNAL_H
#define RETEX_BATCH_JOURNAL_H

#include "common/cli.h"

/* What the journal says about a picture. */
typedef enum PictureState {
    PICTURE_GOOD,    /* made from the present sources, and unchanged as far as was looked */
    PICTURE_MISSING, /* there is no such file */
    PICTURE_UNKNOWN, /* there is a file, but the journal does not have it */
    PICTURE_STALE,   /* made from other sources */
    PICTURE_DAMAGED  /* another size or checksum than it was made with */
} PictureState;
enum { PICTURE_STATES = PICTURE_DAMAGED + 1 };
extern const char *const picture_state_names[PICTURE_STATES];

typedef struct JournalLine {
    const char *text;
    size_t key; /* bytes of the text that name the output */
} JournalLine;

/* Zero-initialized. */
typedef struct BatchJournal {
    const char *path;
    int descriptor; /* 1 + the file's, or 0: none */
    char *text;
    JournalLine *lines; /* sorted by key; the last line of each output only */
    size_t nlines;
} BatchJournal;

/* Read the journal. make = 1: it is created if it does not exist, and lines can be added. */
int batch_journal_open(BatchJournal *journal, const char *path, int make, RetexError *err);
void batch_journal_close(BatchJournal *journal);

/* Claim rows of a table, so that no other process with this journal makes them at the same time; until the process
 * ends. table: a number that tells tables apart. RETEX_EIO if some are claimed already. */
int batch_journal_claim(const BatchJournal *journal, uint32_t table, int first, int count, RetexError *err);

/* The state of the picture at path. sources: the beginning of its line, up to what is known when it has been made.
 * checksum = 1: read the whole file, otherwise only its size is compared. reason: why it is stale or damaged, or "". */
PictureState batch_journal_state(const BatchJournal *journal, const char *sources, const char *path, int checksum,
                                  char *reason, size_t size);
/* Append the line of a picture that was made, and tell its size. Files that are not regular are left out. */
int batch_journal_add(const BatchJournal *journal, const char *sources, const char *path, double seconds,
                       RetexError *err);

#endif
