/* See retex/web.h. All files are encoded in memory, then written by folder.c, the manifest last. */
#include <retex/web.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/reduce.h>

#include "base/json_write.h"
#include "base/params.h"
#include "compact/compact.h"
#include "pack/balance.h"
#include "pack/plan.h"
#include "set/laid.h"
#include "set/set.h"
#include "web/folder.h"
#include "web/footprints.h"
#include "web/lamps.h"
#include "web/light.h"

/* Compacting aims above the whole by so many decibels, as for packs. */
static const double COMPACTING_MARGIN = 3;
/* Pictures by one lamp, which are looked at alone, may lose so many decibels more: with 7 less, a lamp of the living
 * room had 36.9 dB against retex-combine, with 3 more, lamps took a third more bytes for .3 dB. */
static const double LAMP_LOSS = 4;
/* Scales of what is smaller than the picture: as many times as quality allows, else fixed ones, where those make images
 * that are too large. */
static const int SCALES[] = {0, 4, 8};

/* Images that are smaller than the picture, in one file. */
typedef struct Atlas {
    RetexWebFile file;
    RetexWebTile *tiles;
    int ntiles, width, height;
} Atlas;

typedef struct Web {
    RetexSet *set; /* compact */
    RetexPackPart *packed;
    RetexWebModel model;
    RetexWebFile picture, *lights, *streams; /* streams by class, the others by number */
    int *light_parts, nlights;
    RetexPackCurve *curves; /* of lights */
    RetexImage *decoded;    /* by part: what browsers make of light */
    Atlas reduced, lamps;
    char joined[1024]; /* names of the lamps that are in `rest` */
} Web;

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "no memory to write a folder for browsers");
}

static void free_decoded(Web *web)
{
    for (int i = 0; web->decoded && web->set && i < web->set->nparts; i++)
        retex_image_free(&web->decoded[i]);
    free(web->decoded);
    web->decoded = NULL;
}

static void web_close(Web *web)
{
    for (int i = 0; web->lights && i < web->nlights; i++)
        free(web->lights[i].data);
    for (int i = 0; web->streams && i < web->model.nclasses; i++)
        free(web->streams[i].data);
    for (int i = 0; web->packed && web->set && i < web->set->nparts; i++)
        retex_pack_part_free(&web->packed[i]);
    free_decoded(web);
    free(web->picture.data);
    free(web->reduced.file.data);
    free(web->lamps.file.data);
    free(web->lights);
    free(web->streams);
    free(web->light_parts);
    free(web->curves);
    free(web->reduced.tiles);
    free(web->lamps.tiles);
    free(web->packed);
    retex_web_model_close(&web->model);
    retex_set_close(&web->set);
    *web = (Web){0};
}

/* ---- encoding ---- */

static int is_light(const Web *web, int part)
{
    for (int i = 0; i < web->nlights; i++)
        if (web->light_parts[i] == part)
            return i;
    return -1;
}

static int tile_of(const Atlas *atlas, int part)
{
    for (int i = 0; i < atlas->ntiles; i++)
        if (atlas->tiles[i].part == part)
            return i;
    return -1;
}

/* The largest first, in the order that they had, so that shelves of the atlas have little that is empty. */
static void sort_tiles(Atlas *atlas, const RetexSet *set)
{
    for (int i = 1; i < atlas->ntiles; i++) {
        const RetexWebTile tile = atlas->tiles[i];
        int at = i;
        for (; at && set->parts[atlas->tiles[at - 1].part].image.height < set->parts[tile.part].image.height; at--)
            atlas->tiles[at] = atlas->tiles[at - 1];
        atlas->tiles[at] = tile;
    }
}

