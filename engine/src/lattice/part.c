#include "lattice/part.h"

#include <math.h>

#include "base/memory.h"
#include "lattice/skin.h"

/* Points in a row that are looked at together: where the part's surface is far from their middle,
 * it is far from all of them. */
enum { GROUP = 8 };

static const double REACH = 3.5; /* steps from the middle of a group to its ends */
static const double NEAR = 3;    /* steps from the surface, within which distances count */

/* ---- the part's surface ---- */

/* For distances to it, and where nothing but figures is wanted. */
static const double SURFACE_BYTES = 2.5e8, LEAST_BYTES = 5e7;

iso_status part_find_surface(iso_porous *porous, const iso_mesh *mesh, int32_t count, double step) {
    iso_skin_options options = {.voxel = step};
    double most = porous->options.output == ISO_POROUS_FIGURES ? LEAST_BYTES : SURFACE_BYTES;
    volume_free(porous->surface);
    porous->surface = NULL;
    for (;; options.voxel *= 1.1) { /* as fine as there is room for; blocks are half empty */
        options.outer = (REACH + NEAR + 1) * step + options.voxel;
        options.inner = options.outer + porous->options.skin;
        double v = options.voxel;
        if (porous->part_area * (options.outer + options.inner + 8 * v) * 4 / (v * v * v) < most)
            break;
    }
    porous->known = options.inner;
    return skin_make(&porous->surface, mesh, count, &options);
}

/* ---- drains ---- */

/* The lowest point of the part above (x, y), or the part's top if there is none. */
static iso_status find_floor(double *floor, const iso_porous *porous, double x, double y) {
    double step = porous->body.voxel > 0 ? porous->body.voxel : 0.1;
    *floor = porous->max.z;
    for (double z = porous->min.z + step / 2; z < porous->max.z; z += step) {
        const iso_vec3 at = {x, y, z};
        double depth;
        ISO_TRY(volume_sample(&depth, porous->surface, &at, 1));
        if (depth > 0)
            continue;
        *floor = z - step / 2;
        break;
    }
    return ISO_OK;
}

static iso_vec2 drain_at(const iso_porous *porous, int32_t i) {
    iso_vec2 d = porous->options.drain[i];
    return (iso_vec2){(porous->min.x + porous->max.x) / 2 + d.x,
                      (porous->min.y + porous->max.y) / 2 + d.y};
}

iso_status part_find_drains(iso_porous *porous) {
    int32_t count = porous->options.drain_count;
    iso_release(porous->drain_top);
    porous->drain_top = NULL;
    ISO_TRY(ISO_ALLOCATE(porous->drain_top, count));
    for (int32_t i = 0; i < count; i++) {
        iso_vec2 at = drain_at(porous, i);
        ISO_TRY(find_floor(&porous->drain_top[i], porous, at.x, at.y));
        porous->drain_top[i] += porous->options.skin;
    }
    return ISO_OK;
}

static void drill(float *material, const iso_porous *porous, const iso_body_row *row) {
    double r = porous->options.drain_diameter / 2, y = row->first.y, z = row->first.z;
    for (int32_t d = 0; d < porous->options.drain_count; d++) {
        iso_vec2 at = drain_at(porous, d);
        /* a step into the lattice: a film of one voxel would close a hole that just reaches it */
        double above = z - porous->drain_top[d] - row->step, across = fabs(y - at.y) - r;
        if (above > NEAR * row->step || across > NEAR * row->step)
            continue;
        for (int32_t i = 0; i < row->count; i++) {
            double x = row->first.x + i * row->step - at.x, dy = y - at.y;
            double out = fmax(sqrt(x * x + dy * dy) - r, above);
            material[i] = fmaxf(material[i], (float)-out);
        }
    }
}

/* ---- a row ---- */

static iso_status room_for(iso_part_scratch *s, int64_t count) {
    ISO_TRY(ISO_GROW(s->distance, s->distance_capacity, count));
    ISO_TRY(ISO_GROW(s->half, s->half_capacity, count));
    ISO_TRY(ISO_GROW(s->depth, s->depth_capacity, count));
    return ISO_GROW(s->point, s->point_capacity, count);
}

static double x_of(const iso_body_row *row, double i) {
    return row->first.x + i * row->step;
}

static int32_t end_of_group(const iso_body_row *row, int32_t group) {
    int32_t end = GROUP * (group + 1);
    return end < row->count ? end : row->count;
}

/* Distances to the part's surface: of points in groups that it is near to, exactly; else that of
 * the group's middle. */
