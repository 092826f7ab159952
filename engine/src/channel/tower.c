/* Towers of contours as square-links, and the distance along their surface.
 *
 * beta leads from a point to the nearest place of the next contour, which is the way that a
 * geodesic from contour to contour takes. (The nearest of the next ring's points instead, as the
 * paper has it, goes aslant by up to half a step: on a cone the sum is 16 % too long, and longer
 * the finer the rings.) Places are kept in order around the ring, and spread out where they crowd,
 * so that alpha and beta commute whatever the shape. */
#include "channel/tower.h"

#include "channel/polyline.h"

/* Neighbours nearer than this share of their mean distance are crowded; spreading takes each gap
 * this much nearer to the mean, contour by contour: columns must not slip far to the side in one
 * step. */
#define CROWDED 0.5
#define SPREADING 0.25

typedef struct builder {
    const contours *all;
    const tower_options *options;
    iso_arena *arena;
    double *height; /* [contours] largest F there; below 0: not known */
    double *place;  /* [samples] along the contour, unwrapped, rising */
    double *moved;  /* [samples] */
    double *f, *weight;
    int32_t *block;
    int32_t *lead; /* [pieces] what leads a list of contours right below, by piece */
    int32_t *link; /* [contours] the next of the list */
} builder;

static double wrap(double place, double whole) {
    return place - whole * floor(place / whole);
}

static iso_status list_floors(builder *b) {
    const contours *all = b->all;
    int32_t pieces = 0;
    for (int32_t c = 0; c < all->count; c++) {
        pieces = all->roof[c] >= pieces ? all->roof[c] + 1 : pieces;
        pieces = all->floor[c] >= pieces ? all->floor[c] + 1 : pieces;
    }
    ISO_TRY(ISO_PUSH(b->link, b->arena, all->count));
    ISO_TRY(ISO_PUSH(b->lead, b->arena, pieces));
    for (int32_t p = 0; p < pieces; p++)
        b->lead[p] = -1;
    for (int32_t c = 0; c < all->count; c++) {
        b->link[c] = b->lead[all->floor[c]];
        b->lead[all->floor[c]] = c;
    }
    return ISO_OK;
}

// Rings

static iso_status line_of(polyline *line, const builder *b, int32_t contour) {
    int32_t first = b->all->first[contour];
    return polyline_new(line, b->all->point + first, b->all->first[contour + 1] - first, b->arena);
}

/* Even places. */
static void begin(const builder *b, tower *t, const polyline *line, double height) {
    for (int32_t i = 0; i < t->samples; i++) {
        b->place[i] = polyline_whole(line) * i / t->samples;
        t->g[i] = polyline_at(line, b->place[i]);
        t->f[i] = height;
    }
}

/* The nearest places, each turned so many times around the ring that it is as near as can be to
 * where the one before would have it. */
static void project(const builder *b, const tower *t, int32_t ring, const polyline *line) {
    const iso_vec3 *g = t->g + (int64_t)t->samples * ring;
    const double *f = t->f + (int64_t)t->samples * ring;
    double whole = polyline_whole(line), before = 0;
    int32_t guess = 0;
    for (int32_t i = 0; i < t->samples; i++) {
        double at;
        b->f[i] = f[i] + polyline_nearest(&at, line, g[i], &guess);
        before = i == 0 || whole <= 0 ? at : at - whole * floor((at - before) / whole + 0.5);
        b->place[i] = before;
    }
}

/* Least squares among rising sequences: what falls is pooled into blocks at their mean (Ayer et al.
 * 1955). The ends may not be farther apart than the ring is long, which a clamp sees to. A block's
 * heights are pooled too. */
static void put_in_order(const builder *b, int32_t n, double whole) {
    int32_t blocks = 0;
    for (int32_t i = 0; i < n; i++) {
        double place = b->place[i], f = b->f[i];
        int32_t size = 1;
        while (blocks > 0 && b->moved[blocks - 1] >= place) {
            blocks--;
            int32_t other = b->block[blocks];
            place = (place * size + b->moved[blocks] * other) / (size + other);
            f = (f * size + b->weight[blocks] * other) / (size + other);
            size += other;
        }
        b->moved[blocks] = place;
        b->weight[blocks] = f;
        b->block[blocks++] = size;
    }
    for (int32_t k = 0, i = 0; k < blocks; i += b->block[k++])
        for (int32_t j = i; j < i + b->block[k]; j++)
            b->place[j] = b->moved[k], b->f[j] = b->weight[k];
    double first = b->place[0], last = b->place[n - 1], slack = whole * (n - 1) / n;
    if (last - first > slack) { /* more than once around: shrink about the middle */
        double middle = (first + last) / 2, by = slack / (last - first);
        for (int32_t i = 0; i < n; i++)
            b->place[i] = middle + by * (b->place[i] - middle);
    }
}

