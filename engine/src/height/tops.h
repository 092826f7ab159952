/* The tops of a model, seen from above, as samples on a grid. */
#ifndef ISO_HEIGHT_TOPS_H
#define ISO_HEIGHT_TOPS_H

#include <isoslice/mesh.h>

#include "height/spline.h"

enum { TOPS_ACROSS = 3 }; /* samples of a cell along a side */

/* A point of a surface that looks up and isn't too steep. */
typedef struct top {
    double x, y, z;
    double slope_x, slope_y; /* of z */
    double weight;           /* 0 to 1 */
} top;

typedef struct tops {
    top *top; /* [count] */
    int64_t count, capacity;
    double *tallest; /* [columns rows] by cell, whose corner is the point of that number; -INFINITY:
                        nothing of the model is above or below it */
} tops;

/* Those of mesh[count] whose slope is less than `steepest`. Only the grid of `s` is looked at. */
iso_status tops_find(tops *t, const spline *s, const iso_mesh *mesh, int32_t count,
                     double steepest) ISO_MUST_CHECK;
void tops_free(tops *t);

#endif
