/* See iiif.h. */
#include "serve/request/iiif.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/json.h"
#include "serve/request/url.h"

#define CONTEXT "http://iiif.io/api/image/3/context.json"

/* ---- parameters ---- */

/* Decimal digits with at most one point among them; at most 20 characters. */
static int parse_decimal(const char *text, double *value)
{
    size_t whole = strspn(text, "0123456789"), part = text[whole] == '.' ? strspn(text + whole + 1, "0123456789") : 0;
    size_t length = whole + part + (text[whole] == '.');
    if (whole + part == 0 || length > 20 || text[length])
        return 0;
    *value = strtod(text, NULL);
    return 1;
}

static int refuse_region(ServeRequest *request, const char *text)
{
    return serve_refuse(request, 400, "region `%s`: expected full, square, x,y,w,h or pct:x,y,w,h", text);
}

static int parse_region(ServeRequest *request, const char *text)
{
    ServeRegion *region = &request->region;
    double *values[] = {&region->x, &region->y, &region->width, &region->height};
    char numbers[100], *number = numbers;
    *region = (ServeRegion){.kind = SERVE_REGION_FULL};
    if (strcmp(text, "full") == 0)
        return 0;
    if (strcmp(text, "square") == 0) {
        region->kind = SERVE_REGION_SQUARE;
        return 0;
    }
    region->kind = strncmp(text, "pct:", 4) == 0 ? SERVE_REGION_PERCENT : SERVE_REGION_PIXELS;
    const char *list = text + (region->kind == SERVE_REGION_PERCENT ? 4 : 0);
    if (strlen(list) >= sizeof numbers)
        return refuse_region(request, text);
    strcpy(numbers, list);
    for (int i = 0; i < 4; i++) {
        char *next = number ? url_cut(number, ',') : NULL;
        int whole = 0, good = 0;
        if (number && !(i == 3 && next))
            good =
                region->kind == SERVE_REGION_PERCENT ? parse_decimal(number, values[i]) : url_integer(number, &whole);
        if (!good)
            return refuse_region(request, text);
        if (region->kind == SERVE_REGION_PIXELS)
            *values[i] = whole;
        number = next;
    }
    return 0;
}

static int refuse_size(ServeRequest *request, const char *text)
{
    return serve_refuse(request, 400, "size `%s`: expected max, w,  ,h  pct:n  w,h or !w,h", text);
}

static int parse_size(ServeRequest *request, const char *text)
{
    ServeSize *size = &request->size;
    char numbers[32];
    const char *rest = text;
    *size = (ServeSize){.kind = SERVE_SIZE_MAX};
    if (*rest == '^') {
        size->may_enlarge = 1;
        rest++;
    }
    if (strcmp(rest, "max") == 0)
        return 0;
    if (strncmp(rest, "pct:", 4) == 0) {
        size->kind = SERVE_SIZE_PERCENT;
        return parse_decimal(rest + 4, &size->percent) ? 0 : refuse_size(request, text);
    }
    int within = *rest == '!';
    rest += within;
    if (strlen(rest) >= sizeof numbers)
        return refuse_size(request, text);
    strcpy(numbers, rest);
    char *height = url_cut(numbers, ',');
    if (!height || (!*numbers && !*height) || (*numbers && !url_integer(numbers, &size->width)) ||
        (*height && !url_integer(height, &size->height)) || (within && (!*numbers || !*height)))
        return refuse_size(request, text);
    if ((*numbers && size->width == 0) || (*height && size->height == 0))
        return serve_refuse(request, 400, "size `%s`: a picture of 0 pixels", text);
    size->kind = within      ? SERVE_SIZE_WITHIN
                 : !*height  ? SERVE_SIZE_WIDTH
                 : !*numbers ? SERVE_SIZE_HEIGHT
                             : SERVE_SIZE_EXACT;
    return 0;
}

static int parse_rotation(ServeRequest *request, const char *text)
{
    double degrees;
    request->mirror = *text == '!';
    if (!parse_decimal(text + request->mirror, &degrees) || degrees > 360 || fmod(degrees, 90) != 0)
        return serve_refuse(request, 400, "rotation `%s`: expected 0, 90, 180 or 270, or !0 and so on", text);
    request->quarter_turns = (int)(degrees / 90) % 4;
    return 0;
}

