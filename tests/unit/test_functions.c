/* Functions of numbers: values of tests/data/functions.txt, which POV-Ray gave (tests/lib/povray_functions.py), and
 * what compiling them must bear. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "base/noise.h"
#include "function/function.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

static char said[65536];

static void collect(void *context, int level, const char *text)
{
    (void)context;
    (void)level;
    const size_t used = strlen(said);
    snprintf(said + used, sizeof said - used, "%s\n", text);
}

static int read_scene(const char *text, long max_steps, RetexError *err)
{
    char path[] = "/tmp/test_functions_XXXXXX";
    SdlOptions options = SDL_OPTIONS_INIT;
    Scene *scene = NULL;
    FILE *file = fdopen(mkstemp(path), "w");
    assert_non_null(file);
    fprintf(file, "#version 3.7; %s sphere{0,1}\n", text);
    fclose(file);
    options.message = collect;
    if (max_steps)
        options.max_steps = max_steps;
    said[0] = 0;
    const int code = sdl_read(&scene, path, &options, &scene_builder, err);
    scene_close(&scene);
    unlink(path);
    return code;
}

/* What the text prints first. */
static double number_of(const char *text)
{
    RetexError err = {0};
    if (read_scene(text, 0, &err))
        fail_msg("%s: column %d: %s", text, err.column, err.message);
    return strtod(said, NULL);
}

static int same(double a, double b)
{
    return (isnan(a) && isnan(b)) || a == b || fabs(a - b) <= 1e-12 * fmax(1, fabs(b));
}

/* ---- POV-Ray's values ---- */

static char line[512];

/* Calls check for all lines that begin with the word; it gets the rest. */
static void each_line(const char *word, void (*check)(char *rest), int least)
{
    FILE *file = fopen("tests/data/functions.txt", "r");
    int count = 0;
    assert_non_null(file);
    while (fgets(line, sizeof line, file))
        if (!strncmp(line, word, strlen(word))) {
            line[strcspn(line, "\n")] = 0;
            check(line + strlen(word));
            count++;
        }
    fclose(file);
    assert_true(count >= least);
}

static int numbers(char *text, double *out, int most)
{
    int count = 0;
    for (char *end; count < most; text = end) {
        out[count] = strtod(text, &end);
        if (end == text)
            break;
        count++;
    }
    return count;
}

static void check_internal(char *rest)
{
    double n[20];
    const int count = numbers(rest, n, 20);
    assert_int_equal(function_internal_arguments((int)n[0]), count - 2);
    const double is = function_internal((int)n[0], n + 2, NOISE_RANGE_CORRECTED);
    if (!same(is, n[1]))
        fail_msg("internal(%s) is %.17g", rest, is);
}

static void test_internal(void **state)
{
    (void)state;
    each_line("internal ", check_internal, 900);
    assert_int_equal(function_internal_arguments(77), 0);
    assert_int_equal(function_internal_arguments(79), 0);
    assert_int_equal(function_internal_arguments(-1), 0);
}

static void check_noise(char *rest)
{
    double n[5];
    assert_int_equal(numbers(rest, n, 5), 5);
    const double is = noise_value(vec3(n[2], n[3], n[4]), (int)n[0]);
    if (!same(is, n[1]))
        fail_msg("noise %s is %.17g", rest, is);
}

static void check_turbulence(char *rest)
{
    double n[9];
    assert_int_equal(numbers(rest, n, 9), 9);
    const Vec3 is = noise_turbulence(vec3(n[3], n[4], n[5]), n[0], n[1], n[2]);
    if (!same(is.x, n[6]) || !same(is.y, n[7]) || !same(is.z, n[8]))
        fail_msg("turbulence %s is %.17g %.17g %.17g", rest, is.x, is.y, is.z);
}

static void test_noise(void **state)
{
    (void)state;
    each_line("noise ", check_noise, 60);
    each_line("turbulence ", check_turbulence, 20);
    assert_true(noise_value(vec3(NAN, 0, 0), 2) == 0 && noise_value(vec3(0, INFINITY, 0), 3) == 0);
    assert_true(noise_value(vec3(1e30, -1e30, 1e18), 2) >= 0 && noise_value(vec3(1e30, -1e30, 1e18), 3) <= 1);
    /* the scene's generator, also where it is set after the function; the one written wins */
    assert_true(same(number_of("#declare F=function{internal(76)} #declare G=function{F(x,y,z)}"
                               "global_settings{noise_generator 3} #debug str(G(.3,.4,.5),0,17)"),
                     noise_value(vec3(.3, .4, .5), 3)));
}

/* As a function, and inside another one that is called with other names. */
static void check_user(char *rest)
{
    char text[1024], *body = rest;
    double n[3];
    assert_int_equal(numbers(rest, n, 3), 3);
    for (int i = 0; i < 3; i++)
        body = strchr(body, ' ') + 1;
    snprintf(text, sizeof text, "#declare F=function(a,b){%s} #debug str(F(%.3f,%.3f),0,17)", body, n[1], n[2]);
    const double is = number_of(text);
    snprintf(text, sizeof text,
             "#declare F=function(a,b){%s} #declare G=function(u,q,a){a+F(u*1,q+0)-F(a,u)*0-a}"
             "#debug str(G(%.3f,%.3f,3),0,17)",
             body, n[1], n[2]);
    const double nested = number_of(text);
    if (!same(is, n[0]) || (isfinite(n[0]) && isfinite(nested) && fabs(nested - n[0]) > 1e-11 * fmax(1, fabs(n[0]))))
        fail_msg("%s is %.17g and %.17g", rest, is, nested);
}

