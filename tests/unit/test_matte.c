/* The kernels for matte surfaces, a packet at a time, give the same bits as lights, BSDF and rays one by one, with and
 * without vector instructions. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include "lib_plain.h"
#include "shade/bsdf.h"

static double uniform(void)
{
    return rand() / (RAND_MAX + 1.0);
}

static Vec3 anywhere(double size)
{
    return vec3(size * (2 * uniform() - 1), size * (2 * uniform() - 1), size * (2 * uniform() - 1));
}

static void fill(MattePacket *p, double size)
{
    p->count = MATTE_LANES;
    for (int k = 0; k < MATTE_LANES; k++) {
        Vec3 normal = vec_normalize(anywhere(1)), geometric = vec_normalize(vec_mad(normal, anywhere(1), 0.3));
        matte_set(&p->position, k, anywhere(size));
        matte_set(&p->normal, k, normal);
        matte_set(&p->geometric, k, k % 3 ? normal : geometric);
        matte_set(&p->corner, k, anywhere(size));
        matte_set(&p->edge1, k, anywhere(1));
        matte_set(&p->edge2, k, anywhere(1));
        matte_set(&p->face_normal, k, vec_normalize(anywhere(1)));
        p->density[k] = 10 * uniform();
        p->pick_probability[k] = (float)uniform(), p->diffuse[k] = (float)uniform();
        p->along[k] = (float)(rand() % 1024) / 1024, p->across[k] = (float)(rand() % 1024) / 1024;
        p->direction_u[k] = (float)(rand() % 1024) / 1024, p->direction_v[k] = (float)(rand() % 1024) / 1024;
    }
}

static Bsdf lambert(const MattePacket *p, int k)
{
    return (Bsdf){.lambert = 1,
                  .p_diffuse = 1,
                  .diffuse = p->diffuse[k],
                  .normal = matte_get(&p->normal, k),
                  .geometric = matte_get(&p->geometric, k)};
}

static void assert_same(Vec3 a, Vec3 b)
{
    assert_true(a.x == b.x && a.y == b.y && a.z == b.z);
}

static int bounce_is_sample(const MattePacket *p, const MatteBounces *bounces, int k)
{
    Bsdf b = lambert(p, k);
    BsdfSample sample;
    int found = bsdf_sample(&b, 0.7f, p->direction_u[k], p->direction_v[k], &sample);
    assert_int_equal(bounces->found[k], found);
    if (!found)
        return 0;
    Vec3 wi = matte_get(&bounces->direction, k);
    assert_same(wi, sample.wi);
    assert_same(matte_get(&bounces->origin, k), accel_offset(matte_get(&p->position, k), b.geometric, wi));
    assert_true(bounces->pdf[k] == sample.pdf);
    return 1;
}

/* By the surface's own functions. */
static int light_is_sample(const MattePacket *p, const MatteLights *lights, int k)
{
    MeshLightFace face = {.corner = matte_get(&p->corner, k),
                          .edge1 = matte_get(&p->edge1, k),
                          .edge2 = matte_get(&p->edge2, k),
                          .normal = matte_get(&p->face_normal, k)};
    Bsdf b = lambert(p, k);
    Vec3 position = matte_get(&p->position, k), wi = matte_get(&lights->direction, k);
    Surface surface;
    float pdf;
    mesh_light_surface(&(MeshLightPoint){&face, p->along[k], p->across[k], 1}, NULL, &surface);
    Vec3 d = vec_sub(surface.position, position);
    double distance = vec_length(d), facing = vec_dot(wi, face.normal);
    Split f = bsdf_eval(&b, wi, 0, &pdf);
    assert_same(wi, vec_scale(d, 1 / distance));
    assert_int_equal(lights->found[k], f.d.r > 0);
    if (!lights->found[k])
        return 0;
    assert_same(matte_get(&lights->origin, k), accel_offset(position, b.geometric, wi));
    assert_int_equal(lights->behind[k], facing > 0);
    assert_true(lights->value[k] == f.d.r);
    double light_pdf = p->density[k] * distance * distance / fabs(facing) * p->pick_probability[k];
    double weight = light_pdf / (light_pdf * light_pdf + (double)pdf * pdf);
    assert_true(fabs(lights->weight[k] - weight) < 1e-5 * weight);
    assert_true(lights->length[k] >= 0 && lights->length[k] < distance);
    return 1;
}

static void lanes_are_single_surfaces(void **state)
{
    (void)state;
    int bounced = 0, lit = 0;
    for (int n = 0; n < 500; n++) {
        MattePacket p;
        MatteLights lights, lights_plain;
        MatteBounces bounces, bounces_plain;
        memset(&lights, 0, sizeof lights), memset(&lights_plain, 0, sizeof lights);
        memset(&bounces, 0, sizeof bounces), memset(&bounces_plain, 0, sizeof bounces);
        fill(&p, n % 2 ? 1 : 100);
        matte_lights(&lights, &p);
        matte_lights_plain(&lights_plain, &p);
        assert_memory_equal(&lights, &lights_plain, sizeof lights);
        matte_bounces(&bounces, &p);
        matte_bounces_plain(&bounces_plain, &p);
        assert_memory_equal(&bounces, &bounces_plain, sizeof bounces);
        for (int k = 0; k < MATTE_LANES; k++) {
            bounced += bounce_is_sample(&p, &bounces, k);
            lit += light_is_sample(&p, &lights, k);
        }
    }
    assert_true(bounced > 6000 && lit > 2000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lanes_are_single_surfaces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
