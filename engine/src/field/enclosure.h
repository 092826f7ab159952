/* What the operations make of values that lie within intervals; rows of their table (operation.c).
 */
#ifndef ISO_FIELD_ENCLOSURE_H
#define ISO_FIELD_ENCLOSURE_H

#include "field/operation.h"

iso_operation_enclose enclose_negate, enclose_add, enclose_subtract, enclose_multiply,
    enclose_divide, enclose_power;
iso_operation_enclose enclose_less, enclose_less_equal, enclose_greater, enclose_greater_equal,
    enclose_equal, enclose_unequal;
iso_operation_enclose enclose_select, enclose_square, enclose_norm3;
iso_operation_enclose enclose_abs, enclose_sqrt, enclose_min, enclose_max, enclose_clamp;
iso_operation_enclose enclose_floor, enclose_ceil, enclose_round, enclose_mod;
iso_operation_enclose enclose_sin, enclose_cos, enclose_tan, enclose_asin, enclose_acos,
    enclose_atan;
iso_operation_enclose enclose_atan2, enclose_exp, enclose_log, enclose_hypot, enclose_ramp;

#endif