static double gap_after(const double *place, int32_t i, int32_t n, double whole) {
    return i + 1 < n ? place[i + 1] - place[i] : place[0] + whole - place[n - 1];
}

/* Half the way from neighbour to neighbour. */
static void weigh(const builder *b, int32_t n, double whole) {
    for (int32_t i = 0; i < n; i++)
        b->weight[i] = (gap_after(b->place, i, n, whole) +
                        gap_after(b->place, i > 0 ? i - 1 : n - 1, n, whole)) /
                       2;
}

/* F between points, by their places. */
static double height_at(const builder *b, int32_t n, double whole, double place, int32_t *near) {
    int32_t i = *near;
    while (i > -n && b->place[(i + n) % n] - (i < 0 ? whole : 0) > place)
        i--;
    while (i < n - 1 && b->place[(i + 1 + n) % n] - (i + 1 < 0 ? whole : 0) <= place)
        i++;
    *near = i;
    int32_t from = (i + n) % n, to = (from + 1) % n;
    double left = b->place[from] - (i < 0 ? whole : 0), gap = gap_after(b->place, from, n, whole);
    double share = gap > 0 ? (place - left) / gap : 0;
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    return b->f[from] + share * (b->f[to] - b->f[from]);
}

static void spread(const builder *b, int32_t n, double whole) {
    double least = INFINITY, mean = whole / n, shift = 0, at = b->place[0];
    int32_t near = 0;
    for (int32_t i = 0; i < n; i++) {
        double gap = gap_after(b->place, i, n, whole);
        least = gap < least ? gap : least;
    }
    if (!(least < CROWDED * mean))
        return;
    for (int32_t i = 0; i < n; i++) {
        double gap = gap_after(b->place, i, n, whole);
        b->moved[i] = at;
        shift += (b->place[i] - at) / n;
        at += gap + SPREADING * (mean - gap);
    }
    for (int32_t i = 0; i < n; i++) {
        b->moved[i] += shift;
        b->weight[i] = height_at(b, n, whole, b->moved[i], &near);
    }
    for (int32_t i = 0; i < n; i++)
        b->place[i] = b->moved[i], b->f[i] = b->weight[i];
}

/* All of a ring have one height: the mean way from the ring below. */
static void level_out(const builder *b, int32_t n, double whole) {
    double sum = 0, all = 0;
    weigh(b, n, whole);
    for (int32_t i = 0; i < n; i++) {
        sum += b->weight[i] * b->f[i];
        all += b->weight[i];
    }
    for (int32_t i = 0; i < n; i++)
        b->f[i] = all > 0 ? sum / all : b->f[0];
}

static iso_status add_ring(const builder *b, tower *t, int32_t contour) {
    iso_arena_mark mark = iso_arena_get_mark(b->arena);
    polyline line;
    int32_t n = t->samples, ring = t->rings;
    ISO_TRY(line_of(&line, b, contour));
    double whole = polyline_whole(&line);
    project(b, t, ring - 1, &line);
    put_in_order(b, n, whole);
    if (!b->options->pointwise)
        level_out(b, n, whole);
    spread(b, n, whole);
    iso_vec3 *g = t->g + (int64_t)n * ring;
    double *f = t->f + (int64_t)n * ring;
    for (int32_t i = 0; i < n; i++) {
        g[i] = polyline_at(&line, wrap(b->place[i], whole > 0 ? whole : 1));
        f[i] = b->f[i] > f[i - n] ? b->f[i] : f[i - n];
    }
    t->rings++;
    iso_arena_pop(b->arena, mark);
    return ISO_OK;
}

// Towers

/* The way goes on from the highest of the contours that the lowest of this one grows out of. */
static iso_status find_base(double *height, const builder *b, int32_t contour) {
    iso_arena_mark mark = iso_arena_get_mark(b->arena);
    polyline line;
    *height = 0;
    for (int32_t c = b->lead[b->all->roof[contour]]; c >= 0; c = b->link[c]) {
        int32_t guess = 0, n = 0;
        double sum = 0, at;
        ISO_TRY(line_of(&line, b, contour));
        for (int32_t i = b->all->first[c]; i < b->all->first[c + 1]; i++, n++)
            sum += polyline_nearest(&at, &line, b->all->point[i], &guess);
        if (n > 0 && b->height[c] >= 0 && b->height[c] + sum / n > *height)
            *height = b->height[c] + sum / n;
        iso_arena_pop(b->arena, mark);
    }
    return ISO_OK;
}

