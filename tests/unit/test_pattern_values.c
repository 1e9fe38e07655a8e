/* Patterns through the scene language: values of tests/data/patterns.txt, which POV-Ray gave
 * (tests/lib/povray_patterns.py). */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "pattern/pattern.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

enum { MOST_POINTS = 64, LINE = 512 };

static char said[65536];

static void collect(void *context, int level, const char *text)
{
    (void)context;
    (void)level;
    const size_t used = strlen(said);
    snprintf(said + used, sizeof said - used, "%s\n", text);
}

/* A pattern or a pigment, its points and the values there. */
typedef struct Case {
    char name[LINE];
    int is_pigment, npoints;
    double point[MOST_POINTS][3], value[MOST_POINTS][3];
} Case;

static void print_values(FILE *scene, const Case *c)
{
    static const char *const parts[] = {".red", ".green", ".blue"};
    fprintf(scene, "#version 3.7; global_settings { assumed_gamma 1 } sphere { 0, 1 }\n");
    fprintf(scene, "#declare F = function { %s { %s } }\n", c->is_pigment ? "pigment" : "pattern", c->name);
    for (int i = 0; i < c->npoints; i++)
        for (int k = 0; k < (c->is_pigment ? 3 : 1); k++)
            fprintf(scene, "#debug concat(str(F(%.17g,%.17g,%.17g)%s,0,15),\"\\n\")\n", c->point[i][0], c->point[i][1],
                    c->point[i][2], c->is_pigment ? parts[k] : "");
}

static void check_case(const Case *c)
{
    char path[] = "/tmp/test_patterns_XXXXXX", *at = said;
    SdlOptions options = SDL_OPTIONS_INIT;
    RetexError err = {0};
    Scene *scene = NULL;
    FILE *file = fdopen(mkstemp(path), "w");
    assert_non_null(file);
    print_values(file, c);
    fclose(file);
    options.message = collect;
    said[0] = 0;
    if (sdl_read(&scene, path, &options, &scene_builder, &err))
        fail_msg("%s: column %d: %s", c->name, err.column, err.message);
    scene_close(&scene);
    unlink(path);
    for (int i = 0; i < c->npoints; i++)
        for (int k = 0; k < (c->is_pigment ? 3 : 1); k++) {
            char *end;
            const double value = strtod(at, &end);
            /* POV-Ray's colours are floats. */
            if (end == at || !(fabs(value - c->value[i][k]) <= (c->is_pigment ? 2e-6 : 1e-12)))
                fail_msg("%s at %g %g %g: %.15g, not %.15g", c->name, c->point[i][0], c->point[i][1], c->point[i][2],
                         value, c->value[i][k]);
            at = end;
        }
}

/* Whether a pattern stands alone in the file: then its colours are its own. */
static int stands_alone[64];

static void find_alone(const char *name)
{
    char word[64];
    const char *after = strstr(name, " translate <");
    if (sscanf(name, "%63s", word) == 1 && pattern_find(word) >= 0 && !strstr(name, "_map") &&
        (!after || !strpbrk(after + 12, "{ ")))
        stands_alone[pattern_find(word)] = 1;
}

/* All but those that ask for a surface. */
static void check_alone(void)
{
    for (int i = 0; i < pattern_count(); i++) {
        const PatternOps *ops = pattern_at(i);
        if (ops->value && !stands_alone[i] && strcmp(ops->keyword, "slope") != 0 && strcmp(ops->keyword, "aoi") != 0)
            fail_msg("no colours of %s alone", ops->keyword);
    }
}

static void povray_values(void **state)
{
    static Case c;
    char line[LINE];
    int count = 0;
    (void)state;
    FILE *file = fopen("tests/data/patterns.txt", "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        if (*line == '=' || *line == '~') {
            if (c.npoints)
                check_case(&c), count++;
            c.npoints = 0, c.is_pigment = *line == '~';
            strcpy(c.name, line + 2);
            if (c.is_pigment)
                find_alone(c.name);
            continue;
        }
        double *p = c.point[c.npoints], *v = c.value[c.npoints];
        assert_true(c.npoints < MOST_POINTS);
        assert_true(sscanf(line, "%lf %lf %lf %lf %lf %lf", &p[0], &p[1], &p[2], &v[0], &v[1], &v[2]) ==
                    (c.is_pigment ? 6 : 4));
        c.npoints++;
    }
    check_case(&c);
    fclose(file);
    check_alone();
    assert_true(count > 120);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(povray_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
