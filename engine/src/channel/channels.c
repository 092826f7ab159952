/* From a part to channels: the stages in their order. */
#include "channel/body.h"
#include "channel/split.h"
#include "height/height.h"

enum { LEVELS_LEAST = 81, LEVELS_MOST = 2000, SAMPLES_LEAST = 100, SAMPLES_MOST = 1000 };

/* Contours a pitch, points of a ring a depth: with fewer, corners are cut off. */
#define LEVELS_A_PITCH 8
#define SAMPLES_A_DEPTH 10
/* With levels by the pitch, more of them if a pitch turns out to be wrong by more than this: parts
 * with threads or steps are longer along their surface than their contours a pitch / 8 apart. */
#define PITCH_ERROR 1e-3
enum { REFINEMENTS = 2, REFINED = 3 };
/* Points of a channel a radius of its bends: a circle then has 31 and is 0.2 % too short. */
#define STEPS_A_BEND 5
/* Of the depth, to both sides: the surface's slope is the mean of so much. */
#define SLOPE_REACH 0.25

iso_channel_options iso_channel_defaults(void) {
    iso_channel_options options = {.pitch = 20,
                                   .depth = 10,
                                   .start = -1,
                                   .mode = ISO_CHANNEL_PLANAR,
                                   .ports = ISO_CHANNEL_PARALLEL,
                                   .side = ISO_CHANNEL_FRONT,
                                   .margin = -1,
                                   .wall = 2,
                                   .bend = -1};
    if (iso_channel_section_parse(&options.section, "round:8", 32) != ISO_OK)
        options.section.sides = 0; /* can't be; refused as a section then */
    return options;
}

void channels_report(const iso_channels *c, double done, const char *stage) {
    if (c->options.progress)
        c->options.progress(c->options.payload, done, stage);
}

// Options

static iso_status check_range(const char *name, double value, double least, double most) {
    if (value >= least && value <= most)
        return ISO_OK;
    return iso_fail(ISO_BAD_CONFIG, "%s: %g is not from %g to %g", name, value, least, most);
}

static iso_status check_options(const iso_channel_options *o) {
    ISO_TRY(check_range("pitch", o->pitch, 0.1, 1000));
    ISO_TRY(check_range("depth", o->depth, 0.1, 1000));
    ISO_TRY(check_range("start", o->start, -1, 10000));
    ISO_TRY(check_range("section", o->section.sides, 3, ISO_SECTION_SIDES_MAX));
    ISO_TRY(check_range("margin", o->margin, -1, 1000));
    ISO_TRY(check_range("wall", o->wall, 0, 1000));
    ISO_TRY(check_range("bend", o->bend, -1, 1000));
    if (o->levels != 0)
        ISO_TRY(check_range("levels", o->levels, 2, 10000));
    if (o->samples != 0)
        ISO_TRY(check_range("samples", o->samples, 8, 10000));
    ISO_TRY(check_range("mode", (double)o->mode, 0, ISO_CHANNEL_MODE_COUNT - 1));
    ISO_TRY(check_range("ports", (double)o->ports, 0, ISO_CHANNEL_PORTS_COUNT - 1));
    ISO_TRY(check_range("side", (double)o->side, 0, ISO_CHANNEL_SIDE_COUNT - 1));
    double reach = iso_channel_section_reach(&o->section);
    if (!(o->depth > reach))
        return iso_fail(ISO_BAD_CONFIG,
                        "depth: at %g mm a channel that reaches %g mm from its middle would cut "
                        "into the part",
                        o->depth, reach);
    return ISO_OK;
}

static int32_t between(double number, int32_t least, int32_t most) {
    return number < least ? least : number > most ? most : (int32_t)number;
}

static double coordinate(double mm, double by) {
    return iso_mm(iso_units(mm + by));
}

