/* The sources of the kernels once more, under other names and for the baseline alone. See lib_plain.h. */
#include "lib_plain.h"

#include <retex/host/cpu.h>

#define retex_cpu_level() RETEX_CPU_BASELINE

#define lanes_take lanes_take_plain
#define lanes_start lanes_start_plain
#define lanes_refine lanes_refine_plain
void lanes_take_plain(LaneRays *lanes, const Ray *rays, int count);
#include "accel/lanes_kernel.c"

#define matte_lights matte_lights_plain
#define matte_bounces matte_bounces_plain
#include "path/matte_kernel.c"

#define place_pairs_errors place_pairs_errors_plain
#include "film/footprints/places_kernel.c"

#define vertex_samples vertex_samples_plain
#include "path/vertex_samples_kernel.c"
