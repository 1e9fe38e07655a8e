/* How the rows of a view's images are made: one function a kind. Private to libretex. */
#ifndef RETEX_RETEXTURE_VIEW_ROWS_H
#define RETEX_RETEXTURE_VIEW_ROWS_H

#include "retexture/view.h"

RetexViewMake retex_view_make_part, retex_view_make_footprint, retex_view_make_mixture, retex_view_make_further,
    retex_view_make_gate_sums, retex_view_make_gates, retex_view_make_gate, retex_view_make_enlarged,
    retex_view_make_sum;

#endif
