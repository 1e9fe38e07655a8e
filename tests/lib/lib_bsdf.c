/* See lib_bsdf.h. */
#include "lib_bsdf.h"

#include "path/sampler.h"

int test_bsdf_sample(const Bsdf *b, uint32_t sequence, int k, BsdfSample *s)
{
    Sampler sampler = sampler_start(sequence, 0, 0, 0);
    float u, v, lobe, rest;
    sampler.sample = (uint32_t)k;
    sampler_pair(&sampler, 0, &u, &v);
    sampler_pair(&sampler, 1, &lobe, &rest);
    return bsdf_sample(b, lobe, u, v, s);
}
