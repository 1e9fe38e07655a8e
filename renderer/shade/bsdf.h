/* The BSDF of a surface at a point, split into what the albedo multiplies and what it does not:
 *
 *     f = d * albedo + i        (supplement 4.1; d, i >= 0)
 *
 * Lobes: Lambertian or Disney diffuse and retro-reflection, a GGX microfacet reflection, POV-Ray's highlights, a
 * mirror, smooth or rough transmission, and straight passage through a surface that does not refract; over these a
 * clear coat and sheen. Directions point away from the surface; wo is where the path came from. Cosines are about the
 * shading normal.
 *
 * Where a `normal` of the scene tilts the surface (`bumped`), lobes are about the tilted normal, and what they would
 * send to the wrong side of the surface is mirrored at the surface, as it would go on from one side of a groove to the
 * other (like the mirroring facets of Schuessler et al. 2017, 'Microfacet-based Normal Mapping for Robust Monte Carlo
 * Path Tracing'). No energy is lost, and no mirrored or refracted ray is.
 *
 * Choices among lobes never look at a texture: they take NEUTRAL_ALBEDO in its place, so that a set, a plain render
 * and a render with replaced textures trace the same paths. Opacity (filter, transmit, image alpha) counts as
 * geometry and is looked at. */
#ifndef RENDERER_SHADE_BSDF_H
#define RENDERER_SHADE_BSDF_H

#include "base/vec.h"
#include "shade/coating.h"
#include "shade/split.h"

/* One of POV-Ray's highlights: amount (cosine)^exponent, of what a light source of colour 1 is seen as. */
typedef struct Highlight {
    float amount;            /* 0: there is none */
    float exponent;
    float p;                 /* of sampling it, within p_glossy */
} Highlight;

typedef struct Bsdf {
    Vec3 normal;             /* shading normal on wo's side */
    Vec3 geometric;          /* geometric normal on wo's side */
    Vec3 wo;
    double cos_o;            /* dot(wo, normal), > 0 */
    float eta;               /* index of refraction on the far side over that on wo's side */
    float bend;              /* what directions are refracted by: eta, but for dispersion */
    int refracts;            /* transmission bends */
    int lambert;             /* only diffuse lobes, of brilliance 1: fields after alpha are not set */
    int bumped;              /* normal is that of bumps; then lambert is 0 */
    int hidden;              /* bumps face away from wo: normal is that of the opposite slope, which wo sees */
    int tilted;              /* bsdf_tilt_diffuse: hidden, as the diffuse lobes alone have a normal of their own */
    Vec3 diffuse_normal;     /* where hidden: of the diffuse lobes, for which it does not matter who looks */
    Vec3 flat_normal;        /* where tilted: what diffuse_normal would be */
    float p_diffuse, p_back, p_glossy, p_mirror, p_passing; /* of sampling a lobe; with those below and of the coating
                                                             * the sum is 1, or 0: nothing scatters */

    float diffuse, diffuse_back;
    int disney;              /* diffuse lobe with retro-reflection, Fresnel of the supplement's Eq. 1 */
    float subsurface;        /* light that goes in and comes out elsewhere */
    float p_subsurface;      /* of sampling it */
    float transmission;
    Split passing;           /* weight of straight or smoothly refracted passage, already at cos_o */
    float alpha;             /* GGX of disney; 0 = no microfacet lobe, or a smooth one that counts as mirror */

    Vec3 s, t;               /* with normal the frame of the microfacet lobe */
    float brilliance;
    float metallic, roughness, specular_tint, coat_eta; /* disney */
    float coverage;          /* disney: share of the surface that is there, where an image cuts holes */
    float highlights;        /* the most that they reflect; 0: there are none */
    Highlight blinn, phong;  /* `specular`: of the half vector and the normal; `phong`: of light and mirror direction */
    float highlight_metallic; /* the share that is tinted by the pigment */
    int highlight_lights_only; /* highlights reflect light sources only: the mirror lobe reflects all else */
    float grain;             /* `crand`: taken off the diffuse lobe */
    float irid;              /* thin film: reflected light times 1 + irid cos(irid_phase (cos_i + cos_o)) */
    Rgb irid_phase;
    int smooth;              /* disney with roughness about 0: its reflection and transmission are deltas */
    Split mirror;            /* weight of the mirror lobe, already at cos_o */
    Coating coating;           /* disney: coat and sheen; what they let through multiplies the weights above */
} Bsdf;

typedef struct BsdfSample {
    Vec3 wi;
    Split weight;            /* f |cos| / (probability density), with the probability of the lobe */
    float pdf;               /* per solid angle, of all non-delta lobes together; 0 for a delta */
    int transmitted;         /* wi is on the other side */
    int straight;            /* passed without bending: the same ray goes on */
    int subsurface;          /* goes in along wi, to come out elsewhere */
} BsdfSample;

/* What light comes from. */
typedef enum BsdfLight {
    BSDF_ANY_LIGHT,          /* what paths may meet: other surfaces and the sky */
    BSDF_LIGHT_SOURCE,       /* one of POV-Ray's light sources, which no path can hit */
    BSDF_SHADOWLESS          /* such a one without shadows: it has no highlights */
} BsdfLight;

/* f |cos_i| for a given direction. *pdf gets the density with which bsdf_sample would find wi (0 where it never
 * does). */
Split bsdf_eval(const Bsdf *bsdf, Vec3 wi, BsdfLight light, float *pdf);
/* Returns 0 where nothing is scattered. */
int bsdf_sample(const Bsdf *bsdf, float u_lobe, float u1, float u2, BsdfSample *sample);

/* Tilt the diffuse lobes to a normal of their own, and no other ones: from the flat normal a highlight would go to
 * another place, which no sum of some tilted ones gives. */
void bsdf_tilt_diffuse(Bsdf *bsdf, Vec3 normal);

/* Weight of the delta lobes of an opaque surface that reflect along wi, where they are sampled with probability *p:
 * directions whose squared difference is below `tolerance` are the same. 0 and 0 where there is none. */
Split bsdf_delta(const Bsdf *bsdf, Vec3 wi, double tolerance, float *p);

/* A direction in which light goes below the surface. */
Vec3 bsdf_enter(const Bsdf *bsdf, float u1, float u2);

/* The GGX alpha that is as wide as the sharpest highlight; 0 where there is none. */
float bsdf_highlight_alpha(const Bsdf *bsdf);
/* The factor of a thin film on reflected light. */
Rgb bsdf_irid(const Bsdf *bsdf, float cos_i);

/* Of the surface, whoever looks: where bumps face away from wo, so does it. */
static inline Vec3 bsdf_surface_normal(const Bsdf *b)
{
    return b->bumped && b->hidden ? b->diffuse_normal : b->normal;
}

/* The same of what lies over the diffuse lobes. */
static inline Vec3 bsdf_coated_normal(const Bsdf *b)
{
    return b->bumped && b->tilted ? b->flat_normal : bsdf_surface_normal(b);
}

/* Probability of the lobes that are no deltas. */
static inline float bsdf_wide_probability(const Bsdf *b)
{
    const float p = b->p_diffuse + b->p_back + b->p_glossy;
    if (b->lambert || !b->coating.present)
        return p;
    return p + b->coating.sheen.p + (b->coating.coat.alpha > 0 ? b->coating.coat.p : 0);
}

/* No lobe but a delta sends light through. */
static inline int bsdf_only_reflects(const Bsdf *b)
{
    return b->diffuse_back <= 0 && !(b->disney && b->transmission > 0);
}

#endif