static iso_status build(tower *t, builder *b, int32_t contour) {
    polyline line;
    double height;
    int32_t rings = 1, last = contour;
    for (; b->all->next[last] >= 0; last = b->all->next[last])
        rings++;
    *t = (tower){.samples = b->options->samples, .hole = b->all->area[contour] < 0};
    ISO_TRY(ISO_PUSH(t->g, b->arena, (int64_t)t->samples * rings));
    ISO_TRY(ISO_PUSH(t->f, b->arena, (int64_t)t->samples * rings));
    ISO_TRY(find_base(&height, b, contour));
    iso_arena_mark mark = iso_arena_get_mark(b->arena);
    ISO_TRY(line_of(&line, b, contour));
    begin(b, t, &line, height);
    iso_arena_pop(b->arena, mark);
    t->rings = 1;
    for (int32_t c = b->all->next[contour]; c >= 0; c = b->all->next[c])
        ISO_TRY(add_ring(b, t, c));
    const double *f = t->f + (int64_t)t->samples * (t->rings - 1);
    for (int32_t i = 0; i < t->samples; i++)
        b->height[last] = f[i] > b->height[last] ? f[i] : b->height[last];
    return ISO_OK;
}

static iso_status push_scratch(builder *b) {
    int32_t n = b->options->samples;
    ISO_TRY(ISO_PUSH(b->height, b->arena, b->all->count));
    ISO_TRY(ISO_PUSH(b->place, b->arena, n));
    ISO_TRY(ISO_PUSH(b->moved, b->arena, n));
    ISO_TRY(ISO_PUSH(b->f, b->arena, n));
    ISO_TRY(ISO_PUSH(b->weight, b->arena, n));
    for (int32_t c = 0; c < b->all->count; c++)
        b->height[c] = -1;
    return ISO_PUSH(b->block, b->arena, n);
}

iso_status towers_build(tower **out, int32_t *count, const contours *all,
                        const tower_options *options, iso_arena *arena) {
    builder b = {.all = all, .options = options, .arena = arena};
    uint8_t *has_below;
    int32_t *order, *first;
    *count = 0;
    ISO_TRY(list_floors(&b));
    ISO_TRY(push_scratch(&b));
    ISO_TRY(ISO_PUSH(*out, arena, all->count));
    ISO_TRY(ISO_PUSH(has_below, arena, all->count));
    ISO_TRY(ISO_PUSH(order, arena, all->count));
    ISO_TRY(ISO_PUSH(first, arena, (int64_t)all->level_count + 1));
    /* by level, so that what a tower grows out of is built before it: a counting sort */
    for (int32_t l = 0; l <= all->level_count; l++)
        first[l] = 0;
    for (int32_t c = 0; c < all->count; c++)
        first[all->at[c] + 1]++;
    for (int32_t l = 0; l < all->level_count; l++)
        first[l + 1] += first[l];
    for (int32_t c = 0; c < all->count; c++) {
        order[first[all->at[c]]++] = c;
        has_below[c] = 0;
    }
    for (int32_t c = 0; c < all->count; c++)
        if (all->next[c] >= 0)
            has_below[all->next[c]] = 1;
    for (int32_t k = 0; k < all->count; k++) {
        int32_t c = order[k];
        if (has_below[c] || (all->area[c] < 0 && !options->holes))
            continue;
        tower *t = &(*out)[*count];
        ISO_TRY(build(t, &b, c));
        *count += t->rings > 1;
    }
    return ISO_OK;
}

// Heights

iso_vec3 tower_point(const tower *t, int32_t i, double f) {
    int32_t low = 0, high = t->rings - 1;
    while (low < high) { /* the last ring at f or below it */
        int32_t middle = low + (high - low + 1) / 2;
        if (t->f[(int64_t)t->samples * middle + i] <= f)
            low = middle;
        else
            high = middle - 1;
    }
    int64_t a = (int64_t)t->samples * low + i, b = low + 1 < t->rings ? a + t->samples : a;
    double rise = t->f[b] - t->f[a], share = rise > 0 ? (f - t->f[a]) / rise : 0;
    return vec3_between(t->g[a], t->g[b], share < 0 ? 0 : share > 1 ? 1 : share);
}

void tower_range(double *low, double *high, const tower *t) {
    const double *top = t->f + (int64_t)t->samples * (t->rings - 1);
    *low = t->f[0];
    *high = top[0];
    for (int32_t i = 1; i < t->samples; i++) {
        *low = t->f[i] > *low ? t->f[i] : *low;
        *high = top[i] < *high ? top[i] : *high;
    }
}
