/* Scripts for Blender and Nuke. See compositor.h.
 *
 * The graph is the polynomial of layout paper: the sum over terms of radiance times the texture at each of the term's
 * hits. A hit's texture is what the program's own UV node makes of the hit's mean UV. The hit's spread chooses between
 * the texture and a soft copy of it, of which alone further hits are made: they see much of it at once. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/compositor.h"

/* Of the soft copy: its size in pixels, and how far it is blurred, as a standard deviation in UV. */
#define SOFT_SIZE 64
#define SOFT_SIGMA 0.0625

/* Terms whose radiance is black everywhere have no layer. The target is edited, so that corrections count in full, and
 * the picture as rendered does not; light of single lamps is in the others' as well. */
static int is_used(const RetexSet *set, const RetexTerm *term)
{
    return term->role != RETEX_ROLE_PICTURE && retex_set_term_lamp(set, term) < 0 &&
           retex_set_is_layer(set, term->radiance);
}

static int hit_is_used(const RetexSet *set, int footprint)
{
    const RetexTerm *term;
    for (int i = 0; (term = retex_set_term(set, i)); i++)
        for (int k = 0; k < term->nfactors && is_used(set, term); k++)
            if (term->factors[k].kind == RETEX_FACTOR_FOOTPRINT && term->factors[k].index == footprint)
                return 1;
    return 0;
}

static int part_is_used(const RetexSet *set, int part)
{
    const RetexTerm *term;
    const RetexFootprint *footprint;
    int used = 0;
    for (int i = 0; (term = retex_set_term(set, i)); i++)
        used |= term->radiance == part && is_used(set, term);
    for (int i = 0; (footprint = retex_set_footprint(set, i)); i++)
        used |= (footprint->uv == part || footprint->spread == part) && hit_is_used(set, i);
    return used && retex_set_is_layer(set, part);
}

static const char *name_of(const RetexSet *set, int part)
{
    return retex_set_part(set, part)->name;
}

/* "" where the spread has no layer. */
static const char *spread_of(const RetexSet *set, int footprint)
{
    const int part = retex_set_footprint(set, footprint)->spread;
    return part >= 0 && retex_set_is_layer(set, part) ? name_of(set, part) : "";
}

static int is_of_full_size(const RetexSet *set, int footprint)
{
    const RetexPart *uv = retex_set_part(set, retex_set_footprint(set, footprint)->uv);
    return uv && retex_set_scale(set, &uv->image) == 1;
}

int compositor_check(const RetexSet *set, const char *path, RetexError *err)
{
    const RetexSetInfo info = retex_set_info(set);
    const RetexTerm *term;
    if (strcmp(info.layout, "paper") != 0 || info.ntargets != 1)
        return retex_fail(err, RETEX_EUNSUPPORTED,
                          "%s has %d target%s in layout %s: scripts rebuild sets of one target in layout paper", path,
                          info.ntargets, info.ntargets == 1 ? "" : "s", info.layout);
    for (int i = 0; (term = retex_set_term(set, i)); i++) {
        int sound = 1;
        for (int k = 0; k < term->nfactors && sound; k++) {
            const int index = term->factors[k].index;
            if (term->factors[k].kind == RETEX_FACTOR_PARAMETER)
                sound = retex_set_parameter(set, index)->kind == RETEX_PARAMETER_CORRECTION;
            else
                sound = term->factors[k].kind == RETEX_FACTOR_FOOTPRINT && is_of_full_size(set, index);
        }
        if (!sound)
            return retex_fail(err, RETEX_EUNSUPPORTED, "%s has terms that no script rebuilds: take the set as rendered",
                              path);
    }
    return RETEX_OK;
}

/* Of the target's axes, which have places outside of 0 to 1: there the texture repeats. */
static int repeats(const RetexTarget *target, int axis)
{
    return target->uv_min[axis] < 0 || target->uv_max[axis] > 1;
}

/* ---- Blender ---- */

/* A text as a literal of Python. Names of files are bytes; control characters are escaped. */
static void print_python(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c < ' ' || c == '"' || c == '\\' || c == 127)
            fprintf(out, "\\x%02x", c);
        else
            fputc(c, out);
    }
    fputc('"', out);
}

