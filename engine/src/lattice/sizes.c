#include "lattice/sizes.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/sort.h"

enum {
    SIDE = 88,         /* points along a cube's edge */
    MARGIN = SIDE / 5, /* where spheres of beyond the cube may be missing */
    POINTS = SIDE * SIDE * SIDE,
    HALF = SIDE / 2, /* spheres are painted on every other point: their number times their volume is
                      * what takes time */
    PAINTED = HALF * HALF * HALF,
    THIN = 32, /* middles of walls that are looked at more closely */
    FINER = 8, /* times */
    TRIED = 12 /* places along each axis */
};

static const double CELLS = 2.5; /* along a cube's edge */

/* On a wall's middle the distance to its surface changes little to any side, in a strut's neck
 * too; along the ridge that runs into a corner it grows by 0.58 or more. Between them this. */
static const double FLAT = 0.35;

/* A sphere that no neighbour's holds. */
typedef struct sphere {
    float radius; /* mm */
    int32_t at;
} sphere;

static int is_larger(const sphere *a, const sphere *b) {
    return a->radius != b->radius ? a->radius > b->radius : a->at < b->at;
}

static int is_less(const float *a, const float *b) {
    return *a < *b;
}

ISO_SORT(sort_spheres, sphere, is_larger)
ISO_SORT(sort_widths, float, is_less)

typedef struct cube {
    const iso_body *body;
    iso_vec3 corner; /* its first point */
    double step;
    float *material, *part; /* [POINTS] */
    float *radius;          /* [PAINTED] of the largest sphere found around a point */
    uint8_t *has_sphere;    /* [PAINTED] */
    sphere *sphere;
    int64_t count, capacity;
    /* what comes of it */
    double largest, smallest, wall_sum, crossed;
    sphere thin[THIN]; /* the smallest in walls and struts, by radius */
    int32_t thin_count;
    int64_t walls, part_points, material_points;
    float *width; /* [pores] diameters of pores, of the points well within */
    int64_t pores;
} cube;

/* All but the widths. */
static void cube_clear(cube *c) {
    iso_release(c->material);
    iso_release(c->part);
    iso_release(c->radius);
    iso_release(c->has_sphere);
    iso_release(c->sphere);
    c->material = c->part = c->radius = NULL;
    c->sphere = NULL;
    c->has_sphere = NULL;
}

static iso_status cube_new(cube *c) {
    ISO_TRY(ISO_ALLOCATE(c->material, POINTS));
    ISO_TRY(ISO_ALLOCATE(c->part, POINTS));
    ISO_TRY(ISO_ALLOCATE(c->radius, PAINTED));
    ISO_TRY(ISO_ALLOCATE(c->has_sphere, PAINTED));
    return ISO_ALLOCATE(c->width, PAINTED);
}

static iso_status sample_cube(cube *c, int worker) {
    for (int32_t k = 0; k < SIDE; k++)
        for (int32_t j = 0; j < SIDE; j++) {
            int32_t at = SIDE * (j + SIDE * k);
            iso_body_row row = {
                .first = {c->corner.x, c->corner.y + j * c->step, c->corner.z + k * c->step},
                .step = c->step,
                .count = SIDE,
                .j = -1,
                .k = -1,
                .exact = 1};
            ISO_TRY(
                c->body->sample(c->body->payload, c->material + at, c->part + at, &row, worker));
        }
    return ISO_OK;
}

/* ---- spheres ---- */

/* How far a point is within the material (side 1), or in the void of the part (side 0). */
static double depth(const cube *c, int32_t at, int side) {
    return side ? -(double)c->material[at] : fmin(c->material[at], -(double)c->part[at]);
}

/* The distance is a tent across the middle of a wall, and points lie beside its ridge: from three
 * of them in a row, the height of the ridge, which is before or behind the one in the middle. */
static double peak(double a, double b, double c) {
    return b + fabs(c - a) / 2;
}

/* Sets *steep to how much the depth grows towards a neighbour, at most; the sphere's true radius.
 */
static double look_around(double *steep, const cube *c, int32_t at, int side) {
    double here = depth(c, at, side), most = -1, radius = here;
    for (int32_t k = -1; k <= 1; k++)
        for (int32_t j = -1; j <= 1; j++)
            for (int32_t i = -1; i <= 1; i++) {
                int32_t n = i * i + j * j + k * k;
                if (n == 0)
                    continue;
                double away = n == 1 ? 1 : n == 2 ? 1.4142135623730951 : 1.7320508075688772;
                double there = depth(c, at + i + SIDE * (j + SIDE * k), side);
                most = fmax(most, (there - here) / (away * c->step));
            }
    static const int32_t next[3] = {1, SIDE, SIDE * SIDE};
    *steep = most;
    for (int axis = 0; axis < 3 && most < FLAT; axis++)
        radius = fmax(radius,
                      peak(depth(c, at - next[axis], side), here, depth(c, at + next[axis], side)));
    return radius;
}

