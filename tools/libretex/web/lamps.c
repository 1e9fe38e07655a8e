/* See lamps.h. */
#include "web/lamps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/host/set_build.h>

#include "compact/gains.h"
#include "retexture/enlarge.h"
#include "set/parts.h"
#include "set/set.h"

#define REST "rest"
/* `rest` with less of all light is what rounding left: it would be told as 0.00 %. */
static const double REST_LEAST = 5e-5;

/* Whether a term is light of a lamp. */
static int is_of_lamp(const RetexSet *set, const RetexTerm *term, int lamp)
{
    return term->role == RETEX_ROLE_LAMP && retex_set_term_lamp(set, term) == lamp;
}

static int has_terms(const RetexSet *set, int parameter)
{
    for (int i = 0; i < set->nterms; i++)
        if (is_of_lamp(set, &set->terms[i], parameter))
            return 1;
    return 0;
}

/* The name of the lamp whose light a parameter is; "": of none. */
static const char *lamp_name(const RetexSet *set, int parameter)
{
    const RetexParameter *p = &set->parameters[parameter];
    return p->kind != RETEX_PARAMETER_COLOR ? "" : retex_set_has_finishes(set) ? p->lamp : p->name;
}

static int is_same_lamp(const RetexSet *set, int a, int b)
{
    return lamp_name(set, a)[0] && strcmp(lamp_name(set, a), lamp_name(set, b)) == 0;
}

/* The parameter that has the value of the lamp: the same one where there are no finishes; -1: there is no lamp. */
static int lamp_of(const RetexSet *set, int parameter)
{
    for (int i = 0; i < set->nparameters; i++)
        if (retex_parameter_lamp(set, i) && is_same_lamp(set, i, parameter))
            return i;
    return -1;
}

int retex_web_has_light(const RetexSet *set, int parameter)
{
    int has = has_terms(set, parameter);
    for (int i = 0; i < set->nparameters && retex_parameter_lamp(set, parameter); i++)
        has |= is_same_lamp(set, parameter, i) && has_terms(set, i);
    return has;
}

/* ---- which lamps are dim ---- */

/* The mean luminance of a term's light as it is kept, on textures of RETEX_COMPACT_GREY. */
static double brightness_of_term(const RetexSet *set, const RetexTerm *term, const float kept[3])
{
    const RetexImage *light = &set->parts[term->radiance].image;
    const int number = retex_term_image(term);
    const RetexImage *gain = number >= 0 ? &set->parts[number].image : NULL;
    const int scale = gain ? retex_set_scale(set, gain) : 1;
    double sum = 0;
    for (int y = 0; y < light->height; y++)
        for (int x = 0; x < light->width; x++) {
            const float *own = light->pixels + retex_image_index(light, x, y);
            const float *share = gain ? gain->pixels + retex_image_index(gain, x / scale, y / scale) : NULL;
            double rgb[3];
            for (int c = 0; c < 3; c++)
                rgb[c] = (double)kept[c] * (double)own[c] * (share ? (double)share[gain->channels == 3 ? c : 0] : 1);
            sum += retex_luminance(rgb[0], rgb[1], rgb[2]);
        }
    return sum * pow((double)RETEX_COMPACT_GREY, retex_term_hits(term));
}

static double brightness_of(const RetexSet *set, int lamp)
{
    double sum = 0;
    for (int i = 0; i < set->nterms; i++)
        if (is_of_lamp(set, &set->terms[i], lamp))
            sum += brightness_of_term(set, &set->terms[i], set->parameters[lamp].kept);
    return sum;
}

/* With all finishes that it meets. */
static double brightness_of_lamp(const RetexSet *set, int lamp)
{
    double sum = 0;
    for (int i = 0; i < set->nparameters; i++)
        sum += is_same_lamp(set, lamp, i) ? brightness_of(set, i) : 0;
    return sum;
}