int iiif_parse(ServeRequest *request, const char *region, const char *size, const char *rotation, char *quality,
               unsigned formats)
{
    char *format = url_cut(quality, '.');
    if (parse_region(request, region) || parse_size(request, size) || parse_rotation(request, rotation))
        return request->status;
    request->gray = strcmp(quality, "gray") == 0;
    if (!request->gray && strcmp(quality, "default") != 0 && strcmp(quality, "color") != 0)
        return serve_refuse(request, 400, "quality `%s`: expected default, color or gray", quality);
    return format ? serve_format_set(request, format, formats)
                  : serve_refuse(request, 400, "expected a format, as in default.jpg");
}

/* ---- place ---- */

/* a * b / c, rounded to the nearest, of numbers below 2^31. */
static int scaled(int a, int b, int c)
{
    int64_t value = (2 * (int64_t)a * b + c) / (2 * (int64_t)c);
    return value > INT32_MAX ? INT32_MAX : (int)value;
}

static int place_region(ServeRequest *request, int room_width, int room_height, RetexCut *place)
{
    const ServeRegion *region = &request->region;
    double x = region->x, y = region->y, width = region->width, height = region->height;
    int side = room_width < room_height ? room_width : room_height;
    switch (region->kind) {
    case SERVE_REGION_FULL:
        *place = (RetexCut){0, 0, room_width, room_height, 0, 0};
        return 0;
    case SERVE_REGION_SQUARE:
        *place = (RetexCut){(room_width - side) / 2, (room_height - side) / 2, side, side, 0, 0};
        return 0;
    case SERVE_REGION_PERCENT:
        x = round(x * room_width / 100);
        y = round(y * room_height / 100);
        width = round(width * room_width / 100);
        height = round(height * room_height / 100);
        break;
    case SERVE_REGION_PIXELS:
        break;
    }
    if (x >= room_width || y >= room_height || width < 1 || height < 1)
        return serve_refuse(request, 400, "the region has no pixels of the picture, which is %dx%d", room_width,
                            room_height);
    place->x = (int)x;
    place->y = (int)y;
    place->width = (int)fmin(width, room_width - x);
    place->height = (int)fmin(height, room_height - y);
    return 0;
}

static int fill_size(ServeRequest *request, RetexCut *place)
{
    const int region[4] = {place->x, place->y, place->width, place->height};
    RetexError err = {0};
    return retex_cut_fit(place, place->x + place->width, place->y + place->height, region, request->size.width,
                         request->size.height, &err)
               ? serve_refuse(request, 400, "%s", err.message)
               : 0;
}

static int place_size(ServeRequest *request, RetexCut *place)
{
    const ServeSize *size = &request->size;
    int region_width = place->width, region_height = place->height, width = size->width, height = size->height;
    switch (size->kind) {
    case SERVE_SIZE_MAX:
        width = region_width;
        height = region_height;
        break;
    case SERVE_SIZE_WIDTH:
        height = scaled(region_height, width, region_width);
        break;
    case SERVE_SIZE_HEIGHT:
        width = scaled(region_width, height, region_height);
        break;
    case SERVE_SIZE_PERCENT:
        width = (int)fmin(round(region_width * size->percent / 100), INT32_MAX);
        height = (int)fmin(round(region_height * size->percent / 100), INT32_MAX);
        break;
    case SERVE_SIZE_WITHIN:
        if (!size->may_enlarge && width >= region_width && height >= region_height) {
            width = region_width;
            height = region_height;
        } else if ((int64_t)width * region_height <= (int64_t)height * region_width) {
            height = scaled(region_height, width, region_width);
        } else {
            width = scaled(region_width, height, region_height);
        }
        width = width ? width : 1; /* of what is far longer than wide */
        height = height ? height : 1;
        break;
    case SERVE_SIZE_FILL:
        return fill_size(request, place);
    case SERVE_SIZE_EXACT:
        break;
    }
    if (width > region_width || height > region_height || size->percent > 100)
        return serve_refuse(request, size->may_enlarge ? 501 : 400,
                            "the picture, or this part of it, has %dx%d pixels; it is not enlarged", region_width,
                            region_height);
    if (width < 1 || height < 1)
        return serve_refuse(request, 400, "a picture of 0 pixels");
    place->scaled_width = width;
    place->scaled_height = height;
    return 0;
}