static int is_well_within(int32_t at) {
    int32_t x = at % SIDE, y = at / SIDE % SIDE, z = at / SIDE / SIDE;
    int32_t last = SIDE - 1 - MARGIN;
    return x >= MARGIN && y >= MARGIN && z >= MARGIN && x <= last && y <= last && z <= last;
}

/* Keep the thinnest. A wall that the border of the part cuts has no width of its own. */
static void look_at_middle(cube *c, int32_t at, double radius, double steep) {
    if (steep >= FLAT || -(double)c->part[at] <= radius + c->step)
        return;
    int32_t i = c->thin_count < THIN ? c->thin_count++ : THIN - 1;
    if (i == THIN - 1 && c->thin[i].radius > 0 && c->thin[i].radius <= radius)
        return;
    for (; i > 0 && c->thin[i - 1].radius > radius; i--)
        c->thin[i] = c->thin[i - 1];
    c->thin[i] = (sphere){(float)radius, at};
}

/* Points lie beside a wall's middle, by half a step along each axis, so that it seems thinner. */
static iso_status refine(double *radius, const cube *c, int32_t at, int side, int worker) {
    float material[2 * FINER + 1], part[2 * FINER + 1];
    double fine = c->step / FINER;
    iso_vec3 p = {c->corner.x + (at % SIDE - 1) * c->step,
                  c->corner.y + (at / SIDE % SIDE - 1) * c->step,
                  c->corner.z + (at / SIDE / SIDE - 1) * c->step};
    for (int32_t k = 0; k <= 2 * FINER; k++)
        for (int32_t j = 0; j <= 2 * FINER; j++) {
            iso_body_row row = {.first = {p.x, p.y + j * fine, p.z + k * fine},
                                .step = fine,
                                .count = 2 * FINER + 1,
                                .j = -1,
                                .k = -1,
                                .exact = 1};
            ISO_TRY(c->body->sample(c->body->payload, material, part, &row, worker));
            for (int32_t i = 0; i < row.count; i++)
                *radius = fmax(*radius,
                               side ? -(double)material[i] : fmin(material[i], -(double)part[i]));
        }
    return ISO_OK;
}

/* The first of the spheres is the largest. */
static iso_status find_largest(cube *c, int worker) {
    double radius = 0;
    if (c->count > 0)
        ISO_TRY(refine(&radius, c, c->sphere[0].at, 0, worker));
    c->largest = 2 * radius;
    return ISO_OK;
}

static iso_status find_thinnest(cube *c, int worker) {
    for (int32_t i = 0; i < c->thin_count; i++) {
        double radius = 0;
        ISO_TRY(refine(&radius, c, c->thin[i].at, 1, worker));
        c->smallest = fmin(c->smallest, 2 * radius);
    }
    return ISO_OK;
}

static iso_status find_spheres(cube *c, int side) {
    c->count = 0;
    for (int32_t k = 1; k < SIDE - 1; k++)
        for (int32_t j = 1; j < SIDE - 1; j++)
            for (int32_t i = 1; i < SIDE - 1; i++) {
                int32_t at = i + SIDE * (j + SIDE * k);
                double steep;
                if (depth(c, at, side) <= 0)
                    continue;
                double radius = look_around(&steep, c, at, side);
                if (steep > 0.9) /* another sphere holds this one, or all but a crumb of it */
                    continue;
                if (side)
                    look_at_middle(c, at, radius, steep);
                ISO_TRY(ISO_GROW(c->sphere, c->capacity, c->count + 1));
                c->sphere[c->count++] = (sphere){(float)radius, at};
            }
    sort_spheres(c->sphere, c->count);
    return ISO_OK;
}

static int32_t above_zero(int32_t i) {
    return i > 0 ? i : 0;
}

static int32_t below_half(int32_t i) {
    return i < HALF - 1 ? i : HALF - 1;
}

/* Largest first: a point that has a radius keeps it. One sphere a painted point: those beside it
 * are no larger, and cover what it covers. */
static void paint(cube *c, const sphere *s) {
    int32_t x = s->at % SIDE, y = s->at / SIDE % SIDE, z = s->at / SIDE / SIDE;
    uint8_t *has = &c->has_sphere[x / 2 + HALF * (y / 2 + HALF * (z / 2))];
    double r = s->radius / (2 * c->step), mx = x / 2.0, my = y / 2.0, mz = z / 2.0;
    int32_t reach = (int32_t)r + 1;
    if (*has)
        return;
    *has = 1;
    for (int32_t k = above_zero(z / 2 - reach); k <= below_half(z / 2 + reach); k++)
        for (int32_t j = above_zero(y / 2 - reach); j <= below_half(y / 2 + reach); j++) {
            double left = r * r - (k - mz) * (k - mz) - (j - my) * (j - my);
            if (left < 0)
                continue;
            double half = sqrt(left);
            float *row = c->radius + HALF * (j + HALF * k);
            for (int32_t i = above_zero((int32_t)ceil(mx - half));
                 i <= below_half((int32_t)(mx + half)); i++)
                row[i] = row[i] > 0 ? row[i] : s->radius;
        }
}