/* Whether the terms of all light have the lamp as it was rendered. */
static int is_as_rendered(const RetexSet *set, int lamp)
{
    const RetexParameter *p = &set->parameters[lamp];
    return memcmp(p->value, p->kept, sizeof p->value) == 0;
}

static int is_rest(const RetexSet *set, int parameter)
{
    return strcmp(lamp_name(set, parameter), REST) == 0;
}

/* Remove the terms of lamps and finishes that the picture shows nothing of, and of `rest` where all that shines has a
 * name. */
static void drop_dark(RetexSet *set)
{
    double brightness[RETEX_PARAMETERS_MAX], all = 0;
    char is_dark[RETEX_PARAMETERS_MAX];
    for (int i = 0; i < set->nparameters; i++)
        all += brightness[i] = brightness_of(set, i);
    for (int i = 0; i < set->nparameters; i++) {
        const int rest = is_rest(set, i) ? lamp_of(set, i) : -1;
        is_dark[i] = brightness[i] <= 0 || (rest >= 0 && is_as_rendered(set, rest) &&
                                            brightness_of_lamp(set, rest) <= REST_LEAST * all);
    }
    for (int t = set->nterms - 1; t >= 0; t--) {
        const int own = set->terms[t].role == RETEX_ROLE_LAMP ? retex_set_term_lamp(set, &set->terms[t]) : -1;
        if (own >= 0 && is_dark[own])
            memmove(&set->terms[t], &set->terms[t + 1], sizeof *set->terms * (size_t)(--set->nterms - t));
    }
}

/* Choose the lamps that join `rest`. *into: its parameter, or the first of them that becomes it; -1: none join. */
static int choose_joined(const RetexSet *set, int most, char joined[RETEX_PARAMETERS_MAX], int *into, RetexError *err)
{
    double brightness[RETEX_PARAMETERS_MAX];
    int count = 0, rest = -1;
    *into = -1;
    for (int i = 0; i < set->nparameters; i++) {
        brightness[i] = -1;
        const int has_light = retex_web_has_light(set, i);
        if (!retex_parameter_lamp(set, i))
            continue;
        if (is_rest(set, i) && (has_light || is_as_rendered(set, i)))
            rest = i;
        else if (has_light)
            count++, brightness[i] = is_as_rendered(set, i) ? brightness_of_lamp(set, i) : -1;
    }
    const int can_join = rest < 0 || is_as_rendered(set, rest);
    for (; count > most; count--) {
        int dimmest = -1;
        for (int i = 0; i < set->nparameters && can_join; i++)
            if (!joined[i] && brightness[i] >= 0 && (dimmest < 0 || brightness[i] < brightness[dimmest]))
                dimmest = i;
        if (dimmest < 0)
            return retex_fail(err, RETEX_EUNSUPPORTED,
                              "a page of %d lamps has no room for all that are off in the picture: --web-lamps has "
                              "more%s",
                              most, retex_set_has_finishes(set) ? "" : ", --no-lamps none");
        joined[dimmest] = 1;
        *into = rest >= 0 ? rest : *into < 0 ? dimmest : *into;
    }
    return RETEX_OK;
}

/* ---- one term for several lamps ---- */

static void replace_image(RetexSet *set, int part, const RetexImage *image)
{
    retex_image_free(&set->parts[part].image);
    set->parts[part].image = *image;
}

/* What is a single lamp's own in a term: its gain, or its radiance. */
static int own_part(const RetexTerm *term)
{
    return retex_term_image(term) >= 0 ? retex_term_image(term) : term->radiance;
}

static void multiply(RetexImage *image, const float value[3])
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            image->pixels[3 * i + (size_t)c] *= value[c];
}

/* Make an image of RGB finer, bilinearly, where its scale is more than that. */
static int enlarge(RetexSet *set, int part, int scale, RetexError *err)
{
    const RetexImage *image = &set->parts[part].image;
    const int own = retex_set_scale(set, image);
    RetexImage finer = {0};
    if (own <= scale)
        return RETEX_OK;
    int code = retex_image_alloc(&finer, (set->width + scale - 1) / scale, (set->height + scale - 1) / scale, 3, err);
    if (code)
        return code;
    retex_enlarge_rows(image, own / scale, finer.width, 0, finer.height, finer.pixels);
    replace_image(set, part, &finer);
    return RETEX_OK;
}