/* List the images of the picture's size, and those that are smaller. */
static void list_images(Web *web)
{
    const RetexWebModel *m = &web->model;
    for (int i = 0; i < m->ngroups; i++)
        if (is_light(web, m->groups[i].light) < 0)
            web->light_parts[web->nlights++] = m->groups[i].light;
    for (int i = 0; i < m->nclasses; i++) {
        const int albedo = m->classes[i].albedo;
        if (m->classes[i].scale > 1)
            web->reduced.tiles[web->reduced.ntiles++].part = albedo;
        else if (is_light(web, albedo) < 0) /* whole pixels have that of sharp ones */
            web->light_parts[web->nlights++] = albedo;
    }
    for (int i = 0; i < m->nterms; i++) {
        Atlas *atlas = m->terms[i].lamp < 0 ? &web->reduced : &web->lamps;
        if (m->terms[i].gain >= 0 && tile_of(atlas, m->terms[i].gain) < 0)
            atlas->tiles[atlas->ntiles++].part = m->terms[i].gain;
    }
    sort_tiles(&web->lamps, web->set);
}

static int is_sharp_light(const Web *web, int part)
{
    for (int i = 0; i < web->model.nclasses; i++)
        if (web->model.classes[i].scale == 1 && web->model.classes[i].albedo == part)
            return 1;
    for (int i = 0; i < web->model.ngroups; i++)
        if (web->model.groups[i].light == part && web->model.groups[i].mixture < 0)
            return 0;
    return 1;
}

static void take_jpeg(RetexWebFile *file, RetexPackJpeg *jpeg, const char *name)
{
    file->data = jpeg->data;
    file->bytes = jpeg->bytes;
    retex_web_file_name(file, name, "jpg");
    jpeg->data = NULL;
    retex_pack_jpeg_free(jpeg);
}

static int encode_picture(Web *web, RetexError *err)
{
    const RetexPart *part = &web->set->parts[0];
    const RetexPackCurve curve = retex_pack_curve(1, 255);
    const size_t count = (size_t)part->image.width * (size_t)part->image.height * (size_t)part->image.channels;
    RetexPackJpeg jpeg = {0};
    float *levels = malloc(count * sizeof *levels);
    if (!levels)
        return no_memory(err);
    for (size_t i = 0; i < count; i++)
        levels[i] = (float)fmin(retex_pack_curve_level(&curve, 0, fmax((double)part->image.pixels[i], 0)), 255);
    int code = retex_pack_jpeg_encode(&jpeg, levels, part->image.width, part->image.height, part->image.channels,
                                      fmax(web->packed[0].jpeg_step, 1), err);
    free(levels);
    if (!code)
        take_jpeg(&web->picture, &jpeg, "picture");
    return code;
}

static int encode_atlas(Web *web, Atlas *atlas, const char *name, int nthreads, RetexError *err)
{
    RetexPackJpeg jpeg = {0};
    if (!atlas->ntiles)
        return RETEX_OK;
    int code = retex_web_atlas_encode(&jpeg, atlas->tiles, atlas->ntiles, &atlas->width, &atlas->height, web->set,
                                      web->packed, web->decoded, nthreads, err);
    if (!code)
        take_jpeg(&atlas->file, &jpeg, name);
    return code;
}

static int encode(Web *web, int nthreads, RetexError *err)
{
    const RetexSet *set = web->set;
    RetexPackJpeg jpeg = {0};
    int code = encode_picture(web, err);
    for (int i = 0; i < web->nlights && !code; i++) {
        const int part = web->light_parts[i];
        RetexImage *decoded = retex_pack_light_of(set, part) == part ? &web->decoded[part] : NULL;
        code = retex_web_light_encode(&jpeg, &web->curves[i], decoded, &set->parts[part], &web->packed[part],
                                      is_sharp_light(web, part), err);
        if (!code)
            take_jpeg(&web->lights[i], &jpeg, set->parts[part].name);
    }
    if (!code)
        code = encode_atlas(web, &web->reduced, "reduced", nthreads, err);
    if (!code)
        code = encode_atlas(web, &web->lamps, "lamps", nthreads, err);
    free_decoded(web);
    for (int i = 0; i < web->model.nclasses && !code; i++) {
        const RetexWebClass *c = &web->model.classes[i];
        RetexWebFile *file = &web->streams[i];
        code = retex_web_footprints_encode(&file->data, &file->bytes, set, web->packed, c, err);
        if (!code)
            retex_web_file_name(file, set->parts[set->footprints[c->footprints[0]].uv].name, "bin");
    }
    return code;
}

