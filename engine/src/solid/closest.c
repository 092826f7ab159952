/* A tree of discs: flat cylinders, each around the triangles of a node, with the axis that their
 * area gives. On a surface a node is hardly thicker than its triangles bend, whichever way it
 * leans; a box along the axes would be as thick as it is wide, and a point deep inside would have
 * hundreds of triangles that may be nearest.
 *
 * Four nodes at a time are tested in single precision, with room for its rounding; what triangles
 * say is in double. */
#include "solid/closest.h"

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"
#include "solid/halves.h"

enum { WAYS = 4, LEVELS_MAX = 16, WAITING_MAX = (WAYS - 1) * LEVELS_MAX + WAYS };

/* Of the squared distance to a disc's middle: more than what rounding to float makes of it. */
#define SLACK 4e-6f

/* The children of a node, from the middle of all. */
typedef struct discs {
    float x[WAYS], y[WAYS], z[WAYS];
    float nx[WAYS], ny[WAYS], nz[WAYS]; /* axis, of length 1 */
    float radius[WAYS], half[WAYS];     /* half the thickness */
} discs;

/* A triangle in its own frame: from corner a along its longest side, which ends at (along, 0); the
 * third corner is (x, y). */
typedef struct flat {
    iso_vec3 a, u, v, normal;
    double along, x, y;   /* y = 0: no more than a side */
    double second, third; /* 1 / square of the sides' lengths; 0 where it is no side */
} flat;

struct iso_closest {
    int64_t count;
    iso_vec3 middle;
    double size;    /* of the box of all, along its diagonal */
    int levels;     /* the root is level 0, alone; a level has 4 times the nodes of the last */
    int32_t leaves; /* number of the first; children of i are 4 i + 1 to 4 i + 4 */
    discs *node;    /* [leaves] */
    flat *flat;     /* [count] by the leaves, of one triangle at most */
    int32_t *from;  /* [count] which of those given it was */
};

// One triangle

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static iso_vec3 scaled(iso_vec3 a, double by) {
    return (iso_vec3){by * a.x, by * a.y, by * a.z};
}

/* A triangle whose height is less than this share of its longest side has no plane to speak of. */
#define THINNEST 1e-8

/* Any direction across another. */
static iso_vec3 across(iso_vec3 u) {
    double x = fabs(u.x), y = fabs(u.y), z = fabs(u.z);
    iso_vec3 least = {x <= y && x <= z, y < x && y <= z, z < x && z < y};
    iso_vec3 v = cross(u, least);
    return scaled(v, 1 / sqrt(dot(v, v)));
}

static double inverse(double square) {
    return square > 0 ? 1 / square : 0;
}

static void set_flat(flat *to, const iso_vec3 corner[3]) {
    int first = 0;
    double longest = -1;
    for (int i = 0; i < 3; i++) {
        iso_vec3 side = minus(corner[(i + 1) % 3], corner[i]);
        if (dot(side, side) > longest) {
            longest = dot(side, side);
            first = i;
        }
    }
    iso_vec3 a = corner[first], ab = minus(corner[(first + 1) % 3], a);
    iso_vec3 ac = minus(corner[(first + 2) % 3], a);
    double along = sqrt(longest);
    iso_vec3 u = along > 0 ? scaled(ab, 1 / along) : (iso_vec3){1, 0, 0};
    double x = dot(ac, u);
    iso_vec3 v = minus(ac, scaled(u, x));
    v = minus(v, scaled(u, dot(v, u)));
    double y = sqrt(dot(v, v));
    bool thin = !(y > THINNEST * along);
    v = thin ? across(u) : scaled(v, 1 / y);
    y = thin ? 0 : y;
    *to = (flat){.a = a,
                 .u = u,
                 .v = v,
                 .normal = cross(u, v),
                 .along = along,
                 .x = x,
                 .y = y,
                 .second = inverse((along - x) * (along - x) + y * y),
                 .third = inverse(x * x + y * y)};
}

/* Square of the distance in the plane from (x, y) to a side that goes on by (dx, dy). */
static inline double to_side(double x, double y, double dx, double dy, double inverse_square) {
    double part = (x * dx + y * dy) * inverse_square;
    part = part > 0 ? part : 0;
    part = part < 1 ? part : 1;
    x -= part * dx;
    y -= part * dy;
    return x * x + y * y;
}

static inline double to_flat(const flat *t, iso_vec3 p) {
    iso_vec3 way = minus(p, t->a);
    double x = dot(way, t->u), y = dot(way, t->v), z = dot(way, t->normal);
    double beyond = t->along - t->x;
    if (t->y > 0 && y >= 0 && x * t->y >= y * t->x && (t->along - x) * t->y >= y * beyond)
        return z * z;
    double over = x < 0 ? x : x > t->along ? x - t->along : 0;
    double least = over * over + y * y;
    double other = to_side(x - t->along, y, -beyond, t->y, t->second);
    least = other < least ? other : least;
    other = to_side(x, y, t->x, t->y, t->third);
    return z * z + (other < least ? other : least);
}

