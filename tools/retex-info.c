/* retex-info: describe a set, as text or JSON, and verify its checksums. See retex-info(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <retex/retex.h>

#include "common/cli.h"

/* What the command line asks for. */
typedef struct Request {
    const char *path, *layers;
    int json, checking;
} Request;

static const CliOption options[] = {
    {"json", 0, NULL, "print the manifest and the sizes as JSON", 0, CLI_INTO(Request, json)},
    {"check", 0, NULL, "check the checksums of all parts; exit status 1 if one is wrong", 0,
     CLI_INTO(Request, checking)},
    {"layers", 0, "FILE.exr", "write the set's images as the layers of a flat EXR, for compositors", 0,
     CLI_INTO(Request, layers)},
    {0},
};

/* Uncompressed bytes of parts by their use, and the number of AOVs as the paper's supplement counts them. */
typedef struct Sizes {
    long long file; /* size of the file, or -1 if unknown */
    long long radiance, uv, spread, albedo, originals, other, samples;
    int radiance_aovs, uv_aovs, spread_aovs;
} Sizes;

static long long part_bytes(const RetexPart *part)
{
    return (long long)part->image.width * part->image.height * part->image.channels *
           (part->type == RETEX_HALF ? 2 : 4);
}

/* Add a part to the bytes of its use. A part with several references is counted once. */
static void count_part(const RetexSet *set, int part, char *counted, long long *bytes, int *aovs)
{
    if (part < 0 || counted[part])
        return;
    counted[part] = 1;
    *bytes += part_bytes(retex_set_part(set, part));
    if (aovs)
        ++*aovs;
}

static void measure_set(const Cli *cli, const RetexSet *set, Sizes *sizes)
{
    const RetexSetInfo info = retex_set_info(set);
    const RetexTerm *term;
    const RetexFootprint *footprint;
    char *counted = calloc((size_t)info.nparts + 1, 1);

    if (!counted)
        cli_die(cli, "not enough memory to count parts");
    for (int i = 0; (term = retex_set_term(set, i)); i++)
        if (term->role != RETEX_ROLE_PICTURE)
            count_part(set, term->radiance, counted, &sizes->radiance, &sizes->radiance_aovs);
    for (int i = 0; (footprint = retex_set_footprint(set, i)); i++) {
        count_part(set, footprint->uv, counted, &sizes->uv, &sizes->uv_aovs);
        count_part(set, footprint->spread, counted, &sizes->spread, &sizes->spread_aovs);
        count_part(set, footprint->albedo, counted, &sizes->albedo, NULL);
        count_part(set, footprint->sampled - 1, counted, &sizes->samples, NULL);
        for (int k = 0; k < RETEX_FINISHES_MAX; k++)
            count_part(set, footprint->finished[k] - 1, counted, &sizes->samples, NULL);
    }
    for (int i = 0; i < info.ntargets; i++) {
        count_part(set, retex_set_target(set, i)->original, counted, &sizes->originals, NULL);
        count_part(set, retex_set_target(set, i)->gates - 1, counted, &sizes->samples, NULL);
    }
    for (int i = 0; i < info.nparts; i++)
        count_part(set, i, counted, &sizes->other, NULL);
    free(counted);
}

static Sizes measure(const Cli *cli, const char *path, const RetexSet *set)
{
    Sizes sizes = {.file = -1};
    struct stat status;

    if (strcmp(path, "-") != 0 && stat(path, &status) == 0 && S_ISREG(status.st_mode))
        sizes.file = status.st_size;
    measure_set(cli, set, &sizes);
    return sizes;
}

static void print_bytes(FILE *out, const char *what, long long bytes)
{
    if (bytes > 0)
        fprintf(out, "  %-12s %10.2f MB\n", what, (double)bytes / 1e6);
}

/* Names in users' files must not send control characters to a terminal. */
static const char *plain(char text[512], const char *name)
{
    snprintf(text, 512, "%s", name);
    return cli_plain(text);
}

