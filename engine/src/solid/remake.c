/* Distances come from the triangles, and are exact; only the side is the winding number's. Next to
 * a triangle the grid's value is the distance with that sign. Where the surface is open the winding
 * number runs through a half somewhere in the air, and the value is that number's own, scaled, so
 * that the surface closes the gap smoothly: of the two, the one nearer to 0. */
#include "solid/remake.h"

#include <math.h>

#include "base/memory.h"
#include "solid/crumbs.h"
#include "solid/misfit.h"
#include "solid/soup.h"
#include "solid/volume.h"

enum { EDGE = ISO_VOLUME_BLOCK, CELLS = EDGE * EDGE * EDGE };

/* Voxels along the box's longest side, unless the user says otherwise. */
#define VOXELS_USUAL 300
/* Half a thickness needs so many voxels at least: nearer to the triangles distances have an edge,
 * which the grid doesn't know. */
#define SHEET_VOXELS 2.0
/* Voxels to both sides in which values matter. */
#define BAND 3.0
/* No triangle is within or near a block of voxels if its corners and its middle are all further
 * away than this: no point of it is further than 7/4 root 5 voxels from one of them. */
#define FAR_AWAY (BAND + 4.0)
/* Voxels of the grid that tells how far it is to the triangles where that is more. */
#define COARSE 8.0
/* Turned into voxels, a winding number that is so far from a half is beyond the band. */
#define SURE 0.15
#define WINDING_VOXELS (BAND / SURE)

typedef struct maker {
    const iso_soup *soup;
    const iso_volume *near; /* distances without a sign */
    const iso_volume *wide; /* the same, on a grid of COARSE voxels, without an end */
    double voxel;
    /* of the block at hand */
    iso_vec3 point[CELLS];
    double distance[CELLS], winding[CELLS];
    uint8_t known[CELLS];
    int16_t order[CELLS]; /* the most distant first */
} maker;

/* ---- a block ---- */

static void place_points(maker *m, iso_vec3 corner) {
    for (int i = 0; i < CELLS; i++)
        m->point[i] =
            (iso_vec3){corner.x + m->voxel * (i % EDGE), corner.y + m->voxel * (i / EDGE % EDGE),
                       corner.z + m->voxel * (i / (EDGE * EDGE))};
}

/* *far: no triangle is near enough to count. */
static iso_status measure(maker *m, int *far, iso_vec3 corner) {
    iso_vec3 point[9];
    double span = (EDGE - 1) * m->voxel, distance[9], least = INFINITY;
    for (int i = 0; i < 9; i++)
        point[i] = i == 8
                       ? (iso_vec3){corner.x + span / 2, corner.y + span / 2, corner.z + span / 2}
                       : (iso_vec3){corner.x + (i & 1) * span, corner.y + (i >> 1 & 1) * span,
                                    corner.z + (i >> 2) * span};
    ISO_TRY(volume_sample(distance, m->near, point, 9));
    for (int i = 0; i < 9; i++)
        least = fmin(least, distance[i]);
    *far = least > FAR_AWAY * m->voxel * (1 - 1e-6);
    return *far ? ISO_OK : volume_sample(m->distance, m->near, m->point, CELLS);
}

/* Farthest first, to a quarter of a voxel; within that by number. */
static void sort_by_distance(maker *m) {
    enum { STEPS = 4, BINS = STEPS * 8 };
    int16_t first[BINS + 1] = {0}, bin[CELLS];
    for (int i = 0; i < CELLS; i++) {
        double steps = STEPS * m->distance[i] / m->voxel;
        bin[i] = (int16_t)(BINS - 1 - (steps < BINS - 1 ? (int)steps : BINS - 1));
        first[bin[i] + 1]++;
    }
    for (int i = 0; i < BINS; i++)
        first[i + 1] = (int16_t)(first[i + 1] + first[i]);
    for (int i = 0; i < CELLS; i++)
        m->order[first[bin[i]]++] = (int16_t)i;
}

/* ---- its sides ---- */

static int larger(int a, int b) {
    return a > b ? a : b;
}

static int smaller(int a, int b) {
    return a < b ? a : b;
}