// The tree

static double larger(double a, double b) {
    return a > b ? a : b;
}

static void grow_box(iso_vec3 *min, iso_vec3 *max, const iso_vec3 *p) {
    min->x = p->x < min->x ? p->x : min->x;
    min->y = p->y < min->y ? p->y : min->y;
    min->z = p->z < min->z ? p->z : min->z;
    max->x = p->x > max->x ? p->x : max->x;
    max->y = p->y > max->y ? p->y : max->y;
    max->z = p->z > max->z ? p->z : max->z;
}

/* Twice the area, as a vector of length 1; any, where sides cancel. */
static iso_vec3 axis_of(const iso_vec3 *corner, int64_t count) {
    iso_vec3 sum = {0, 0, 0};
    for (int64_t i = 0; i < count; i++) {
        const iso_vec3 *t = corner + 3 * i;
        iso_vec3 n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
        /* the other way around is as flat */
        double sense = dot(n, sum) < 0 ? -1 : 1;
        sum = (iso_vec3){sum.x + sense * n.x, sum.y + sense * n.y, sum.z + sense * n.z};
    }
    double length = sqrt(dot(sum, sum));
    if (!(length > 1e-100))
        return (iso_vec3){0, 0, 1};
    return (iso_vec3){sum.x / length, sum.y / length, sum.z / length};
}

/* Everything is measured from what the floats say, and only then made larger. */
static void set_disc(discs *to, int way, const iso_closest *tree, const iso_vec3 *corner,
                     int64_t count) {
    if (count == 0) { /* nowhere */
        to->x[way] = to->y[way] = to->z[way] = INFINITY;
        to->nx[way] = to->ny[way] = to->nz[way] = to->radius[way] = to->half[way] = 0;
        return;
    }
    iso_vec3 min = corner[0], max = min, axis = axis_of(corner, count);
    for (int64_t i = 1; i < 3 * count; i++)
        grow_box(&min, &max, &corner[i]);
    to->x[way] = (float)((min.x + max.x) / 2 - tree->middle.x);
    to->y[way] = (float)((min.y + max.y) / 2 - tree->middle.y);
    to->z[way] = (float)((min.z + max.z) / 2 - tree->middle.z);
    to->nx[way] = (float)axis.x;
    to->ny[way] = (float)axis.y;
    to->nz[way] = (float)axis.z;
    const iso_vec3 middle = {tree->middle.x + (double)to->x[way],
                             tree->middle.y + (double)to->y[way],
                             tree->middle.z + (double)to->z[way]};
    axis = (iso_vec3){(double)to->nx[way], (double)to->ny[way], (double)to->nz[way]};
    double radius = 0, half = 0;
    for (int64_t i = 0; i < 3 * count; i++) {
        iso_vec3 way_to = minus(corner[i], middle);
        double height = dot(way_to, axis);
        half = larger(half, fabs(height));
        radius = larger(radius, dot(way_to, way_to) - height * height);
    }
    to->radius[way] = (float)(sqrt(radius) * (1 + 1e-6) + 1e-6 * tree->size);
    to->half[way] = (float)(half * (1 + 1e-6) + 1e-6 * tree->size);
}

static void make_nodes(iso_closest *tree, const iso_vec3 *corner) {
    int32_t node = 0;
    for (int level = 0; level < tree->levels; level++)
        for (int32_t k = 0; k < 1 << 2 * level; k++, node++)
            for (int way = 0; way < WAYS; way++) {
                int64_t child = WAYS * (int64_t)k + way;
                int64_t first = halves_first(tree->count, 2 * level + 2, child);
                int64_t end = halves_first(tree->count, 2 * level + 2, child + 1);
                set_disc(&tree->node[node], way, tree, corner + 3 * first, end - first);
            }
    for (int64_t i = 0; i < tree->count; i++)
        set_flat(&tree->flat[i], corner + 3 * i);
}

