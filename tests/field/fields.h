/* What the tests of fields share: fields made of texts, and points the same in every run. */
#ifndef TESTS_FIELD_FIELDS_H
#define TESTS_FIELD_FIELDS_H

#include "check.h"

#include <isoslice/field.h>

#include "base/random.h"

static inline double between(uint64_t *state, double low, double high) {
    return low + (high - low) * random_unit(state);
}

static inline iso_vec3 point_within(uint64_t *state, double size) {
    double x = between(state, -size, size), y = between(state, -size, size);
    return (iso_vec3){x, y, between(state, -size, size)};
}

static inline iso_field *field_of(const char *text) {
    iso_field *field = NULL;
    if (!CHECK_OK(iso_field_new(&field, text)))
        fprintf(stderr, "%s\n", text);
    return field;
}

static inline double value_at(const iso_field *field, iso_vec3 at) {
    double value;
    iso_field_evaluate(&value, NULL, field, &at, 1);
    return value;
}

static inline iso_vec3 gradient_at(const iso_field *field, iso_vec3 at) {
    double value;
    iso_vec3 gradient;
    iso_field_evaluate(&value, &gradient, field, &at, 1);
    return gradient;
}

/* Every kind of shape, and every operation of expressions, kinks and jumps included. */
static const char *const every_field[] = {
    "z",
    "plane:1,2,3",
    "plane:0,-1,0",
    "cone:30",
    "cone:-20,3,4",
    "cone:0",
    "sphere:1,2,-30",
    "sphere:1,2,3",
    "cylinder:x",
    "cylinder:y,1,2",
    "cylinder:z,3,-2",
    "torus:12",
    "torus:8,1,2,3",
    "wave:2,15",
    "wave:1,8,30",
    "fan:y,-20,0,15",
    "fan:x,20,0,-12",
    "fan:z,1,2,10",
    "z + 0.05*sqrt(x^2+y^2)",
    "sqrt((x-3)*(x-3)+y^2+z*z)",
    "(x^2+y^2+z^2)^0.5 - sqrt(x^2)",
    "sin(x/5)*cos(y/5)+z",
    "max(z, z+0.3*x)",
    "min(x, y*2, z - 3, 4)",
    "abs(x)+abs(y)-z",
    "x*y*z/100 - -x",
    "exp(x/10)+log(z*z+1)",
    "z^3-x^3/8+(y-40)^-2+(x+30)^-3",
    "x^4 - 3*x^2*y + z^7/1e6",
    "abs(x)^1.5 + 2^(y/5) + (x*x+1)^(z/20)",
    "(abs(x)+0.5)^-0.7 + z^0 + y^1",
    "atan2(y,x)+z",
    "atan2(z-50,x*x+1)",
    "x>3?y:2*y+z",
    "(x<y)+2*(x<=z)+4*(y>=z)+8*(y==z)+16*(x!=y)",
    "x > 0 ? y > 0 ? x : z : x - y",
    "floor(x/4)+mod(y,3)+mod(z,-7)",
    "mod(x, y + 30)",
    "round(x)+ceil(y)",
    "ramp(z,0,4,x,y)",
    "ramp(z,5,-4,x,30)",
    "ramp(x,y-25,z+25,1,z)",
    "clamp(z,-3,x+30)",
    "clamp(z,x,y)",
    "hypot(x,y)*tan(z/30)",
    "asin(x/21)+acos(y/21)+atan(z)",
    "asin(x/20)-acos(z/20)",
    "1/x + sqrt(y)",
    "log(z) + tan(x)",
};
enum { EVERY_FIELD = sizeof every_field / sizeof *every_field };

#endif
