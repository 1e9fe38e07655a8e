/* Files that clients send: a name up to the first line end, and bytes. retex-studio keeps them under a name below its
 * folder; retex-serve keeps what is an image, by its hash. What is kept has all its bytes and lies where it should. */
#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
#include <retex/image_file.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lib_fuzz.h"
#include "lib_test.h"
#include "serve/files/uploads.h"
#include "studio/received.h"

static RetexBudget *budget;
static char here[PATH_MAX - 32];

static void seed_image(const char *name)
{
    static unsigned char bytes[1 << 16];
    const size_t head = (size_t)snprintf((char *)bytes, sizeof bytes, "%s\n", name);
    RetexImage image = {0};
    test_random_image(&image, 9, 6, 3, 3, 0, 1);
    RetexError err = {0};
    test_must(retex_image_write(&image, name, NULL, 1, &err), &err);
    retex_image_free(&image);
    FILE *file = fopen(name, "rb");
    const size_t size = file ? fread(bytes + head, 1, sizeof bytes - head, file) : 0;
    fuzz_must(size > 0 && fclose(file) == 0 && unlink(name) == 0, "an image can be written");
    fuzz_seed(bytes, head + size);
}

static void begin(void)
{
    static const char *const images[] = {"a.png", "b.jpg", "c.exr",  "d.tif", "e.bmp",
                                         "f.tga", "g.gif", "h.webp", "i.hdr"};
    static const char *const names[] = {"rooms/oak/floor.obj\nv 0 0 0\n", "../../.hidden\nx", "CON\\a:b*?.jpg\n",
                                        "\xc3\xa9\xcc\x81/./..//a. \n\x80"};
    RetexError err = {0};
    fuzz_must(getcwd(here, sizeof here) != NULL, "there is a folder");
    test_must(retex_budget_create(&budget, &err), &err);
    retex_budget_set_pixels(budget, 1 << 16);
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        seed_image(images[i]);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        fuzz_seed(names[i], strlen(names[i]));
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *walk)
{
    (void)status, (void)kind, (void)walk;
    return remove(path);
}

/* An empty folder of this name here; its path. */
static const char *fresh(const char *name)
{
    static char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", here, name);
    nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS);
    fuzz_must(mkdir(path, 0700) == 0, "a folder can be made");
    return path;
}

static void check_kept(const char *path, const unsigned char *bytes, size_t size)
{
    struct stat status;
    FILE *file = fopen(path, "rb");
    fuzz_must(file && fstat(fileno(file), &status) == 0 && (size_t)status.st_size == size, "a kept file has its size");
    for (size_t i = 0; i < size; i++)
        fuzz_must(fgetc(file) == bytes[i], "a kept file has its bytes");
    fclose(file);
}

/* By its name, as the studio does. */
static int receive(const char *name, const unsigned char *bytes, size_t size)
{
    static Received received;
    const char *folder = fresh("received");
    char path[PATH_MAX];
    if (received_begin(&received, open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder, name, size, NULL))
        return 0;
    fuzz_must(received_bytes(&received, bytes, size / 2, NULL) == 0, "a half can be written");
    fuzz_must(received_bytes(&received, bytes + size / 2, size - size / 2, NULL) == 0, "the rest can be written");
    fuzz_must(received_end(&received, path, NULL) == 0, "a file gets its name");
    const size_t length = strlen(folder);
    fuzz_must(strncmp(path, folder, length) == 0 && path[length] == '/' && !strstr(path, "/../"), "it lies below");
    check_kept(path, bytes, size);
    return 1;
}

/* The only file of a folder, or "". */
static void only_file(const char *folder, char path[PATH_MAX])
{
    DIR *files = opendir(folder);
    *path = 0;
    for (struct dirent *entry; files && (entry = readdir(files));) {
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, ".."))
            continue;
        fuzz_must(!*path, "one file at most");
        snprintf(path, PATH_MAX, "%s/%.*s", folder, 255, entry->d_name);
    }
    closedir(files);
}

/* By its hash, as the server does. */
static int upload(const unsigned char *bytes, size_t size)
{
    static const char hash[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
    const char *folder = fresh("uploads");
    const UploadsParams params = {folder, FUZZ_LARGEST, 1 << 20, 2, 0, budget, 5};
    char path[PATH_MAX];
    Uploads *uploads;
    RetexError err = {0};
    test_must(uploads_open(&uploads, &params, &err), &err);
    Answer *answer = uploads_keep(uploads, hash, bytes, size, 1e30);
    fuzz_must(answer != NULL, "there is an answer");
    const int status = answer->status, count = uploads_count(uploads).count;
    fuzz_must(status == 201 || status == 413 || status == 415 || status == 507, "a status that is described");
    fuzz_must(count == (status == 201), "what is refused is not counted");
    answer_release(answer);
    only_file(folder, path);
    fuzz_must(!!*path == (status == 201), "what is refused leaves nothing");
    if (*path)
        check_kept(path, bytes, size);
    uploads_close(uploads);
    return status == 201;
}

/* The formats that are decoded in the process, by code of the project around the formats' libraries. Others are decoded
 * in a process of their own, by OpenImageIO. */
static int is_own_format(const unsigned char *bytes, size_t size)
{
    static const char *const magic[] = {"\x89PNG\r\n", "\xff\xd8\xff", "\x76\x2f\x31\x01"};
    int own = 0;
    for (size_t i = 0; i < sizeof magic / sizeof *magic; i++)
        own |= size >= strlen(magic[i]) && memcmp(bytes, magic[i], strlen(magic[i])) == 0;
    return own;
}

static int decode(const unsigned char *bytes, size_t size)
{
    RetexReadParams params = RETEX_READ_INIT;
    RetexImage image = {0};
    FILE *file = fopen("upload", "wb");
    fuzz_must(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0, "a file can be written");
    params.max_pixels = 1 << 16;
    const int code = retex_image_read(&image, "upload", &params, 1, NULL);
    fuzz_must(!code == (image.pixels != NULL), "a picture and a failure exclude each other");
    fuzz_must(code || (long)image.width * image.height <= params.max_pixels, "a picture is no larger than may be");
    retex_image_free(&image);
    return !code;
}

static int run(const unsigned char *bytes, size_t size)
{
    char name[2000];
    unsigned sum = 0;
    const unsigned char *end = memchr(bytes, '\n', size);
    const size_t length = end ? (size_t)(end - bytes) : size, from = length + (end != NULL);
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), (const char *)bytes);
    int accepted = receive(name, bytes + from, size - from);
    if (is_own_format(bytes + from, size - from))
        accepted |= decode(bytes + from, size - from);
    for (size_t i = 0; i < size; i++)
        sum = 31 * sum + bytes[i];
    if (sum % 1024 == 0) /* it starts a process */
        accepted |= upload(bytes + from, size - from);
    return accepted;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"upload", 0, begin, run};
    return fuzz_main(&driver, argc, argv);
}