static const char *const blender_code =
    "\n"
    "given = sys.argv[sys.argv.index(\"--\") + 1:] if \"--\" in sys.argv else []\n"
    "texture = given[0] if given else TEXTURE\n"
    "scene = bpy.context.scene\n"
    "scene.use_nodes = True\n"
    "scene.render.resolution_x, scene.render.resolution_y = SIZE\n"
    "scene.render.resolution_percentage = 100\n"
    "tree = scene.node_tree\n"
    "tree.nodes.clear()\n"
    "\n"
    "\n"
    "def node(kind, x, y, *inputs, **values):\n"
    "    \"\"\"A node at column x and row y; inputs are sockets or, for no link, None.\"\"\"\n"
    "    made = tree.nodes.new(\"CompositorNode\" + kind)\n"
    "    made.location = 220 * x, -260 * y\n"
    "    for name, value in values.items():\n"
    "        setattr(made, name, value)\n"
    "    for socket, given in zip(made.inputs, inputs):\n"
    "        if given is not None:\n"
    "            tree.links.new(given, socket)\n"
    "    return made\n"
    "\n"
    "\n"
    "def blend(kind, x, y, a, b, factor=None):\n"
    "    made = node(\"MixRGB\", x, y, factor, a, b, blend_type=kind)\n"
    "    made.inputs[0].default_value = 1\n"
    "    return made.outputs[0]\n"
    "\n"
    "\n"
    "def softness(row, spread):\n"
    "    \"\"\"How much of the soft copy a hit takes, 0 to 1, so that the variance is that of its spread.\"\"\"\n"
    "    apart = node(\"SeparateXYZ\", 1, row, spread)\n"
    "    squares = [node(\"Math\", 2, row + k / 2, o, o, operation=\"MULTIPLY\").outputs[0]\n"
    "               for k, o in enumerate(apart.outputs[:2])]\n"
    "    mean = node(\"Math\", 3, row, *squares, operation=\"ADD\").outputs[0]\n"
    "    share = node(\"Math\", 3, row + 0.5, mean, operation=\"DIVIDE\", use_clamp=True)\n"
    "    share.inputs[1].default_value = 2 * SOFT_SIGMA**2\n"
    "    return share.outputs[0]\n"
    "\n"
    "\n"
    "def mapped(x, y, image, place):\n"
    "    \"\"\"The image's colours in these places. What Map UV takes from outside of the image does not count.\"\"\"\n"
    "    there = node(\"MapUV\", x, y, image, place, alpha=0)\n"
    "    return node(\"PremulKey\", x + 1, y, there.outputs[0], mapping=\"PREMUL_TO_STRAIGHT\").outputs[0]\n"
    "\n"
    "\n"
    "def wrapped(x, y, uv):\n"
    "    \"\"\"Coordinates without their whole parts, on the axes that go beyond 0 to 1.\"\"\"\n"
    "    apart = node(\"SeparateXYZ\", x, y, uv)\n"
    "    axes = list(apart.outputs)\n"
    "    for axis in (0, 1):\n"
    "        if REPEATS[axis]:\n"
    "            axes[axis] = node(\"Math\", x + 1, y + axis / 2, axes[axis], operation=\"FRACT\").outputs[0]\n"
    "    return node(\"CombineXYZ\", x + 2, y, *axes).outputs[0]\n"
    "\n"
    "\n"
    "layers = node(\"Image\", 0, 0)\n"
    "layers.image = bpy.data.images.load(LAYERS)\n"
    "source = node(\"Image\", 0, -2, label=\"Texture\")\n"
    "if texture:\n"
    "    source.image = bpy.data.images.load(os.path.abspath(texture))\n"
    "else:\n"
    "    source.image = bpy.data.images.new(\"Texture\", 1024, 1024)\n"
    "    source.image.generated_type = \"COLOR_GRID\"\n"
    "soft = node(\"Blur\", 1, -2, source.outputs[0], filter_type=\"FAST_GAUSS\", use_relative=True,\n"
    "            factor_x=200 * SOFT_SIGMA, factor_y=200 * SOFT_SIGMA)\n"
    "size = source.image.size\n"
    "side = min(SOFT_SIZE, *size)\n"
    "soft = node(\"Scale\", 2, -2, soft.outputs[0], space=\"ABSOLUTE\")  # in the middle of what remains as large\n"
    "soft.inputs[1].default_value = soft.inputs[2].default_value = side\n"
    "left, low = (size[0] - side) // 2, (size[1] - side) // 2\n"
    "soft = node(\"Crop\", 3, -2, soft.outputs[0], use_crop_size=True, label=\"Soft copy\", min_x=left, max_x=left + "
    "side,\n"
    "            min_y=low + side, max_y=low)\n"
    "at = {}\n"
    "for row, (hit, uv, spread) in enumerate(HITS):\n"
    "    place = layers.outputs[uv]\n"
    "    if True in REPEATS:\n"
    "        place = wrapped(1, row + 1, place)\n"
    "    at[hit] = mapped(4, row + 1, soft.outputs[0], place)\n"
    "    if hit == 1:\n"
    "        share = softness(-1, layers.outputs[spread]) if spread else None\n"
    "        if share:  # Map UV skips places without the third coordinate, and is slow where they are far apart\n"
    "            apart = node(\"SeparateXYZ\", 1, -2, place)\n"
    "            is_sharp = node(\"Math\", 2, -2, share, operation=\"LESS_THAN\")\n"
    "            is_sharp.inputs[1].default_value = 1\n"
    "            place = node(\"CombineXYZ\", 3, -2, *apart.outputs[:2], is_sharp.outputs[0]).outputs[0]\n"
    "        sharp = mapped(4, -1, source.outputs[0], place)\n"
    "        at[hit] = blend(\"MIX\", 6, -1, sharp, at[hit], share) if share else sharp\n"
    "total = None\n"
    "for row, (layer, hits) in enumerate(TERMS):\n"
    "    light = layers.outputs[layer]\n"
    "    for column, hit in enumerate(hits):\n"
    "        light = blend(\"MULTIPLY\", 7 + column, row, light, at[hit])\n"
    "    total = light if total is None else blend(\"ADD\", 14, row, total, light)\n"
    "node(\"Composite\", 16, 0, total)\n"
    "node(\"Viewer\", 16, 1, total)\n"
    "if len(given) > 1:\n"
    "    output = node(\"OutputFile\", 16, 2, total, base_path=os.path.dirname(os.path.abspath(given[1])))\n"
    "    output.format.file_format = \"OPEN_EXR\"\n"
    "    output.format.color_mode = \"RGB\"\n"
    "    output.format.color_depth = \"32\"\n"
    "    output.file_slots[0].path = os.path.basename(given[1]) + \"-\"\n"
    "    bpy.ops.render.render()\n"
    "    os.replace(\"%s-%04d.exr\" % (os.path.abspath(given[1]), scene.frame_current), os.path.abspath(given[1]))\n";