static int all_zero(const RetexImage *im)
{
    size_t k = 0;
    const size_t count = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
    while (k < count && im->pixels[k] == 0)
        k++;
    return k == count;
}

/* Give footprints the numbers that maps of packs are for. Means have so many bits before their fraction's: those of
 * surfaces that reach farther, as planes do to the horizon, are moved by whole repeats. Where all standard deviations
 * are 0, or no pixel sees the footprint, one value that nothing shows keeps the images from being left out. */
static void prepare_footprints(RetexSet *set)
{
    const float farthest = 1 << (29 - RETEX_PACK_LATTICE_BITS), unseen = 0x1p-30F;
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        if (f->uv < 0 || f->spread < 0)
            continue;
        RetexImage *uv = &set->parts[f->uv].image, *spread = &set->parts[f->spread].image;
        for (size_t k = 0; k < (size_t)uv->width * (size_t)uv->height * (size_t)uv->channels; k++)
            if (k % (size_t)uv->channels < 2 && !(fabsf(uv->pixels[k]) < farthest))
                uv->pixels[k] = remainderf(uv->pixels[k], farthest);
        if (all_zero(uv))
            uv->pixels[0] = unseen;
        if (all_zero(spread))
            spread->pixels[0] = unseen;
    }
}

static int web_open(Web *web, const RetexSet *set, const RetexWebParams *params, int scale, int nthreads,
                    RetexError *err)
{
    const int quality = params->quality;
    const RetexPackQuantizer quantizer = retex_pack_quantizer(retex_pack_quality_psnr(quality));
    RetexCompactParams compacting = RETEX_COMPACT_INIT;
    compacting.psnr = retex_pack_quality_psnr(quality) + COMPACTING_MARGIN;
    compacting.lamps = retex_pack_quality_psnr(quality) - LAMP_LOSS;
    compacting.noise = pow(fmin((100 - quality) / 10.0, 1), 2);
    compacting.broad = compacting.interreflection = compacting.gain = scale;
    compacting.least = 2; /* see model.c */
    *web = (Web){0};
    int code = retex_set_compact(&web->set, set, &compacting, nthreads, err);
    if (!code)
        code = retex_web_lamps_prepare(web->set, params->lamps, web->joined, sizeof web->joined, err);
    if (!code)
        code = retex_web_model_open(&web->model, web->set, err);
    if (code)
        return code;
    prepare_footprints(web->set);
    const size_t count = (size_t)web->set->nparts + 1;
    web->packed = calloc(count, sizeof *web->packed);
    web->lights = calloc(count, sizeof *web->lights);
    web->streams = calloc((size_t)web->model.nclasses + 1, sizeof *web->streams);
    web->light_parts = calloc(count, sizeof *web->light_parts);
    web->curves = calloc(count, sizeof *web->curves);
    web->decoded = calloc(count, sizeof *web->decoded);
    web->reduced.tiles = calloc(count, sizeof *web->reduced.tiles);
    web->lamps.tiles = calloc(count, sizeof *web->lamps.tiles);
    if (!web->packed || !web->lights || !web->streams || !web->light_parts || !web->curves || !web->decoded ||
        !web->reduced.tiles || !web->lamps.tiles)
        return no_memory(err);
    list_images(web);
    code = retex_pack_plan(web->packed, web->set, &quantizer, nthreads, err);
    return code ? code : encode(web, nthreads, err);
}

/* ---- the manifest ---- */

static json_t *describe_file(const RetexWebFile *file)
{
    return json_pack("{s:s,s:I,s:I}", "file", file->name, "bytes", (json_int_t)file->bytes, "crc32",
                     (json_int_t)file->crc);
}

static void put_curve(json_t **object, const RetexPackCurve *curve)
{
    retex_json_put(object, "white", retex_pack_describe_white(curve));
    retex_json_put(object, "levels", json_real(curve->levels));
}

/* A name of any bytes. */
static json_t *text(const char *bytes)
{
    json_t *string = json_string(bytes);
    return string ? string : json_string("?");
}

