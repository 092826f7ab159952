#include <isoslice/porous.h>

#include <math.h>

#include "base/memory.h"
#include "config/value.h"
#include "lattice/part.h"

static const double BYTES_MOST = 1.5e9; /* that an output may need while it is made */
static const double DISTANCE_BYTES = 60, MESH_BYTES = 150; /* for a square voxel of surface */
static const double MASK_BYTES = 116;   /* for a block of 8 x 8 x 8 voxels, if all have a surface */
static const double COUNTED_MOST = 4e8; /* voxels, where nothing but figures is wanted */
static const int64_t LOOSE_MOST = (int64_t)1 << 30; /* voxels of loose pieces' boxes */

/* ---- the part ---- */

static double length(double x, double y, double z) {
    return sqrt(x * x + y * y + z * z);
}

static double area_of(const iso_mesh *mesh) {
    double sum = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 a = mesh->position[mesh->origin[3 * t]];
        iso_vec3 b = mesh->position[mesh->origin[3 * t + 1]];
        iso_vec3 c = mesh->position[mesh->origin[3 * t + 2]];
        double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
        double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        sum += length(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
    }
    return sum;
}

static void find_box(iso_porous *p, const iso_mesh *mesh, int32_t count) {
    p->min = (iso_vec3){HUGE_VAL, HUGE_VAL, HUGE_VAL};
    p->max = (iso_vec3){-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int32_t i = 0; i < count; i++) {
        if (mesh[i].triangle_count == 0)
            continue;
        iso_vec3 low = mesh[i].min, high = mesh[i].max;
        p->min = (iso_vec3){fmin(p->min.x, low.x), fmin(p->min.y, low.y), fmin(p->min.z, low.z)};
        p->max = (iso_vec3){fmax(p->max.x, high.x), fmax(p->max.y, high.y), fmax(p->max.z, high.z)};
        p->part_volume += fabs(iso_mesh_volume(&mesh[i]));
        p->part_area += area_of(&mesh[i]);
    }
}

/* ---- its grid ---- */

static void set_axis(double *min, int32_t *size, double low, double high, double voxel) {
    double first = 8 * floor((low / voxel - 6) / 8), end = 8 * ceil((high / voxel + 6) / 8);
    *min = first * voxel;
    *size = (int32_t)(end - first);
}

/* Whole blocks of a volume, whose voxels are multiples of their edge. */
static void set_grid(iso_porous *p, double voxel) {
    iso_body *b = &p->body;
    *b = (iso_body){.voxel = voxel, .skin = p->options.skin, .sample = part_sample, .payload = p};
    set_axis(&b->min.x, &b->size[0], p->min.x, p->max.x, voxel);
    set_axis(&b->min.y, &b->size[1], p->min.y, p->max.y, voxel);
    set_axis(&b->min.z, &b->size[2], p->min.z, p->max.z, voxel);
    double wall = p->sizes.wall_smallest, whole = 1.7320508075688772 * voxel;
    if (wall > 0 && wall < whole) /* the diagonal of a voxel: thinner ones are seen as crumbs */
        b->swell = (whole - wall) / 2;
}

static double voxels_of(const iso_porous *p, double voxel) {
    return (p->max.x - p->min.x) * (p->max.y - p->min.y) * (p->max.z - p->min.z) /
           (voxel * voxel * voxel);
}

/* Squares of surface: the pores' and the part's. */
static double squares_of(const iso_porous *p, double voxel) {
    return (p->sizes.surface * p->part_volume + p->part_area) / (voxel * voxel);
}

/* Bytes for the output at this voxel; sets the kind of a volume. */
static double bytes_of(iso_porous *p, double voxel) {
    double squares = squares_of(p, voxel);
    p->kind = ISO_POROUS_DISTANCE;
    if (p->options.output == ISO_POROUS_STL)
        return squares * MESH_BYTES;
    if (p->options.output == ISO_POROUS_FIGURES)
        return voxels_of(p, voxel) > COUNTED_MOST ? 2 * BYTES_MOST : 0;
    if (squares * DISTANCE_BYTES <= BYTES_MOST)
        return squares * DISTANCE_BYTES;
    p->kind = ISO_POROUS_MASK;
    double side = 8 * voxel, blocks = p->part_volume / (side * side * side);
    return fmin(blocks, 3 * squares / 64) * MASK_BYTES;
}

