/* What URLs ask retex-serve for: routes, textures, sizes, formats; and what is refused. */
#include "lib_test.h"
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/json_text.h"
#include "serve/request/hints.h"
#include "serve/request/parse.h"

#define ALL ((1u << SERVE_FORMATS) - 1)

static ServeRequest request;

static void accept_url(const char *url)
{
    if (serve_request_parse(&request, url, NULL, ALL))
        fail_msg("%s: %d, %s", url, request.status, request.reason);
    assert_string_equal(request.reason, "");
}

static void refuse_url(int status, const char *url)
{
    if (serve_request_parse(&request, url, NULL, ALL) != status)
        fail_msg("%s: %d, %s", url, request.status, request.reason);
    assert_int_equal(request.status, status);
    assert_true(request.reason[0] != '\0');
    for (const char *c = request.reason; *c; c += utf8_length(c))
        assert_true(utf8_length(c) > 0 && (unsigned char)*c >= 32 && *c != 127);
}

static void test_routes(void **state)
{
    static const struct {
        const char *url;
        ServeRoute route;
        const char *room;
    } routes[] = {
        {"/health", SERVE_HEALTH, ""},
        {"/metrics", SERVE_METRICS, ""},
        {"/metrics?", SERVE_METRICS, ""},
        {"/v1", SERVE_ROOMS, ""},
        {"/v1/room", SERVE_ROOM, "room"},
        {"/v1/my%20r%c3%b6om,+(2)_-.", SERVE_ROOM, "my r\xc3\xb6om,+(2)_-."},
        {"/v1/room/full.jpg", SERVE_PICTURE, "room"},
        {"/v1/full.jpg/full.jpg", SERVE_PICTURE, "full.jpg"},
        {"/v1/room/Floor=oak/thumbnail.jpg", SERVE_THUMBNAIL, "room"},
        {"/v1/textures/oak/thumbnail.jpg?quality=80", SERVE_TEXTURE, ""},
        {"/v1/textures/thumbnail.jpg", SERVE_THUMBNAIL, "textures"},
        {"/v1/textures/Floor=oak/thumbnail.jpg", SERVE_THUMBNAIL, "textures"},
        {"/iiif/3/room", SERVE_IIIF_BASE, "room"},
        {"/iiif/3/room;Floor=oak/info.json", SERVE_IIIF_INFO, "room"},
        {"/iiif/3/room%3bFloor%3Doak/full/max/0/default.jpg", SERVE_IIIF_IMAGE, "room"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof routes / sizeof *routes; i++) {
        accept_url(routes[i].url);
        assert_int_equal(request.route, routes[i].route);
        assert_string_equal(request.room, routes[i].room);
    }
    refuse_url(400, "");
    refuse_url(400, "*");
    refuse_url(400, "http://host/v1");
    const char *const unknown[] = {"/",
                                   "//",
                                   "/v1/",
                                   "/v1//full.jpg",
                                   "/v2",
                                   "/v1/room/",
                                   "/v1/room/Floor=oak/",
                                   "/v1/room/a=b/full.jpg/",
                                   "/v1/room/a=b/c=d/full.jpg",
                                   "/V1/room",
                                   "/health/",
                                   "/metrics/room",
                                   "/iiif",
                                   "/iiif/3",
                                   "/iiif/2/room",
                                   "/iiif/3/room/full",
                                   "/iiif/3/room/a/b/c/d/e",
                                   "/iiif/3/room/a/b/c/d/e/f/g/h/i",
                                   "/favicon.ico",
                                   "/v1/room/oak.jpg",
                                   "/v1/room/800.jpg",
                                   "/v1/room/x.jpg",
                                   "/v1/room/8x6x4.jpg",
                                   "/v1/room/-8x6.jpg",
                                   "/v1/room/1e3x.jpg",
                                   "/v1/room/9999999999x.jpg"};
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
        refuse_url(404, unknown[i]);
}

static void test_textures(void **state)
{
    (void)state;
    accept_url("/v1/room/Wall=rgb(.2,.3,.4);Floor=oak%20old.jpg;Floor.scale=2,1/800x600.jpg"
               "?Floor.rotate=30&Floor.offset=0,.5&Floor.wrap=mirror&Floor.flip=u&Floor.colorspace=Linear%20Rec.709"
               "&Floor.width=1.5,2&Floor.repeat=straight&quality=90");
    assert_int_equal(request.nspecs, 2);
    const RetexTextureSpec *floor = &request.specs[0], *wall = &request.specs[1];
    assert_string_equal(floor->target, "Floor");
    assert_string_equal(floor->image, "oak old.jpg");
    assert_true(floor->scale[0] == 2 && floor->scale[1] == 1 && floor->rotate == 30);
    assert_true(floor->offset[0] == 0 && floor->offset[1] == 0.5);
    assert_true(floor->width[0] == 1.5 && floor->width[1] == 2);
    assert_true(floor->wrap[0] == RETEX_WRAP_MIRROR && floor->flip[0] == 1 && floor->flip[1] == 0);
    assert_int_equal(floor->repeat, RETEX_REPEAT_STRAIGHT);
    assert_string_equal(floor->colorspace, "Linear Rec.709");
    assert_string_equal(wall->target, "Wall");
    assert_true(wall->constant && wall->color[0] == 0.2f && wall->color[1] == 0.3f && wall->color[2] == 0.4f);
    assert_int_equal(request.size.width, 800);
    assert_int_equal(request.size.height, 600);
    assert_int_equal(request.quality, 90);
    assert_string_equal(request.edits, "Floor=oak old.jpg;Floor.scale=2,1;Floor.rotate=30;Floor.offset=0,0.5;"
                                       "Floor.flip=u;Floor.wrap=mirror;Floor.width=1.5,2;"
                                       "Floor.colorspace=Linear Rec.709;Wall=rgb(0.2,0.3,0.4)");
    /* without textures; dots in a target's name */
    accept_url("/v1/room/x600.png");
    assert_int_equal(request.nspecs, 0);
    assert_string_equal(request.edits, "");
    assert_int_equal(request.quality, 0);
    accept_url("/v1/room/Wall.001=oak;Wall.001.scale=2/x600.png");
    assert_string_equal(request.specs[0].target, "Wall.001");
    assert_true(request.specs[0].scale[0] == 2);
    const char *const wrong[] = {
        "/v1/room/Floor/full.jpg",
        "/v1/room/Floor=/full.jpg",
        "/v1/room/=oak/full.jpg",
        "/v1/room/;/full.jpg",
        "/v1/room/Floor=oak;/full.jpg",
        "/v1/room/Floor=oak;Floor=oak/full.jpg",
        "/v1/room/Floor=oak;Floor.scale=1;Floor.scale=1/full.jpg",
        "/v1/room/Floor.scale=2/full.jpg",
        "/v1/room/Floor=oak/full.jpg?Wall.scale=2",
        "/v1/room/Floor=oak/full.jpg?Floor.scal=2",
        "/v1/room/Floor=oak/full.jpg?Wall=oak",
        "/v1/room/Floor=oak/full.jpg?Floor.colorspace=a;Floor.flip=u",
        "/v1/room/Floor=oak/full.jpg?Floor.colorspace=a%3BFloor.flip=u",
        "/v1/room/Floor=oak;Floor.scale=0/full.jpg",
        "/v1/room/Floor=oak;Floor.scale=2:rotate=3/full.jpg",
        "/v1/room/Floor=oak;Floor.rotate=inf/full.jpg",
        "/v1/room/Floor=oak;.scale=2/full.jpg",
        "/v1/room/Floor=rgb(1,2)/full.jpg",
        "/v1/room/Floor=rgb(1,2,3).jpg/full.jpg",
        "/v1/room/Floor=rgb(-1,2,3)/full.jpg",
        "/v1/room/Floor=oak%3Fa/full.jpg",
        "/v1/room/Floor=.oak/full.jpg",
        "/v1/room/Floor=oak*/full.jpg",
        "/v1/room/Floor=c:oak/full.jpg",
        "/v1/room/Floor=~oak/full.jpg",
        "/v1/room/Floor=oak%23/full.jpg",
        "/v1/room/a=x;b=x;c=x;d=x;e=x;f=x;g=x;h=x;i=x/full.jpg",
        "/iiif/3/room;",
        "/iiif/3/room;Floor",
        "/iiif/3/;Floor=oak",
        "/v1/room;Floor=oak/full.jpg",
        "/v1/.room",
        "/v1/ro%3Aom",
        "/v1/ro%22om",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        refuse_url(400, wrong[i]);
}

/* Whatever an edit names is a file that is served, and no other one. */
static void test_names(void **state)
{
    (void)state;
    static const char *const places[] = {
        "/v1/room/Floor=%s/full.jpg",
        "/v1/room/Floor=oak;Wall=%s/full.jpg",
        "/v1/room/Floor=oak;Floor.finish=%s/full.jpg",
        "/v1/room/over:Floor=%s/full.jpg",
        "/v1/room/Floor=oak;over:Floor=ash;over2:Floor=%s/full.jpg",
        "/v1/room/Floor=oak;Floor.width=1;Floor.tiles=%s/full.jpg",
        "/v1/room/Floor=oak;Floor.width=1;Floor.tiles=ash,%s/full.jpg",
    };
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        char url[256];
        snprintf(url, sizeof url, places[i], "elm");
        accept_url(url);
        snprintf(url, sizeof url, places[i], "..elm");
        refuse_url(400, url);
        assert_non_null(strstr(request.reason, "`..elm` cannot be the name of a texture"));
    }
}

/* Bytes that no file's name may get to see, in every place where a name can stand. */
static void test_encodings(void **state)
{
    static const char *const bad[] = {
        "%2e%2e",       ".%2E",      "..",           "%2e",          "a%2Fb",
        "a%2fb",        "%2F",       "a%5Cb",        "a\\b",         "a%00b",
        "%00",          "a%0ab",     "a%7Fb",        "a%0D%0ab",     "%",
        "%4",           "a%",        "%4g",          "%g4",          "% 4",
        "a b",          "a\tb",      "a\xc3\xa4",    "%C3",          "%C3%28",
        "%A4",          "%FF",       "%C0%AF",       "%C0%AE%C0%AE", "%E0%80%AF",
        "%F0%80%80%AF", "%ED%A0%80", "%F4%90%80%80", "%C2%85",       "%F8%88%80%80%80", "%g0%9F%98%80",
    };
    static const char *const places[] = {"/v1/%s",
                                         "/v1/%s/full.jpg",
                                         "/v1/room/Floor=oak/%s",
                                         "/%s",
                                         "/iiif/3/%s",
                                         "/v1/room/full.jpg?Floor.colorspace=%s",
                                         "/iiif/3/%s/full/max/0/default.jpg",
                                         "/iiif/3/room/full/max/%s/default.jpg",
                                         "/v1/room/full.jpg?%s=2"};
    char url[200];
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
            snprintf(url, sizeof url, places[p], bad[i]);
            refuse_url(400, url);
        }
        /* behind other text; `=..` is refused as the name of a texture */
        snprintf(url, sizeof url, "/v1/room/Floor=%s/full.jpg", bad[i]);
        refuse_url(400, url);
        snprintf(url, sizeof url, "/iiif/3/room;Floor=%s", bad[i]);
        refuse_url(400, url);
    }
    accept_url("/v1/%e2%82%ac%F0%9F%98%80%C3%A4"); /* of 3, 4 and 2 bytes */
    refuse_url(400, "/v1/a%252Fb");                /* decoded once: a percent sign is in no name */
    refuse_url(400, "/v1/%252e%252e");
    refuse_url(400, "/v1?a=1");
    refuse_url(400, "/health?a");
}

