/* Reads the parameters and terms of the manifest. */
#include <string.h>

#include <retex/host/set_build.h>

#include "set/manifest_fields.h"
#include "set/parts.h"

/* A target's number; -1 for null. */
static int get_target(Reading *reading, const RetexSet *set, const json_t *json)
{
    return json_is_null(json_object_get(json, "target"))
               ? -1
               : retex_reading_integer(reading, json, "target", 0, set->ntargets - 1);
}

static RetexFactor read_factor(Reading *reading, const json_t *json, const RetexSet *set)
{
    RetexFactor factor = retex_factor(RETEX_FACTOR_FOOTPRINT, 0);
    const char *const key = json_object_iter_key(json_object_iter((json_t *)json));
    char name[RETEX_NAME_MAX] = "";

    if (!key) {
        retex_reading_fail(reading, RETEX_EFORMAT, "has a factor that names no kind");
        return factor;
    }
    factor.kind =
        (RetexFactorKind)retex_reading_name(reading, key, "factor", retex_factor_kind_name, RETEX_FACTOR_KINDS);
    if (factor.kind == RETEX_FACTOR_IMAGE) {
        factor.index = retex_reading_weight(reading, set, json, key);
        retex_reading_check_scale(reading, set, factor.index, key);
    } else if (factor.kind == RETEX_FACTOR_PARAMETER) {
        retex_reading_text(reading, json, key, name, sizeof name);
        factor.index = retex_set_find_parameter(set, name);
        if (factor.index < 0)
            retex_reading_fail(reading, RETEX_EFORMAT, "refers to a parameter that is not there");
    } else if (!reading->code) {
        const int count = factor.kind == RETEX_FACTOR_MIXTURE ? set->nmixtures : set->nfootprints;
        factor.index = retex_reading_integer(reading, json, key, 0, count - 1);
        if (json_object_get(json, "quantity"))
            factor.quantity = (RetexQuantity)retex_reading_named(reading, json, "quantity", "quantity",
                                                                 retex_quantity_name, RETEX_QUANTITIES);
    }
    return factor;
}

static void read_term(Reading *reading, const json_t *json, RetexSet *set)
{
    const json_t *factors = retex_reading_array(reading, json, "factors", RETEX_MAX_FACTORS);
    RetexTerm term = {.role =
                          (RetexRole)retex_reading_named(reading, json, "role", "role", retex_role_name, RETEX_ROLES),
                      .target = get_target(reading, set, json),
                      .radiance = retex_reading_part(reading, set, json, "radiance", 3, 0),
                      .nfactors = (int)json_array_size(factors)};

    for (int f = 0; f < term.nfactors && !reading->code; f++)
        term.factors[f] = read_factor(reading, json_array_get(factors, (size_t)f), set);
    if (json_object_get(json, "noise_weight"))
        term.noise_weight = (float)retex_reading_real(reading, json_object_get(json, "noise_weight"), "noise_weight");
    if (!reading->code)
        retex_reading_check_size(reading, set, term.radiance, "radiance");
    if (!reading->code)
        reading->code = retex_set_add_term(set, &term, NULL, reading->err);
}

static void read_color(Reading *reading, const json_t *json, const char *key, float color[3])
{
    const json_t *numbers = retex_reading_array(reading, json, key, 3);

    for (size_t c = 0; c < 3; c++)
        color[c] = (float)retex_reading_real(reading, json_array_get(numbers, c), key);
}

static void read_finishes(Reading *reading, const json_t *json, const RetexSet *set, RetexParameter *parameter)
{
    const json_t *numbers = retex_reading_array(reading, json, "finishes", RETEX_MAX_TARGETS);

    retex_reading_text(reading, json, "lamp", parameter->lamp, sizeof parameter->lamp);
    if (json_array_size(numbers) != (size_t)set->ntargets)
        retex_reading_fail(reading, RETEX_EFORMAT, "has \"finishes\" that are not as many as its targets");
    for (int t = 0; t < set->ntargets && !reading->code; t++) {
        const double number = retex_reading_real(reading, json_array_get(numbers, (size_t)t), "finishes");
        if (!(number >= 0 && number <= set->targets[t].nfinishes && number == (int)number))
            retex_reading_fail(reading, RETEX_EFORMAT, "has a finish that its target has not");
        else
            parameter->finishes[t] = (signed char)number;
    }
}

static void read_parameter(Reading *reading, const json_t *json, RetexSet *set)
{
    RetexParameter parameter = {.kind = (RetexParameterKind)retex_reading_named(reading, json, "kind", "parameter",
                                                                                retex_parameter_kind_name,
                                                                                RETEX_PARAMETER_KINDS),
                                .target = get_target(reading, set, json),
                                .several = json_is_true(json_object_get(json, "several"))};

    retex_reading_text(reading, json, "name", parameter.name, sizeof parameter.name);
    read_color(reading, json, "value", parameter.value);
    if (json_object_get(json, "kept"))
        read_color(reading, json, "kept", parameter.kept);
    if (json_object_get(json, "finishes"))
        read_finishes(reading, json, set, &parameter);
    if (!reading->code)
        reading->code = retex_set_add_parameter(set, &parameter, NULL, reading->err);
}

void retex_reading_terms(Reading *reading, const json_t *root, RetexSet *set)
{
    const json_t *parameters = retex_reading_array(reading, root, "parameters", RETEX_PARAMETERS_MAX);
    const json_t *terms = retex_reading_array(reading, root, "terms", RETEX_SET_TERMS_MAX);

    for (size_t i = 0; i < json_array_size(parameters) && !reading->code; i++)
        read_parameter(reading, json_array_get(parameters, i), set);
    for (size_t i = 0; i < json_array_size(terms) && !reading->code; i++)
        read_term(reading, json_array_get(terms, i), set);
}
