/* See lib_random_texture.h. */
#include "lib_random_texture.h"

#include <string.h>

uint32_t pick_state;

int pick(int count)
{
    pick_state = pick_state * 1664525u + 1013904223u;
    return (int)((pick_state >> 8) % (uint32_t)count);
}

const char *pick_one(const char **list, int count)
{
    return list[pick(count)];
}

void add_text(char *text, const char *more)
{
    strcat(text, more);
    strcat(text, " ");
}

void random_finish(char *text, int rough)
{
    add_text(text, "finish {");
    add_text(text, PICK("diffuse 0", "diffuse .6", "diffuse 1", "diffuse .5, .5", "diffuse 1, 1", "diffuse albedo .8",
                        "diffuse albedo 1, 1"));
    add_text(text, PICK("", "brilliance 4", "brilliance .5", "brilliance 0"));
    add_text(text, PICK("", "", "crand .3"));
    add_text(text, PICK("", "specular .3", "specular 1", "specular albedo 1", "specular albedo .4"));
    add_text(text, rough ? PICK("roughness .05", "roughness .3", "roughness 1")
                         : PICK("roughness .0005", "roughness .05", "roughness 1"));
    add_text(text, PICK("", "phong .3", "phong 1", "phong albedo 1", "phong albedo .4"));
    add_text(text,
             rough ? PICK("phong_size 1", "phong_size 5") : PICK("phong_size 1", "phong_size 40", "phong_size 500"));
    add_text(text, PICK("", "metallic", "metallic .5"));
    add_text(text, PICK("", "", "reflection .3", "reflection 1", "reflection rgb <1,.2,.1>", "reflection { 1 fresnel }",
                        "reflection { .2, 1 falloff 3 metallic }", "reflection { .5 exponent .3 metallic .5 }",
                        "reflection { 0, 1 fresnel exponent 2 }"));
    add_text(text, PICK("", "conserve_energy"));
    add_text(text, PICK("", "", "irid { .35 thickness .5 turbulence .5 }", "irid { 1 thickness 2 }"));
    if (!rough && pick(5) == 0)
        add_text(text, PICK("retex { metallic 1 roughness .5 }", "retex { transmission 1 ior 1.3 }",
                            "retex { transmission 1 roughness .5 ior 1.5 }", "retex { metallic 1 roughness .01 }",
                            "retex { metallic 1 roughness .4 clearcoat 1 clearcoat_roughness .3 }",
                            "retex { metallic 1 clearcoat .7 sheen rgb 1 sheen_roughness .5 }",
                            "retex { transmission 1 roughness .3 clearcoat 1 sheen rgb <1,.5,.2> }"));
    add_text(text, PICK("", "", "use_alpha"));
    add_text(text, "}");
}

void random_normal(char *text)
{
    add_text(text,
             PICK("", "normal { bumps 3 }", "normal { dents 2 }", "normal { granite 1 }", "normal { wrinkles 4 }"));
}