/* What was left to be chosen, and the mould's box. */
static iso_status settle(iso_channels *c) {
    iso_channel_options *o = &c->options;
    iso_vec3 low = c->mesh->min, high = c->mesh->max, size = vec3_minus(high, low);
    double most = iso_mm(ISO_COORDINATE_MAX) / 2;
    c->reach = iso_channel_section_reach(&o->section);
    c->start = o->start < 0 ? o->pitch / 2 : o->start;
    c->bend = o->bend < 0 ? 1.5 * c->reach : fmax(o->bend, 1.01 * c->reach);
    double margin = o->margin < 0 ? o->depth + c->reach + fmax(o->depth, 1.5 * c->bend) : o->margin;
    for (const double *x = (double[]){low.x, low.y, low.z, high.x, high.y, high.z}, *end = x + 6;
         x < end; x++)
        if (!(fabs(*x) < most))
            return iso_fail(ISO_OUTSIDE, "the part is farther than %g mm from the origin", most);
    if (o->levels == 0)
        o->levels =
            between(ceil(size.z / o->pitch * LEVELS_A_PITCH) + 1, LEVELS_LEAST, LEVELS_MOST);
    if (o->samples == 0)
        o->samples = between(2 * (size.x + size.y) / o->depth * SAMPLES_A_DEPTH, SAMPLES_LEAST,
                             SAMPLES_MOST);
    c->figures.box_min =
        vec3(coordinate(low.x, -margin), coordinate(low.y, -margin), coordinate(low.z, -margin));
    c->figures.box_max =
        vec3(coordinate(high.x, margin), coordinate(high.y, margin), coordinate(high.z, margin));
    static const iso_vec3 out[] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}};
    c->side = (port_side){.out = out[o->side],
                          .along = vec3_cross(vec3(0, 0, 1), out[o->side]),
                          .half = c->reach + 0.6 * o->wall + 0.05,
                          .axis = o->side < ISO_CHANNEL_FRONT ? 0 : 1};
    bool far = o->side == ISO_CHANNEL_RIGHT || o->side == ISO_CHANNEL_BACK;
    c->side.face = vec3_dot(far ? c->figures.box_max : c->figures.box_min, c->side.out);
    return ISO_OK;
}

// Rings

static iso_status build_towers(iso_channels *c) {
    tower_options options = {c->options.mode == ISO_CHANNEL_POINTWISE, c->options.holes != 0,
                             c->options.samples};
    contours all;
    channels_report(c, 0, "slice");
    ISO_TRY(contours_cut_flat(&all, c->mesh, c->options.levels, &c->arena));
    channels_report(c, 0.2, "towers");
    return towers_build(&c->tower, &c->tower_count, &all, &options, &c->arena);
}

static iso_status push_ring(curve *out, iso_channels *c, const ring *outline) {
    ring_offset offset = {c->options.depth, c->bend / STEPS_A_BEND, &c->part};
    int32_t folds;
    ISO_TRY(ring_push_off(out, &folds, outline, &offset));
    c->figures.folds += folds;
    return ISO_OK;
}

static iso_status ring_off(curve *out, iso_channels *c, const tower *t, double f, ring *outline,
                           iso_arena *arena) {
    ISO_TRY(ring_of_tower(outline, t, f, SLOPE_REACH * c->options.depth, arena));
    return push_ring(out, c, outline);
}

static iso_status note_ring(iso_channels *c, int32_t tower_index, double f, const ring *outline) {
    iso_channel_figures *figures = &c->figures;
    iso_channel_ring noted = {.tower = tower_index, .channel = figures->channel_count, .height = f};
    for (int32_t i = 0; i < outline->count; i++) {
        noted.z += outline->point[i].z / outline->count;
        noted.length +=
            vec3_distance(outline->point[i > 0 ? i - 1 : outline->count - 1], outline->point[i]);
    }
    ISO_TRY(ISO_GROW(c->ring, c->ring_capacity, figures->ring_count + 1));
    ISO_TRY(ISO_GROW(c->outline, c->outline_capacity, figures->ring_count + 1));
    c->ring[figures->ring_count] = noted;
    c->outline[figures->ring_count++] = *outline;
    return ISO_OK;
}

