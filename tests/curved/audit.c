/* An audit of G-code with curved layers against the part: does what comes out fill it, and nothing
 * else?
 *
 *     audit PRINT.gcode PART.stl [--field TEXT [--base FROM,TO,OFF]] [--told] [--center X,Y]
 *           [--kinematics NAME [--pivot X,Y,Z]] [--filament MM] [--voxel MM]
 *           [--slack MM] [--worst] [--picture AXIS,AT,FILE]
 *           [--most-underfill %] [--most-layer %] [--most-spill %] [--volume-within %]
 *
 * Every extruding move leaves a bead: its section is what comes out over the length in space. Its
 * thickness is across the layer, between this layer and the one below. By --field both come from
 * the height function, worked out anew (heights.c); without it from where the other beads are;
 * --told believes ;HEIGHT: comments.
 *
 * A voxel counts as filled if its centre is in the box around a bead's stadium, round at its ends:
 * plastic is squeezed into the corners, if there is enough of it, which the volume shows. It is
 * also filled if it lies at most --slack below a bead: layers are drawn by straight lines, so that
 * between two there are slits as thin as that. Figures, one 'name value' a line:
 *
 *     part_mm3, printed_mm3, volume_pct (printed - part, over part), odd_beads (wider than 2.5 mm)
 *     underfill_pct   in the part but in no bead
 *     step_pct        of that: where the layer's middle isn't in the part; steps of a layer's edge
 *     gap_pct         the rest: what is missing (also without any rounding, flat_pct: by boxes of
 *                     the spacing, section / height, that are cut off straight)
 *     spill_pct       in a bead but not in the part, over the part; spill_gap_pct the same without
 *                     steps
 *     overfill_pct    printed volume that lies in no free space: boxes cover each other
 *     worst_layer_pct the largest gap in a single layer that has 0.2 % of the part or more
 *     tilt_deg        largest angle between tool and layer's normal (machines that turn)
 *
 * Exit 1 if a limit is passed, 2 if there is nothing to audit. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "beads.h"

enum { SLAB = 16 /* slices at a time */, MARGIN = 8 /* slices of the part known around them */ };

typedef struct request {
    const char *gcode, *stl, *field, *picture;
    double base[3], center[2], voxel, slack;
    double most_gap, most_underfill, most_layer, most_spill, volume_within;
    double told, worst;
    machine machine;
} request;

typedef struct audit {
    const request *ask;
    part part;
    moves moves;
    beads beads;
    heights *field;
    grid grid;
    int64_t inside, missing, steps, spilled, spilled_steps, flat_missing, flat;
    int64_t *layer_inside, *layer_missing; /* [layers], of a share of the voxels */
    uint64_t *solid;                       /* of a slab with its margin: the part */
    uint64_t *filled, *printed, *boxes;    /* of a slab: with slack, without, and as boxes */
    unsigned char *picture;
    int picture_axis, picture_index;
    char picture_file[500];
} audit;

static int read_request(request *ask, int count, char **word) {
    double pivot[3] = {0, 0, 0};
    const char *kinematics = "cartesian";
    *ask = (request){.center = {100, 100},
                     .voxel = 0.05,
                     .slack = 0.02,
                     .most_gap = 1e9,
                     .most_underfill = 1e9,
                     .most_layer = 1e9,
                     .most_spill = 1e9,
                     .volume_within = 1e9,
                     .machine = {.filament = 1.75}};
    const argument known[] = {{"", &ask->gcode, 0, NULL},
                              {"", &ask->stl, 0, NULL},
                              {"--field", &ask->field, 0, NULL},
                              {"--picture", &ask->picture, 0, NULL},
                              {"--kinematics", &kinematics, 0, NULL},
                              {"--told", NULL, 0, &ask->told},
                              {"--worst", NULL, 0, &ask->worst},
                              {"--base", NULL, 3, ask->base},
                              {"--center", NULL, 2, ask->center},
                              {"--pivot", NULL, 3, pivot},
                              {"--filament", NULL, 1, &ask->machine.filament},
                              {"--voxel", NULL, 1, &ask->voxel},
                              {"--slack", NULL, 1, &ask->slack},
                              {"--most-gap", NULL, 1, &ask->most_gap},
                              {"--most-underfill", NULL, 1, &ask->most_underfill},
                              {"--most-layer", NULL, 1, &ask->most_layer},
                              {"--most-spill", NULL, 1, &ask->most_spill},
                              {"--volume-within", NULL, 1, &ask->volume_within}};
    int good = arguments_read(known, sizeof known / sizeof *known, count, word);
    ask->machine.pivot = (vec){pivot[0], pivot[1], pivot[2]};
    return good && machine_named(&ask->machine, kinematics) && ask->gcode && ask->stl;
}