/* Walls want three voxels, and the cell's curves 24; no more than 64 of them even so. */
static iso_status choose_voxel(iso_porous *p) {
    double voxel = p->options.voxel, asked = voxel;
    if (!(voxel > 0)) {
        voxel = p->cell / 24;
        if (p->sizes.wall_smallest > 0)
            voxel = fmax(p->cell / 64, fmin(voxel, p->sizes.wall_smallest / 3));
    }
    while (bytes_of(p, voxel) > BYTES_MOST)
        voxel *= 1.02;
    if (asked > 0 && voxel > asked && p->options.output != ISO_POROUS_FIGURES)
        return iso_fail(ISO_NO_MEMORY,
                        "voxels of %g mm would need more than %g GB; %.3g mm are the finest here",
                        asked, BYTES_MOST / 1e9, voxel);
    set_grid(p, voxel);
    return ISO_OK;
}

/* ---- making ---- */

static iso_status check_options(const iso_porous_options *options) {
    if (!(options->skin >= 0) || !(options->voxel >= 0))
        return iso_fail(ISO_BAD_CONFIG, "neither skin nor voxel of a lattice are below 0");
    if (options->drain_count > 0 && !(options->skin > 0))
        return iso_fail(ISO_BAD_CONFIG, "lattice_drain: without lattice_skin there is nothing to "
                                        "drill holes through");
    if (options->drain_count > 0 && !(options->drain_diameter > 0))
        return iso_fail(ISO_BAD_CONFIG, "lattice_drain_diameter: must be above 0 mm");
    return ISO_OK;
}

static iso_status make(iso_porous *p, const iso_mesh *mesh, int32_t count) {
    ISO_TRY(check_options(&p->options));
    ISO_TRY(iso_pool_new(&p->pool, p->options.threads));
    int64_t threads = iso_pool_threads(p->pool);
    ISO_TRY(ISO_ALLOCATE(p->scratch, threads));
    memset(p->scratch, 0, (size_t)threads * sizeof *p->scratch);
    find_box(p, mesh, count);
    if (!(p->min.x <= p->max.x))
        return iso_fail(ISO_UNSLICEABLE, "there is no triangle in the model");
    ISO_TRY(lattice_new(&p->lattice, &p->options.lattice, mesh, count));
    p->has_sides = lattice_cell(p->lattice)->has_sides;
    p->cell = lattice_smallest_cell(p->lattice);
    /* a first look, at a grid that any part has room for: how thin are the walls? */
    double extent = length(p->max.x - p->min.x, p->max.y - p->min.y, p->max.z - p->min.z);
    set_grid(p, fmax(p->cell / 24, extent / 1000));
    ISO_TRY(part_find_surface(p, mesh, count, p->body.voxel));
    ISO_TRY(part_find_drains(p));
    ISO_TRY(body_sizes(&p->sizes, &p->body, p->cell, SIZES_CUBES_MOST, p->pool));
    ISO_TRY(choose_voxel(p));
    ISO_TRY(part_find_surface(p, mesh, count, p->body.voxel));
    return part_find_drains(p);
}

iso_status iso_porous_new(iso_porous **porous, const iso_mesh *mesh, int32_t count,
                          const iso_porous_options *options) {
    iso_porous *made;
    *porous = NULL;
    ISO_TRY(ISO_ALLOCATE(made, 1));
    *made = (iso_porous){.options = *options};
    if (options->progress)
        options->progress(options->payload, 0, "lattice");
    iso_status status = make(made, mesh, count);
    if (status == ISO_OK)
        *porous = made;
    else
        iso_porous_free(made);
    return status;
}

