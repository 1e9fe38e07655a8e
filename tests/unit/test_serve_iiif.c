/* The IIIF Image API 3.0: regions, sizes and rotations, with the pixels that the standard's text says, worked out by
 * hand; links; info.json. The picture of 300x200 and its rows are the standard's own examples. */
#include "lib_test.h"
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "serve/request/iiif.h"
#include "serve/request/parse.h"

#define ALL ((1u << SERVE_FORMATS) - 1)

typedef struct Row {
    int room_width, room_height;
    const char *url; /* after /iiif/3/room/ */
    int status;
    RetexCut place;
} Row;

static const Row rows[] = {
    /* 4.1 Region */
    {300, 200, "full/max/0/default.jpg", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "square/max/0/default.jpg", 0, {50, 0, 200, 200, 200, 200}},
    {200, 301, "square/max/0/default.jpg", 0, {0, 50, 200, 200, 200, 200}},
    {300, 200, "125,15,120,140/max/0/default.jpg", 0, {125, 15, 120, 140, 120, 140}},
    {300, 200, "pct:41.6,7.5,40,70/max/0/default.jpg", 0, {125, 15, 120, 140, 120, 140}},
    {300, 200, "125,15,200,200/max/0/default.jpg", 0, {125, 15, 175, 185, 175, 185}},
    {300, 200, "pct:41.6,7.5,66.6,100/max/0/default.jpg", 0, {125, 15, 175, 185, 175, 185}},
    {300, 200, "0,0,300,200/max/0/default.jpg", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "299,199,1,1/max/0/default.jpg", 0, {299, 199, 1, 1, 1, 1}},
    {300, 200, "299,199,999999999,999999999/max/0/default.jpg", 0, {299, 199, 1, 1, 1, 1}},
    {300, 200, "pct:0,0,100,100/max/0/default.jpg", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "pct:.5,0.5,50,50./max/0/default.jpg", 0, {2, 1, 150, 100, 150, 100}},
    {300, 200, "300,0,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "0,200,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "10,10,0,10/max/0/default.jpg", 400, {0}},
    {300, 200, "10,10,10,0/max/0/default.jpg", 400, {0}},
    {300, 200, "pct:100,0,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "pct:0,0,0.1,10/max/0/default.jpg", 400, {0}},
    {300, 200, "-1,0,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "+1,0,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "1.5,0,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "0,0,10/max/0/default.jpg", 400, {0}},
    {300, 200, "0,0,10,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "0,0,10,9999999999/max/0/default.jpg", 400, {0}},
    {300, 200, "pct:1e1,0,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "pct:.,0,10,10/max/0/default.jpg", 400, {0}},
    {300, 200, "pct:0,0,10,nan/max/0/default.jpg", 400, {0}},
    {300, 200, "Full/max/0/default.jpg", 400, {0}},
    /* 4.2 Size */
    {300, 200, "full/150,/0/default.jpg", 0, {0, 0, 300, 200, 150, 100}},
    {300, 200, "full/,150/0/default.jpg", 0, {0, 0, 300, 200, 225, 150}},
    {300, 200, "full/pct:50/0/default.jpg", 0, {0, 0, 300, 200, 150, 100}},
    {300, 200, "full/225,100/0/default.jpg", 0, {0, 0, 300, 200, 225, 100}},
    {300, 200, "full/!225,100/0/default.jpg", 0, {0, 0, 300, 200, 150, 100}},
    {300, 200, "full/!100,225/0/default.jpg", 0, {0, 0, 300, 200, 100, 67}},
    {300, 200, "full/!360,360/0/default.jpg", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "full/!360,100/0/default.jpg", 0, {0, 0, 300, 200, 150, 100}},
    {300, 200, "125,15,120,140/90,/0/default.jpg", 0, {125, 15, 120, 140, 90, 105}},
    {300, 200, "125,15,200,200/,37/0/default.jpg", 0, {125, 15, 175, 185, 35, 37}},
    {300, 200, "square/pct:12.5/0/default.jpg", 0, {50, 0, 200, 200, 25, 25}},
    {1999, 1001, "full/100,/0/default.jpg", 0, {0, 0, 1999, 1001, 100, 50}},
    {1999, 1001, "full/,100/0/default.jpg", 0, {0, 0, 1999, 1001, 200, 100}},
    {1999, 1001, "full/pct:33.3/0/default.jpg", 0, {0, 0, 1999, 1001, 666, 333}},
    {1999, 1001, "full/!640,640/0/default.jpg", 0, {0, 0, 1999, 1001, 640, 320}},
    {6000, 4000, "full/375,250/0/default.jpg", 0, {0, 0, 6000, 4000, 375, 250}},
    {6000, 4000, "4096,0,1904,2048/476,512/0/default.jpg", 0, {4096, 0, 1904, 2048, 476, 512}},
    {300, 200, "full/301,/0/default.jpg", 400, {0}},
    {300, 200, "full/,201/0/default.jpg", 400, {0}},
    {300, 200, "full/pct:120/0/default.jpg", 400, {0}},
    {300, 200, "full/pct:100.1/0/default.jpg", 400, {0}},
    {300, 200, "full/300,201/0/default.jpg", 400, {0}},
    {300, 200, "125,15,120,140/121,/0/default.jpg", 400, {0}},
    {300, 200, "full/0,/0/default.jpg", 400, {0}},
    {300, 200, "full/,0/0/default.jpg", 400, {0}},
    {300, 200, "full/pct:0/0/default.jpg", 400, {0}},
    {300, 200, "full/pct:0.1/0/default.jpg", 400, {0}},
    {1000, 2, "full/100,/0/default.jpg", 400, {0}}, /* 0.2 pixels high */
    {300, 200, "full/,/0/default.jpg", 400, {0}},
    {300, 200, "full/!100,/0/default.jpg", 400, {0}},
    {300, 200, "full/100/0/default.jpg", 400, {0}},
    {300, 200, "full/full/0/default.jpg", 400, {0}}, /* of version 2 */
    {300, 200, "full/100,100,100/0/default.jpg", 400, {0}},
    {300, 200, "full/1e2,/0/default.jpg", 400, {0}},
    {300, 200, "full/2147483648,/0/default.jpg", 400, {0}},
    /* `^`: 501 where it would enlarge */
    {300, 200, "full/^max/0/default.jpg", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "full/^150,/0/default.jpg", 0, {0, 0, 300, 200, 150, 100}},
    {300, 200, "full/^360,/0/default.jpg", 501, {0}},
    {300, 200, "full/^,240/0/default.jpg", 501, {0}},
    {300, 200, "full/^pct:120/0/default.jpg", 501, {0}},
    {300, 200, "full/^360,360/0/default.jpg", 501, {0}},
    {300, 200, "full/^!360,360/0/default.jpg", 501, {0}},
    {300, 200, "full/^!360,100/0/default.jpg", 0, {0, 0, 300, 200, 150, 100}},
    {300, 200, "full/,^240/0/default.jpg", 400, {0}},
    /* 4.3 to 4.5 */
    {300, 200, "full/max/90/default.jpg", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "full/max/!180/gray.png", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "full/max/360/color.webp", 0, {0, 0, 300, 200, 300, 200}},
    {300, 200, "full/max/22.5/default.png", 400, {0}},
    {300, 200, "full/max/450/default.png", 400, {0}},
    {300, 200, "full/max/-90/default.png", 400, {0}},
    {300, 200, "full/max//default.png", 404, {0}},
    {300, 200, "full/max/!/default.png", 400, {0}},
    {300, 200, "full/max/0/bitonal.jpg", 400, {0}},
    {300, 200, "full/max/0/native.jpg", 400, {0}},
    {300, 200, "full/max/0/default.jp2", 400, {0}},
    {300, 200, "full/max/0/default.jpeg", 400, {0}},
    {300, 200, "full/max/0/default.JPG", 400, {0}},
    {300, 200, "full/max/0/default", 400, {0}},
    {300, 200, "full/max/0/.jpg", 400, {0}},
    {300, 200, "full/max/0", 404, {0}},
    {300, 200, "full/max/0/default.jpg/", 404, {0}},
    {300, 200, "full/max/0/default.jpg?quality=9", 400, {0}},
};

static void test_places(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        ServeRequest request;
        RetexCut place = {0};
        char url[200];
        snprintf(url, sizeof url, "/iiif/3/room/%s", rows[i].url);
        int status = serve_request_parse(&request, url, NULL, ALL);
        if (!status)
            status = iiif_place(&request, rows[i].room_width, rows[i].room_height, &place);
        if (status != rows[i].status || status != request.status)
            fail_msg("%s: status %d (%s)", url, status, request.reason);
        assert_int_equal(status != 0, request.reason[0] != '\0');
        if (!status && memcmp(&place, &rows[i].place, sizeof place) != 0)
            fail_msg("%s: %d,%d,%d,%d to %dx%d", url, place.x, place.y, place.width, place.height, place.scaled_width,
                     place.scaled_height);
    }
}

/* Pictures of /v1: the middle of what was asked for, never distorted and never enlarged. */
static void test_fill(void **state)
{
    static const Row fills[] = {
        {1920, 1080, "1920x1080.jpg", 0, {0, 0, 1920, 1080, 1920, 1080}},
        {1920, 1080, "500x500.jpg", 0, {420, 0, 1080, 1080, 500, 500}},
        {1920, 1080, "300x400.jpg", 0, {555, 0, 810, 1080, 300, 400}},
        {1920, 1080, "1000x100.jpg", 0, {0, 444, 1920, 192, 1000, 100}},
        {1920, 1080, "960x.jpg", 0, {0, 0, 1920, 1080, 960, 540}},
        {1920, 1080, "x108.jpg", 0, {0, 0, 1920, 1080, 192, 108}},
        {1920, 1080, "full.jpg", 0, {0, 0, 1920, 1080, 1920, 1080}},
        {1920, 1080, "thumbnail.jpg", 0, {0, 0, 1920, 1080, 256, 144}},
        {108, 192, "thumbnail.jpg", 0, {0, 0, 108, 192, 108, 192}},
        {1920, 1080, "full.jpg?crop=100,200,300,400", 0, {100, 200, 300, 400, 300, 400}},
        {1920, 1080, "30x20.jpg?crop=100,200,300,400", 0, {100, 300, 300, 200, 30, 20}},
        {1920, 1080, "1921x.jpg", 400, {0}},
        {1920, 1080, "x1081.jpg", 400, {0}},
        {1920, 1080, "301x.jpg?crop=100,200,300,400", 400, {0}},
        {1920, 1080, "full.jpg?crop=1920,0,1,1", 400, {0}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof fills / sizeof *fills; i++) {
        ServeRequest request;
        RetexCut place = {0};
        char url[200];
        snprintf(url, sizeof url, "/v1/room/%s", fills[i].url);
        assert_int_equal(serve_request_parse(&request, url, NULL, ALL), 0);
        int status = iiif_place(&request, fills[i].room_width, fills[i].room_height, &place);
        if (status != fills[i].status || (!status && memcmp(&place, &fills[i].place, sizeof place) != 0))
            fail_msg("%s: status %d, %d,%d,%d,%d to %dx%d", url, status, place.x, place.y, place.width, place.height,
                     place.scaled_width, place.scaled_height);
    }
}

static void test_rotations(void **state)
{
    static const struct {
        const char *text;
        int mirror, quarter_turns;
    } turns[] = {{"0", 0, 0},    {"90", 0, 1}, {"180", 0, 2},  {"270", 0, 3}, {"360", 0, 0},
                 {"90.0", 0, 1}, {"!0", 1, 0}, {"!270", 1, 3}, {"!360", 1, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
        ServeRequest request;
        char url[100];
        snprintf(url, sizeof url, "/iiif/3/room/full/max/%s/gray.png", turns[i].text);
        assert_int_equal(serve_request_parse(&request, url, NULL, ALL), 0);
        assert_int_equal(request.mirror, turns[i].mirror);
        assert_int_equal(request.quarter_turns, turns[i].quarter_turns);
        assert_int_equal(request.gray, 1);
        assert_int_equal(request.format, SERVE_PNG);
    }
}

static void assert_canonical(const char *url, const char *expected)
{
    ServeRequest request;
    RetexCut place;
    char text[IIIF_URL_MAX];
    assert_int_equal(serve_request_parse(&request, url, NULL, ALL), 0);
    assert_int_equal(iiif_place(&request, 300, 200, &place), 0);
    assert_string_equal(iiif_canonical(text, &request, &place, "http://a.b:1", 300, 200), expected);
    /* it is canonical itself */
    assert_int_equal(serve_request_parse(&request, expected + strlen("http://a.b:1"), NULL, ALL), 0);
    assert_int_equal(iiif_place(&request, 300, 200, &place), 0);
    assert_string_equal(iiif_canonical(text, &request, &place, "http://a.b:1", 300, 200), expected);
}

static void test_canonical_links(void **state)
{
    (void)state;
    assert_canonical("/iiif/3/room/pct:0,0,100,100/300,/0/color.jpg",
                     "http://a.b:1/iiif/3/room/full/max/0/default.jpg");
    assert_canonical("/iiif/3/room/125,15,200,200/max/!360/gray.png",
                     "http://a.b:1/iiif/3/room/125,15,175,185/max/!0/gray.png");
    assert_canonical("/iiif/3/room/square/!50,90/270.0/default.webp",
                     "http://a.b:1/iiif/3/room/50,0,200,200/50,50/270/default.webp");
    assert_canonical("/iiif/3/ro%6Fm%3BWall%3Drgb(1%2C.5,0)%3bFloor=my%20oak.jpg;Floor.scale=2/full/max/0/default.jpg",
                     "http://a.b:1/iiif/3/room;Floor=my%20oak.jpg;Floor.scale=2,2;Wall=rgb(1,0.5,0)/full/max/0/"
                     "default.jpg");
}

static void test_info(void **state)
{
    ServeRequest request;
    (void)state;
    assert_int_equal(serve_request_parse(&request, "/iiif/3/r%C3%A4ume;Floor=oak/info.json", NULL, ALL), 0);
    assert_int_equal(request.route, SERVE_IIIF_INFO);
    json_t *info = iiif_info(&request, "https://a.b", 1999, 1001, ALL & ~(1u << SERVE_AVIF)),
           *expected = json_pack(
               "{s:s,s:s,s:s,s:s,s:s,s:i,s:i,s:[{s:i,s:i},{s:i,s:i},{s:i,s:i}],s:[{s:i,s:[i,i,i]}],s:[s,s],s:[s,s],"
               "s:[s,s,s]}",
               "@context", "http://iiif.io/api/image/3/context.json", "id", "https://a.b/iiif/3/r%C3%A4ume;Floor=oak",
               "type", "ImageService3", "protocol", "http://iiif.io/api/image", "profile", "level2", "width", 1999,
               "height", 1001, "sizes", "width", 500, "height", 251, "width", 1000, "height", 501, "width", 1999,
               "height", 1001, "tiles", "width", 512, "scaleFactors", 1, 2, 4, "extraQualities", "color", "gray",
               "extraFormats", "webp", "jxl", "extraFeatures", "mirroring", "canonicalLinkHeader", "profileLinkHeader");
    assert_non_null(info);
    assert_non_null(expected);
    if (!json_equal(info, expected))
        fail_msg("%s", json_dumps(info, 0));
    assert_string_equal(json_object_iter_key(json_object_iter(info)), "@context"); /* the first key, as it should be */
    json_decref(info);
    json_decref(expected);
    assert_int_equal(serve_request_parse(&request, "/iiif/3/room", NULL, ALL), 0);
    assert_int_equal(request.route, SERVE_IIIF_BASE);
}

static void test_info_type(void **state)
{
    const char *linked = "application/ld+json;profile=\"http://iiif.io/api/image/3/context.json\"";
    (void)state;
    assert_string_equal(iiif_info_type(NULL), linked);
    assert_string_equal(iiif_info_type("*/*"), linked);
    assert_string_equal(iiif_info_type("application/ld+json"), linked);
    assert_string_equal(iiif_info_type("application/ld+json;profile=\"x\", application/json;q=0.9"), linked);
    assert_string_equal(iiif_info_type("application/json"), "application/json");
    assert_string_equal(iiif_info_type("application/json, */*;q=0.1"), "application/json");
    assert_string_equal(iiif_info_type("text/html"), "application/json");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places),          cmocka_unit_test(test_fill), cmocka_unit_test(test_rotations),
        cmocka_unit_test(test_canonical_links), cmocka_unit_test(test_info), cmocka_unit_test(test_info_type),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