static void test_user(void **state)
{
    (void)state;
    each_line("user ", check_user, 80);
}

/* ---- compiling ---- */

/* Bodies too large to be compiled in place, calls of calls, loops around both. */
static void test_calls(void **state)
{
    (void)state;
    char text[16384] = "#declare A=function(x,y){";
    for (int i = 0; i < 200; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%sx*%d*y", i ? "+" : "", i);
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "} #declare B=function(y,x){A(y+1,x)-A(1,x)} #declare C=function(x){sum(i,1,3,B(i,x)+sum(j,1,i,B(j,i)))}"
             "#debug str(C(2),0,17)");
    double expected = 0;
    for (int i = 1; i <= 3; i++) {
        expected += 19900.0 * i * 2;
        for (int j = 1; j <= i; j++)
            expected += 19900.0 * j * i;
    }
    assert_true(same(number_of(text), expected));
    assert_true(
        same(number_of("#declare T=function{transform{scale 2 translate <1,2,3>}}"
                       "#declare F=function(x,y){T(x,y,x+y).z+10*T(x,y,0).x+100*T(0,0,y).y} #debug str(F(1,2),0,17)"),
             9 + 30 + 200));
    assert_true(same(number_of("#declare S=function{spline{linear_spline 0,<0,1,2> 1,<1,3,6>}}"
                               "#declare F=function(x){S(x).y+S(x/2).z} #debug str(F(.5),0,17)"),
                     2 + 3));
    assert_true(
        same(number_of("#declare P=function{pattern{checker scale 2}} #declare F=function(x){P(x,1,1)+2*P(x-2,1,1)}"
                       "#debug str(F(3),0,17)"),
             1));
    assert_true(same(number_of("#declare P=function{pigment{gradient x color_map{[0 rgb <.2,.4,.6>][1 rgb 1]}}}"
                               "#declare F=function(x){P(x,0,0).green+10*P(x,0,0).gray} #debug str(F(0),0,6)"),
                     .4 + 10 * (.297 * .2 + .589 * .4 + .114 * .6)));
}

/* What random arguments do not meet: a condition of exactly 0, ranges that do not begin or end at whole numbers. */
static void test_edges(void **state)
{
    (void)state;
    assert_true(number_of("#declare F=function(x){select(x,1,2,3)+10*select(x,4,5)} #debug str(F(0),0,9)") == 52);
    assert_true(number_of("#declare F=function(x){select(x,1,2,3)+10*select(x,4,5)} #debug str(F(1),0,9)") == 53);
    assert_true(number_of("#declare F=function(x){select(x,1,2,3)+10*select(x,4,5)} #debug str(F(-1),0,9)") == 41);
    assert_true(number_of("#declare F=function(x){sum(i,x,2.7,i+1)} #debug str(F(.5),0,9)") == 6);
    assert_true(number_of("#declare F=function(x){prod(i,x,1,i)+sum(i,3,x,i)} #debug str(F(2),0,9)") == 1);
}

static void test_limits(void **state)
{
    (void)state;
    RetexError err = {0};
    char text[8192] = "#declare F0=function(x){x+1}";
    /* doubled forty times: a tree of a billion nodes, of 40 lines */
    for (int i = 1; i <= 40; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "#declare F%d=function(x){F%d(x)+F%d(x+1)}", i, i - 1,
                 i - 1);
    strcat(text, "#debug str(F40(1),0,0)");
    assert_int_equal(read_scene(text, 1000000, &err), RETEX_ELIMIT);
    assert_int_equal(read_scene("#declare F=function(x){sum(i,x,1e300,i)} #debug str(F(1e299),0,0)", 1000000, &err),
                     RETEX_ELIMIT);
    assert_int_equal(read_scene("#declare F=function(x){sum(i,x,y,i)} #declare G=F(1)", 0, &err), RETEX_EPARSE);
    assert_int_equal(read_scene("#declare F=function{internal(61)} #declare G=F(1,2,3)", 0, &err), RETEX_EPARSE);
    /* some that are reported when they are called only, also through others */
    assert_int_equal(read_scene("#declare F=function{internal(77)} #declare G=function{F(x,y,z)+1}", 0, &err), 0);
    assert_null(strstr(said, "internal(77)"));
    assert_int_equal(
        read_scene("#declare F=function{internal(77)} #declare G=function{F(x,y,z)+1} #debug str(G(0,0,0),0,0)", 0,
                   &err),
        0);
    assert_non_null(strstr(said, "`internal(77)` is not supported yet: it gives 0\n1\n"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_internal), cmocka_unit_test(test_noise), cmocka_unit_test(test_user),
        cmocka_unit_test(test_calls),    cmocka_unit_test(test_edges), cmocka_unit_test(test_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