void iso_porous_free(iso_porous *porous) {
    if (!porous)
        return;
    for (int i = 0; porous->scratch && i < iso_pool_threads(porous->pool); i++) {
        iso_part_scratch *s = &porous->scratch[i];
        iso_release(s->distance);
        iso_release(s->half);
        iso_release(s->depth);
        iso_release(s->point);
    }
    iso_release(porous->scratch);
    iso_release(porous->drain_top);
    iso_release(porous->run);
    iso_pool_free(porous->pool);
    volume_free(porous->surface);
    lattice_free(porous->lattice);
    iso_release(porous);
}

void part_progress(void *payload, double done) {
    const iso_porous *p = payload;
    if (p->options.progress)
        p->options.progress(p->options.payload,
                            p->stage_from + (p->stage_to - p->stage_from) * done, p->stage);
}

/* ---- figures ---- */

/* A density that is a plain number says what porosity is asked for. */
static double asked_porosity(const iso_lattice_options *options) {
    double percent;
    const char *at = options->density;
    if (!iso_number_read(&percent, &at) || *at != 0)
        return -1;
    return 1 - fmin(100, fmax(0, percent)) / 100;
}

static double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

static void fill_in(iso_porous_figures *f, const iso_porous *p, const iso_body_counts *c) {
    double v = p->body.voxel * p->body.voxel * p->body.voxel, whole = c->part_share * v;
    int64_t removed = 0;
    for (int64_t i = 0; i < p->run_count; i++)
        removed += p->run[i].end - p->run[i].first;
    *f = (iso_porous_figures){
        .voxel = p->body.voxel,
        .voxels = (int64_t)p->body.size[0] * p->body.size[1] * p->body.size[2],
        .part_volume = whole,
        .volume = whole * share((double)c->material, (double)c->part),
        .core_volume = whole * share((double)c->core, (double)c->part),
        .core_material = whole * share((double)c->core_material, (double)c->part),
        .asked_porosity = asked_porosity(&p->options.lattice),
        .porosity = 1 - share((double)c->core_material, (double)c->core),
        .part_porosity = 1 - share((double)c->material, (double)c->part),
        .surface = c->surface,
        .pore_surface = c->pore_surface,
        .cell = p->cell,
        .cells = whole / (p->cell * p->cell * p->cell),
        .detail = p->sizes.detail,
        .pore_largest = p->sizes.pore_largest,
        .pore_mean = p->sizes.pore_mean,
        .pore_d10 = p->sizes.pore_d10,
        .pore_d50 = p->sizes.pore_d50,
        .pore_d90 = p->sizes.pore_d90,
        .wall_smallest = p->sizes.wall_smallest,
        .wall_mean = p->sizes.wall_mean,
        .pieces = c->pieces,
        .removed = c->loose_count + c->unlisted,
        .removed_volume = (double)removed * v,
        .closed_pores = c->closed_pores,
        .closed_volume = (double)c->closed_voxels * v};
}

iso_status iso_porous_analyse(iso_porous_figures *figures, iso_porous *porous) {
    iso_body_counts counts = {0};
    int64_t left = 0;
    iso_release(porous->run); /* of a count before, which must see everything again */
    porous->run = NULL;
    porous->run_count = 0;
    porous->stage = "analysis";
    porous->stage_from = 0.05;
    porous->stage_to = porous->options.output == ISO_POROUS_FIGURES ? 0.95 : 0.5;
    ISO_TRY(body_count(&counts, &porous->body, porous->pool, part_progress, porous));
    iso_lattice_run *run;
    int64_t run_count;
    iso_status status =
        body_loose_runs(&run, &run_count, &left, &porous->body, &counts, LOOSE_MOST);
    if (status == ISO_OK) {
        porous->run = run, porous->run_count = run_count;
        fill_in(figures, porous, &counts);
        figures->left = left;
        figures->removed -= left;
    }
    iso_release(counts.loose);
    return status;
}

void iso_porous_cut(iso_lattice_cut *cut, const iso_porous *porous) {
    const iso_body *body = &porous->body;
    double x = (porous->min.x + porous->max.x) / 2, y = (porous->min.y + porous->max.y) / 2;
    *cut = (iso_lattice_cut){.min = {body->min.x - x, body->min.y - y, body->min.z - porous->min.z},
                             .voxel = body->voxel,
                             .count = porous->run_count,
                             .run = porous->run};
}
