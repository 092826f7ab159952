/* Height functions worked out once more, from what their texts mean: the layer a point is in, how
 * thick it is there and which way it lies. */
#ifndef TESTS_CURVED_HEIGHTS_H
#define TESTS_CURVED_HEIGHTS_H

#include "space.h"

typedef struct heights heights;

/* From a text as --field takes it. base: z up to base[0], the field less base[2] from base[1] on
 * and a smooth step between; base[1] <= base[0]: none. NULL, with a message, if it isn't
 * understood. */
heights *heights_new(const char *text, const double base[3]);
void heights_free(heights *h);

/* At a place counted from the middle and the foot of the part. */
double heights_at(const heights *h, vec p);

/* By central differences. */
vec heights_gradient(const heights *h, vec p);

#endif