/* Whether a parameter is in the manifest's list: a colour that did not join others. */
static int is_listed(const Web *web, int parameter)
{
    return web->set->parameters[parameter].kind == RETEX_PARAMETER_COLOR &&
           (!web->lamps.ntiles || retex_web_has_light(web->set, parameter));
}

static void put_finishes(json_t **object, const RetexTarget *target)
{
    json_t *names = json_array(), *roughness = json_array();
    for (int k = 0; k < target->nfinishes; k++) {
        retex_json_add(&names, text(target->finishes[k]));
        retex_json_add(&roughness, json_real((double)target->finish_roughness[k]));
    }
    retex_json_put(object, "finishes", names);
    retex_json_put(object, "finish_roughness", roughness);
    retex_json_put(object, "finish", json_integer(target->finish));
    if (target->normal_tilt > 0)
        retex_json_put(object, "normal_tilt", json_real(target->normal_tilt));
}

static json_t *describe_targets(const Web *web)
{
    const RetexSet *set = web->set;
    json_t *list = json_array();
    for (int i = 0; i < set->ntargets; i++) {
        const RetexTarget *t = &set->targets[i];
        json_t *object =
            json_pack("{s:o,s:[i,i],s:[f,f],s:[f,f],s:[f,f],s:f}", "name", text(t->name), "periodic", t->periodic[0],
                      t->periodic[1], "uv_min", t->uv_min[0], t->uv_min[1], "uv_max", t->uv_max[0], t->uv_max[1],
                      "uv_scale", t->uv_scale[0], t->uv_scale[1], "share", t->share);
        retex_json_put(
            &object, "mean_albedo",
            json_pack("[f,f,f]", (double)t->mean_albedo[0], (double)t->mean_albedo[1], (double)t->mean_albedo[2]));
        if (t->nfinishes)
            put_finishes(&object, t);
        retex_json_add(&list, object);
    }
    return list;
}

/* The number of a colour in the manifest's list of parameters. */
static int number_of(const Web *web, int parameter)
{
    int number = 0;
    for (int i = 0; i < parameter; i++)
        number += is_listed(web, i);
    return number;
}

static json_t *describe_color(const float color[3])
{
    return json_pack("[f,f,f]", (double)color[0], (double)color[1], (double)color[2]);
}

/* Whose light it is, and with which finishes. */
static void put_lamp(json_t **object, const RetexSet *set, const RetexParameter *parameter)
{
    json_t *finishes = json_array();
    for (int t = 0; t < set->ntargets; t++)
        retex_json_add(&finishes, json_integer(parameter->finishes[t]));
    retex_json_put(object, "lamp", text(parameter->lamp));
    retex_json_put(object, "finishes", finishes);
}

/* The colours that can be changed; NULL: none. */
static json_t *describe_parameters(const Web *web)
{
    json_t *list = NULL;
    for (int i = 0; i < web->set->nparameters; i++) {
        const RetexParameter *p = &web->set->parameters[i];
        if (!is_listed(web, i))
            continue;
        json_t *object = json_pack("{s:o,s:o}", "name", text(p->name), "value", describe_color(p->value));
        if (web->lamps.ntiles)
            retex_json_put(&object, "kept", describe_color(p->kept));
        if (p->several)
            retex_json_put(&object, "several", json_true());
        if (retex_set_has_finishes(web->set))
            put_lamp(&object, web->set, p);
        list = list ? list : json_array();
        retex_json_add(&list, object);
    }
    return list;
}

/* The target that light belongs to, or -1: of all. */
static int target_of_light(const Web *web, int part)
{
    for (int i = 0; i < web->model.nclasses; i++)
        if (web->model.classes[i].albedo == part)
            return web->model.classes[i].target;
    for (int i = 0; i < web->model.ngroups; i++)
        if (web->model.groups[i].light == part)
            return web->model.groups[i].target;
    return -1;
}

static json_t *describe_lights(const Web *web)
{
    json_t *list = json_array();
    for (int i = 0; i < web->nlights; i++) {
        json_t *object = describe_file(&web->lights[i]);
        retex_json_put(&object, "target", json_integer(target_of_light(web, web->light_parts[i])));
        put_curve(&object, &web->curves[i]);
        retex_json_add(&list, object);
    }
    return list;
}

