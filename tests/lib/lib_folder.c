/* See lib_folder.h. */
#include "lib_folder.h"
#include "lib_test.h"

#include <cmocka.h>
#include <dirent.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

char test_folder[32];
char test_own_file[48];

int test_make_folder(void **state)
{
    (void)state;
    strcpy(test_folder, "/tmp/retex-test-XXXXXX");
    if (!mkdtemp(test_folder))
        return -1;
    snprintf(test_own_file, sizeof test_own_file, "%s/file", test_folder);
    return 0;
}

static int is_entry(const struct dirent *entry)
{
    return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *walk)
{
    (void)info, (void)kind, (void)walk;
    return remove(path);
}

int test_remove_folder(void **state)
{
    (void)state;
    return nftw(test_folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

const char *test_in_folder(const char *name)
{
    static char paths[8][512];
    static int next;
    next = (next + 1) % 8;
    snprintf(paths[next], sizeof paths[next], "%s/%s", test_folder, name);
    return paths[next];
}

int test_files_left(void)
{
    DIR *dir = opendir(test_folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(dir));)
        count += is_entry(entry);
    closedir(dir);
    return count;
}

unsigned char *test_read_file(const char *path, size_t *bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *bytes = (size_t)ftell(file);
    rewind(file);
    unsigned char *data = malloc(*bytes);
    assert_int_equal(fread(data, 1, *bytes, file), *bytes);
    fclose(file);
    return data;
}