static int add_image(RetexSet *set, int to, int from, RetexError *err)
{
    const int a = retex_set_scale(set, &set->parts[to].image), b = retex_set_scale(set, &set->parts[from].image);
    int code = enlarge(set, to, a < b ? a : b, err);
    if (!code)
        code = enlarge(set, from, a < b ? a : b, err);
    const RetexImage *image = &set->parts[from].image;
    for (size_t i = 0; i < 3 * (size_t)image->width * (size_t)image->height && !code; i++)
        set->parts[to].image.pixels[i] += image->pixels[i];
    return code;
}

/* Whether two terms of lamps differ in the lamp and its own part only. */
static int is_same_light(const RetexTerm *a, const RetexTerm *b)
{
    const int images = (retex_term_image(a) >= 0) + (retex_term_image(b) >= 0);
    if (a->nfactors != b->nfactors || images == 1 || (images && a->radiance != b->radiance))
        return 0;
    for (int k = 0; k < a->nfactors; k++) {
        const RetexFactor *f = &a->factors[k], *g = &b->factors[k];
        if (f->kind != g->kind || (retex_factor_is_texture(*f) && (f->index != g->index || f->quantity != g->quantity)))
            return 0;
    }
    return 1;
}

static void set_lamp(RetexTerm *term, int lamp)
{
    for (int k = 0; k < term->nfactors; k++)
        if (term->factors[k].kind == RETEX_FACTOR_PARAMETER)
            term->factors[k].index = lamp;
}

/* Which parameter the light of each joins: one of `rest`, with the same finishes; -1: it stays. */
static void choose_parameters(int to[RETEX_PARAMETERS_MAX], const RetexSet *set,
                              const char joined[RETEX_PARAMETERS_MAX], int into)
{
    for (int i = 0; i < set->nparameters; i++) {
        const int lamp = lamp_of(set, i);
        to[i] = lamp >= 0 && (lamp == into || joined[lamp]) ? i : -1;
        for (int k = set->nparameters - 1; k >= 0 && to[i] >= 0; k--)
            if (is_same_lamp(set, k, into) && memcmp(set->parameters[k].finishes, set->parameters[i].finishes,
                                                     sizeof set->parameters[k].finishes) == 0)
                to[i] = k;
    }
}

/* Make a parameter that of `rest`, whose gains have the values of lamps: 1, but with finishes that are not in the
 * picture 0. The terms of all light have the mean of all finishes. */
static void become_rest(RetexSet *set, int parameter)
{
    RetexParameter *p = &set->parameters[parameter];
    const char *lamp = lamp_name(set, parameter);
    char name[sizeof p->name];
    int shown = 1, choices = 1;
    for (int t = 0; t < set->ntargets; t++)
        if (p->finishes[t])
            choices *= set->targets[t].nfinishes, shown &= p->finishes[t] == set->targets[t].finish;
    const size_t begin = strncmp(p->name, lamp, strlen(lamp)) == 0 ? strlen(lamp) : 0;
    snprintf(name, sizeof name, REST "%s", p->name + begin);
    snprintf(p->name, sizeof p->name, "%s", name);
    if (retex_set_has_finishes(set))
        snprintf(p->lamp, sizeof p->lamp, REST);
    p->several = 1;
    for (int c = 0; c < 3; c++)
        p->value[c] = (float)shown, p->kept[c] = 1 / (float)choices;
}