static void print_blender(FILE *out, const RetexSet *set, const char *layers)
{
    const RetexSetInfo info = retex_set_info(set);
    const RetexTarget *target = retex_set_target(set, 0);
    const RetexFootprint *footprint;
    const RetexTerm *term;
    fprintf(out, "# Compositor nodes of Blender that retexture %s, by retex-info --blender.\n", target->name);
    fprintf(out, "# In Blender: open this file in the text editor and run it. From a shell:\n"
                 "#     blender -b --python THIS -- TEXTURE PICTURE.exr\n"
                 "import os\nimport sys\n\nimport bpy\n\nLAYERS = ");
    print_python(out, layers);
    fprintf(out, "\nTEXTURE = \"\"  # an image; a grid of colours without one\n");
    fprintf(out, "SIZE = (%d, %d)\n", info.width, info.height);
    fprintf(out, "# Whether the texture repeats along u and v.\nREPEATS = (%s, %s)\n",
            repeats(target, 0) ? "True" : "False", repeats(target, 1) ? "True" : "False");
    fprintf(out,
            "# A soft copy of the texture is so many pixels wide and high, and blurred by so much of its width.\n"
            "SOFT_SIZE, SOFT_SIGMA = %d, %g\n",
            SOFT_SIZE, SOFT_SIGMA);
    fprintf(out, "# The layers that say where each hit lies on the texture, and how widely: u is red, v is green.\n"
                 "HITS = [\n");
    for (int i = 0; (footprint = retex_set_footprint(set, i)); i++)
        if (hit_is_used(set, i))
            fprintf(out, "    (%d, \"%s\", \"%s\"),\n", footprint->hit, name_of(set, footprint->uv), spread_of(set, i));
    fprintf(out, "]\n# The layers of light, each with the hits whose colours multiply it; the picture is their sum.\n"
                 "TERMS = [\n");
    for (int i = 0; (term = retex_set_term(set, i)); i++) {
        if (!is_used(set, term))
            continue;
        fprintf(out, "    (\"%s\", [", name_of(set, term->radiance));
        for (int k = 0; k < retex_term_hits(term); k++) /* which come before the weight of a correction */
            fprintf(out, "%s%d", k ? ", " : "", retex_set_footprint(set, term->factors[k].index)->hit);
        fprintf(out, "]),\n");
    }
    fprintf(out, "]\n%s", blender_code);
}

