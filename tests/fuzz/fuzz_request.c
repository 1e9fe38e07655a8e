/* URLs of retex-serve, and the header Accept behind the first line end of the input. What is accepted must be safe to
 * use: names without folders, regions within the room, nothing enlarged; and its links must mean the same. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "common/json_text.h"
#include "lib_fuzz.h"
#include "serve/request/iiif.h"
#include "serve/request/parse.h"

#define ALL ((1u << SERVE_FORMATS) - 1)

static void begin(void)
{
    static const char *const seeds[] = {
        "/v1/room/Floor=oak;Wall=rgb(.2,.3,.4)/800x600.jpg?Floor.scale=2,1&Floor.rotate=30&crop=1,2,30,40&quality=90\n",
        "/v1/room/Floor=a%20b.png;Floor.wrap=mirror,clamp;Floor.flip=uv/x600\nimage/avif,image/webp;q=0.8,*/*;q=0.1",
        "/v1/textures/a%20b.png/thumbnail?quality=80\nimage/webp",
        "/v1/room/full.png?Floor.colorspace=Linear%20Rec.709\nimage/*",
        "/v1/room/Floor=a;Floor.width=60cm;Floor.grout=4mm;Floor.tiles=b,c;Floor.vary=turn,3/x90.jpg?Floor.hue=30\n",
        "/v1/room/over:Floor=logo;over:Floor.at=1,2;over:Floor.width=.5;finish:Wall=satin/full.jpg\n",
        "/v1/room/thumbnail.webp\n",
        "/v1/room/light:Lamp=1.5*3000K;Floor=oak/640x.jpg?light:Sun=0\n",
        "/v1/r%C3%A4ume,+(2)\n",
        "/iiif/3/room;Floor%3Doak;Floor.width=1.2,2;Floor.repeat=brick/info.json\napplication/ld+json;profile=\"x\"",
        "/iiif/3/room/full/max/0/default.jpg\n",
        "/iiif/3/room/square/150,/!90/gray.png\n",
        "/iiif/3/room/125,15,120,140/!225,100/270/color.webp\n",
        "/iiif/3/room/pct:41.6,7.5,66.6,100/^pct:33.3/360/default.avif\n",
        "/iiif/3/room;A=rgb(1,0,2)/0,0,999999999,5/,37/180.0/default.jpg\n",
        "/iiif/3/room\n",
        "/%2e%2e/%2F/%00/%C0%AF/..//health\n",
        "/metrics?\n",
    };
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++) {
        fuzz_seed(seeds[i], strlen(seeds[i]));
        fuzz_words(seeds[i], strlen(seeds[i]));
    }
}

static void check_plain(const char *text)
{
    for (int bytes; *text; text += bytes) {
        bytes = utf8_length(text);
        fuzz_must(bytes > 0 && (unsigned char)*text >= 32 && *text != 127, "text is UTF-8 without control characters");
    }
}

static void check_name(const char *name)
{
    check_plain(name);
    fuzz_must(serve_name_is_valid(name) && !strpbrk(name, "/\\?*:") && name[0] != '.', "a name is a file's own");
}

static int same_place(const RetexCut *a, const RetexCut *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* The canonical URL asks for the same, and is its own canonical URL. */
static void check_canonical(const ServeRequest *request, const RetexCut *place, int width, int height)
{
    static ServeRequest again;
    RetexCut same;
    char url[IIIF_URL_MAX], canonical[IIIF_URL_MAX];
    iiif_canonical(url, request, place, "", width, height);
    if (strlen(url) > SERVE_URL_MAX)
        return;
    fuzz_must(!serve_request_parse(&again, url, NULL, ALL) && !iiif_place(&again, width, height, &same),
              "the canonical URL is accepted");
    fuzz_must(same_place(place, &same) && strcmp(request->edits, again.edits) == 0 &&
                  strcmp(request->room, again.room) == 0 && request->mirror == again.mirror &&
                  request->quarter_turns == again.quarter_turns && request->gray == again.gray,
              "the canonical URL means the same");
    fuzz_must(strcmp(url, iiif_canonical(canonical, &again, &same, "", width, height)) == 0, "it is canonical itself");
}

static void check_place(ServeRequest *request)
{
    static const int sizes[][2] = {{300, 200}, {1, 1}, {1999, 1001}, {3, 2000}, {1 << 29, 1 << 29}, {16384, 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        int width = sizes[i][0], height = sizes[i][1];
        RetexCut place;
        int status = iiif_place(request, width, height, &place);
        fuzz_must(status == request->status && (!status || status == 400 || status == 501), "a status of its own");
        request->status = 0;
        if (status)
            continue;
        fuzz_must(place.x >= 0 && place.y >= 0 && place.width >= 1 && place.height >= 1 &&
                      place.x <= width - place.width && place.y <= height - place.height,
                  "the region is within the room");
        fuzz_must(place.scaled_width >= 1 && place.scaled_height >= 1 && place.scaled_width <= place.width &&
                      place.scaled_height <= place.height,
                  "nothing is enlarged");
        if (request->route == SERVE_IIIF_IMAGE)
            check_canonical(request, &place, width, height);
    }
}

static void check_info(const ServeRequest *request)
{
    json_t *info = iiif_info(request, "http://a.b", 1999, 1001, ALL);
    fuzz_must(info != NULL, "info.json is JSON");
    json_decref(info);
}

static int run(const unsigned char *bytes, size_t size)
{
    static ServeRequest request;
    char *url = strdup((const char *)bytes), *accept = url ? strchr(url, '\n') : NULL;
    (void)size;
    if (!url)
        return 0;
    if (accept)
        *accept++ = '\0';
    int status = serve_request_parse(&request, url, accept, ALL);
    check_plain(request.reason);
    fuzz_must(status == request.status &&
                  (status == 0 || status == 400 || status == 404 || status == 406 || status == 414),
              "a status of its own");
    fuzz_must((status == 0) == (request.reason[0] == '\0'), "an error has a reason");
    free(url);
    if (status)
        return 0;
    if (request.route >= SERVE_ROOM && request.route != SERVE_TEXTURE)
        check_name(request.room);
    check_plain(request.edits);
    for (int i = 0; i < request.nspecs; i++) {
        fuzz_must(i == 0 || strcmp(request.specs[i - 1].target, request.specs[i].target) < 0, "targets are sorted");
        check_plain(request.specs[i].target);
        const RetexTextureSpec *spec = &request.specs[i];
        if (!spec->constant && (spec->image[0] || !spec->nlayers))
            check_name(spec->image);
        for (int k = 0; k < spec->nlayers; k++)
            check_name(spec->layers[k].image);
        for (int k = 0; k < RETEX_TILES_MAX && spec->tiles[k][0]; k++)
            check_name(spec->tiles[k]);
        if (spec->finish[0])
            check_name(spec->finish);
    }
    if (request.route == SERVE_PICTURE || request.route == SERVE_THUMBNAIL || request.route == SERVE_TEXTURE ||
        request.route == SERVE_IIIF_IMAGE)
        check_place(&request);
    if (request.route == SERVE_IIIF_INFO)
        check_info(&request);
    return 1;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"request", 1, begin, run};
    return fuzz_main(&driver, argc, argv);
}