// Channels

/* x of the section is to point off the part: away from the nearest point of the channel's rings. */
static iso_vec3 off_part(const iso_channels *c, iso_vec3 p) {
    iso_vec3 found = p;
    double best = INFINITY;
    for (int32_t r = 0; r < c->figures.ring_count; r++) {
        const ring *outline = &c->outline[r];
        if (c->ring[r].channel != c->figures.channel_count)
            continue;
        for (int32_t i = 0; i < outline->count; i++) {
            double distance = vec3_distance(p, outline->point[i]);
            if (distance < best)
                best = distance, found = outline->point[i];
        }
    }
    return vec3_unit(vec3_minus(p, found));
}

/* The channel takes the curve over, whatever comes of it. */
static iso_status add_channel(iso_channels *c, curve *line, const double leg[2]) {
    keeping keep = {c->options.depth, c->bend, c->bend / STEPS_A_BEND, 2};
    iso_status status = keep_off(line, &c->part, &keep);
    if (status == ISO_OK)
        status = ISO_GROW(c->channel, c->channel_capacity, c->figures.channel_count + 1);
    channel made = {.line = *line, .leg = {leg[0], leg[1]}};
    if (status == ISO_OK) {
        int32_t middle = line->count / 2;
        status = sweep(&made.skin, &made.line, &c->options.section, middle,
                       off_part(c, line->point[middle]), c->side.out, &c->arena);
    }
    if (status == ISO_OK)
        c->channel[c->figures.channel_count++] = made;
    else
        curve_free(line);
    *line = (curve){0};
    return status;
}

static iso_status add_ported(iso_channels *c, const curve *way) {
    curve line;
    double leg[2];
    ISO_TRY(route_ports(&line, leg, way, &c->side));
    return add_channel(c, &line, leg);
}

static iso_status add_ring(iso_channels *c, curve *pushed) {
    static const double none[2] = {0, 0};
    double middle = NAN;
    curve way;
    if (c->options.ports == ISO_CHANNEL_CLOSED)
        return add_channel(c, pushed, none);
    ISO_TRY(route_open(&way, &middle, pushed, &c->side));
    iso_status status = add_ported(c, &way);
    curve_free(&way);
    return status;
}

typedef struct series {
    curve way;
    int32_t rings;
    double last;   /* height of the last ring */
    double middle; /* between its ends, along the side */
} series;

/* Steps of the way from ring to ring, on the part's offset too. */
enum { STAIRS = 4 };

static iso_status append_stairs(series *s, iso_channels *c, const tower *t) {
    bool right = s->rings % 2 == 1;
    double middle = s->middle;
    for (int k = 1; k < STAIRS; k++) {
        iso_arena_mark mark = iso_arena_get_mark(&c->arena);
        ring outline;
        curve pushed = {0}, opened = {0};
        int32_t folds = c->figures.folds;
        iso_status status =
            ring_off(&pushed, c, t, s->last + c->options.pitch * k / STAIRS, &outline, &c->arena);
        if (status == ISO_OK)
            status = route_open(&opened, &middle, &pushed, &c->side);
        if (status == ISO_OK && middle == s->middle)
            status = curve_add(&s->way, opened.point[right ? 0 : opened.count - 1]);
        curve_free(&pushed);
        curve_free(&opened);
        iso_arena_pop(&c->arena, mark);
        c->figures.folds = folds;
        if (status != ISO_OK && status != ISO_NOT_VERIFIED)
            return status; /* without a place for a step the way goes straight on */
    }
    return ISO_OK;
}

/* t is NULL where there is no square-link: the way from ring to ring is straight then.
 * There and back: each ring begins at the end where the one below ends. */