/* ---- Nuke ---- */

/* A text as a quoted word of Tcl. */
static void print_tcl(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++)
        fprintf(out, strchr("\"\\$[]{}", *text) ? "\\%c" : "%c", *text);
    fputc('"', out);
}

/* The layer that Nuke makes of a part's name: without digits at the front, with _ for what is no letter or digit. */
static void nuke_layer(char layer[RETEX_NAME_MAX], const char *name)
{
    while (isdigit((unsigned char)*name))
        name++;
    snprintf(layer, RETEX_NAME_MAX, "%s", *name ? name : "unnamed");
    for (char *c = layer; *c; c++)
        if (!isalnum((unsigned char)*c))
            *c = '_';
}

/* Push a layer of the file as red, green and blue. */
static void print_nuke_layer(FILE *out, const char *name, int x, int y)
{
    char layer[RETEX_NAME_MAX];
    nuke_layer(layer, name);
    fprintf(out, "push $Nlayers\nShuffle {\n in %s\n alpha white\n name Take_%s\n xpos %d\n ypos %d\n}\n", layer, layer,
            120 * x, 90 * y);
}

/* Multiply, or add, the two nodes on the stack. */
static void print_nuke_merge(FILE *out, const char *operation, const char *name, int number, int x, int y)
{
    fprintf(out, "Merge2 {\n inputs 2\n operation %s\n output rgb\n name %s%d\n xpos %d\n ypos %d\n}\n", operation,
            name, number, 120 * x, 90 * y);
}

/* Mix the texture at the first hit, Nhit, with its soft copy, Nsoft, by the hit's spread. */
static void print_nuke_mix(FILE *out, const char *spread, int x)
{
    char layer[RETEX_NAME_MAX];
    const double whole = 2 * SOFT_SIGMA * SOFT_SIGMA;
    print_nuke_layer(out, spread, x - 1, 3);
    nuke_layer(layer, spread);
    fprintf(out,
            "Expression {\n expr0 clamp((r*r+g*g)/%g)\n expr1 clamp((r*r+g*g)/%g)\n expr2 clamp((r*r+g*g)/%g)\n"
            " name Softness\n xpos %d\n ypos 360\n}\nset Nshare [stack 0]\npush $Nsoft\n",
            whole, whole, whole, 120 * (x - 1));
    print_nuke_merge(out, "multiply", "Soft", 1, x - 1, 5);
    fprintf(out,
            "push $Nshare\nExpression {\n expr0 1-r\n expr1 1-g\n expr2 1-b\n name Sharpness\n xpos %d\n"
            " ypos 360\n}\npush $Nhit\n",
            120 * x);
    print_nuke_merge(out, "multiply", "Sharp", 1, x, 5);
    print_nuke_merge(out, "plus", "Mixed", 1, x, 6);
}

/* The texture, or its soft copy, at the places on the stack. */
static void print_nuke_map(FILE *out, const char *texture, const char *name, int hit, int x)
{
    fprintf(out, "push $N%s\nSTMap {\n inputs 2\n channels rgb\n uv rgb\n name %s_%d\n xpos %d\n ypos 360\n}\n",
            texture, name, hit, 120 * x);
}