/* The winding number of a cell is good for all within so many voxels. */
static void spread(maker *m, int cell, double radius) {
    int reach = (int)radius, x = cell % EDGE, y = cell / EDGE % EDGE, z = cell / (EDGE * EDGE);
    for (int k = larger(z - reach, 0); k <= smaller(z + reach, EDGE - 1); k++)
        for (int j = larger(y - reach, 0); j <= smaller(y + reach, EDGE - 1); j++)
            for (int i = larger(x - reach, 0); i <= smaller(x + reach, EDGE - 1); i++) {
                int to = i + EDGE * (j + EDGE * k), dx = i - x, dy = j - y, dz = k - z;
                if (m->known[to] || dx * dx + dy * dy + dz * dz > radius * radius)
                    continue;
                m->known[to] = 1;
                m->winding[to] = m->winding[cell];
            }
}

/* Where there are no triangles within d, the winding number changes little within less: most beside
 * the rim of a sheet, by an angle whose sine is the share of d, of a full turn. So one answer tells
 * the side of many voxels, unless it is so near a half that its own value counts there. */
static void find_sides(maker *m) {
    memset(m->known, 0, sizeof m->known);
    sort_by_distance(m);
    for (int i = 0; i < CELLS; i++) {
        int cell = m->order[i];
        if (m->known[cell])
            continue;
        soup_winding(&m->winding[cell], m->soup, &m->point[cell], 1);
        m->known[cell] = 1;
        double spare = 4 * (fabs(m->winding[cell] - 0.5) - SURE);
        if (spare > 0)
            spread(m, cell, fmin(spare, 0.9) * m->distance[cell] / m->voxel);
    }
}

/* One answer may do for all of a block that is far from everything: where no voxel next to any of
 * its own is on the other side, values don't count. */
static iso_status find_side_of_all(maker *m, int *all, iso_vec3 middle) {
    const double radius = (EDGE - 1) / 2.0 * 1.7320508075688774 + 2;
    double winding, distance;
    ISO_TRY(volume_sample(&distance, m->wide, &middle, 1));
    distance =
        distance / m->voxel - COARSE; /* between its grid's points it may be off by so much */
    distance = fmax(distance, FAR_AWAY);
    soup_winding(&winding, m->soup, &middle, 1);
    *all = fmin(4 * fabs(winding - 0.5), 0.9) * distance >= radius;
    for (int i = 0; *all && i < CELLS; i++) {
        m->winding[i] = winding > 0.5;
        m->distance[i] = BAND * m->voxel;
    }
    return ISO_OK;
}

static iso_status fill(void *payload, float *value, iso_vec3 corner) {
    maker *m = payload;
    int far;
    double half = (EDGE - 1) * m->voxel / 2;
    place_points(m, corner);
    ISO_TRY(measure(m, &far, corner));
    int all = 0;
    iso_vec3 middle = {corner.x + half, corner.y + half, corner.z + half};
    if (far) {
        ISO_TRY(find_side_of_all(m, &all, middle));
        if (!all)
            ISO_TRY(volume_sample(m->distance, m->near, m->point, CELLS));
    }
    if (!all)
        find_sides(m);
    for (int i = 0; i < CELLS; i++) {
        double outside = 0.5 - m->winding[i];
        double reach = fmin(m->distance[i], fabs(outside) * WINDING_VOXELS * m->voxel);
        value[i] = (float)(outside > 0 ? reach : -reach);
    }
    return ISO_OK;
}

/* ---- the whole ---- */

static double longest_side(const iso_mesh *mesh) {
    double x = mesh->max.x - mesh->min.x, y = mesh->max.y - mesh->min.y;
    return fmax(fmax(x, y), mesh->max.z - mesh->min.z);
}

static iso_status nowhere_inside(void *payload, uint8_t *inside, const iso_vec3 *point,
                                 int64_t count) {
    memset(inside, 0, (size_t)count);
    return ISO_OK;
}

static iso_status make_near(iso_volume **near, const iso_vec3 *corner, int64_t count, double voxel,
                            double outer) {
    const iso_volume_surface surface = {.corner = corner,
                                        .count = count,
                                        .voxel = voxel,
                                        .outer = outer,
                                        .inner = voxel,
                                        .inside = nowhere_inside};
    return volume_from_surface(near, &surface);
}

static iso_status build_signed(iso_volume **made, maker *m, const iso_mesh *soup) {
    const iso_volume_plan plan = {
        .min = soup->min, /* where the surface is open nothing keeps it from bulging out */
        .max = soup->max,
        .voxel = m->voxel,
        .kind = ISO_VOLUME_DISTANCE,
        .name = "surface",
        .fill = fill,
        .payload = m,
    };
    return volume_build(made, &plan);
}