static void lay_grid(audit *a) {
    vec low = a->part.low, high = a->part.high;
    for (int64_t i = 0; i < a->beads.count; i++) {
        const bead *b = &a->beads.at[i];
        double r = b->width / 2 + b->height;
        low = (vec){fmin(low.x, fmin(b->from.x, b->to.x) - r),
                    fmin(low.y, fmin(b->from.y, b->to.y) - r),
                    fmin(low.z, fmin(b->from.z, b->to.z) - r)};
        high = (vec){fmax(high.x, fmax(b->from.x, b->to.x) + r),
                     fmax(high.y, fmax(b->from.y, b->to.y) + r),
                     fmax(high.z, fmax(b->from.z, b->to.z) + r)};
    }
    grid *g = &a->grid;
    g->voxel = a->ask->voxel;
    /* flat layers' tops at whole voxels */
    g->low =
        (vec){low.x - 2 * g->voxel, low.y - 2 * g->voxel, (floor(low.z / g->voxel) - 2) * g->voxel};
    g->nx = (int)ceil((high.x - g->low.x) / g->voxel) + 2;
    g->ny = (int)ceil((high.y - g->low.y) / g->voxel) + 2;
    g->nz = (int)ceil((high.z - g->low.z) / g->voxel) + 2;
    g->words = (g->nx + 63) / 64;
}

/* Is a place near slices z0 to z1 - 1 in the part? */
static int in_part(const audit *a, vec at, int z0) {
    const grid *g = &a->grid;
    int i = (int)floor((at.x - g->low.x) / g->voxel), j = (int)floor((at.y - g->low.y) / g->voxel);
    int k = (int)floor((at.z - g->low.z) / g->voxel) - (z0 - MARGIN);
    if (i < 0 || j < 0 || i >= g->nx || j >= g->ny || k < 0 || k >= SLAB + 2 * MARGIN)
        return 0;
    size_t word = ((size_t)k * (size_t)g->ny + (size_t)j) * (size_t)g->words + (size_t)i / 64;
    return a->solid[word] >> i % 64 & 1;
}

static vec center_of(const grid *g, int i, int j, int k) {
    return (vec){g->low.x + (i + 0.5) * g->voxel, g->low.y + (j + 0.5) * g->voxel,
                 g->low.z + (k + 0.5) * g->voxel};
}

/* One voxel that is missing or too much: a step of the layer's edge, if its middle is right. */
static void judge(audit *a, int i, int j, int k, int z0, int is_missing) {
    vec middle;
    int step = 0;
    if (a->field) {
        beads_layer(&middle, &a->beads, a->field, center_of(&a->grid, i, j, k));
        step = in_part(a, middle, z0) != is_missing;
    }
    *(is_missing ? &a->missing : &a->spilled) += 1;
    *(is_missing ? &a->steps : &a->spilled_steps) += step;
}

static void share_by_layer(audit *a, int i, int j, int k, int z0, int is_missing) {
    vec middle;
    int32_t layer = beads_layer(&middle, &a->beads, a->field, center_of(&a->grid, i, j, k));
    a->layer_inside[layer]++;
    a->layer_missing[layer] += is_missing && in_part(a, middle, z0);
}