static iso_status add_to_series(iso_channels *c, series *s, const tower *t, double f,
                                const curve *pushed) {
    curve opened;
    double middle = s->rings > 0 ? s->middle : NAN;
    if (s->rings > 0 && t)
        ISO_TRY(append_stairs(s, c, t));
    ISO_TRY(route_open(&opened, &middle, pushed, &c->side));
    iso_status status = route_append(&s->way, &opened, s->rings % 2 == 0);
    curve_free(&opened);
    s->rings++;
    s->last = f;
    s->middle = middle;
    return status;
}

static iso_status add_level(iso_channels *c, int32_t tower_index, double f, series *s) {
    const tower *t = &c->tower[tower_index];
    ring outline;
    curve pushed = {0};
    ISO_TRY(ring_off(&pushed, c, t, f, &outline, &c->arena));
    iso_status status = note_ring(c, tower_index, f, &outline);
    if (status == ISO_OK)
        status = c->options.ports == ISO_CHANNEL_SERIES ? add_to_series(c, s, t, f, &pushed)
                                                        : add_ring(c, &pushed);
    curve_free(&pushed);
    return status;
}

/* The first of the levels at `low` or above. */
static double first_level(const iso_channels *c, double low) {
    double skipped = ceil((low - c->start) / c->options.pitch - 1e-9);
    return skipped > 0 ? skipped : 0;
}

static iso_status add_tower(iso_channels *c, int32_t index) {
    double low, high;
    const tower *t = &c->tower[index];
    const double *top = t->f + (int64_t)t->samples * (t->rings - 1);
    series s = {0};
    tower_range(&low, &high, t);
    iso_status status = ISO_OK;
    double f = c->start + c->options.pitch * first_level(c, low);
    for (double k = first_level(c, low); f <= high && status == ISO_OK;) {
        status = add_level(c, index, f, &s);
        f = c->start + c->options.pitch * ++k;
    }
    bool part_of_it = false;
    for (int32_t i = 0; i < t->samples; i++)
        part_of_it |= top[i] >= f;
    c->figures.incomplete += part_of_it;
    if (status == ISO_OK && s.rings > 0)
        status = add_ported(c, &s.way);
    curve_free(&s.way);
    return status;
}

// Channels of the distance on the triangles

/* Of the pitch: edges are no longer than that. Distances are exact at vertices, and between them
 * they are taken as straight. */
#define EDGE_SHARE 0.25

/* From the lowest vertices; parts of the mesh that they have no way to are below all levels. */
static iso_status find_distances(double *distance, double *most, const iso_mesh *mesh) {
    double low = mesh->min.z + 1e-6 * (mesh->max.z - mesh->min.z);
    int32_t *source, count = 0;
    ISO_TRY(ISO_ALLOCATE(source, mesh->vertex_count));
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        if (mesh->position[v].z <= low)
            source[count++] = v;
    iso_status status = height_geodesic(distance, mesh, source, count);
    iso_release(source);
    ISO_TRY(status);
    *most = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        distance[v] = isfinite(distance[v]) ? distance[v] : -1;
        *most = distance[v] > *most ? distance[v] : *most;
    }
    return ISO_OK;
}

/* Around a top the last ring may be as narrow as can be. */
static iso_status find_narrow(bool *narrow, const iso_channels *c, const curve *pushed) {
    curve tried;
    int32_t at;
    ISO_TRY(curve_resample(&tried, pushed, c->bend / STEPS_A_BEND));
    iso_status status = curve_relax(&tried, c->bend, c->bend / STEPS_A_BEND, 0);
    if (status == ISO_OK)
        *narrow = curve_least_radius(&at, &tried) < c->bend;
    curve_free(&tried);
    return status;
}

