/* Lattices of struts: bars between the nodes of a crystal that are a certain way apart. */
#include "lattice/family.h"

#include <string.h>

#include "lattice/segments.h"

enum { NODES_MAX = 12, SEGMENTS_MAX = 64 };

/* Nodes in quarters of the cell, three digits each; every node of `from` is joined to those of `to`
 * whose distance has the square `square`, whatever period they are in. */
typedef struct crystal {
    int32_t from_count, to_count;
    const char *from[NODES_MAX], *to[NODES_MAX];
    int32_t square;
} crystal;

#define CUBE_AND_FACES "000", "022", "202", "220"
#define KELVIN_NODES                                                                               \
    "102", "302", "210", "230", "021", "023", "120", "320", "012", "032", "201", "203"

/* In the order of iso_lattice_pattern. An octet truss has all the bonds of face-centred cubic; of
 * these, those in the faces of the cube alone make what is called FCC. Kelvin's cells are the
 * truncated octahedra around the nodes of BCC. */
static const crystal crystals[] = {
    {1, 1, {"000"}, {"222"}, 12},
    {1, 3, {"000"}, {"022", "202", "220"}, 8},
    {4, 4, {CUBE_AND_FACES}, {CUBE_AND_FACES}, 8},
    {12, 12, {KELVIN_NODES}, {KELVIN_NODES}, 2},
    {4, 4, {CUBE_AND_FACES}, {"111", "133", "313", "331"}, 3},
};

/* Of a bond that leads from nodes to nodes of the same set, the half that goes up. */
static int goes_up(const int32_t *way) {
    return way[2] != 0 ? way[2] > 0 : way[1] != 0 ? way[1] > 0 : way[0] > 0;
}

static int32_t join(iso_segment *out, const crystal *c, const char *from, const char *to,
                    float step) {
    int32_t made = 0, way[3];
    int same_set = memcmp(c->from[0], c->to[0], 3) == 0;
    for (int32_t period = 0; period < 27; period++) {
        const int32_t shift[3] = {period % 3 - 1, period / 3 % 3 - 1, period / 9 - 1};
        int32_t square = 0;
        for (int a = 0; a < 3; a++) {
            way[a] = to[a] - from[a] + 4 * shift[a];
            square += way[a] * way[a];
        }
        if (square != c->square || (same_set && !goes_up(way)))
            continue;
        for (int a = 0; a < 3; a++) {
            out[made].from[a] = (float)(from[a] - '0') * step;
            out[made].way[a] = (float)way[a] * step;
        }
        made++;
    }
    return made;
}

iso_status strut_fill(iso_lattice_cell *cell, const iso_lattice_options *options) {
    const crystal *c = &crystals[options->pattern - ISO_LATTICE_BCC_STRUTS];
    iso_segment segment[SEGMENTS_MAX];
    int32_t count = 0, size = cell->size[0];
    for (int32_t f = 0; f < c->from_count; f++)
        for (int32_t t = 0; t < c->to_count; t++)
            count += join(segment + count, c, c->from[f], c->to[t], 0.25f * (float)size);
    ISO_TRY(distance_from_segments(cell->distance, size, segment, count));
    for (int64_t i = 0; i < (int64_t)size * size * size; i++)
        cell->distance[i] /= (float)size;
    return ISO_OK;
}
