/* What the operations make of values that lie within intervals; rows of their table (operation.c).
 */
#ifndef ISO_FIELD_SPREAD_H
#define ISO_FIELD_SPREAD_H

#include "field/operation.h"

iso_operation_spread spread_negate, spread_add, spread_subtract, spread_multiply, spread_divide,
    spread_power;
iso_operation_spread spread_less, spread_less_equal, spread_greater, spread_greater_equal,
    spread_equal, spread_unequal;
iso_operation_spread spread_select, spread_square, spread_norm3;
iso_operation_spread spread_abs, spread_sqrt, spread_min, spread_max, spread_clamp;
iso_operation_spread spread_floor, spread_ceil, spread_round, spread_mod;
iso_operation_spread spread_sin, spread_cos, spread_tan, spread_asin, spread_acos, spread_atan;
iso_operation_spread spread_atan2, spread_exp, spread_log, spread_hypot, spread_ramp;

#endif
