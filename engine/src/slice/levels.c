#include <isoslice/slice.h>

#include <stdbool.h>

#include "base/memory.h"

/* More layers than this are a mistake in a unit. */
#define LAYERS_MAX 10000000

static bool positive(double value) {
    return value > 0 && value - value == 0;
}

/* Bottom of layer i. Behind the list the last height goes on, by multiplication: adding a tenth a
 * thousand times drifts. */
static double bottom_of(const double *height, const double *top, int32_t count, int64_t i) {
    if (i == 0)
        return 0;
    if (i < count)
        return top[i - 1];
    double below = count > 1 ? top[count - 2] : 0;
    return below + (double)(i - count + 1) * height[count - 1];
}

static iso_status check_heights(const double *height, int32_t count, double object_height) {
    if (!positive(object_height))
        return iso_fail(ISO_USAGE, "an object of height %g mm has no layers", object_height);
    if (count <= 0)
        return iso_fail(ISO_USAGE, "no layer height is given");
    for (int32_t i = 0; i < count; i++)
        if (!positive(height[i]))
            return iso_fail(ISO_USAGE, "layer %d has the height %g mm; it must be above 0", i,
                            height[i]);
    if (object_height / height[count - 1] > LAYERS_MAX)
        return iso_fail(ISO_USAGE, "%g mm in layers of %g mm are more than %d layers",
                        object_height, height[count - 1], LAYERS_MAX);
    return ISO_OK;
}

iso_status iso_levels_from_heights(iso_levels *levels, const double *height, int32_t count,
                                   double object_height) {
    *levels = (iso_levels){0};
    ISO_TRY(check_heights(height, count, object_height));
    int64_t room = count + (int64_t)(object_height / height[count - 1]) + 2;
    iso_levels made = {0};
    iso_status status = ISO_ALLOCATE(made.cut, room);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(made.top, room);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(made.height, room);
    if (status != ISO_OK) {
        iso_levels_free(&made);
        return status;
    }
    for (int64_t i = 0; i < room; i++) {
        double thick = height[i < count ? i : count - 1];
        double bottom = bottom_of(height, made.top, count, i), middle = bottom + 0.5 * thick;
        if (!(middle < object_height))
            break;
        made.cut[i] = middle;
        made.top[i] = i < count ? bottom + thick : bottom_of(height, made.top, count, i + 1);
        made.height[i] = thick;
        made.count++;
    }
    *levels = made;
    return ISO_OK;
}

iso_status iso_levels_uniform(iso_levels *levels, double object_height, double first,
                              double height) {
    return iso_levels_from_heights(levels, (double[]){first, height}, 2, object_height);
}

void iso_levels_free(iso_levels *levels) {
    iso_release(levels->cut);
    iso_release(levels->top);
    iso_release(levels->height);
    *levels = (iso_levels){0};
}
