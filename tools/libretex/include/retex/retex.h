/* libretex: retexturing rendered pictures in image space. This header includes all others but
 * those in <retex/host>, which are for renderers. */
#ifndef RETEX_RETEX_H
#define RETEX_RETEX_H

#include <retex/access.h>
#include <retex/budget.h>
#include <retex/clock.h>
#include <retex/color.h>
#include <retex/color_text.h>
#include <retex/combine.h>
#include <retex/denoise.h>
#include <retex/denoise_picture.h>
#include <retex/develop.h>
#include <retex/diff.h>
#include <retex/edit.h>
#include <retex/error.h>
#include <retex/file_sum.h>
#include <retex/image.h>
#include <retex/image_file.h>
#include <retex/laid.h>
#include <retex/lamp.h>
#include <retex/metrics.h>
#include <retex/output_file.h>
#include <retex/pack.h>
#include <retex/parallel.h>
#include <retex/picture.h>
#include <retex/preset.h>
#include <retex/reduce.h>
#include <retex/set.h>
#include <retex/set_file.h>
#include <retex/shrink.h>
#include <retex/solve.h>
#include <retex/texture.h>
#include <retex/version.h>
#include <retex/web.h>

#endif