static void test_sizes_are_bounded(void **state)
{
    char url[SERVE_URL_MAX + 100];
    (void)state;
    memset(url, 'a', sizeof url);
    memcpy(url, "/v1/", 4);
    url[4 + SERVE_NAME_MAX] = '\0';
    accept_url(url);
    url[4 + SERVE_NAME_MAX] = 'a';
    url[4 + SERVE_NAME_MAX + 1] = '\0';
    refuse_url(400, url);
    /* the reason is cut between two characters */
    memset(url, 'a', sizeof url);
    memcpy(url, "/v1/", 4);
    for (size_t i = 0; i < 300; i++)
        memcpy(url + 4 + 6 * i + i % 2, "%C3%A4", 6);
    url[4 + 6 * 300] = '\0';
    refuse_url(400, url);
    memset(url, 'a', sizeof url);
    memcpy(url, "/v1/", 4);
    url[SERVE_URL_MAX] = '\0';
    refuse_url(400, url);
    url[SERVE_URL_MAX] = 'a';
    url[SERVE_URL_MAX + 1] = '\0';
    refuse_url(414, url);
    /* the longest lists of edits and their options */
    snprintf(url, sizeof url, "/v1/room/F=rgb(0.%0*d,0,0)/full.jpg?F.rotate=0.%0*d", 1900, 1, 1900, 1);
    accept_url(url);
    assert_true(request.specs[0].constant);
    snprintf(url, sizeof url, "/v1/room/%0*d=o/full.jpg", SERVE_NAME_MAX, 1);
    accept_url(url);
    snprintf(url, sizeof url, "/v1/room/%0*d=o/full.jpg", SERVE_NAME_MAX + 1, 1);
    refuse_url(400, url);
}

