/* Bytes as a field: what is one has values, the same ones in blocks of any size, gradients that are
 * numbers, and no value or gradient outside the bound of a box that it is in. */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#include <isoslice/field.h>

enum { VALUES = 48 };

static char text[1 << 14];

static void give_up(const char *why) {
    fprintf(stderr, "%s: %s\n", text, why);
    abort();
}

static int within(double low, double value, double high) {
    return low <= value && value <= high;
}

static void check_bound(const iso_field *field, iso_vec3 low, iso_vec3 high) {
    iso_vec3 at[VALUES], gradient[VALUES];
    double value[VALUES];
    iso_field_bound b;
    iso_field_bound_over(&b, field, low, high);
    int is_known = b.low > -HUGE_VAL && b.high < HUGE_VAL;
    for (int i = 0; i < VALUES; i++) /* corners, then on a lattice within */
        at[i] = (iso_vec3){low.x + (high.x - low.x) * (i < 8 ? i & 1 : i % 6 / 5.),
                           low.y + (high.y - low.y) * (i < 8 ? i >> 1 & 1 : i % 7 / 6.),
                           low.z + (high.z - low.z) * (i < 8 ? i >> 2 & 1 : i % 5 / 4.)};
    iso_field_evaluate(value, gradient, field, at, VALUES);
    for (int i = 0; i < VALUES; i++) {
        if (at[i].x > high.x || at[i].y > high.y || at[i].z > high.z)
            continue; /* by rounding */
        if (isnan(value[i]) ? is_known : !within(b.low, value[i], b.high))
            give_up("a value outside its bound");
        if (is_known && (!within(b.gradient_low.x, gradient[i].x, b.gradient_high.x) ||
                         !within(b.gradient_low.y, gradient[i].y, b.gradient_high.y) ||
                         !within(b.gradient_low.z, gradient[i].z, b.gradient_high.z)))
            give_up("a gradient outside its bound");
    }
}

static void check_values(const iso_field *field) {
    iso_vec3 at[VALUES], gradient[VALUES], one;
    double value[VALUES], single;
    for (int i = 0; i < VALUES; i++)
        at[i] = (iso_vec3){(i - 17) * 0.37, (i * 7 % 40 - 20) * 0.5, (i * 11 % 40 - 20) * 0.25};
    iso_field_evaluate(value, gradient, field, at, VALUES);
    for (int i = 0; i < VALUES; i++) {
        if (!isfinite(gradient[i].x) || !isfinite(gradient[i].y) || !isfinite(gradient[i].z))
            give_up("a gradient that is no number");
        iso_field_evaluate(&single, &one, field, &at[i], 1);
        if ((single != value[i] && !(isnan(single) && isnan(value[i]))) || one.x != gradient[i].x ||
            one.y != gradient[i].y || one.z != gradient[i].z)
            give_up("another value alone");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    if (size >= sizeof text)
        return 0;
    memcpy(text, bytes, size);
    text[size] = 0;
    iso_field *field = NULL;
    iso_status status = iso_field_new(&field, text);
    if (status != ISO_OK) {
        if (status != ISO_BAD_CONFIG || field || !strstr(iso_error_message(), "column "))
            give_up(iso_error_message());
        return 0;
    }
    check_values(field);
    for (int i = 0; i < 12; i++) {
        double wide = i % 3 == 0 ? 4 : i % 3 == 1 ? 0.25 : 0.001;
        iso_vec3 low = {i * 5 % 12 - 6, i * 7 % 12 - 6.5, i * 11 % 12 - 5};
        check_bound(field, low, (iso_vec3){low.x + wide, low.y + wide, low.z + wide});
    }
    if (iso_field_is_z(field) && iso_field_kind_of(field) != ISO_FIELD_PLANE)
        give_up("z, but no plane");
    iso_field_free(field);
    return 0;
}