static iso_status add_contour(iso_channels *c, const contours *all, int32_t at, int32_t number,
                              series *s) {
    double f = all->level[all->at[at]];
    ring outline;
    curve pushed;
    bool narrow = false;
    ISO_TRY(ring_of_contour(&outline, all, at, &c->fine, &c->arena));
    ISO_TRY(push_ring(&pushed, c, &outline));
    iso_status status = all->next[at] < 0 ? find_narrow(&narrow, c, &pushed) : ISO_OK;
    c->figures.narrow += narrow;
    if (status == ISO_OK && !narrow)
        status = note_ring(c, number, f, &outline);
    if (status == ISO_OK && !narrow)
        status = c->options.ports == ISO_CHANNEL_SERIES ? add_to_series(c, s, NULL, f, &pushed)
                                                        : add_ring(c, &pushed);
    curve_free(&pushed);
    return status;
}

/* Contours on top of each other, from one that is on none or on several. */
static iso_status add_chain(iso_channels *c, const contours *all, int32_t first, int32_t number) {
    series s = {0};
    iso_status status = ISO_OK;
    for (int32_t at = first; at >= 0 && status == ISO_OK; at = all->next[at])
        status = add_contour(c, all, at, number, &s);
    if (status == ISO_OK && s.rings > 0)
        status = add_ported(c, &s.way);
    curve_free(&s.way);
    return status;
}

static iso_status add_chains(iso_channels *c, const contours *all) {
    uint8_t *has_below;
    int32_t number = 0;
    ISO_TRY(ISO_PUSH(has_below, &c->arena, all->count));
    for (int32_t i = 0; i < all->count; i++)
        has_below[i] = 0;
    for (int32_t i = 0; i < all->count; i++)
        if (all->next[i] >= 0)
            has_below[all->next[i]] = 1;
    for (int32_t i = 0; i < all->count; i++) {
        if (has_below[i] || (all->area[i] < 0 && !c->options.holes))
            continue;
        channels_report(c, 0.3 + 0.3 * i / all->count, "channels");
        ISO_TRY(add_chain(c, all, i, number++));
    }
    return ISO_OK;
}

static iso_status add_geodesics(iso_channels *c) {
    contours all = {0};
    double *distance, most;
    ISO_TRY(mesh_split(&c->fine, c->mesh, EDGE_SHARE * c->options.pitch));
    ISO_TRY(ISO_PUSH(distance, &c->arena, c->fine.vertex_count));
    ISO_TRY(find_distances(distance, &most, &c->fine));
    double levels = floor((most - c->start) / c->options.pitch) + 1;
    if (!(levels >= 1))
        return ISO_OK;
    all.level_count = between(levels, 1, LEVELS_MOST);
    ISO_TRY(ISO_PUSH(all.level, &c->arena, all.level_count));
    for (int32_t k = 0; k < all.level_count; k++)
        all.level[k] = c->start + c->options.pitch * k;
    ISO_TRY(contours_cut(&all, &c->fine, distance, &c->arena));
    return add_chains(c, &all);
}

static iso_status add_all(iso_channels *c) {
    bool geodesic = c->options.mode == ISO_CHANNEL_GEODESIC;
    for (int32_t i = 0; i < c->tower_count && !geodesic; i++) {
        channels_report(c, 0.3 + 0.3 * i / c->tower_count, "channels");
        ISO_TRY(add_tower(c, i));
    }
    if (geodesic)
        ISO_TRY(add_geodesics(c));
    if (c->figures.channel_count > 0)
        return ISO_OK;
    return iso_fail(ISO_UNSLICEABLE,
                    "there is no channel: the first would be %g mm up along the surface, which the "
                    "part, %.4g mm tall, doesn't have all around; a smaller pitch or start does",
                    c->start, c->mesh->max.z - c->mesh->min.z);
}

// Figures