static void print_target(FILE *out, const RetexSet *set, const RetexTarget *target)
{
    int any = 0;
    const RetexPart *original = retex_set_part(set, target->original);
    char text[512];
    fprintf(out, "target %s\n", plain(text, target->name));
    fprintf(out, "  idents       %s\n", plain(text, target->idents));
    if (target->uv_scale[0] > 0 && target->uv_scale[1] > 0)
        fprintf(out, "  size         %.6g x %.6g scene units a unit of u and of v\n", target->uv_scale[0],
                target->uv_scale[1]);
    fprintf(out, "  share        %.2f%% of the picture\n", 100 * target->share);
    if (target->normal_tilt > 0)
        fprintf(out, "  normals      of %s, by %.3g degrees: it takes normal maps\n", plain(text, target->finishes[0]),
                target->normal_tilt);
    for (int k = 0; k < target->nfinishes && !(target->normal_tilt > 0); k++)
        fprintf(out, "%s%s%s%s", k ? ", " : "  finishes     ", plain(text, target->finishes[k]),
                k + 1 == target->finish ? " (as rendered)" : "", k + 1 == target->nfinishes ? "\n" : "");
    for (int k = 0; k < target->nfinishes; k++)
        if (target->finish_roughness[k] >= 0)
            fprintf(out, "%s%.3g of %s", any++ ? ", " : "  roughness    ", (double)target->finish_roughness[k],
                    plain(text, target->finishes[k]));
    if (any)
        fprintf(out, "\n");
    fprintf(out, "  mean albedo  %.4f %.4f %.4f\n", (double)target->mean_albedo[0], (double)target->mean_albedo[1],
            (double)target->mean_albedo[2]);
    fprintf(out, "  u            %.6g to %.6g%s\n", target->uv_min[0], target->uv_max[0],
            target->periodic[0] ? ", closed" : "");
    fprintf(out, "  v            %.6g to %.6g%s\n", target->uv_min[1], target->uv_max[1],
            target->periodic[1] ? ", closed" : "");
    if (original)
        fprintf(out, "  original     %d x %d texels over %.6g,%.6g to %.6g,%.6g\n", original->image.width,
                original->image.height, target->original_min[0], target->original_min[1], target->original_max[0],
                target->original_max[1]);
}

/* Of a colour that can be changed; the weights of corrections follow from the edit. */
static void print_color(FILE *out, const char *what, const float color[3])
{
    fprintf(out, "  %-11s  %.6g %.6g %.6g\n", what, (double)color[0], (double)color[1], (double)color[2]);
}

/* Lamps only: what a set with finishes has besides follows from them. */
static void print_parameter(FILE *out, const RetexSet *set, int number)
{
    const RetexParameter *parameter = retex_set_parameter(set, number);
    const char *lamp = retex_parameter_lamp(set, number);
    char text[512];

    if (!lamp)
        return;
    fprintf(out, "parameter %s\n", plain(text, lamp));
    print_color(out, "as rendered", parameter->value);
    if (memcmp(parameter->kept, parameter->value, sizeof parameter->kept) != 0)
        print_color(out, "shines with", parameter->kept);
    if (parameter->several)
        fprintf(out, "  light        of several colours, which a new one multiplies\n");
}

/* Layout footprints: print the highest number of clusters per pixel and target, for any target. */
static void print_clusters(FILE *out, const RetexSet *set)
{
    int sharp[RETEX_MAX_TARGETS] = {0}, broad[RETEX_MAX_TARGETS] = {0}, most_sharp = 0, most_broad = 0, quarters = 0;
    const RetexFootprint *footprint;

    for (int i = 0; (footprint = retex_set_footprint(set, i)); i++) {
        sharp[footprint->target] += footprint->kind == RETEX_FOOTPRINT_SHARP && !footprint->quadrant;
        quarters |= footprint->quadrant > 0;
        broad[footprint->target] += footprint->kind == RETEX_FOOTPRINT_BROAD;
    }
    for (int i = 0; i < RETEX_MAX_TARGETS; i++) {
        most_sharp = sharp[i] > most_sharp ? sharp[i] : most_sharp;
        most_broad = broad[i] > most_broad ? broad[i] : most_broad;
    }
    if (most_sharp || most_broad || quarters)
        fprintf(out, "clusters       %d sharp, %d broad%s\n", most_sharp, most_broad,
                quarters ? ", quarters of pixels" : "");
}

/* Warn of light that does not follow a new texture: its path has more hits than the set keeps apart. */
static void warn_folded(const Cli *cli, const RetexSet *set)
{
    const RetexSetInfo info = retex_set_info(set);
    const double worst = info.folded > info.folded_white ? info.folded : info.folded_white;
    const char *advice = info.orders < RETEX_MAX_ORDERS ? "more --orders keep its hits apart"
                         : info.ntargets > 1            ? "fewer targets may keep its hits apart"
                                                        : "it has more hits than a set can keep apart";

    if (worst > 0.005 && !info.further_hits)
        cli_warn(cli, "%.2f%% of the light%s keeps the original textures: %s", 100 * worst,
                 info.folded < worst ? ", were the targets white," : "", advice);
}