/* Of a point that no sphere reached, since not all were painted, or in a corner: that of a point
 * beside it, or what it has itself. */
static double radius_at(const cube *c, int32_t i, int32_t j, int32_t k, double deep) {
    double radius = c->radius[i + HALF * (j + HALF * k)];
    for (int32_t z = k - 1; z <= k + 1 && radius <= 0; z++)
        for (int32_t y = j - 1; y <= j + 1; y++)
            for (int32_t x = i - 1; x <= i + 1; x++)
                deep = fmax(deep, c->radius[x + HALF * (y + HALF * z)]);
    return fmax(deep, radius);
}

static void collect(cube *c, int side) {
    for (int32_t k = 1; k < HALF - 1; k++)
        for (int32_t j = 1; j < HALF - 1; j++)
            for (int32_t i = 1; i < HALF - 1; i++) {
                int32_t at = 2 * i + SIDE * (2 * j + SIDE * 2 * k);
                double deep = depth(c, at, side);
                if (deep <= 0 || !is_well_within(at))
                    continue;
                double width = 2 * radius_at(c, i, j, k, deep);
                if (side)
                    c->wall_sum += width, c->walls++;
                else
                    c->width[c->pores++] = (float)fmin(width, c->largest);
            }
}

/* As cross() of the count. */
static void measure(cube *c) {
    static const int32_t next[3] = {1, SIDE, SIDE * SIDE};
    for (int32_t at = 0; at < POINTS; at++) {
        if (c->part[at] > 0 || !is_well_within(at))
            continue;
        c->part_points++;
        c->material_points += c->material[at] <= 0;
        for (int axis = 0; axis < 3; axis++) {
            double a = c->material[at], b = c->material[at + next[axis]];
            c->crossed += (a <= 0) != (b <= 0) ? fmin(fabs(a - b), c->step) : 0;
        }
    }
}

static iso_status look_closely(cube *c, int worker) {
    ISO_TRY(cube_new(c));
    ISO_TRY(sample_cube(c, worker));
    measure(c);
    for (int side = 0; side < 2; side++) {
        ISO_TRY(find_spheres(c, side));
        ISO_TRY(side ? find_thinnest(c, worker) : find_largest(c, worker));
        memset(c->radius, 0, PAINTED * sizeof *c->radius);
        memset(c->has_sphere, 0, PAINTED);
        for (int64_t i = 0; i < c->count; i++)
            paint(c, &c->sphere[i]);
        collect(c, side);
    }
    return ISO_OK;
}

static iso_status look_into_cube(void *payload, int64_t task, int worker) {
    cube *c = (cube *)payload + task;
    iso_status status = look_closely(c, worker);
    cube_clear(c);
    return status;
}

/* ---- where to look ---- */

typedef struct places {
    const iso_body *body;
    double extent[3];
    float depth[TRIED * TRIED * TRIED]; /* in the part */
} places;

static iso_vec3 place_at(const places *p, int32_t i, int32_t j, int32_t k) {
    const iso_vec3 *min = &p->body->min;
    return (iso_vec3){min->x + p->extent[0] * (i + 0.5) / TRIED,
                      min->y + p->extent[1] * (j + 0.5) / TRIED,
                      min->z + p->extent[2] * (k + 0.5) / TRIED};
}

static iso_status try_places(places *p, const iso_body *body) {
    p->body = body;
    for (int axis = 0; axis < 3; axis++)
        p->extent[axis] = (body->size[axis] - 1) * body->voxel;
    for (int32_t k = 0; k < TRIED; k++)
        for (int32_t j = 0; j < TRIED; j++) {
            float material[TRIED], part[TRIED];
            iso_body_row row = {.first = place_at(p, 0, j, k),
                                .step = p->extent[0] / TRIED,
                                .count = TRIED,
                                .j = -1,
                                .k = -1,
                                .exact = 1};
            ISO_TRY(body->sample(body->payload, material, part, &row, 0));
            for (int32_t i = 0; i < TRIED; i++)
                p->depth[i + TRIED * (j + TRIED * k)] = -part[i];
        }
    return ISO_OK;
}

/* Of the places in an eighth of the box that are at least half as deep in the part as any there,
 * and not in its skin: the one nearest to the eighth's middle. */
