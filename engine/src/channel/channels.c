/* From a part to channels: the stages in their order. */
#include "channel/body.h"
#include "channel/lead.h"

enum { LEVELS_LEAST = 81, SAMPLES_LEAST = 100, SAMPLES_MOST = 1000 };

/* Contours a pitch, points of a ring a depth: with fewer, corners are cut off. */
#define LEVELS_A_PITCH 8
#define SAMPLES_A_DEPTH 10
/* With levels by the pitch, more of them if a pitch turns out to be wrong by more than this: parts
 * with threads or steps are longer along their surface than their contours a pitch / 8 apart. */
#define PITCH_ERROR 1e-3
enum { REFINEMENTS = 2, REFINED = 3 };

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

// Channels

static iso_status build_towers(iso_channels *c) {
    tower_options options = {c->options.mode == ISO_CHANNEL_POINTWISE, c->options.holes != 0,
                             c->options.samples};
    contours all;
    channels_report(c, 0, "slice");
    ISO_TRY(contours_cut_flat(&all, c->mesh, c->options.levels, &c->arena));
    channels_report(c, 0.2, "towers");
    return towers_build(&c->tower, &c->tower_count, &all, &options, &c->arena);
}

static iso_status add_all(iso_channels *c) {
    bool geodesic = c->options.mode == ISO_CHANNEL_GEODESIC;
    for (int32_t i = 0; i < c->tower_count && !geodesic; i++) {
        channels_report(c, 0.3 + 0.3 * i / c->tower_count, "channels");
        ISO_TRY(lead_tower(c, i));
    }
    if (geodesic)
        ISO_TRY(lead_geodesics(c));
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