static void print_set(FILE *out, const RetexSet *set, const Sizes *sizes)
{
    const RetexSetInfo info = retex_set_info(set);
    char text[512];
    fprintf(out, "layout         %s\n", info.layout);
    fprintf(out, "size           %d x %d pixels, %s filter\n", info.width, info.height, plain(text, info.filter));
    fprintf(out, "samples        %d a pixel, seed %lu\n", info.spp, (unsigned long)info.seed);
    if (info.denoised)
        fprintf(out, "denoised       yes\n");
    else
        fprintf(out, "denoise data   %s\n", retex_denoise_has_data(set) ? "yes" : "no");
    fprintf(out, "orders         %d%s\n", info.orders, info.strict_paper ? " (strict)" : "");
    fprintf(out, "folded         %.4f%% of the light", 100 * info.folded);
    if (info.folded_white > 0)
        fprintf(out, ", %.4f%% were the targets white", 100 * info.folded_white);
    fprintf(out, "\n");
    if (info.further_hits)
        fprintf(out, "further hits   up to %d, each leaves %.3f %.3f %.3f of the light, times the texture\n",
                info.further_hits, (double)info.further_ratio[0], (double)info.further_ratio[1],
                (double)info.further_ratio[2]);
    print_clusters(out, set);
    if (info.unit != 1)
        fprintf(out, "scene unit     %g m\n", info.unit);
    if (info.exposure != 0)
        fprintf(out, "exposure       %+.4g stops, of the scene\n", info.exposure);
    fprintf(out, "max depth      %d segments", info.max_depth);
    if (info.depth_cut >= 5e-7) /* less would be 0.0000 */
        fprintf(out, ", without %.4f%% of the light", 100 * info.depth_cut);
    fprintf(out, "\n");
    if (info.scene[0])
        fprintf(out, "scene          %s\n", plain(text, info.scene));
    if (info.generator[0])
        fprintf(out, "generator      %s\n", plain(text, info.generator));
    for (int i = 0; i < info.nparameters; i++)
        print_parameter(out, set, i);
    for (int i = 0; i < info.ntargets; i++)
        print_target(out, set, retex_set_target(set, i));
    fprintf(out, "AOVs           %d: %d radiance, %d UV, %d spread\n",
            sizes->radiance_aovs + sizes->uv_aovs + sizes->spread_aovs, sizes->radiance_aovs, sizes->uv_aovs,
            sizes->spread_aovs);
}

static void print_samples(FILE *out, const RetexSet *set)
{
    const RetexSetInfo info = retex_set_info(set);
    const RetexTarget *target;
    char name[512], texture[512];
    int count = 0;

    for (int i = 0; i < info.nfootprints; i++)
        count += retex_set_footprint(set, i)->sampled > 0;
    fprintf(out, "samples of     %d footprints out of %d, %d x %d pixels\n", count, info.nfootprints, info.width,
            info.height);
    if (*retex_set_reference(set))
        fprintf(out, "of the set     %s\n", plain(texture, retex_set_reference(set)));
    for (int i = 0; (target = retex_set_target(set, i)); i++)
        if (target->texture[0])
            fprintf(out, "  %-12s %s\n", plain(name, target->name), plain(texture, target->texture));
}

/* For a pack: print the sizes of its parts in the file. */
static void print_packed(FILE *out, const RetexSet *set)
{
    uint64_t bytes[RETEX_PACK_USES];

    if (retex_pack_bytes(bytes, RETEX_PACK_USES, set, NULL))
        return;
    fprintf(out, "bytes in the pack\n");
    for (int i = 0; i < RETEX_PACK_USES; i++)
        if (bytes[i] > 0)
            fprintf(out, "  %-12s %10llu\n", retex_pack_use_name(i), (unsigned long long)bytes[i]);
}

static void print_levels(FILE *out, const RetexSet *set)
{
    RetexPackLevel level = {.size = sizeof level};

    for (int i = 0; retex_pack_level(&level, set, i); i++)
        fprintf(out, "level 1/%d      %d x %d pixels, %llu bytes\n", level.scale, level.width, level.height,
                (unsigned long long)level.bytes);
}

static void print_text(FILE *out, const RetexSet *set, const Sizes *sizes)
{
    const int is_samples = retex_set_info(set).is_samples;

    if (!is_samples)
        print_set(out, set, sizes);
    if (is_samples || retex_set_has_laid(set))
        print_samples(out, set);
    print_levels(out, set);
    fprintf(out, "bytes\n");
    print_bytes(out, "radiance", sizes->radiance);
    print_bytes(out, "UV", sizes->uv);
    print_bytes(out, "spread", sizes->spread);
    print_bytes(out, "albedo", sizes->albedo);
    print_bytes(out, "originals", sizes->originals);
    print_bytes(out, "other", sizes->other);
    print_bytes(out, "samples", sizes->samples);
    print_bytes(out, "file", sizes->file);
    print_packed(out, set);
}