static void count_row(audit *a, const uint64_t *solid, size_t at, int j, int k, int z0) {
    const uint64_t *filled = a->filled + at, *printed = a->printed + at, *boxes = a->boxes + at;
    for (int w = 0; w < a->grid.words; w++) {
        a->inside += __builtin_popcountll(solid[w]);
        a->flat += __builtin_popcountll(boxes[w]);
        a->flat_missing += __builtin_popcountll(solid[w] & ~boxes[w]);
        for (uint64_t odd = (solid[w] & ~filled[w]) | (printed[w] & ~solid[w]); odd;
             odd &= odd - 1) {
            int bit = __builtin_ctzll(odd);
            judge(a, 64 * w + bit, j, k, z0, solid[w] >> bit & 1);
        }
        if (a->field && (j + k) % 5 == 0)
            for (int bit = (j + 2 * k) % 7; bit < 64; bit += 7)
                if (solid[w] >> bit & 1)
                    share_by_layer(a, 64 * w + bit, j, k, z0, !(filled[w] >> bit & 1));
    }
}

/* White: neither; grey: filled part; red: missing; blue: spilled. */
static void draw_row(audit *a, const uint64_t *solid, const uint64_t *filled, int j, int k) {
    const grid *g = &a->grid;
    for (int i = 0; i < g->nx; i++) {
        int at[3] = {i, j, k};
        if (at[a->picture_axis] != a->picture_index)
            continue;
        int s = solid[i / 64] >> i % 64 & 1, f = filled[i / 64] >> i % 64 & 1;
        int column = a->picture_axis == 0 ? j : i, line = a->picture_axis == 2 ? j : k;
        int wide = a->picture_axis == 0 ? g->ny : g->nx,
            high = a->picture_axis == 2 ? g->ny : g->nz;
        unsigned char *to =
            a->picture + 3 * ((size_t)(high - 1 - line) * (size_t)wide + (size_t)column);
        to[0] = s && f ? 170 : s ? 220 : f ? 60 : 255;
        to[1] = s && f ? 170 : s ? 0 : f ? 90 : 255;
        to[2] = s && f ? 170 : s ? 0 : f ? 255 : 255;
    }
}

static int open_picture(audit *a) {
    double at;
    char axis;
    const grid *g = &a->grid;
    if (sscanf(a->ask->picture, "%c,%lf,%499s", &axis, &at, a->picture_file) != 3 || axis < 'x' ||
        axis > 'z')
        return 0;
    a->picture_axis = axis - 'x';
    double low = axis == 'x' ? g->low.x : axis == 'y' ? g->low.y : g->low.z;
    a->picture_index = (int)floor((at - low) / g->voxel);
    a->picture =
        malloc(3 * (size_t)(axis == 'x' ? g->ny : g->nx) * (size_t)(axis == 'z' ? g->ny : g->nz));
    return a->picture != NULL;
}

static void close_picture(const audit *a) {
    int wide = a->picture_axis == 0 ? a->grid.ny : a->grid.nx;
    int high = a->picture_axis == 2 ? a->grid.ny : a->grid.nz;
    FILE *file = fopen(a->picture_file, "wb");
    if (!file)
        return;
    fprintf(file, "P6 %d %d 255\n", wide, high);
    fwrite(a->picture, 3, (size_t)wide * (size_t)high, file);
    fclose(file);
}