static json_t *describe_atlas(const Web *web, const Atlas *atlas)
{
    json_t *tiles = json_array(), *object = describe_file(&atlas->file);
    for (int i = 0; i < atlas->ntiles; i++) {
        const RetexImage *im = &web->set->parts[atlas->tiles[i].part].image;
        json_t *tile = json_pack("{s:i,s:i,s:i,s:i,s:i}", "x", atlas->tiles[i].x, "y", atlas->tiles[i].y, "width",
                                 im->width, "height", im->height, "scale", retex_set_scale(web->set, im));
        put_curve(&tile, &atlas->tiles[i].curve);
        retex_json_add(&tiles, tile);
    }
    retex_json_put(&object, "width", json_integer(atlas->width));
    retex_json_put(&object, "height", json_integer(atlas->height));
    retex_json_put(&object, "tiles", tiles);
    return object;
}

static json_t *describe_classes(const Web *web)
{
    json_t *list = json_array();
    for (int i = 0; i < web->model.nclasses; i++) {
        const RetexWebClass *c = &web->model.classes[i];
        const RetexImage *im = &web->set->parts[web->set->footprints[c->footprints[0]].uv].image;
        json_t *object = describe_file(&web->streams[i]);
        retex_json_put(&object, "target", json_integer(c->target));
        retex_json_put(&object, "kind", json_string(retex_footprint_kind_name(c->kind)));
        retex_json_put(&object, "scale", json_integer(c->scale));
        retex_json_put(&object, "width", json_integer(im->width));
        retex_json_put(&object, "height", json_integer(im->height));
        retex_json_put(&object, "albedo",
                       json_integer(c->scale == 1 ? is_light(web, c->albedo) : tile_of(&web->reduced, c->albedo)));
        retex_json_put(&object, "records", json_integer((json_int_t)retex_web_records(web->set, c)));
        retex_json_put(&object, "spreads",
                       json_integer(web->set->parts[web->set->footprints[c->footprints[0]].spread].image.channels));
        retex_json_put(&object, "footprints", retex_web_footprints_describe(web->packed, web->set, c));
        retex_json_add(&list, object);
    }
    return list;
}

/* How light goes on beyond the terms' hits, and the mixtures whose quantity that is. */
static void describe_further(json_t **object, const Web *web)
{
    const float *ratio = web->set->further_ratio;
    json_t *mixtures = json_array();
    for (int i = 0; i < web->model.nmixtures; i++)
        if (web->model.mixtures[i].factor.quantity == RETEX_QUANTITY_FURTHER)
            retex_json_add(&mixtures, json_integer(i));
    if (json_array_size(mixtures))
        retex_json_put(object, "further",
                       json_pack("{s:i,s:[f,f,f],s:O}", "hits", web->set->further_hits, "ratio", (double)ratio[0],
                                 (double)ratio[1], (double)ratio[2], "mixtures", mixtures));
    json_decref(mixtures);
}

static json_t *describe_term(const Atlas *atlas, const RetexWebTerm *term)
{
    json_t *factors = json_array();
    for (int k = 0; k < term->nfactors; k++)
        retex_json_add(&factors, json_integer(term->factors[k]));
    return json_pack("{s:i,s:i,s:o}", "group", term->group, "gain", term->gain >= 0 ? tile_of(atlas, term->gain) : -1,
                     "factors", factors);
}