static void print_nuke_hit(FILE *out, const RetexSet *set, int footprint)
{
    const RetexTarget *target = retex_set_target(set, 0);
    const int hit = retex_set_footprint(set, footprint)->hit, x = 3 * hit;
    const int wraps[2] = {repeats(target, 0), repeats(target, 1)};
    const char *spread = spread_of(set, footprint);
    print_nuke_layer(out, name_of(set, retex_set_footprint(set, footprint)->uv), x, 2);
    if (wraps[0] || wraps[1])
        fprintf(out, "Expression {\n expr0 %s\n expr1 %s\n name Wrap_%d\n xpos %d\n ypos 270\n}\n",
                wraps[0] ? "r-floor(r)" : "r", wraps[1] ? "g-floor(g)" : "g", hit, 120 * x);
    fprintf(out, "set Nplace [stack 0]\n");
    print_nuke_map(out, hit > 1 ? "softtexture" : "texture", "Hit", hit, x);
    if (hit == 1 && *spread) {
        fprintf(out, "set Nhit [stack 0]\npush $Nplace\n");
        print_nuke_map(out, "softtexture", "Softhit", hit, x + 1);
        fprintf(out, "set Nsoft [stack 0]\n");
        print_nuke_mix(out, spread, x);
    }
    fprintf(out, "set Nhit%d [stack 0]\n", hit);
}

static void print_nuke(FILE *out, const RetexSet *set, const char *layers)
{
    const RetexSetInfo info = retex_set_info(set);
    const RetexTerm *term;
    char layer[RETEX_NAME_MAX];
    int terms = 0, products = 0;
    fprintf(out,
            "# A script of Nuke that retextures %s, by retex-info --nuke. Put your texture into the node Texture.\n",
            retex_set_target(set, 0)->name);
    for (int i = 1; i < info.nparts; i++)
        if (part_is_used(set, i)) {
            nuke_layer(layer, name_of(set, i));
            fprintf(out, "add_layer {%s %s.red %s.green %s.blue}\n", layer, layer, layer, layer);
        }
    fprintf(out, "Read {\n inputs 0\n file ");
    print_tcl(out, layers);
    fprintf(out, "\n raw true\n name Layers\n xpos 0\n ypos 0\n}\nset Nlayers [stack 0]\n"
                 "CheckerBoard2 {\n inputs 0\n name Texture\n label \"replace this by a Read of your texture\"\n"
                 " xpos -240\n ypos 0\n}\nset Ntexture [stack 0]\n");
    fprintf(
        out,
        "Reformat {\n type \"to box\"\n box_width %d\n box_height %d\n box_fixed true\n resize distort\n name Small\n"
        " xpos -240\n ypos 90\n}\nBlur {\n channels rgb\n size %g\n name Soft\n xpos -240\n ypos 180\n}\n"
        "set Nsofttexture [stack 0]\n",
        SOFT_SIZE, SOFT_SIZE, 2 * SOFT_SIZE * SOFT_SIGMA);
    for (int i = 0; i < info.nfootprints; i++)
        if (hit_is_used(set, i))
            print_nuke_hit(out, set, i);
    for (int i = 0; (term = retex_set_term(set, i)); i++) {
        if (!is_used(set, term))
            continue;
        print_nuke_layer(out, name_of(set, term->radiance), 2 * terms, 6);
        for (int k = 0; k < retex_term_hits(term); k++) {
            fprintf(out, "push $Nhit%d\n", retex_set_footprint(set, term->factors[k].index)->hit);
            print_nuke_merge(out, "multiply", "Times", ++products, 2 * terms, 7 + k);
        }
        if (terms) {
            fprintf(out, "push $Nsum\n");
            print_nuke_merge(out, "plus", "Sum", terms, 2 * terms, 14);
        }
        fprintf(out, "set Nsum [stack 0]\n");
        terms++;
    }
    fprintf(out, "push $Nsum\nViewer {\n name Viewer1\n xpos %d\n ypos 1400\n}\n", 240 * terms);
}

int compositor_print(FILE *out, CompositorKind kind, const RetexSet *set, const char *layers, RetexError *err)
{
    if (strpbrk(layers, "\n\r"))
        return retex_fail(err, RETEX_EINVAL, "a file whose name has line breaks cannot be named in a script");
    (kind == COMPOSITOR_BLENDER ? print_blender : print_nuke)(out, set, layers);
    return RETEX_OK;
}