static iso_status sample_part(float *part, const iso_porous *porous, const iso_body_row *row,
                              iso_part_scratch *s) {
    int32_t groups = (row->count + GROUP - 1) / GROUP, near = 0;
    double far = (REACH + NEAR) * row->step;
    for (int32_t g = 0; g < groups; g++)
        s->point[g] =
            (iso_vec3){x_of(row, GROUP * g + (GROUP - 1) / 2.0), row->first.y, row->first.z};
    ISO_TRY(volume_sample(s->distance, porous->surface, s->point, groups));
    for (int32_t g = 0; g < groups; g++) {
        int is_near =
            row->exact || (s->distance[g] <= far && s->distance[g] >= -far - porous->options.skin);
        for (int32_t i = GROUP * g; i < end_of_group(row, g); i++) {
            part[i] = (float)s->distance[g];
            if (is_near)
                s->point[near++] = (iso_vec3){x_of(row, i), row->first.y, row->first.z};
        }
        s->half[g] = is_near;
    }
    ISO_TRY(volume_sample(s->depth, porous->surface, s->point, near));
    near = 0;
    for (int32_t g = 0; g < groups; g++)
        for (int32_t i = GROUP * g; i < end_of_group(row, g) && s->half[g] != 0; i++)
            part[i] = (float)s->depth[near++];
    return ISO_OK;
}

/* Distances to the lattice's surface between two points. */
static void sample_lattice(float *material, const iso_porous *porous, const iso_body_row *row,
                           int32_t from, int32_t to, iso_part_scratch *s) {
    iso_lattice_plane plane = {.origin = {row->first.x, row->first.y},
                               .step = row->step,
                               .z = row->first.z,
                               .columns = row->count,
                               .rows = 1};
    lattice_sample_row(s->distance, s->half, porous->lattice, &plane, 0, from, to - from);
    for (int32_t i = from; i < to; i++) {
        double d = s->distance[i - from];
        d = (porous->has_sides ? fabs(d) : d) - s->half[i - from];
        material[i] = (float)fmin(1e9, fmax(-1e9, d));
    }
}

static void combine(float *material, float *part, const iso_porous *porous,
                    const iso_body_row *row) {
    float skin = (float)porous->options.skin, known = (float)-porous->known * 0.999f;
    for (int32_t i = 0; i < row->count; i++) {
        if (skin > 0)
            material[i] = fminf(material[i], -part[i] - skin);
        material[i] = fmaxf(material[i], part[i]);
        if (row->exact && part[i] <= known)
            part[i] = -1e9f; /* how deep isn't known, but no wall of the part is near */
    }
}

static const iso_lattice_run *find_runs(const iso_porous *porous, int32_t z, int32_t y) {
    int64_t low = 0, high = porous->run_count;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        const iso_lattice_run *run = &porous->run[middle];
        if (run->z < z || (run->z == z && run->y < y))
            low = middle + 1;
        else
            high = middle;
    }
    return porous->run + low;
}

/* Loose pieces are void, half a step from their surface everywhere: what matters is the sign. */
static void remove_loose(float *material, const iso_porous *porous, const iso_body_row *row) {
    if (row->k < 0 || porous->run_count == 0)
        return;
    const iso_lattice_run *run = find_runs(porous, row->k, row->j),
                          *end = porous->run + porous->run_count;
    for (; run < end && run->z == row->k && run->y == row->j; run++)
        for (int32_t i = run->first; i < run->end && i < row->count; i++)
            material[i] = fmaxf(material[i], (float)(0.5 * row->step));
}

/* Voxels on the part's very surface count as material, but a mesh has no thickness there: pieces
 * that hold together by them alone would come apart in it. So they lie a thousandth of a voxel
 * inside. */
static void thicken_zeros(float *material, const iso_body_row *row) {
    float least = (float)(-1e-3 * row->step);
    for (int32_t i = 0; i < row->count; i++)
        if (material[i] <= 0 && material[i] > least)
            material[i] = least;
}

iso_status part_sample(void *payload, float *material, float *part, const iso_body_row *row,
                       int worker) {
    const iso_porous *porous = payload;
    iso_part_scratch *s = &porous->scratch[worker];
    ISO_TRY(room_for(s, row->count));
    ISO_TRY(sample_part(part, porous, row, s));
    double far = NEAR * row->step;
    for (int32_t i = 0; i < row->count;) {
        while (i < row->count && part[i] > far)
            material[i] = part[i], i++;
        int32_t from = i;
        while (i < row->count && part[i] <= far)
            i++;
        if (i > from)
            sample_lattice(material, porous, row, from, i, s);
    }
    combine(material, part, porous, row);
    drill(material, porous, row);
    thicken_zeros(material, row);
    remove_loose(material, porous, row);
    return ISO_OK;
}
