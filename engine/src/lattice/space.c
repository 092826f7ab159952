#include "lattice/space.h"

#include <math.h>
#include <stddef.h>

#include "lattice/skin.h"

static double lesser(double a, double b) {
    return a < b ? a : b;
}

static double greater(double a, double b) {
    return a > b ? a : b;
}

static void join_box(iso_vec3 *min, iso_vec3 *max, const iso_mesh *mesh) {
    *min = (iso_vec3){lesser(min->x, mesh->min.x), lesser(min->y, mesh->min.y),
                      lesser(min->z, mesh->min.z)};
    *max = (iso_vec3){greater(max->x, mesh->max.x), greater(max->y, mesh->max.y),
                      greater(max->z, mesh->max.z)};
}

/* Squared distance from the origin to a segment. */
static double square_to_segment(iso_vec2 a, iso_vec2 b) {
    double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    double t = length > 0 ? -(a.x * dx + a.y * dy) / length : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double x = a.x + t * dx, y = a.y + t * dy;
    return x * x + y * y;
}

/* The same to a triangle; 0 where it covers the origin. Upright ones cover nothing. */
static double square_to_triangle(const iso_vec2 corner[3]) {
    double least = HUGE_VAL;
    int left = 0, right = 0;
    for (int k = 0; k < 3; k++) {
        iso_vec2 a = corner[k], b = corner[(k + 1) % 3];
        double side = a.x * b.y - a.y * b.x;
        left += side >= 0;
        right += side <= 0;
        least = lesser(least, square_to_segment(a, b));
    }
    return (left == 3) != (right == 3) ? 0 : least;
}

/* Sums over the volume, by the divergence theorem: div(r (x, y, 0)) = 3 r, div(R (x, y, z)) = 4 R,
 * div(x, y, z) = 3. On a triangle the middles of its sides stand for all of it. */
typedef struct volume_sums {
    double volume, r, radius;
} volume_sums;

static void add_triangle(volume_sums *sums, const iso_vec3 p[3], double middle) {
    iso_vec3 a = {p[1].x - p[0].x, p[1].y - p[0].y, p[1].z - p[0].z};
    iso_vec3 b = {p[2].x - p[0].x, p[2].y - p[0].y, p[2].z - p[0].z};
    iso_vec3 n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    for (int k = 0; k < 3; k++) { /* twice the area is in n: a sixth of it for each middle */
        const iso_vec3 *q = &p[k], *e = &p[(k + 1) % 3];
        double x = (q->x + e->x) / 2, y = (q->y + e->y) / 2, z = (q->z + e->z) / 2 - middle;
        double flat = (x * n.x + y * n.y) / 6, round = flat + z * n.z / 6;
        sums->volume += round / 3;
        sums->r += sqrt(x * x + y * y) * flat / 3;
        sums->radius += sqrt(x * x + y * y + z * z) * round / 4;
    }
}

static double usable(double mean, double largest) {
    return mean > largest / 100 && mean < largest ? mean : largest / 2;
}

static void measure(iso_space *space, const iso_mesh *mesh, int32_t count) {
    double least = HUGE_VAL, middle = space->max.z / 2;
    volume_sums sums = {0};
    for (int32_t m = 0; m < count; m++) {
        for (int32_t t = 0; t < mesh[m].triangle_count; t++) {
            iso_vec3 corner[3];
            iso_vec2 flat[3];
            for (int k = 0; k < 3; k++) {
                iso_vec3 p = mesh[m].position[mesh[m].origin[3 * t + k]];
                corner[k] =
                    (iso_vec3){p.x - space->origin.x, p.y - space->origin.y, p.z - space->origin.z};
                flat[k] = (iso_vec2){corner[k].x, corner[k].y};
            }
            add_triangle(&sums, corner, middle);
            least = lesser(least, square_to_triangle(flat));
        }
    }
    double r = sqrt(space->max.x * space->max.x + space->max.y * space->max.y);
    space->least_r = sqrt(least);
    space->mean_r = usable(sums.r / sums.volume, r);
    space->mean_radius = usable(sums.radius / sums.volume, sqrt(r * r + middle * middle));
}