static void audit_slab(audit *a, int z0, const int32_t *member, int64_t members) {
    const grid *g = &a->grid;
    int z1 = z0 + SLAB < g->nz ? z0 + SLAB : g->nz;
    size_t slice = (size_t)g->ny * (size_t)g->words;
    part_fill(a->solid, &a->part, g, z0 - MARGIN, z0 + SLAB + MARGIN);
    memset(a->filled, 0, SLAB * slice * sizeof *a->filled);
    memset(a->printed, 0, SLAB * slice * sizeof *a->printed);
    memset(a->boxes, 0, SLAB * slice * sizeof *a->boxes);
    for (int64_t i = 0; i < members; i++) {
        const bead *b = &a->beads.at[member[i]];
        bead_fill(a->filled, g, b, b->width, 1, a->ask->slack, z0, z1);
        bead_fill(a->printed, g, b, b->width, 1, 0, z0, z1);
        bead_fill(a->boxes, g, b, b->area / b->height, 0, 0, z0, z1);
    }
    for (int k = z0; k < z1; k++)
        for (int j = 0; j < g->ny; j++) {
            size_t at = (size_t)(k - z0) * slice + (size_t)j * (size_t)g->words;
            const uint64_t *solid = a->solid + MARGIN * slice + at;
            count_row(a, solid, at, j, k, z0);
            if (a->picture)
                draw_row(a, solid, a->filled + at, j, k);
        }
}

static void audit_all(audit *a) {
    const grid *g = &a->grid;
    size_t slice = (size_t)g->ny * (size_t)g->words;
    int slabs = (g->nz + SLAB - 1) / SLAB;
    a->solid = malloc((SLAB + 2 * MARGIN) * slice * sizeof *a->solid);
    a->filled = malloc(SLAB * slice * sizeof *a->filled);
    a->printed = malloc(SLAB * slice * sizeof *a->printed);
    a->boxes = malloc(SLAB * slice * sizeof *a->boxes);
    int32_t *member = malloc((size_t)a->beads.count * sizeof *member);
    a->layer_inside = calloc((size_t)a->beads.layers + 1, sizeof *a->layer_inside);
    a->layer_missing = calloc((size_t)a->beads.layers + 1, sizeof *a->layer_missing);
    if (!a->solid || !a->filled || !a->printed || !a->boxes || !member || !a->layer_inside ||
        !a->layer_missing)
        abort();
    for (int s = 0; s < slabs; s++) {
        double low = g->low.z + s * SLAB * g->voxel, high = low + SLAB * g->voxel;
        int64_t members = 0;
        for (int64_t i = 0; i < a->beads.count; i++) {
            double range[2];
            bead_range(range, &a->beads.at[i], a->ask->slack);
            if (range[1] >= low && range[0] <= high && a->beads.at[i].width <= 2.5)
                member[members++] = (int32_t)i;
        }
        audit_slab(a, s * SLAB, member, members);
    }
    free(member);
}

static double worst_layer(const audit *a) {
    int64_t all = 0, next = 0;
    double worst = 0;
    for (int32_t k = 0; k < a->beads.layers; k++)
        all += a->layer_inside[k];
    for (int32_t k = 0; k < a->beads.layers; k++) {
        double inside = (double)a->layer_inside[k], printed = 0;
        double gap = inside > 0 ? 100 * (double)a->layer_missing[k] / inside : 0;
        for (; next < a->beads.count && a->beads.level[a->beads.at[next].layer] == k; next++)
            printed += a->beads.at[next].volume;
        if (a->ask->worst != 0)
            printf("layer %d top %.4f part_mm3 %.3f printed_mm3 %.3f gap_pct %.3f\n", k,
                   a->beads.top[k], inside / (double)all * a->part.volume, printed, gap);
        if (inside > 0.002 * (double)all)
            worst = fmax(worst, gap);
    }
    return worst;
}

static double worst_tilt(const audit *a) {
    double worst = 0;
    int64_t b = 0;
    for (int64_t i = 0; i < a->moves.count && b < a->beads.count; i++) {
        const move *m = &a->moves.at[i];
        if (m->line != a->beads.at[b].line || m->volume <= 0)
            continue;
        vec up = turned_back(machine_turn(&a->ask->machine, m->angle), (vec){0, 0, 1});
        vec n = unit(heights_gradient(a->field, minus(m->to, a->beads.middle)));
        worst = fmax(worst, 180 / PI * acos(fmin(1, dot(up, n))));
        b++;
    }
    return worst;
}

