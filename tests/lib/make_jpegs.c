/* make_jpegs FOLDER: JPEG files of every kind that libjpeg writes, and strange ones that are whole. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

enum { WIDTH = 61, HEIGHT = 47, FILE_MOST = 1 << 17 };

/* How one is encoded. */
typedef struct Kind {
    const char *name;
    J_COLOR_SPACE from, to;
    int quality, sampling; /* of luminance, in each direction */
    int progressive, arithmetic, restart, optimize, scan_by_component;
} Kind;

static const Kind kinds[] = {
    {.name = "baseline", JCS_RGB, JCS_YCbCr, 90, 1},
    {.name = "coarse", JCS_RGB, JCS_YCbCr, 25, 2},
    {.name = "subsampled", JCS_RGB, JCS_YCbCr, 85, 2, .optimize = 1},
    {.name = "restarts", JCS_RGB, JCS_YCbCr, 90, 1, .restart = 3},
    {.name = "progressive", JCS_RGB, JCS_YCbCr, 90, 1, .progressive = 1},
    {.name = "progressive-restarts", JCS_RGB, JCS_YCbCr, 80, 2, .progressive = 1, .restart = 5},
    {.name = "arithmetic", JCS_RGB, JCS_YCbCr, 90, 1, .arithmetic = 1},
    {.name = "arithmetic-progressive", JCS_RGB, JCS_YCbCr, 90, 2, .arithmetic = 1, .progressive = 1},
    {.name = "scans", JCS_RGB, JCS_YCbCr, 90, 1, .scan_by_component = 1},
    {.name = "rgb", JCS_RGB, JCS_RGB, 90, 1},
    {.name = "grey", JCS_GRAYSCALE, JCS_GRAYSCALE, 90, 1},
    {.name = "grey-progressive", JCS_GRAYSCALE, JCS_GRAYSCALE, 90, 1, .progressive = 1},
    {.name = "cmyk", JCS_CMYK, JCS_CMYK, 90, 1},
    {.name = "ycck", JCS_CMYK, JCS_YCCK, 90, 2},
    {.name = "ycck-progressive", JCS_CMYK, JCS_YCCK, 90, 1, .progressive = 1},
};

/* Edges, a gradient and noise. */
static void make_row(unsigned char *row, int y, int channels)
{
    unsigned noise = 12345u + (unsigned)y * 7919u;
    for (int x = 0; x < WIDTH; x++)
        for (int c = 0; c < channels; c++) {
            noise = noise * 1664525u + 1013904223u;
            const int edge = (x / 9 + y / 7 + c) % 3 == 0 ? 60 : 0;
            row[x * channels + c] = (unsigned char)(x * 2 + y * (c + 1) / 2 + edge + (int)(noise >> 28));
        }
}

static size_t encode(const Kind *kind, unsigned char *file)
{
    static const jpeg_scan_info by_component[3] = {
        {1, {0, 0, 0, 0}, 0, 63, 0, 0}, {1, {1, 0, 0, 0}, 0, 63, 0, 0}, {1, {2, 0, 0, 0}, 0, 63, 0, 0}};
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char row[WIDTH * 4], *rows = row, *out = NULL;
    unsigned long size = 0;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &out, &size);
    jpeg.image_width = WIDTH, jpeg.image_height = HEIGHT;
    jpeg.in_color_space = kind->from;
    jpeg.input_components = kind->from == JCS_GRAYSCALE ? 1 : kind->from == JCS_CMYK ? 4 : 3;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, kind->to);
    jpeg_set_quality(&jpeg, kind->quality, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = kind->sampling;
    if (kind->to == JCS_YCCK)
        jpeg.comp_info[3].h_samp_factor = jpeg.comp_info[3].v_samp_factor = kind->sampling;
    jpeg.restart_interval = (unsigned)kind->restart;
    jpeg.arith_code = kind->arithmetic;
    jpeg.optimize_coding = kind->optimize;
    if (kind->progressive)
        jpeg_simple_progression(&jpeg);
    if (kind->scan_by_component)
        jpeg.scan_info = by_component, jpeg.num_scans = 3;
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < HEIGHT; y++) {
        make_row(row, y, jpeg.input_components);
        jpeg_write_scanlines(&jpeg, &rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    memcpy(file, out, size);
    free(out);
    return size;
}

static int write_file(const char *folder, const char *name, const unsigned char *data, size_t size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/jpeg-%s.jpg", folder, name);
    FILE *out = fopen(path, "wb");
    const int written = out && fwrite(data, 1, size, out) == size;
    return (out && fclose(out) != 0) || !written;
}

/* Writes the file with bytes inserted at some place. */
static int write_with(const char *folder, const char *name, const unsigned char *file, size_t size, size_t at,
                      const void *insert, size_t count)
{
    static unsigned char changed[FILE_MOST * 2];
    memcpy(changed, file, at);
    memcpy(changed + at, insert, count);
    memcpy(changed + at + count, file + at, size - at);
    return write_file(folder, name, changed, size + count);
}

/* Where the marker begins. */
static size_t find(const unsigned char *file, size_t size, unsigned char marker)
{
    for (size_t i = 2; i + 4 <= size; i += 2 + (size_t)(file[i + 2] << 8 | file[i + 3]))
        if (file[i + 1] == marker)
            return i;
    return 0;
}

static int write_strange(const char *folder, const unsigned char *file, size_t size)
{
    static const unsigned char padding[16384],
        fill[5] = {0xff, 0xff, 0xff, 0xff, 0xff}, comment[] = "\xff\xfe\x00\x07hello",
        photoshop[] = "\xff\xed\x00\x10Photoshop 3.0", /* 16 bytes, with the zero */
        exif[] = "\xff\xe1\x00\x22"
                 "Exif\0\0"
                 "II*\0\x08\0\0\0"
                 "\x01\0"
                 "\x12\x01\x03\0\x01\0\0\0\x06\0\0\0"
                 "\0\0\0",
        preview[] = "\xff\xe2\x00\x10MPF\0II*\0\x08\0\0\0\0"; /* 14 bytes with the last zero, and two of the length */
    static unsigned char changed[FILE_MOST];
    int failed = write_with(folder, "trailing-zeros", file, size, size, padding, sizeof padding);
    failed |= write_with(folder, "second-picture", file, size, size, file, size);
    failed |= write_with(folder, "fill-before-end", file, size, size - 2, fill, sizeof fill);
    failed |= write_with(folder, "fill-before-tables", file, size, find(file, size, 0xdb), fill, sizeof fill);
    failed |= write_with(folder, "comment", file, size, 2, comment, 9);
    failed |= write_with(folder, "photoshop", file, size, 20, photoshop, 18);
    failed |= write_with(folder, "turned", file, size, 20, exif, 36);
    failed |= write_with(folder, "preview", file, size, 20, preview, 18);
    memcpy(changed, file, size);
    changed[11] = 9; /* JFIF's version, which libjpeg warns of */
    failed |= write_file(folder, "jfif-9", changed, size);
    memcpy(changed, file, size);
    const size_t scan = find(file, size, 0xda);
    changed[scan + 12] = 0; /* the last coefficient, which decoders of sequential files ignore */
    return failed | write_file(folder, "spectrum-0", changed, size);
}

int main(int argc, char **argv)
{
    static unsigned char file[FILE_MOST];
    int failed = 0;
    if (argc != 2)
        return 2;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        failed |= write_file(argv[1], kinds[i].name, file, encode(&kinds[i], file));
    failed |= write_strange(argv[1], file, encode(&kinds[0], file));
    return failed ? 2 : 0;
}