static void measure(iso_closest *tree, const iso_vec3 *corner) {
    iso_vec3 min = corner[0], max = min;
    for (int64_t i = 1; i < 3 * tree->count; i++)
        grow_box(&min, &max, &corner[i]);
    iso_vec3 side = minus(max, min);
    tree->middle = (iso_vec3){(min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2};
    tree->size = sqrt(dot(side, side));
}

static iso_status fill(iso_closest *tree, const iso_vec3 *corner) {
    int32_t *from = tree->from;
    iso_vec3 *ordered;
    ISO_TRY(ISO_ALLOCATE(ordered, 3 * tree->count));
    iso_status status = halves_order(from, corner, tree->count, 2 * tree->levels);
    if (status == ISO_OK) {
        for (int64_t i = 0; i < tree->count; i++)
            memcpy(&ordered[3 * i], &corner[3 * (int64_t)from[i]], 3 * sizeof *corner);
        measure(tree, ordered);
        make_nodes(tree, ordered);
    }
    iso_release(ordered);
    return status;
}

iso_status closest_new(iso_closest **tree, const iso_vec3 *corner, int64_t count) {
    *tree = NULL;
    if (count > INT32_MAX / 2)
        return iso_fail(ISO_UNSLICEABLE, "more than %d triangles in one object", INT32_MAX / 2);
    iso_closest *made;
    ISO_TRY(ISO_ALLOCATE(made, 1));
    *made = (iso_closest){.count = count};
    for (; count > (int64_t)1 << 2 * made->levels; made->levels++)
        made->leaves = WAYS * made->leaves + 1;
    iso_status status = ISO_ALLOCATE(made->flat, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(made->from, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(made->node, made->leaves);
    if (status == ISO_OK && count > 0)
        status = fill(made, corner);
    if (status != ISO_OK) {
        closest_free(made);
        return status;
    }
    *tree = made;
    return ISO_OK;
}

void closest_free(iso_closest *tree) {
    if (!tree)
        return;
    iso_release(tree->node);
    iso_release(tree->flat);
    iso_release(tree->from);
    iso_release(tree);
}

int32_t closest_number(const iso_closest *tree, int32_t guess) {
    return tree->from[guess];
}

// Asking

typedef struct waiting_node {
    float least; /* square; nothing in it is nearer */
    int32_t node;
} waiting_node;

/* x, or 0 where that is less. Without a branch, so that four go side by side. */
static inline float positive(float x) {
    return 0.5f * (x + fabsf(x));
}

/* No less than so far, squared, is what is in each of four discs. */
static inline void bound_discs(float least[WAYS], const discs *d, const float p[3]) {
    for (int i = 0; i < WAYS; i++) {
        float x = p[0] - d->x[i], y = p[1] - d->y[i], z = p[2] - d->z[i];
        float square = x * x + y * y + z * z;
        float height = x * d->nx[i] + y * d->ny[i] + z * d->nz[i];
        float across = positive(sqrtf(positive(square - height * height)) - d->radius[i]);
        float above = positive(fabsf(height) - d->half[i]);
        least[i] = above * above + across * across - SLACK * square;
    }
}

/* Children that may hold something nearer than `most`, the nearest on top. */
static int push_children(waiting_node *waiting, int count, const float least[WAYS], int32_t node,
                         float most) {
    int first = count;
    for (int i = 0; i < WAYS; i++) {
        if (!(least[i] < most))
            continue;
        int at = count++;
        for (; at > first && waiting[at - 1].least < least[i]; at--)
            waiting[at] = waiting[at - 1];
        waiting[at] = (waiting_node){least[i], WAYS * node + 1 + i};
    }
    return count;
}

double closest_square(const iso_closest *tree, iso_vec3 p, double most, int32_t *guess) {
    if (tree->count == 0)
        return most;
    double square = to_flat(&tree->flat[*guess], p);
    most = square < most ? square : most;
    const float from[3] = {(float)(p.x - tree->middle.x), (float)(p.y - tree->middle.y),
                           (float)(p.z - tree->middle.z)};
    waiting_node waiting[WAITING_MAX];
    int count = 0;
    waiting[count++] = (waiting_node){0, 0};
    float limit = (float)most * 1.00001f;
    while (count > 0) {
        waiting_node next = waiting[--count];
        if (!(next.least < limit) && next.least > 0)
            continue;
        if (next.node >= tree->leaves) {
            int64_t leaf = next.node - tree->leaves;
            int64_t triangle = halves_first(tree->count, 2 * tree->levels, leaf);
            square = to_flat(&tree->flat[triangle], p);
            if (square < most) {
                most = square;
                limit = (float)most * 1.00001f;
                *guess = (int32_t)triangle;
            }
            continue;
        }
        float least[WAYS];
        bound_discs(least, &tree->node[next.node], from);
        count = push_children(waiting, count, least, next.node, limit);
    }
    return most;
}

int closest_gather(int32_t *near, int most, const iso_closest *tree, iso_vec3 p, double reach) {
    const float from[3] = {(float)(p.x - tree->middle.x), (float)(p.y - tree->middle.y),
                           (float)(p.z - tree->middle.z)};
    const float limit = (float)(reach * reach) * 1.00001f;
    waiting_node waiting[WAITING_MAX];
    int count = 0, found = 0;
    if (tree->count > 0)
        waiting[count++] = (waiting_node){0, 0};
    while (count > 0) {
        int32_t node = waiting[--count].node;
        if (node < tree->leaves) {
            float least[WAYS];
            bound_discs(least, &tree->node[node], from);
            count = push_children(waiting, count, least, node, limit);
            continue;
        }
        int64_t triangle = halves_first(tree->count, 2 * tree->levels, node - tree->leaves);
        if (to_flat(&tree->flat[triangle], p) > reach * reach)
            continue;
        if (found == most)
            return most + 1;
        near[found++] = (int32_t)triangle;
    }
    return found;
}

double closest_of_few(const iso_closest *tree, const int32_t *near, int count, iso_vec3 p,
                      double most) {
    for (int i = 0; i < count; i++) {
        double square = to_flat(&tree->flat[near[i]], p);
        most = square < most ? square : most;
    }
    return most;
}