static int within(const char *name, double value, double most) {
    if (value <= most)
        return 1;
    fprintf(stderr, "%s is %.3f, more than %.3f\n", name, value, most);
    return 0;
}

static int report(const audit *a) {
    const request *ask = a->ask;
    double printed = 0, boxes = 0, voxel = pow(ask->voxel, 3), all = (double)a->inside / 100;
    double widest = 0, thin = 1e30, thick = 0;
    int odd = 0;
    for (int64_t i = 0; i < a->beads.count; i++) {
        const bead *b = &a->beads.at[i];
        printed += b->volume;
        odd += b->width > 2.5;
        boxes += b->width > 2.5 ? 0 : b->volume;
        widest = fmax(widest, b->width), thin = fmin(thin, b->height),
        thick = fmax(thick, b->height);
    }
    double volume = 100 * (printed / a->part.volume - 1),
           gap = (double)(a->missing - a->steps) / all;
    double spill_gap = (double)(a->spilled - a->spilled_steps) / all,
           layer = a->field ? worst_layer(a) : 0;
    printf("layers %d\nbeads %lld\npart_mm3 %.2f\nprinted_mm3 %.2f\nvolume_pct %.3f\n",
           a->beads.layers, (long long)a->beads.count, a->part.volume, printed, volume);
    printf("lost_mm3 %.3f\nodd_beads %d\nwidest %.3f\nheights %.4f %.4f\n", a->moves.lost, odd,
           widest, thin, thick);
    printf("voxels %.2f of %.2f mm3\n", (double)a->inside * voxel, a->part.volume);
    printf("underfill_pct %.3f\nstep_pct %.3f\ngap_pct %.3f\nflat_pct %.3f\n",
           (double)a->missing / all, (double)a->steps / all, gap, (double)a->flat_missing / all);
    printf("spill_pct %.3f\nspill_gap_pct %.3f\n", (double)a->spilled / all, spill_gap);
    printf("overfill_pct %.3f\nworst_layer_pct %.3f\n",
           100 * (boxes - (double)a->flat * voxel) / a->part.volume, layer);
    if (a->field && ask->machine.tilt >= 0)
        printf("tilt_deg %.3f\n", worst_tilt(a));
    int good = within("|volume_pct|", fabs(volume), ask->volume_within);
    good &= within("underfill_pct", (double)a->missing / all, ask->most_underfill);
    good &= within("gap_pct", gap, ask->most_gap);
    good &= within("spill_pct", (double)a->spilled / all, ask->most_spill);
    good &= within("worst_layer_pct", layer, ask->most_layer);
    good &= within("odd_beads", odd, ask->most_gap < 1e8 ? 0 : 1e9);
    return good;
}

int main(int count, char **word) {
    request ask;
    audit a = {.ask = &ask};
    if (!read_request(&ask, count, word)) {
        fprintf(stderr, "usage: audit PRINT.gcode PART.stl [options], see audit.c\n");
        return 2;
    }
    if (ask.field && !(a.field = heights_new(ask.field, ask.base)))
        return 2;
    if (!part_read(&a.part, ask.stl, ask.center[0], ask.center[1]) ||
        !moves_read(&a.moves, ask.gcode, &ask.machine) ||
        !beads_make(&a.beads, &a.moves, a.field, &a.part, ask.told != 0))
        return 2;
    lay_grid(&a);
    if (ask.picture && !open_picture(&a))
        return 2;
    audit_all(&a);
    if (a.picture)
        close_picture(&a);
    int good = report(&a);
    free(a.solid), free(a.filled), free(a.printed), free(a.boxes), free(a.picture);
    free(a.layer_inside), free(a.layer_missing), free(a.moves.at);
    beads_free(&a.beads);
    part_free(&a.part);
    heights_free(a.field);
    return good ? 0 : 1;
}
