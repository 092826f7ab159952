/* How far apart the rings are, measured on square-links of their own with three times as many
 * contours and samples: where a point lies between two contours its height does between theirs. */
#include "channel/body.h"
#include "channel/polyline.h"

enum { FINER = 3, SAMPLES_MOST = 1000 };

/* Of the pitch: farther than this off all towers there is nothing to measure by, as on the part's
 * top; nor is a ring of which there is more than the other share. */
#define OFF 0.1
#define MISSED 0.01

typedef struct measure {
    const iso_channels *c;
    iso_arena arena;
    tower *fine;
    int32_t count;
} measure;

/* The nearest place of ring j, and its height. */
static iso_vec3 on_ring(double *height, const tower *t, int32_t j, iso_vec3 p) {
    const iso_vec3 *g = t->g + (int64_t)t->samples * j;
    const double *f = t->f + (int64_t)t->samples * j;
    double best = INFINITY;
    iso_vec3 found = p;
    for (int32_t i = 0; i < t->samples; i++) {
        int32_t k = i + 1 < t->samples ? i + 1 : 0;
        iso_vec3 along = vec3_minus(g[k], g[i]), to = vec3_minus(p, g[i]);
        double square = vec3_dot(along, along);
        double s = square > 0 ? vec3_dot(to, along) / square : 0;
        s = s < 0 ? 0 : s > 1 ? 1 : s;
        iso_vec3 off = vec3_along(to, -s, along);
        double distance = vec3_dot(off, off);
        if (distance < best) {
            best = distance;
            found = vec3_along(g[i], s, along);
            *height = f[i] + s * (f[k] - f[i]);
        }
    }
    return found;
}

static double z_of(const tower *t, int32_t j) {
    return t->g[(int64_t)t->samples * j].z;
}

/* The last ring below z, or at it, but for the topmost one; -1 outside. A little beyond the ends
 * isn't: the coarser square-link ends there. */
static int32_t ring_below(const tower *t, double z) {
    double low = z_of(t, 0), high = z_of(t, t->rings - 1), slack = (high - low) / (t->rings - 1);
    int32_t from = 0, to = t->rings - 2;
    if (z < low - slack || z > high + slack)
        return -1;
    while (from < to) {
        int32_t middle = from + (to - from + 1) / 2;
        if (z_of(t, middle) <= z)
            from = middle;
        else
            to = middle - 1;
    }
    return from;
}

enum { STEPS = 8 };

/* How far p is off the tower; infinite off its ends. Between the nearest places of two rings it is
 * where the line between them passes it: its own z says only which rings to begin with, for it may
 * lie a little within the surface. */
static double height_of(double *height, const tower *t, iso_vec3 p) {
    int32_t j = ring_below(t, p.z);
    double off = INFINITY;
    for (int k = 0, before = -1; k < STEPS && j >= 0; k++) {
        double below, above;
        iso_vec3 low = on_ring(&below, t, j, p), high = on_ring(&above, t, j + 1, p);
        iso_vec3 along = vec3_minus(high, low);
        double square = vec3_dot(along, along);
        double s = square > 0 ? vec3_dot(vec3_minus(p, low), along) / square : 0;
        int32_t next = s < 0 && j > 0 ? j - 1 : s > 1 && j + 2 < t->rings ? j + 1 : j;
        *height = below + s * (above - below);
        off = vec3_distance(p, vec3_along(low, s, along));
        if (next == j || next == before)
            break;
        before = j;
        j = next;
    }
    return off;
}

static const tower *tower_at(const measure *m, iso_vec3 p) {
    const tower *found = NULL;
    double best = INFINITY, height;
    for (int32_t i = 0; i < m->count; i++) {
        double off = height_of(&height, &m->fine[i], p);
        if (off < best)
            best = off, found = &m->fine[i];
    }
    return found;
}

static void measure_ring(const measure *m, iso_channel_ring *out, const ring *r, double *squares,
                         int64_t *count) {
    const tower *t = tower_at(m, r->point[0]);
    double sum = 0, length = 0, missed = 0;
    out->least = INFINITY;
    out->most = -INFINITY;
    for (int32_t i = 0; i < r->count && t; i++) {
        iso_vec3 before = r->point[i > 0 ? i - 1 : r->count - 1];
        iso_vec3 after = r->point[i + 1 < r->count ? i + 1 : 0];
        double height,
            weight = vec3_distance(before, r->point[i]) + vec3_distance(r->point[i], after);
        if (height_of(&height, t, r->point[i]) > OFF * m->c->options.pitch) {
            missed += weight;
            continue;
        }
        out->least = fmin(out->least, height);
        out->most = fmax(out->most, height);
        sum += weight * height;
        length += weight;
        if (out->height > 0) {
            double off = height / out->height - 1;
            *squares += off * off;
            ++*count;
        }
    }
    out->measured = length > 0 && missed < MISSED * length;
    out->mean = out->measured ? sum / length : out->height;
    if (!out->measured)
        out->least = out->most = out->height;
}

static void sum_up(iso_channel_figures *f, double pitch, double squares, int64_t count) {
    double measured = 0, off = 0;
    int32_t pitches = 0;
    f->spread_rms = count > 0 ? sqrt(squares / (double)count) : 0;
    for (int32_t i = 1; i < f->ring_count; i++) {
        const iso_channel_ring *a = &f->ring[i - 1], *b = &f->ring[i];
        if (a->tower != b->tower || !a->measured || !b->measured || b->height <= a->height)
            continue;
        double way = b->mean - a->mean, error = way / (b->height - a->height) - 1;
        measured += way;
        off += error * error;
        f->pitch_max = fmax(f->pitch_max, fabs(error));
        pitches++;
    }
    if (pitches > 0) {
        f->pitch_total = measured / (pitch * pitches) - 1;
        f->pitch_rms = sqrt(off / pitches);
    }
}

static iso_status measure_all(iso_channels *c, measure *m) {
    int32_t few = c->options.samples,
            many = FINER * few < SAMPLES_MOST ? FINER * few : SAMPLES_MOST;
    tower_options options = {true, c->options.holes != 0, few > many ? few : many};
    contours all;
    double squares = 0;
    int64_t count = 0;
    ISO_TRY(contours_cut_flat(&all, c->mesh, FINER * (c->options.levels - 1) + 1, &m->arena));
    ISO_TRY(towers_build(&m->fine, &m->count, &all, &options, &m->arena));
    for (int32_t i = 0; i < c->figures.ring_count; i++) {
        measure_ring(m, &c->ring[i], &c->outline[i], &squares, &count);
        channels_report(c, 0.6 + 0.2 * (i + 1) / c->figures.ring_count, "measure");
    }
    sum_up(&c->figures, c->options.pitch, squares, count);
    return ISO_OK;
}

iso_status channels_measure_pitch(iso_channels *c) {
    measure m = {.c = c};
    iso_status status = measure_all(c, &m);
    iso_arena_free(&m.arena);
    return status;
}