static iso_status find_frame(iso_space *space, const iso_mesh *mesh, int32_t count) {
    iso_vec3 min = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, max = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    int64_t triangles = 0;
    for (int32_t i = 0; i < count; i++) {
        if (mesh[i].triangle_count == 0)
            continue;
        join_box(&min, &max, &mesh[i]);
        triangles += mesh[i].triangle_count;
    }
    if (triangles == 0)
        return iso_fail(ISO_UNSLICEABLE, "a lattice in no part: there are no triangles");
    iso_vec3 origin = {(min.x + max.x) / 2, (min.y + max.y) / 2, min.z};
    space->origin = origin;
    space->min = (iso_vec3){min.x - origin.x, min.y - origin.y, 0};
    space->max = (iso_vec3){max.x - origin.x, max.y - origin.y, max.z - origin.z};
    return ISO_OK;
}

/* ---- skin and grid ---- */

static iso_status make_skin(iso_space *space, const iso_lattice_options *options,
                            const iso_mesh *mesh, int32_t count) {
    iso_vec3 side = {2 * space->max.x, 2 * space->max.y, space->max.z};
    double largest = greater(side.x, greater(side.y, side.z));
    double smallest = lesser(side.x, lesser(side.y, side.z));
    double voxel = options->skin_voxel > 0 ? options->skin_voxel : largest / 128;
    const iso_skin_options skin = {
        .origin = space->origin, .voxel = voxel, .inner = smallest / 2 + 2 * voxel};
    return skin_make(&space->skin, mesh, count, &skin);
}

static iso_status make_grid(iso_space *space, const iso_lattice_options *options) {
    if (!options->grid || !*options->grid)
        return iso_fail(ISO_BAD_CONFIG, "an expression has grid in it, but lattice_grid names no "
                                        ".vdb file");
    return volume_read(&space->grid, options->grid, NULL);
}

iso_status space_make(iso_space *space, const iso_lattice_options *options, uint32_t wanted,
                      const iso_mesh *mesh, int32_t count) {
    *space = (iso_space){0};
    iso_status status = find_frame(space, mesh, count);
    if (status != ISO_OK)
        return status;
    measure(space, mesh, count);
    if (wanted >> GRADING_GRID & 1)
        status = make_grid(space, options);
    if (status == ISO_OK && (wanted >> GRADING_SKIN & 1))
        status = make_skin(space, options, mesh, count);
    if (status != ISO_OK)
        space_free(space);
    return status;
}

void space_free(iso_space *space) {
    volume_free(space->skin);
    volume_free(space->grid);
    space->skin = space->grid = NULL;
}

/* A volume's samples come from another library: 24 bits of each are taken for true, lest the last
 * ones decide anything. */
static double trusted(double value) {
    double spread = value * 536870913; /* 2^29 + 1 */
    return spread - (spread - value);
}

static void sample_volume(double *value, const iso_volume *volume, const iso_places *places,
                          double factor, int32_t count) {
    iso_vec3 point[GRADING_BLOCK] = {0};
    for (int32_t i = 0; i < count; i++)
        point[i] = (iso_vec3){places->value[GRADING_X][i], places->value[GRADING_Y][i],
                              places->value[GRADING_Z][i]};
    iso_status status = volume_sample(value, volume, point, count);
    for (int32_t i = 0; i < count; i++)
        value[i] = status == ISO_OK ? trusted(value[i] * factor) : (double)NAN;
}

void space_know(iso_places *places, const iso_space *space, uint32_t wanted, int32_t count) {
    for (int32_t k = 0; k < GRADING_VARIABLES; k++)
        places->variable[k] = places->value[k];
    const double *x = places->value[GRADING_X], *y = places->value[GRADING_Y];
    if (wanted >> GRADING_R & 1)
        for (int32_t i = 0; i < count; i++)
            places->value[GRADING_R][i] = sqrt(x[i] * x[i] + y[i] * y[i]);
    if (wanted >> GRADING_SKIN & 1)
        sample_volume(places->value[GRADING_SKIN], space->skin, places, -1, count);
    if (wanted >> GRADING_GRID & 1)
        sample_volume(places->value[GRADING_GRID], space->grid, places, 1, count);
}
