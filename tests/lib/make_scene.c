/* make_scene SEED: prints a random scene of several shapes, finishes, lights and cameras. These can be targets: Floor
 * and Floor2, two textures that are the same and meet on one surface; Thing; Metal. Numbers that -D may give:
 *     Size    scene and camera are so many times as large
 *     Bright  all light is so many times as bright
 *     Mirror  -1: everything, and what the camera looks at, is mirrored at x = 0, so the picture from left to right
 * Something moves with the clock. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lib_random_texture.h"
#include "lib_test.h"

static uint32_t state;

/* Prints a text with a random number in the place of each `LOW HIGH`. */
static void say(const char *text)
{
    while (*text) {
        if (*text != '`') {
            putchar(*text++);
            continue;
        }
        char *end;
        const double low = strtod(text + 1, &end), high = strtod(end, &end);
        printf("%.4f", low + (high - low) * test_random(&state));
        text = end + 1;
    }
    putchar('\n');
}

static void say_finish(void)
{
    char text[1024] = "";
    random_finish(text, 1);
    random_normal(text);
    char *turbulence = strstr(text, "turbulence .5"); /* of the place in the world, as in POV-Ray: it is not mirrored */
    if (turbulence)
        memcpy(turbulence, "turbulence 0.", strlen("turbulence 0."));
    puts(text);
}

/* What textures are made of: two and two the same, for a target that is split. */
static void say_textures(void)
{
    const char *pigment =
        PICK("rgb <`.1 .9`, `.1 .9`, `.1 .9`>", "checker rgb <`.1 .9`, `.1 .9`, .2> rgb .6 scale `.2 1`",
             "gradient x color_map { [0 rgb `0 .9`] [1 rgb <.8, `0 .9`, .1>] }",
             "bozo color_map { [0 rgb <.1, .2, `0 .9`>] [1 rgb `.5 .9`] } scale `.2 1`");
    const uint32_t numbers = state, picks = pick_state;
    for (int k = 0; k < 2; k++) {
        state = numbers, pick_state = picks;
        printf("#declare Floor%s = texture { pigment {", k ? "2" : "");
        say(pigment);
        puts("}");
        say_finish();
        puts("}");
    }
    say("#declare Thing = texture { pigment { rgb <`.05 .95`, `.05 .95`, `.05 .95`> }");
    say_finish();
    say("} #declare Metal = texture { pigment { rgb <`.3 .9`, `.3 .9`, `.3 .9`> }");
    say(PICK("finish { retex { metallic `.2 1` roughness `.05 1` } }", "finish { retex { roughness `.1 1` ior 1.5 } }",
             "finish { diffuse .7 }", "finish { diffuse `0 .3` reflection { .5 metallic } }"));
    say("} #declare Other = texture { pigment { rgb <`.05 .95`, `.05 .95`, `.05 .95`> }");
    say_finish();
    puts("} #declare Glass = texture { pigment { rgbf <.95, .98, .9, 1> } finish { reflection { 0, 1 fresnel } } }");
}

static void say_form(void)
{
    say(PICK("sphere { 0, 1", "box { -.8, .8", "cone { -y, 1, y, `0 1` open", "cylinder { -y, y, `.3 .9`",
             "torus { .8, `.1 .5`", "superellipsoid { <`.2 1.5`, `.2 1.5`>",
             "difference { sphere { 0, 1 } box { 0, 2 }", "merge { sphere { 0, .8 } cylinder { -1.2*y, 1.2*y, .3 }",
             "disc { 0, y, 1, `0 .5`", "intersection { box { -.9, .9 } sphere { 0, 1.1 }",
             "lathe { cubic_spline 6, <0,-1>, <.3,-.8>, <1,-.3>, <.4,.2>, <.7,.9>, <0,1.2>",
             "prism { -.5, .5, 5, <-1,-1>, <1,-.8>, <.2,0>, <.5,1>, <-1,-1>",
             "blob { threshold .6 sphere { <-.5,0,0>, 1, 1 } cylinder { -y, <0,1,.3>, .5, 1 }", "ovus { .6, .4",
             "quadric { <1,1,1>, <0,.2,0>, <0,0,.3>, -.4",
             "mesh { triangle { <-1,-1,0>, <1,-1,0>, <0,1,.5> } triangle { <-1,-1,0>, <1,-1,0>, <0,0,-1> }",
             "height_field { function 9, 9 { .5 + .3*sin(9*x)*cos(7*y) } translate -.5 scale 1.5"));
}

