/* media and density: what fills the air, and objects. */
#include "medium/medium.h"
#include "sdl/medium/interior.h"

enum { DENSITIES_MAX = 64 };

/* ---- density ---- */

/* A pigment whose colours are factors; white where it has none. */
const ParsedPigment *parse_density(Sdl *sdl)
{
    ParsedPigment *white = pigment_new(sdl, NULL);
    white->pigment.color = (Rgbft){1, 1, 1, 0, 0};
    sdl_expect(sdl, "{");
    return parse_pigment_body(sdl, white, '}');
}

static void add_density(Sdl *sdl, ParsedMedium *medium, const ParsedPigment *density)
{
    Medium *m = &medium->medium;
    const Rgb most = density_bound(&density->pigment);
    gaps_join(&medium->gaps, &density->gaps);
    if (density->pigment.kind == PIGMENT_COLOR) {
        medium->constant = rgb_mul(medium->constant, most);
        return;
    }
    if (m->ndensities == DENSITIES_MAX)
        sdl_error(sdl, "a medium has at most %d densities", DENSITIES_MAX);
    const Pigment **densities = sdl_alloc(sdl, (size_t)(m->ndensities + 1) * sizeof *densities);
    for (int k = 0; k < m->ndensities; k++)
        densities[k] = m->densities[k];
    densities[m->ndensities++] = &density->pigment;
    m->densities = densities;
    m->most = rgb_mul(m->most, rgb(not_negative(most.r), not_negative(most.g), not_negative(most.b)));
}

/* ---- media ---- */

/* Infinite and negative coefficients have no meaning. */
static Rgb coefficients(Sdl *sdl)
{
    const Rgbft c = sdl_color(sdl);
    if (!(c.r >= 0 && c.g >= 0 && c.b >= 0))
        sdl_warn(sdl, "media take no light below 0: it is 0");
    return rgb(at_most(not_negative(c.r), 1e9f), at_most(not_negative(c.g), 1e9f), at_most(not_negative(c.b), 1e9f));
}

static void parse_scattering(Sdl *sdl, Medium *medium)
{
    sdl_expect(sdl, "{");
    const double type = sdl_float(sdl);
    if (!(type >= PHASE_ISOTROPIC && type < PHASE_HENYEY_GREENSTEIN + 1))
        sdl_error(sdl, "scattering of type %g: there are 1 to 5", type);
    medium->phase = (PhaseKind)type;
    sdl_optional_comma(sdl);
    medium->scattering = coefficients(sdl);
    medium->eccentricity = 0, medium->extinction = 1;
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "eccentricity"))
            medium->eccentricity = fmax(-0.9999, fmin(0.9999, sdl_float(sdl)));
        else if (sdl_accept(sdl, "extinction"))
            medium->extinction = fmax(0, fmin(1e9, sdl_float(sdl)));
        else
            sdl_expected(sdl, "eccentricity, extinction or }");
        sdl_optional_comma(sdl);
    }
}

/* How POV-Ray marches through media. */
static int accept_quality(Sdl *sdl)
{
    static const char *const words[] = {"intervals",    "samples",  "confidence", "variance", "ratio", "method",
                                        "aa_threshold", "aa_level", "jitter",     "collect",  NULL};
    for (int k = 0; words[k]; k++)
        if (sdl_accept(sdl, words[k])) {
            sdl_optional_bool(sdl, 1);
            if (k == 1) {
                sdl_optional_comma(sdl);
                optional_float(sdl, 0);
            }
            return 1;
        }
    return 0;
}

static const Pigment *moved(Sdl *sdl, const Pigment *density, const Transform *by)
{
    ParsedPigment *copy = sdl_alloc(sdl, sizeof *copy);
    *copy = *parsed_pigment(density);
    copy->pigment.transform = transform_then(copy->pigment.transform, *by);
    return &copy->pigment;
}

static void medium_move(Sdl *sdl, Medium *medium, const Transform *by)
{
    const Pigment **densities = sdl_alloc(sdl, (size_t)(medium->ndensities + 1) * sizeof *densities);
    for (int k = 0; k < medium->ndensities; k++)
        densities[k] = moved(sdl, medium->densities[k], by);
    medium->densities = densities;
}

static void media_item(Sdl *sdl, ParsedMedium *medium)
{
    Medium *m = &medium->medium;
    Transform by;
    const ParsedMedium *known = accept_ident_of_word(sdl, "media");
    if (known)
        *medium = *known, m->next = NULL;
    else if (sdl_accept(sdl, "absorption"))
        m->absorption = coefficients(sdl);
    else if (sdl_accept(sdl, "emission"))
        m->emission = coefficients(sdl);
    else if (sdl_accept(sdl, "scattering"))
        parse_scattering(sdl, m);
    else if (sdl_accept(sdl, "density"))
        add_density(sdl, medium, parse_density(sdl));
    else if (accept_transform(sdl, &by))
        medium_move(sdl, m, &by);
    else if (!accept_quality(sdl))
        sdl_expected(sdl, "absorption, emission, scattering, density, a transform or } in media");
}

ParsedMedium *parse_media(Sdl *sdl)
{
    ParsedMedium *medium = sdl_alloc(sdl, sizeof *medium);
    medium->medium.phase = PHASE_ISOTROPIC, medium->medium.extinction = 1;
    medium->medium.most = medium->constant = rgb_grey(1);
    statement_begin(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}"))
        media_item(sdl, medium), sdl_optional_comma(sdl);
    statement_end(sdl);
    return medium;
}

const Medium *media_with(Sdl *sdl, const Medium *list, const ParsedMedium *added)
{
    ParsedMedium *first = sdl_alloc(sdl, sizeof *first);
    Medium *m = &first->medium;
    *first = *added;
    m->absorption = rgb_mul(m->absorption, first->constant);
    m->emission = rgb_mul(m->emission, first->constant);
    m->scattering = rgb_mul(m->scattering, first->constant);
    m->next = list;
    return m;
}

/* ---- media in objects ---- */

int interior_varies(const ParsedInterior *interior)
{
    for (const Medium *m = interior ? interior->interior.media : NULL; m; m = m->next)
        if (m->ndensities > 0)
            return 1;
    return 0;
}

const ParsedInterior *interior_moved(Sdl *sdl, const ParsedInterior *interior, const Transform *by)
{
    if (!interior_varies(interior) || transform_is_identity(by))
        return interior;
    ParsedInterior *copy = sdl_alloc(sdl, sizeof *copy);
    const Medium *const all = interior->interior.media;
    const Medium **end = &copy->interior.media;
    *copy = *interior;
    for (const Medium *m = all; m; m = m->next) {
        ParsedMedium *medium = sdl_alloc(sdl, sizeof *medium);
        *medium = *parsed_medium(m);
        medium_move(sdl, &medium->medium, by);
        *end = &medium->medium;
        end = &medium->medium.next;
    }
    return copy;
}

/* ---- at the end of reading ---- */

static void load_densities(Sdl *sdl, const Medium *media)
{
    for (; media; media = media->next) {
        gaps_report(sdl, &parsed_medium(media)->gaps);
        for (int k = 0; k < media->ndensities; k++)
            load_pigment_images(sdl, media->densities[k], 1);
    }
}

void complete_media(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    const Interior *last = NULL;
    load_densities(sdl, scene->media);
    scene->has_media = scene->media != NULL;
    for (int i = 0; i < scene->nprimitives; i++) {
        const Interior *in = scene->primitives[i].interior;
        if (!in || in == last || !in->media)
            continue;
        last = in;
        scene->has_media = 1;
        load_densities(sdl, in->media);
    }
}
