/* Sheets: surfaces without an inside, which are given a thickness.
 *
 * Every triangle is there twice, once a side, moved outwards by half the thickness. Across an edge
 * a side goes on with the side that continues it, whichever way the two triangles turn: so the two
 * sides of all triangles make up a closed oriented surface even of a Moebius strip (its orientable
 * double cover), but for the rims, where walls join them. Only two triangles go on into each other
 * at an edge; of more, the straightest pair does, and the others end within its thickness. */
#ifndef ISO_MESH_SHEET_H
#define ISO_MESH_SHEET_H

#include <isoslice/mesh.h>

/* Where faces meet at an angle, a corner moves further than half the thickness, so that the faces
 * keep their distance; but no further than this many times. 2 is an edge of 60 degrees. */
#define SHEET_MITRE 2.0

/* Zero-initialise, but for the thickness; sheets_free at the end. */
typedef struct sheets {
    double thickness; /* mm, above 0 */
    uint8_t *mark;    /* [triangles of the mesh at hand]: 1, this is of a sheet */
    int64_t marked;   /* is there any */
    int32_t *corner;  /* [3 count] vertices of triangles that were taken from the mesh */
    int64_t count, capacity;
} sheets;

void sheets_free(sheets *from);

/* Move the marked triangles from the mesh to `to`. Leaves opposite[] undefined, no marks. */
iso_status sheets_take(sheets *to, iso_mesh *mesh) ISO_MUST_CHECK;

/* Add to the mesh, whose vertices they use, what was taken, with its thickness, and count it. */
iso_status sheets_thicken(iso_mesh *mesh, const sheets *from) ISO_MUST_CHECK;

#endif