static void say_object(int moves)
{
    say_form();
    say(PICK("scale `.3 .8`", "scale <`.2 .8`, `.2 .8`, `.2 .8`>",
             "scale `.3 .7` matrix <1,`0 .5`,0, 0,1,0, `0 .5`,0,1, 0,0,0>"));
    say("rotate <`0 360`, `0 360`, `0 360`> translate <`-2 2`, `.2 2`, `-1 2.5`>");
    if (moves)
        say("translate clock*`-1 1`*x");
    say(moves ? "texture { Thing }"
              : PICK("texture { Thing }", "texture { Metal }", "texture { Other }", "texture { Floor }",
                     "texture { Glass } interior { ior `1.2 1.8` }"));
    puts("transform { Place } }");
}

/* The colour of light. */
#define LIGHT " rgb <`.2 1`, `.2 1`, `.2 1`>*Bright"

static void say_light(void)
{
    say(PICK("light_source { <`-2 2`, `2.2 2.8`, `-3 2`>," LIGHT,
             "light_source { <`-2 2`, 2.7, `-2 1`>, " LIGHT "*3 fade_distance Size*`.5 2` fade_power 2",
             "light_source { <`-2 2`, 2.8, `-3 0`>, " LIGHT "*2 spotlight radius `10 30` falloff 45 point_at <0, 0, 1>",
             "light_source { <`-5 5`, 6, -9>," LIGHT " parallel point_at 0",
             "light_source { <`-2 2`, 2.7, `-2 1`>," LIGHT " area_light `.2 1`*x, `.2 1`*z, 4, 4 adaptive 1 jitter"));
    puts("transform { Place } }");
}

static void say_lights(void)
{
    const int lights = 1 + pick(3);
    for (int k = 0; k < lights; k++)
        say_light();
    if (pick(2)) {
        say(PICK("#declare Bulb = sphere { <`-2 2`, `1 2.5`, `-1 2`>, `.1 .4`",
                 "#declare Bulb = box { <-.5, 2.8, -.5>, <`0 .5`, 2.9, `0 .5`>",
                 "#declare Bulb = disc { <`-2 2`, 2.8, `-1 2`>, -y, `.2 .6`"));
        say("pigment { rgb 1 } finish { diffuse 0 emission " LIGHT "*4 } transform { Place } } object { Bulb }");
    }
    say(PICK("", "background {" LIGHT "*.3 }",
             "sky_sphere { pigment { gradient y color_map { [0" LIGHT "*.2] [1" LIGHT "] } } }"));
    if (pick(5) == 0)
        say("fog { distance Size*`8 30`" LIGHT "*.3 }");
}

static void say_room(void)
{
    puts("plane { y, 0 texture { Floor } clipped_by { plane { x, 0 } } transform { Place } }");
    puts("plane { y, 0 texture { Floor2 } clipped_by { plane { -x, 0 } } transform { Place } }");
    if (pick(2))
        say("box { <-3, 0, 3>, <3, 3, 3.1> texture { Other } transform { Place } }");
    if (pick(2))
        say("box { <-3.1, 0, -3>, <-3, 3, 3> texture { Thing } transform { Place } }");
    if (pick(3) == 0)
        say("box { <-3, 3, -5>, <3, 3.1, 3> texture { Other } transform { Place } }");
}

static void say_camera(void)
{
    say("#declare Eye = <Mirror*`-1.5 1.5`, `.8 2.2`, `-4.5 -3.5`>*Size;");
    say("#declare Aim = <Mirror*`-.3 .3`, `.5 1.2`, .5>*Size;");
    say(PICK("camera { location Eye right 4/3*x up y look_at Aim angle `40 80` }",
             "camera { location Eye right 4/3*x up y look_at Aim angle `40 80` }",
             "camera { orthographic location Eye right Size*4*x up Size*3*y look_at Aim }",
             "camera { location Eye right 4/3*x up y look_at Aim angle 55 aperture Size*`.05 .4` blur_samples 9 "
             "focal_point Aim }",
             "camera { ultra_wide_angle location Eye right 4/3*x up y look_at Aim angle `80 110` }",
             "camera { fisheye location Eye right 4/3*x up y look_at Aim angle `90 150` }"));
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    pick_state = state = (uint32_t)strtoul(argv[1], NULL, 10) * 2654435761u + 1;
    puts("#version 3.7; global_settings { assumed_gamma 1 } #default { finish { ambient 0 } }\n"
         "#ifndef (Size) #declare Size = 1; #end\n"
         "#ifndef (Bright) #declare Bright = 1; #end\n"
         "#ifndef (Mirror) #declare Mirror = 1; #end\n"
         "#declare Place = transform { scale <Mirror, 1, 1>*Size }");
    say_camera();
    say_textures();
    say_room();
    say_lights();
    const int objects = 2 + pick(5);
    for (int k = 0; k < objects; k++)
        say_object(k == 0);
    return 0;
}