/* Print the manifest, with the sizes before its first key. Its numbers stay as the set has them, to the last digit. */
static int print_json(const Cli *cli, const RetexSet *set, const Sizes *sizes)
{
    FILE *out = cli->answer;
    RetexError error = {0};
    char *manifest;

    if (retex_set_manifest(set, &manifest, &error)) {
        cli_error(cli, &error);
        return CLI_FAIL;
    }
    fprintf(out, "{\"file_bytes\":");
    if (sizes->file >= 0)
        fprintf(out, "%lld", sizes->file);
    else
        fprintf(out, "null");
    fprintf(out,
            ",\"aovs\":%d,\"bytes\":{\"radiance\":%lld,\"uv\":%lld,\"spread\":%lld,\"albedo\":%lld,\"originals\":%lld,"
            "\"other\":%lld,\"samples\":%lld},",
            sizes->radiance_aovs + sizes->uv_aovs + sizes->spread_aovs, sizes->radiance, sizes->uv, sizes->spread,
            sizes->albedo, sizes->originals, sizes->other, sizes->samples);
    uint64_t bytes[RETEX_PACK_USES];
    if (!retex_pack_bytes(bytes, RETEX_PACK_USES, set, NULL)) {
        fprintf(out, "\"packed_bytes\":");
        for (int i = 0; i < RETEX_PACK_USES; i++)
            fprintf(out, "%c\"%s\":%llu", i ? ',' : '{', retex_pack_use_name(i), (unsigned long long)bytes[i]);
        fprintf(out, "},");
    }
    RetexPackLevel level = {.size = sizeof level};
    for (int i = 0; retex_pack_level(&level, set, i); i++)
        fprintf(out, "%s{\"scale\":%d,\"width\":%d,\"height\":%d,\"bytes\":%llu}", i ? "," : "\"levels\":[",
                level.scale, level.width, level.height, (unsigned long long)level.bytes);
    if (retex_pack_level(&level, set, 0))
        fprintf(out, "],");
    fprintf(out, "\"denoise_data\":%s,%s\n", retex_denoise_has_data(set) ? "true" : "false", manifest + 1);
    free(manifest);
    return CLI_OK;
}

static int print_info(const Cli *cli, const char *path, int json)
{
    RetexSet *set = NULL;
    RetexError error = {0};
    int status = CLI_OK;

    if (retex_set_open_any(path, &set, cli->threads, &error))
        cli_fail(cli, &error);
    cli_check_pixels(cli, set, path);
    const Sizes sizes = measure(cli, path, set);
    if (json) {
        status = print_json(cli, set, &sizes);
    } else {
        print_text(cli->answer, set, &sizes);
    }
    warn_folded(cli, set);
    retex_set_close(&set);
    return status;
}

/* The exit status is 1 for a damaged set, and 2 for a file that cannot be read or is not a set. */
static int check(const Cli *cli, const char *path)
{
    RetexError error = {0};
    const int code = retex_set_check(path, cli->threads, &error);

    if (code == RETEX_EFORMAT && !strstr(error.message, "not a set")) {
        cli_error(cli, &error);
        return CLI_NO;
    }
    if (code)
        cli_fail(cli, &error);
    if (!cli->quiet)
        fprintf(cli->answer, "%s: ok\n", strcmp(path, "-") == 0 ? "standard input" : path);
    return CLI_OK;
}

static int write_layers(const Cli *cli, const Request *request)
{
    RetexSet *set = NULL;
    RetexError error = {0};

    if (retex_set_open(request->path, &set, cli->threads, &error))
        cli_fail(cli, &error);
    cli_check_pixels(cli, set, request->path);
    int code = retex_set_load(set, cli->threads, &error);
    if (!code)
        code = retex_set_write_layers(set, request->layers, cli->threads, &error);
    retex_set_close(&set);
    if (code)
        cli_error(cli, &error);
    return code ? CLI_FAIL : CLI_OK;
}

static void check_request(Cli *cli, const Request *request)
{
    if (!request->path)
        cli_die(cli, "no set given");
    if (request->json + request->checking + (request->layers != NULL) > 1)
        cli_die(cli, "--json, --check and --layers exclude each other");
    if (request->layers && !cli_ends_with(request->layers, ".exr"))
        cli_die(cli, "--layers writes OpenEXR: expected a name that ends in .exr, not `%s`", request->layers);
    cli_input(cli, request->path, "a set, as from retex-render");
    cli_reads(cli, "the set", request->path);
    cli_writes(cli, "--layers", request->layers);
}

int main(int argc, char **argv)
{
    Cli cli = {.tool = "retex-info",
               .usage = "SET [--json] [--check] [--layers FILE.exr] [-o FILE]",
               .about = "Describe a set, samples or a pack, or check that it is whole.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1};
    Request request = {0};
    cli_parse(&cli, &request, CLI_ARGUMENTS(&request.path), "one set is enough");
    check_request(&cli, &request);
    cli_answer(&cli);
    return cli_close(&cli, request.layers     ? write_layers(&cli, &request)
                           : request.checking ? check(&cli, request.path)
                                              : print_info(&cli, request.path, request.json));
}