static void describe_terms(json_t **object, const Web *web)
{
    json_t *mixtures = json_array(), *groups = json_array(), *terms = json_array();
    for (int i = 0; i < web->model.nmixtures; i++) {
        const RetexWebMixture *m = &web->model.mixtures[i];
        json_t *mixture = json_array();
        for (int k = 0; k < m->nclasses; k++)
            retex_json_add(&mixture, json_pack("[i,i]", m->classes[k].index, m->classes[k].weighting));
        retex_json_add(&mixtures, mixture);
    }
    for (int i = 0; i < web->model.ngroups; i++) {
        const RetexWebGroup *g = &web->model.groups[i];
        json_t *group =
            json_pack("{s:i,s:i,s:i}", "light", is_light(web, g->light), "mixture", g->mixture, "target", g->target);
        json_t *parameters = g->nparameters ? json_array() : NULL;
        for (int k = 0; k < g->nparameters; k++)
            retex_json_add(&parameters, json_integer(number_of(web, g->parameters[k])));
        if (g->nparameters)
            retex_json_put(&group, "parameters", parameters);
        retex_json_add(&groups, group);
    }
    for (int i = 0; i < web->model.nterms; i++)
        if (web->model.terms[i].lamp < 0)
            retex_json_add(&terms, describe_term(&web->reduced, &web->model.terms[i]));
    retex_json_put(object, "mixtures", mixtures);
    describe_further(object, web);
    retex_json_put(object, "groups", groups);
    retex_json_put(object, "terms", terms);
}

/* The terms of single lamps and their file. */
static json_t *describe_lamps(const Web *web)
{
    json_t *terms = json_array(), *object = describe_atlas(web, &web->lamps);
    for (int i = 0; i < web->model.nterms; i++) {
        const RetexWebTerm *t = &web->model.terms[i];
        json_t *term = t->lamp >= 0 ? describe_term(&web->lamps, t) : NULL;
        if (t->lamp < 0)
            continue;
        retex_json_put(&term, "parameter", json_integer(number_of(web, t->lamp)));
        retex_json_add(&terms, term);
    }
    retex_json_put(&object, "finest", json_integer(web->model.lamps_finest));
    retex_json_put(&object, "terms", terms);
    return object;
}