/* Add up the light of the lamps that join `into`, with each finish apart. */
static int join(RetexSet *set, const char joined[RETEX_PARAMETERS_MAX], int into, RetexError *err)
{
    int code = RETEX_OK, kept = 0, to[RETEX_PARAMETERS_MAX];
    choose_parameters(to, set, joined, into);
    for (int t = 0; t < set->nterms && !code; t++) {
        RetexTerm term = set->terms[t];
        const int own = term.role == RETEX_ROLE_LAMP ? retex_set_term_lamp(set, &term) : -1;
        int same = kept;
        if (own >= 0 && to[own] >= 0) {
            multiply(&set->parts[own_part(&term)].image, set->parameters[lamp_of(set, own)].value);
            set_lamp(&term, to[own]);
            for (same = 0; same < kept; same++)
                if (is_of_lamp(set, &set->terms[same], to[own]) && is_same_light(&set->terms[same], &term))
                    break;
        }
        if (same < kept)
            code = add_image(set, own_part(&set->terms[same]), own_part(&term), err);
        else
            set->terms[kept++] = term;
    }
    set->nterms = code ? set->nterms : kept;
    for (int i = 0; i < set->nparameters; i++)
        if (to[i] == i)
            become_rest(set, i);
    for (int i = set->nparts - 1; i > 0 && !code; i--) /* not the AOVs of the set, which the page leaves out */
        if (!retex_part_is_used(set, i))
            retex_set_remove_part(set, i);
    return code;
}

/* ---- sizes ---- */

/* Make a gain twice as coarse: blocks' shares of light, and means where there is none. All its light stays. */
static int halve(RetexSet *set, const RetexTerm *term, RetexError *err)
{
    const int part = retex_term_image(term);
    const RetexImage *gain = &set->parts[part].image, *light = &set->parts[term->radiance].image;
    RetexImage coarse = {0};
    int code = retex_image_alloc(&coarse, (gain->width + 1) / 2, (gain->height + 1) / 2, 3, err);
    for (int y = 0; y < coarse.height && !code; y++)
        for (int i = 0; i < 3 * coarse.width; i++) {
            const int x = i / 3;
            double sum = 0, own = 0, all = 0, count = 0;
            for (int k = 0; k < 4; k++) {
                const int px = 2 * x + k % 2, py = 2 * y + k / 2;
                if (px >= gain->width || py >= gain->height)
                    continue;
                const size_t at = retex_image_index(gain, px, py) + (size_t)(i % 3);
                const double share = (double)gain->pixels[at], weight = fmax((double)light->pixels[at], 0);
                sum += share, count++, own += share * weight, all += weight;
            }
            const size_t at = retex_image_index(&coarse, x, y) + (size_t)(i % 3);
            coarse.pixels[at] = (float)(all > 0 ? own / all : sum / count);
        }
    if (!code)
        code = retex_compact_gain_end(&coarse, light, 2 * retex_set_scale(set, gain), err);
    if (!code)
        replace_image(set, part, &coarse);
    else
        retex_image_free(&coarse);
    return code;
}

/* The names of the lamps that join, divided by commas. */
static void list_names(char *names, size_t size, const RetexSet *set, const char joined[RETEX_PARAMETERS_MAX])
{
    size_t used = 0;
    names[0] = '\0';
    for (int i = 0; i < set->nparameters && used < size; i++)
        if (joined[i])
            used += (size_t)snprintf(names + used, size - used, "%s%s", used ? ", " : "", lamp_name(set, i));
}

int retex_web_lamps_prepare(RetexSet *set, int most, char *names, size_t size, RetexError *err)
{
    char joined[RETEX_PARAMETERS_MAX] = {0};
    int into;
    drop_dark(set);
    int code = choose_joined(set, most, joined, &into, err);
    list_names(names, size, set, joined);
    if (!code && into >= 0)
        code = join(set, joined, into, err);
    for (int t = 0; t < set->nterms && !code; t++) {
        const int part = retex_term_image(&set->terms[t]);
        if (set->terms[t].role == RETEX_ROLE_LAMP && part >= 0 &&
            retex_set_scale(set, &set->parts[part].image) < RETEX_WEB_LAMP_SCALE)
            code = halve(set, &set->terms[t], err);
    }
    return code;
}
