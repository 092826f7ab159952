/* Shortest ways inside closed walls. */
#ifndef ISO_PATH_WAYS_H
#define ISO_PATH_WAYS_H

#include "path/edges.h"

/* A vertex at which the walls' inside is wider than a half turn: shortest ways bend only there. */
typedef struct iso_bend {
    iso_point at, before, after;
} iso_bend;

typedef struct iso_ways {
    const iso_edge_grid *grid;
    int32_t begin, end; /* owners of the edges that bound the inside */
    iso_bend *bend;     /* [count] */
    int32_t count;
    int32_t *near; /* [nears] bends that a way of the allowed length may reach */
    int32_t nears;
    int64_t patience; /* steps that a search may take; at first a million */
    double *length;   /* [nears + 1] of the way so far, units; at the end: `to` */
    int32_t *back;    /* [nears + 1] the bend before; -1: `from` */
    uint8_t *settled; /* [nears + 1] */
    iso_point *point; /* [nears] of the way found last */
    int32_t points;
} iso_ways;

/* Room for bends among `vertices` vertices. All on scratch. */
iso_status iso_ways_new(iso_ways *ways, const iso_edge_grid *grid, int32_t vertices,
                        iso_arena *scratch) ISO_MUST_CHECK;

/* A closed wall with the inside to its left. */
void iso_ways_add(iso_ways *ways, iso_point before, iso_point at, iso_point after);

/* Is the straight way inside? It may touch walls at its ends. */
int iso_ways_is_inside(const iso_ways *ways, iso_point from, iso_point to);

/* The shortest way inside (A* on the graph of bends that see each other, where a way is tangent to
 * both: Hart, Nilsson and Raphael 1968; Lozano-Perez and Wesley 1979). Its bends are point[0 ..
 * points - 1]. 0 if there is none no longer than `longest`, or none is found within so many
 * steps. */
int iso_ways_find(iso_ways *ways, iso_point from, iso_point to, double longest);

#endif