static void test_pictures(void **state)
{
    (void)state;
    accept_url("/v1/room/800x.jpg?crop=1,2,30,40");
    assert_int_equal(request.region.kind, SERVE_REGION_PIXELS);
    assert_true(request.region.x == 1 && request.region.y == 2 && request.region.width == 30 &&
                request.region.height == 40);
    assert_int_equal(request.size.kind, SERVE_SIZE_WIDTH);
    assert_int_equal(request.size.width, 800);
    accept_url("/v1/room/x600.avif");
    assert_int_equal(request.size.kind, SERVE_SIZE_HEIGHT);
    assert_int_equal(request.region.kind, SERVE_REGION_FULL);
    assert_int_equal(request.format, SERVE_AVIF);
    accept_url("/v1/room/8x6.jpeg");
    assert_int_equal(request.size.kind, SERVE_SIZE_FILL);
    assert_int_equal(request.format, SERVE_JPEG);
    assert_int_equal(request.format_by_accept, 0);
    const char *const wrong[] = {"/v1/room/0x6.jpg",
                                 "/v1/room/x0.jpg",
                                 "/v1/room/8x.gif",
                                 "/v1/room/8x.",
                                 "/v1/room/8x.PNG",
                                 "/v1/room/8x.jpg?quality=0",
                                 "/v1/room/8x.jpg?quality=101",
                                 "/v1/room/8x.jpg?quality=",
                                 "/v1/room/8x.jpg?quality=9&quality=9",
                                 "/v1/room/8x.jpg?crop=1,2,3",
                                 "/v1/room/8x.jpg?crop=1,2,3,4,5",
                                 "/v1/room/8x.jpg?crop=-1,2,3,4",
                                 "/v1/room/8x.jpg?crop=",
                                 "/v1/room/8x.jpg?crop=1,2,3,4&crop=1,2,3,4",
                                 "/v1/room/8x.jpg?size=1",
                                 "/v1/room/8x.jpg?&",
                                 "/v1/room/8x.jpg?crop",
                                 "/v1/room/8x.jpg?quality=9;crop=1,2,3,4",
                                 "/v1/room/8x.jpg??quality=9"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        refuse_url(400, wrong[i]);
}

static void test_accept(void **state)
{
    static const struct {
        const char *accept;
        unsigned formats;
        int format; /* -1: none */
    } cases[] = {
        {NULL, ALL, SERVE_JPEG},
        {"", ALL, -1},
        {"*/*", ALL, SERVE_JPEG},
        {"image/*", ALL, SERVE_JPEG},
        {"IMAGE/*;q=0.1", ALL, SERVE_JPEG},
        {"image/avif,image/webp,image/apng,image/svg+xml,image/*,*/*;q=0.8", ALL, SERVE_AVIF}, /* Chromium */
        {"image/avif,image/webp,*/*", ALL & ~(1u << SERVE_AVIF), SERVE_WEBP},
        {"image/jxl,image/webp,image/*", ALL, SERVE_JXL},
        {"image/jxl,image/webp,image/*", ALL & ~(1u << SERVE_JXL), SERVE_WEBP},
        {"image/avif;q=0.8,image/jxl;q=0.9", ALL, SERVE_JXL},
        {"image/avif,image/webp,*/*", 1u << SERVE_JPEG, SERVE_JPEG},
        {"image/png", ALL, SERVE_PNG},
        {"image/png, */*;q=0.5", ALL, SERVE_PNG},
        {"image/png;q=0.5, */*;q=0.7", ALL, SERVE_JPEG},
        {"image/webp;q=0.5,image/jpeg;q=0.501", ALL, SERVE_JPEG},
        {"image/webp ; q=0.9 , image/jpeg;q=0.8", ALL, SERVE_WEBP},
        {"image/avif;q=0,image/*", ALL, SERVE_JPEG},
        {"image/jpeg;q=0,*/*", ALL, SERVE_PNG},
        {"image/jpeg;q=0,*/*;q=0,image/png;q=0.0", ALL, -1},
        {"text/html", ALL, -1},
        {"image/avif", 1u << SERVE_JPEG, -1},
        {"image/*;q=0,*/*", ALL, -1},
        {"text/html;level=1;q=0.2;image/png", ALL, -1},
        {",,, ;q=1,,image/jpeg", ALL, SERVE_JPEG},
        {"image/jpegs,image/jpe", ALL, -1},
        {"image/jpeg;q", ALL, SERVE_JPEG},
        {"image/jpeg;q=", ALL, -1},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int status = serve_request_parse(&request, "/v1/room/8x", cases[i].accept, cases[i].formats);
        int format = status ? -1 : (int)request.format;
        if (format != cases[i].format || (status && status != 406))
            fail_msg("%s: %d, format %d", cases[i].accept, status, format);
        assert_true(status || request.format_by_accept);
    }
    /* the extension counts more */
    assert_int_equal(serve_request_parse(&request, "/v1/room/8x.png", "image/avif", ALL), 0);
    assert_int_equal(request.format, SERVE_PNG);
    assert_int_equal(serve_request_parse(&request, "/v1/room/8x.avif", NULL, 1u << SERVE_JPEG), 400);
}

static void test_hints(void **state)
{
    static const struct {
        const char *width, *viewport_width, *dpr;
        int wanted;
    } cases[] = {
        {NULL, NULL, NULL, 0}, {"1", NULL, NULL, 320}, {"320", NULL, NULL, 320}, {"321", NULL, NULL, 480},
        {"640", "9", "3", 640}, {"99999", NULL, NULL, 3840}, {NULL, "390", "3", 1280}, {NULL, "390", NULL, 480},
        {NULL, "390", "2.5", 1280}, {NULL, "400", "0.5", 320}, {NULL, NULL, "3", 0}, {"0", "390", "1", 480},
        {"-5", NULL, NULL, 0}, {"640px", NULL, NULL, 0}, {" 640 ", NULL, NULL, 640}, {"", "", "", 0},
        {"1e3", NULL, NULL, 0}, {".5", NULL, NULL, 0}, {"639.5", NULL, NULL, 640}, {"640.5", NULL, NULL, 960},
        {"nan", "inf", "1", 0}, {NULL, "390", "x", 480}, {"1,2", NULL, NULL, 0}, {"9999999999999", NULL, NULL, 0},
        {"99999999999", NULL, NULL, 3840}, {NULL, "999999999999", "999999999999", 3840},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const Hints hints = {cases[i].width, cases[i].viewport_width, cases[i].dpr};
        if (hints_width(&hints) != cases[i].wanted)
            fail_msg("%s, %s, %s: %d, not %d", hints.width, hints.viewport_width, hints.dpr, hints_width(&hints),
                     cases[i].wanted);
    }
    const Hints phone = {NULL, "390", "3"};
    accept_url("/v1/room/auto.jpg?quality=80");
    assert_int_equal(request.size.kind, SERVE_SIZE_MAX);
    hints_apply(&request, &phone);
    assert_int_equal(request.size.kind, SERVE_SIZE_WITHIN);
    assert_int_equal(request.size.width, 1280);
    accept_url("/v1/room/full.jpg");
    hints_apply(&request, &phone);
    assert_int_equal(request.size.kind, SERVE_SIZE_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_routes), cmocka_unit_test(test_names), cmocka_unit_test(test_textures),
        cmocka_unit_test(test_encodings), cmocka_unit_test(test_pictures), cmocka_unit_test(test_accept),
        cmocka_unit_test(test_hints), cmocka_unit_test(test_sizes_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