int iiif_place(ServeRequest *request, int room_width, int room_height, RetexCut *place)
{
    *place = (RetexCut){0};
    return place_region(request, room_width, room_height, place) || place_size(request, place) ? request->status : 0;
}

/* ---- links ---- */

const char *iiif_id(char text[IIIF_URL_MAX], const ServeRequest *request, const char *base)
{
    snprintf(text, IIIF_URL_MAX, "%s/iiif/3/", base);
    url_encode(text, IIIF_URL_MAX, request->room);
    if (request->edits[0]) {
        url_encode(text, IIIF_URL_MAX, ";");
        url_encode(text, IIIF_URL_MAX, request->edits);
    }
    return text;
}

const char *iiif_canonical(char text[IIIF_URL_MAX], const ServeRequest *request, const RetexCut *place,
                           const char *base, int room_width, int room_height)
{
    char region[64] = "full", size[32] = "max";
    if (place->width < room_width || place->height < room_height)
        snprintf(region, sizeof region, "%d,%d,%d,%d", place->x, place->y, place->width, place->height);
    if (place->scaled_width < place->width || place->scaled_height < place->height)
        snprintf(size, sizeof size, "%d,%d", place->scaled_width, place->scaled_height);
    size_t used = strlen(iiif_id(text, request, base));
    snprintf(text + used, IIIF_URL_MAX - used, "/%s/%s/%s%d/%s.%s", region, size, request->mirror ? "!" : "",
             90 * request->quarter_turns, request->gray ? "gray" : "default", serve_format_extension(request->format));
    return text;
}

/* ---- info.json ---- */

const char *iiif_info_type(const char *accept)
{
    int named;
    double linked = url_accepts(accept, "application/ld+json", &named);
    if (linked > 0 && linked >= url_accepts(accept, "application/json", &named))
        return "application/ld+json;profile=\"" CONTEXT "\"";
    return "application/json";
}

json_t *iiif_info(const ServeRequest *request, const char *base, int room_width, int room_height, unsigned formats)
{
    char id[IIIF_URL_MAX];
    int larger = room_width > room_height ? room_width : room_height, halvings = 0;
    json_t *sizes = json_array(), *factors = json_array(), *extra = json_array();
    while (larger >> halvings > IIIF_TILE_SIDE)
        halvings++;
    for (int h = halvings; h >= 0; h--) /* as viewers compute them from scale factors: rounded up */
        json_add(&sizes, json_pack("{s:i, s:i}", "width", (room_width + (1 << h) - 1) >> h, "height",
                                   (room_height + (1 << h) - 1) >> h));
    for (int h = 0; h <= halvings; h++)
        json_add(&factors, json_integer(1 << h));
    for (int f = SERVE_WEBP; f < SERVE_FORMATS; f++)
        if (formats & 1u << f)
            json_add(&extra, json_string(serve_format_extension((ServeFormat)f)));
    return json_pack("{s:s, s:o, s:s, s:s, s:s, s:i, s:i, s:o, s:[{s:i, s:o}], s:[s, s], s:o, s:[s, s, s]}", "@context",
                     CONTEXT, "id", json_of_text(iiif_id(id, request, base)), "type", "ImageService3", "protocol",
                     "http://iiif.io/api/image", "profile", "level2", "width", room_width, "height", room_height,
                     "sizes", sizes, "tiles", "width", IIIF_TILE_SIDE, "scaleFactors", factors, "extraQualities",
                     "color", "gray", "extraFormats", extra, "extraFeatures", "mirroring", "canonicalLinkHeader",
                     "profileLinkHeader");
}
