/* Derivatives of the operations over arrays; rows of their table (operation.c). */
#ifndef ISO_FIELD_SLOPE_H
#define ISO_FIELD_SLOPE_H

#include "field/operation.h"

iso_operation_slope slope_multiply, slope_divide, slope_power, slope_select, slope_square,
    slope_norm3;
iso_operation_slope slope_abs, slope_sqrt, slope_min, slope_max, slope_clamp, slope_mod,
    slope_hypot, slope_ramp;
iso_operation_slope slope_sin, slope_cos, slope_tan, slope_asin, slope_acos, slope_atan,
    slope_atan2, slope_exp, slope_log;

#endif
