/* A mesh whose edges are split where a field asks for it; a double-link after every round. */
#ifndef ISO_SLICE_REFINED_H
#define ISO_SLICE_REFINED_H

#include <isoslice/field.h>
#include <isoslice/slice.h>

#include "base/memory.h"

/* A face that edges are split of. */
typedef struct refined_parent {
    int32_t face;
    int32_t corner[3], opposite[3]; /* as they were */
    int32_t middle[3];              /* vertex in the middle of the dart's edge, or -1 */
    int32_t half[3][2];             /* darts that take the dart's place */
} refined_parent;

typedef struct refined {
    const iso_mesh *mesh; /* its arrays are used as long as no edge is split */
    const iso_field *field;
    int32_t triangle_count, vertex_count;
    const int32_t *origin, *opposite;
    const iso_vec3 *position;
    double *value;      /* [vertex] of the field */
    iso_vec3 *gradient; /* [vertex] */

    /* of our own, and for splitting */
    int32_t *own_origin, *own_opposite, *middle; /* [dart]; middle: vertex + 1 of a marked edge */
    int32_t *parent_of;                          /* [face] number of its parent + 1, or 0 */
    uint8_t *settled;                            /* [face] no level comes near: never asked again */
    iso_vec3 *own_position;
    refined_parent *parent;
    int32_t parent_count, new_vertices;
    int64_t dart_capacity[3], face_capacity[2], vertex_capacity[3], parent_capacity;
} refined;

/* ISO_UNSLICEABLE: the field has no value at a vertex. Free it also after a failure. */
iso_status refined_begin(refined *r, const iso_mesh *mesh, const iso_field *field) ISO_MUST_CHECK;
void refined_free(refined *r);

/* The edge of a dart is to be split in its middle, for both its faces. */
iso_status refined_mark(refined *r, int32_t dart) ISO_MUST_CHECK;

/* Split the marked edges and all faces at them. Faces that must be asked again are appended to
 * `queue`. */
typedef struct refined_queue {
    int32_t *face;
    int64_t count, capacity;
} refined_queue;
iso_status refined_split(refined *r, refined_queue *queue) ISO_MUST_CHECK;

#endif