static double volume_of(const skin *s) {
    double six = 0;
    iso_vec3 o = s->point[0];
    for (int32_t r = 0; r < skin_steps(s); r++)
        for (int32_t k = 0; k < s->sides; k++) {
            iso_vec3 c[6];
            skin_square(c, s, r, k);
            for (int i = 0; i < 6; i += 3)
                six += vec3_dot(vec3_minus(c[i], o),
                                vec3_cross(vec3_minus(c[i + 1], o), vec3_minus(c[i + 2], o)));
        }
    if (!s->closed) { /* the lid at point 0 adds nothing, that at the other end does */
        const iso_vec3 *b = s->point + (int64_t)s->sides * (s->rows - 1);
        for (int32_t k = 1; k + 1 < s->sides; k++)
            six += vec3_dot(vec3_minus(b[0], o),
                            vec3_cross(vec3_minus(b[k], o), vec3_minus(b[k + 1], o)));
    }
    return six / 6;
}

static iso_status find_figures(iso_channels *c) {
    iso_channel_figures *f = &c->figures;
    iso_vec3 size = vec3_minus(f->box_max, f->box_min);
    f->tower_count = c->tower_count;
    f->ring = c->ring;
    for (int32_t i = 0; i < f->channel_count; i++) {
        f->length += curve_length(&c->channel[i].line);
        f->volume += volume_of(&c->channel[i].skin);
    }
    f->part_volume = iso_mesh_volume(c->mesh);
    f->mould_volume = size.x * size.y * size.z - f->part_volume - f->volume;
    ISO_TRY(channels_measure_pitch(c));
    channels_report(c, 0.85, "walls");
    return channels_measure_walls(c);
}

static iso_status build(iso_channels *c) {
    ISO_TRY(settle(c));
    ISO_TRY(part_space_new(&c->part, c->mesh));
    ISO_TRY(build_towers(c));
    ISO_TRY(add_all(c));
    ISO_TRY(find_figures(c));
    channels_report(c, 1, "walls");
    return ISO_OK;
}

static iso_status make(iso_channels **channels, const iso_mesh *mesh,
                       const iso_channel_options *options) {
    iso_channels *c;
    *channels = NULL;
    ISO_TRY(ISO_ALLOCATE(c, 1));
    *c = (iso_channels){.options = *options, .mesh = mesh};
    iso_status status = build(c);
    if (status == ISO_OK)
        *channels = c;
    else
        iso_channels_free(c);
    return status;
}

iso_status iso_channels_new(iso_channels **channels, const iso_mesh *mesh,
                            const iso_channel_options *options) {
    iso_channel_options finer = *options;
    *channels = NULL;
    ISO_TRY(check_options(options));
    ISO_TRY(make(channels, mesh, options));
    bool by_levels = options->levels == 0 && options->mode != ISO_CHANNEL_GEODESIC;
    for (int turn = 0; turn < REFINEMENTS && by_levels; turn++) {
        iso_channels *better;
        double error = (*channels)->figures.pitch_max;
        finer.levels = REFINED * ((*channels)->options.levels - 1) + 1;
        if (error <= PITCH_ERROR || finer.levels > LEVELS_MOST)
            break;
        if (make(&better, mesh, &finer) != ISO_OK)
            break; /* as between threads of a screw: the coarser ones will do */
        double after = better->figures.pitch_max;
        iso_channels_free(after < error ? *channels : better);
        if (after < error)
            *channels = better;
        if (after > error / 2)
            break; /* it isn't for the levels */
    }
    return ISO_OK;
}

void iso_channels_free(iso_channels *c) {
    if (!c)
        return;
    for (int32_t i = 0; i < c->figures.channel_count; i++)
        curve_free(&c->channel[i].line);
    iso_release(c->channel);
    iso_release(c->ring);
    iso_release(c->outline);
    part_space_free(&c->part);
    iso_mesh_free(&c->fine);
    iso_arena_free(&c->arena);
    iso_release(c);
}

const iso_channel_figures *iso_channels_figures(const iso_channels *channels) {
    return &channels->figures;
}