static char *describe(const Web *web, const json_t *smaller, RetexError *err)
{
    const RetexSet *set = web->set;
    char id[16];
    snprintf(id, sizeof id, "%08x", set->id);
    json_t *object =
        json_pack("{s:i,s:o,s:s,s:i,s:i,s:s,s:i,s:o,s:o,s:o,s:o}", "retex_web", RETEX_FORMAT_VERSION, "scene",
                  text(set->scene), "id", id, "width", set->width, "height", set->height, "filter", set->filter,
                  "finest", web->model.finest, "picture", describe_file(&web->picture), "targets",
                  describe_targets(web), "lights", describe_lights(web), "classes", describe_classes(web));
    if (number_of(web, set->nparameters))
        retex_json_put(&object, "parameters", describe_parameters(web));
    if (set->unit != 1)
        retex_json_put(&object, "unit", json_real(set->unit));
    retex_json_put(&object, "reduced", web->reduced.ntiles ? describe_atlas(web, &web->reduced) : json_null());
    if (web->lamps.ntiles)
        retex_json_put(&object, "lamps", describe_lamps(web));
    if (object)
        describe_terms(&object, web);
    if (json_array_size(smaller))
        retex_json_put(&object, "smaller", json_deep_copy(smaller));
    char *json = object ? retex_json_text(object, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(object);
    if (!json)
        no_memory(err);
    return json;
}

/* ---- the folder ---- */

static RetexWebFile *file_at(Web *web, int index)
{
    if (index < 1 + web->nlights)
        return index ? &web->lights[index - 1] : &web->picture;
    index -= 1 + web->nlights;
    if (index < web->model.nclasses)
        return &web->streams[index];
    return index == web->model.nclasses && web->reduced.ntiles ? &web->reduced.file : &web->lamps.file;
}

static int count_files(const Web *web)
{
    return 1 + web->nlights + web->model.nclasses + (web->reduced.ntiles > 0) + (web->lamps.ntiles > 0);
}

/* Whether the picture as rendered needs the light of single lamps: one is off in it, or finishes are kept apart. */
static int needs_lamps(const Web *web)
{
    int needs = 0;
    for (int i = 0; i < web->set->nparameters; i++)
        needs |= is_listed(web, i) && memcmp(web->set->parameters[i].value, web->set->parameters[i].kept,
                                             sizeof web->set->parameters[i].value) != 0;
    return needs && web->lamps.ntiles;
}

static RetexWebBytes count_bytes(const Web *web, size_t manifest)
{
    RetexWebBytes bytes = {.still = web->picture.bytes + manifest};
    size_t common = web->reduced.file.bytes, others = 0;
    int best = 0;
    *(needs_lamps(web) ? &common : &others) += web->lamps.file.bytes;
    for (int i = 1; i < web->set->ntargets; i++)
        if (web->set->targets[i].share > web->set->targets[best].share)
            best = i;
    for (int i = 0; i < web->model.nclasses; i++)
        if (web->model.classes[i].kind == RETEX_FOOTPRINT_INTERREFLECTION || web->model.classes[i].target == best)
            common += web->streams[i].bytes;
        else
            others += web->streams[i].bytes;
    for (int i = 0; i < web->nlights; i++)
        if (target_of_light(web, web->light_parts[i]) == best)
            common += web->lights[i].bytes;
        else
            others += web->lights[i].bytes;
    bytes.first = bytes.still + common;
    bytes.all = bytes.first + others;
    return bytes;
}

/* Append a name to a list. */
static void list_name(char *names, size_t size, const char *before, const char *name)
{
    const size_t used = strlen(names);
    snprintf(names + used, size - used, "%s%s", before, name);
}

/* Tell which lamps and finishes there are. */
static void tell_lamps(const Web *web, const RetexWebParams *params)
{
    const RetexSet *set = web->set;
    char names[1024] = "", note[2400];
    int coarsest = 1, count = 0;
    if (!params->note || !web->lamps.ntiles)
        return;
    for (int i = 0; i < set->nparameters; i++)
        if (is_listed(web, i) && retex_parameter_lamp(set, i))
            list_name(names, sizeof names, count++ ? ", " : "lamps ", retex_parameter_lamp(set, i));
    for (int i = 0, finishes = 0; i < set->ntargets; i++)
        if (set->targets[i].nfinishes && !(set->targets[i].normal_tilt > 0))
            list_name(names, sizeof names, finishes++ ? ", " : count ? "; finishes of " : "finishes of ",
                      set->targets[i].name);
    for (int i = 0; i < web->lamps.ntiles; i++) {
        const int scale = retex_set_scale(set, &set->parts[web->lamps.tiles[i].part].image);
        coarsest = scale > coarsest ? scale : coarsest;
    }
    snprintf(note, sizeof note, "%s: %zu bytes, loaded %s; shares of light %d to %d times smaller than the picture",
             names, web->lamps.file.bytes, needs_lamps(web) ? "at once" : "when one is changed",
             web->model.lamps_finest, coarsest);
    params->note(params->note_context, note);
    if (*web->joined) {
        snprintf(note, sizeof note, "%s %s rest, being dimmest: a page has %d lamps, or as many as --web-lamps says",
                 web->joined, strchr(web->joined, ',') ? "join" : "joins", params->lamps);
        params->note(params->note_context, note);
    }
}

/* ---- rooms ---- */

/* A room and those beside it that are smaller. */
typedef struct Rooms {
    Web webs[RETEX_WEB_SMALLER + 1]; /* the whole one first */
    RetexWebFile manifests[RETEX_WEB_SMALLER + 1];
    int count;
} Rooms;

static void close_rooms(Rooms *rooms)
{
    for (int i = 0; i < rooms->count; i++) {
        free(rooms->manifests[i].data);
        web_close(&rooms->webs[i]);
    }
}

/* Encode all of a room. smaller: what its manifest says of others; NULL = it is one of those. */
static int make_room(Web *web, RetexWebFile *manifest, const RetexSet *set, const RetexWebParams *params,
                     const json_t *smaller, int nthreads, RetexError *err)
{
    int code = RETEX_EUNSUPPORTED;
    for (size_t i = 0; i < sizeof SCALES / sizeof *SCALES && code == RETEX_EUNSUPPORTED; i++) {
        web_close(web);
        code = web_open(web, set, params, SCALES[i], nthreads, err);
    }
    if (code)
        return code;
    manifest->data = (unsigned char *)describe(web, smaller, err);
    if (!manifest->data)
        return RETEX_ENOMEM;
    manifest->bytes = strlen((char *)manifest->data);
    if (!smaller)
        retex_web_file_name(manifest, "room", "json");
    return RETEX_OK;
}

/* A smaller room, which the list of them gets. */
static int add_smaller(Rooms *rooms, json_t *list, const RetexSet *set, const RetexWebParams *params, int scale,
                       int nthreads, RetexError *err)
{
    const int i = rooms->count++;
    RetexSet *reduced = NULL;
    RetexWebParams plain = *params;
    plain.note = NULL;
    int code = retex_set_reduce(&reduced, set, scale, nthreads, err);
    if (!code)
        code = make_room(&rooms->webs[i], &rooms->manifests[i], reduced, &plain, NULL, nthreads, err);
    if (!code) {
        json_t *entry = describe_file(&rooms->manifests[i]);
        retex_json_put(&entry, "width", json_integer(reduced->width));
        retex_json_put(&entry, "height", json_integer(reduced->height));
        code = json_array_append_new(list, entry) ? no_memory(err) : RETEX_OK;
    }
    retex_set_close(&reduced);
    return code;
}

static void tell_room(const RetexWebParams *params, const Web *web, const RetexWebFile *manifest)
{
    char note[256];
    const RetexWebBytes bytes = count_bytes(web, manifest->bytes);
    snprintf(note, sizeof note, "smaller room, %dx%d: %zu bytes, %zu until the picture, %zu until the first target",
             web->set->width, web->set->height, bytes.all, bytes.still, bytes.first);
    if (params->note)
        params->note(params->note_context, note);
}

static int write_rooms(Rooms *rooms, const char *folder, RetexError *err)
{
    int count = 0, total = 0;
    for (int i = 0; i < rooms->count; i++)
        total += count_files(&rooms->webs[i]) + 1;
    RetexWebFile **files = malloc((size_t)total * sizeof *files);
    if (!files)
        return no_memory(err);
    for (int i = 0; i < rooms->count; i++) {
        for (int k = 0; k < count_files(&rooms->webs[i]); k++)
            files[count++] = file_at(&rooms->webs[i], k);
        if (i)
            files[count++] = &rooms->manifests[i];
    }
    const int code = retex_web_folder_write(folder, files, count, &rooms->manifests[0], err);
    free(files);
    return code;
}

static int check(const RetexWebParams *params, RetexError *err)
{
    if (params->quality < 1 || params->quality > 100)
        return retex_fail(err, RETEX_EINVAL, "quality is 1 to 100, not %d", params->quality);
    if (params->lamps < 1 || params->lamps > RETEX_PARAMETERS_MAX)
        return retex_fail(err, RETEX_EINVAL, "a page has 1 to %d lamps, not %d", RETEX_PARAMETERS_MAX, params->lamps);
    return RETEX_OK;
}

int retex_web_write(const RetexSet *set, const char *folder, const RetexWebParams *params, RetexWebBytes *bytes,
                    int nthreads, RetexError *err)
{
    RetexWebParams own = RETEX_WEB_INIT;
    Rooms rooms = {.count = 1};
    if (RETEX_PARAMS_COPY(&own, params, err))
        return RETEX_EINVAL;
    int code = check(&own, err);
    if (!code)
        code = retex_set_check_bare(set, "a page", err);
    if (code)
        return code;
    json_t *smaller = json_array();
    for (int k = 0; !code && k < RETEX_WEB_SMALLER && own.smaller[k]; k++)
        code = add_smaller(&rooms, smaller, set, &own, own.smaller[k], nthreads, err);
    if (!code)
        code = make_room(&rooms.webs[0], &rooms.manifests[0], set, &own, smaller, nthreads, err);
    if (!code)
        code = write_rooms(&rooms, folder, err);
    if (!code && bytes)
        *bytes = count_bytes(&rooms.webs[0], rooms.manifests[0].bytes);
    if (!code)
        tell_lamps(&rooms.webs[0], &own);
    for (int i = 1; i < rooms.count && !code; i++)
        tell_room(&own, &rooms.webs[i], &rooms.manifests[i]);
    json_decref(smaller);
    close_rooms(&rooms);
    return code;
}