static int choose_place(iso_vec3 *place, const places *p, int32_t eighth) {
    static const int32_t half = TRIED / 2;
    int32_t low[3], best = INT32_MAX;
    double deepest = 0, cap = p->extent[0] + p->extent[1] + p->extent[2];
    for (int axis = 0; axis < 3; axis++)
        low[axis] = eighth >> axis & 1 ? half : 0;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t k = low[2]; k < low[2] + half; k++)
            for (int32_t j = low[1]; j < low[1] + half; j++)
                for (int32_t i = low[0]; i < low[0] + half; i++) {
                    double deep = fmin(cap, p->depth[i + TRIED * (j + TRIED * k)]);
                    int32_t x = 2 * (i - low[0]) + 1 - half, y = 2 * (j - low[1]) + 1 - half,
                            z = 2 * (k - low[2]) + 1 - half, away = x * x + y * y + z * z;
                    if (pass == 0)
                        deepest = fmax(deepest, deep);
                    if (pass == 0 || deep <= p->body->skin || deep < deepest / 2 || away >= best)
                        continue;
                    best = away;
                    *place = place_at(p, i, j, k);
                }
    return best < INT32_MAX;
}

static iso_status find_places(iso_vec3 place[SIZES_CUBES_MOST], int32_t *count, int32_t most,
                              const iso_body *body) {
    places p;
    *count = 0;
    ISO_TRY(try_places(&p, body));
    for (int32_t eighth = 0; eighth < SIZES_CUBES_MOST && *count < most; eighth++)
        *count += choose_place(&place[*count], &p, eighth);
    return ISO_OK;
}

/* ---- all cubes ---- */

static double share_of(const float *sorted, int64_t count, double share) {
    return sorted[(int64_t)(share * (double)(count - 1) + 0.5)];
}

static iso_status sum_pores(iso_sizes *sizes, const cube *c, int32_t count) {
    int64_t pores = 0, at = 0;
    double sum = 0;
    float *width;
    for (int32_t i = 0; i < count; i++)
        pores += c[i].pores;
    if (pores == 0)
        return ISO_OK;
    ISO_TRY(ISO_ALLOCATE(width, pores));
    for (int32_t i = 0; i < count; i++)
        for (int64_t p = 0; p < c[i].pores; p++)
            sum += width[at++] = c[i].width[p];
    sort_widths(width, pores);
    sizes->pore_mean = sum / (double)pores;
    sizes->pore_d10 = share_of(width, pores, 0.1);
    sizes->pore_d50 = share_of(width, pores, 0.5);
    sizes->pore_d90 = share_of(width, pores, 0.9);
    iso_release(width);
    return ISO_OK;
}

static iso_status sum_up(iso_sizes *sizes, const cube *c, int32_t count) {
    double walls = 0, smallest = HUGE_VAL, crossed = 0;
    int64_t wall_points = 0, part = 0, material = 0;
    for (int32_t i = 0; i < count; i++) {
        sizes->pore_largest = fmax(sizes->pore_largest, c[i].largest);
        smallest = fmin(smallest, c[i].smallest);
        walls += c[i].wall_sum, wall_points += c[i].walls;
        crossed += c[i].crossed;
        part += c[i].part_points, material += c[i].material_points;
    }
    sizes->wall_mean = wall_points > 0 ? walls / (double)wall_points : 0;
    sizes->wall_smallest = smallest < HUGE_VAL ? smallest : 0;
    sizes->surface = part > 0 ? crossed / (sizes->detail * sizes->detail * (double)part) : 0;
    sizes->material = part > 0 ? (double)material / (double)part : 0;
    return sum_pores(sizes, c, count);
}

iso_status body_sizes(iso_sizes *sizes, const iso_body *body, double cell, int32_t cubes,
                      iso_pool *pool) {
    iso_vec3 place[SIZES_CUBES_MOST];
    cube all[SIZES_CUBES_MOST] = {{0}};
    int32_t count;
    *sizes = (iso_sizes){0};
    ISO_TRY(find_places(place, &count, cubes, body));
    if (count == 0)
        return ISO_OK;
    sizes->detail = CELLS * cell / (SIDE - 1);
    for (int32_t i = 0; i < count; i++) {
        double half = CELLS * cell / 2;
        iso_vec3 at = place[i];
        all[i] = (cube){.body = body,
                        .corner = {at.x - half, at.y - half, at.z - half},
                        .step = sizes->detail,
                        .smallest = HUGE_VAL};
    }
    iso_status status = iso_parallel_for(pool, count, look_into_cube, all);
    if (status == ISO_OK)
        status = sum_up(sizes, all, count);
    for (int32_t i = 0; i < count; i++)
        iso_release(all[i].width);
    return status;
}