/* *level: where its surface is. */
static iso_status make_signed(iso_volume **made, double *level, const iso_volume *near,
                              const iso_vec3 *corner, const iso_mesh *soup, double voxel) {
    maker *m;
    iso_soup *turns = NULL;
    iso_volume *wide = NULL;
    ISO_TRY(ISO_ALLOCATE(m, 1));
    iso_status status = soup_new(&turns, corner, soup->triangle_count);
    if (status == ISO_OK)
        status =
            make_near(&wide, corner, soup->triangle_count, COARSE * voxel, longest_side(soup) / 2);
    if (status == ISO_OK) {
        m->soup = turns;
        m->near = near;
        m->wide = wide;
        m->voxel = voxel;
        status = build_signed(made, m, soup);
    }
    const crumbs_options options = {soup->min, soup->max, voxel};
    if (status == ISO_OK)
        status = crumbs_level(level, *made, turns, &options);
    soup_free(turns);
    volume_free(wide);
    iso_release(m);
    return status;
}

static iso_status choose_voxel(double *voxel, const iso_mesh *soup,
                               const iso_mesh_options *options) {
    double most = options->sheet_thickness / 2 / SHEET_VOXELS;
    *voxel = options->voxel > 0 ? options->voxel : longest_side(soup) / VOXELS_USUAL;
    if (!(*voxel > 0))
        return iso_fail(ISO_UNSLICEABLE, "the triangles lie in one point");
    if (options->sheet_thickness > 0 && *voxel > most && options->voxel > 0)
        return iso_fail(ISO_BAD_CONFIG,
                        "a sheet_thickness of %g mm needs a repair_voxel of %g mm at most",
                        options->sheet_thickness, most);
    if (options->sheet_thickness > 0 && *voxel > most)
        *voxel = most;
    return ISO_OK;
}

static iso_status nothing_enclosed(double voxel) {
    return iso_fail(
        ISO_UNSLICEABLE,
        "the triangles enclose nothing that a grid of %g mm can tell; --sheet-thickness "
        "gives them a thickness, --repair-voxel makes the grid finer",
        voxel);
}

static iso_status extract(iso_mesh *mesh, const iso_volume *volume, double level, double voxel) {
    float *triangle;
    int64_t count;
    ISO_TRY(volume_surface(&triangle, &count, volume, level));
    iso_status status =
        count > 0 ? iso_mesh_from_triangles(mesh, triangle, count) : nothing_enclosed(voxel);
    iso_release(triangle);
    return status;
}

static iso_status remake(iso_mesh *mesh, const iso_mesh *soup, const iso_vec3 *corner,
                         double thickness, double voxel) {
    iso_volume *near = NULL, *whole = NULL;
    double level = thickness / 2;
    iso_status status =
        make_near(&near, corner, soup->triangle_count, voxel, thickness / 2 + FAR_AWAY * voxel);
    if (status == ISO_OK && thickness == 0)
        status = make_signed(&whole, &level, near, corner, soup, voxel);
    if (status == ISO_OK)
        status = extract(mesh, whole ? whole : near, level, voxel);
    if (status == ISO_OK)
        status = misfit_measure(&mesh->defects, mesh, soup, whole, thickness / 2, voxel);
    volume_free(near);
    volume_free(whole);
    return status;
}

iso_status remake_surface(iso_mesh *mesh, const iso_mesh *soup, const iso_mesh_options *options) {
    iso_vec3 *corner;
    double voxel;
    *mesh = (iso_mesh){0};
    ISO_TRY(choose_voxel(&voxel, soup, options));
    ISO_TRY(ISO_ALLOCATE(corner, 3 * (int64_t)soup->triangle_count));
    for (int32_t a = 0; a < 3 * soup->triangle_count; a++)
        corner[a] = soup->position[soup->origin[a]];
    iso_mesh made = {0};
    iso_status status = remake(&made, soup, corner, options->sheet_thickness, voxel);
    iso_release(corner);
    if (status != ISO_OK) {
        iso_mesh_free(&made);
        return status;
    }
    made.defects.triangles_read = soup->defects.triangles_read;
    made.defects.degenerate += soup->defects.degenerate;
    made.defects.sheet_thickness = options->sheet_thickness;
    made.defects.voxel = voxel;
    *mesh = made;
    return ISO_OK;
}
