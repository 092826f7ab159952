/* The direction of a bridge, by trial: the part is swept with lines in each of some directions, and
 * what counts is how much of their length over air is held at both ends, at one, or at none. */
#include <math.h>
#include <stdbool.h>

#include <isoslice/shell.h>

#include "base/angle.h"
#include "base/sort.h"
#include "planar/scratch.h"

enum {
    STEP = 10, /* degrees between directions */
    EDGES = 4, /* longest edges of the part, whose own directions are tried as well */
    CANDIDATES_MAX = 1 + 180 / STEP + EDGES,
    LINES_MIN = 16, /* lines of a sweep */
    LINES_MAX = 64,
    LINE_SPACING = 4500, /* units, between those */
    HOLD = 3000,         /* units behind its end within which what holds a line must lie */
    COARSE = 500,        /* units; edges finer than that don't matter */
    SHORT = 1000         /* units; gaps over air that no line takes notice of */
};

/* Of a line's length over air: that held at one end only counts for this much as not held. */
#define HALF_HELD 0.6
/* Directions within this of the best are as good, in the share and in the length. */
#define ALIKE 0.02
#define AS_LONG 1.005

enum { PART, SUPPORT };

typedef struct iso_meeting {
    int32_t line;
    int32_t side; /* PART or SUPPORT; */
    double at;    /* along the line */
    int32_t turn; /* +1: what is to the right of it is inside, on one layer more */
} iso_meeting;

static bool meeting_less(const iso_meeting *a, const iso_meeting *b) {
    if (a->line != b->line)
        return a->line < b->line;
    if (a->at != b->at)
        return a->at < b->at;
    return a->side != b->side ? a->side < b->side : a->turn < b->turn;
}
ISO_SORT(sort_meetings, iso_meeting, meeting_less)

typedef struct iso_trial {
    double degrees;
    double unheld;  /* share of the length over air */
    double longest; /* length over air */
} iso_trial;

typedef struct iso_sweeping {
    const iso_region *region[2]; /* PART, SUPPORT */
    double along_x, along_y;
    double low, step; /* of the lines, across */
    int32_t lines;
    iso_meeting *meeting;
    int64_t count, capacity;
} iso_sweeping;

static double along(const iso_sweeping *s, iso_point p) {
    return p.x * s->along_x + p.y * s->along_y;
}

static double across(const iso_sweeping *s, iso_point p) {
    return p.y * s->along_x - p.x * s->along_y;
}

static void set_lines(iso_sweeping *s) {
    const iso_region *part = s->region[PART];
    double low = across(s, part->point[0]), high = low;
    for (int32_t i = 1; i < part->first[part->count]; i++) {
        double v = across(s, part->point[i]);
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
    double lines = (high - low) / LINE_SPACING;
    s->lines = lines < LINES_MIN ? LINES_MIN : lines > LINES_MAX ? LINES_MAX : (int32_t)lines;
    s->low = low;
    s->step = (high - low) / s->lines;
}

/* Line k runs at low + (k + 1/2) step; an edge meets those from its lower end on, up to below its
 * higher one. */
static int32_t line_from(const iso_sweeping *s, double v) {
    double k = ceil((v - s->low) / s->step - 0.5);
    return k < 0 ? 0 : k > s->lines ? s->lines : (int32_t)k;
}

static iso_status meet_edge(iso_sweeping *s, iso_point a, iso_point b, int32_t side) {
    double va = across(s, a), vb = across(s, b), ua = along(s, a), ub = along(s, b);
    int32_t turn = va > vb ? 1 : -1; /* down on the left of what is inside */
    int32_t from = line_from(s, va < vb ? va : vb), end = line_from(s, va < vb ? vb : va);
    if (from >= end)
        return ISO_OK;
    ISO_TRY(ISO_GROW(s->meeting, s->capacity, s->count + end - from));
    for (int32_t k = from; k < end; k++) {
        double t = (s->low + (k + 0.5) * s->step - va) / (vb - va);
        s->meeting[s->count++] = (iso_meeting){k, side, ua + t * (ub - ua), turn};
    }
    return ISO_OK;
}

static iso_status meet_all(iso_sweeping *s) {
    s->count = 0;
    for (int32_t side = PART; side <= SUPPORT; side++) {
        const iso_region *region = s->region[side];
        for (int32_t c = 0; c < region->count; c++) {
            int32_t first = region->first[c], end = region->first[c + 1];
            for (int32_t i = first; i < end; i++)
                ISO_TRY(meet_edge(s, region->point[i], region->point[i + 1 < end ? i + 1 : first],
                                  side));
        }
    }
    sort_meetings(s->meeting, s->count);
    return ISO_OK;
}

/* Does the support reach from meeting i, where a gap ends, on over HOLD? `way` is the direction. */
static bool is_held(const iso_sweeping *s, int64_t i, int way) {
    double end = s->meeting[i].at;
    int32_t line = s->meeting[i].line, depth = 0;
    for (int64_t k = i; k >= 0 && k < s->count && s->meeting[k].line == line; k += way) {
        const iso_meeting *m = &s->meeting[k];
        if ((m->at - end) * way > HOLD)
            break;
        if (m->side == SUPPORT)
            depth += m->turn * way;
    }
    return depth > 0;
}

typedef struct iso_tally {
    double all, unheld, longest;
} iso_tally;

static void add_gap(iso_tally *tally, const iso_sweeping *s, int64_t from, int64_t to) {
    double length = s->meeting[to].at - s->meeting[from].at;
    if (length < SHORT)
        return;
    int held = is_held(s, from, -1) + is_held(s, to, 1);
    tally->all += length;
    tally->unheld += held == 2 ? 0 : held == 1 ? HALF_HELD * length : length;
    if (length > tally->longest)
        tally->longest = length;
}

/* Gaps are pieces of the part without support. */
static iso_status try_direction(iso_trial *trial, iso_sweeping *s, double degrees) {
    iso_tally tally = {0};
    iso_sine_cosine(&s->along_y, &s->along_x, degrees);
    set_lines(s);
    ISO_TRY(meet_all(s));
    int32_t in[2] = {0}, line = -1;
    int64_t from = -1;
    for (int64_t i = 0; i < s->count; i++) {
        const iso_meeting *m = &s->meeting[i];
        if (m->line != line)
            line = m->line, in[PART] = in[SUPPORT] = 0, from = -1;
        in[m->side] += m->turn;
        bool gap = in[PART] > 0 && in[SUPPORT] <= 0;
        if (gap && from < 0)
            from = i;
        if (!gap && from >= 0) {
            add_gap(&tally, s, from, i);
            from = -1;
        }
    }
    *trial = (iso_trial){degrees, tally.all > 0 ? tally.unheld / tally.all : 0, tally.longest};
    return ISO_OK;
}

/* ---- candidates ---- */

/* The direction of (x, y), y >= 0, in degrees below 180, by bisection. */
static double degrees_of(double x, double y) {
    double low = 0, high = 180;
    for (int i = 0; i < 40; i++) {
        double middle = (low + high) / 2, sine, cosine;
        iso_sine_cosine(&sine, &cosine, middle);
        *(cosine * y - sine * x > 0 ? &low : &high) = middle;
    }
    return low;
}

typedef struct iso_direction {
    double x, y, square; /* of the length; y >= 0 */
} iso_direction;

/* The longest edges of the part, longest first, one of each direction. */
static int32_t longest_edges(iso_direction *edge, const iso_region *part) {
    int32_t count = 0;
    for (int32_t c = 0; c < part->count; c++)
        for (int32_t i = part->first[c], end = part->first[c + 1]; i < end; i++) {
            iso_point a = part->point[i], b = part->point[i + 1 < end ? i + 1 : part->first[c]];
            double x = (double)b.x - a.x, y = (double)b.y - a.y;
            int sign = y < 0 || (y == 0 && x < 0) ? -1 : 1, k = 0;
            iso_direction d = {x * sign, y * sign, x * x + y * y};
            while (k < count && edge[k].square >= d.square)
                k++;
            if (k == EDGES)
                continue;
            count += count < EDGES;
            for (int j = count - 1; j > k; j--)
                edge[j] = edge[j - 1];
            edge[k] = d;
        }
    return count;
}

static int32_t list_candidates(double *degrees, const iso_region *part, double usual) {
    iso_direction edge[EDGES];
    int32_t count = 0, edges = longest_edges(edge, part);
    degrees[count++] = usual;
    for (int32_t i = 0; i < edges; i++)
        degrees[count++] = degrees_of(edge[i].x, edge[i].y);
    for (int32_t d = 0; d < 180; d += STEP)
        degrees[count++] = d;
    return count;
}

/* ---- choice ---- */

static double choose(const iso_trial *trial, int32_t count) {
    double unheld = 2, longest = -1;
    for (int32_t i = 0; i < count; i++)
        unheld = trial[i].unheld < unheld ? trial[i].unheld : unheld;
    for (int32_t i = 0; i < count; i++)
        if (trial[i].unheld <= unheld + ALIKE && (longest < 0 || trial[i].longest < longest))
            longest = trial[i].longest;
    for (int32_t i = 0; i < count; i++)
        if (trial[i].unheld <= unheld + ALIKE && trial[i].longest <= longest * AS_LONG)
            return trial[i].degrees;
    return trial[0].degrees;
}

/* What lies far off the part holds nothing. */
static iso_status near_support(iso_region *near, iso_region *coarse, const iso_region *part,
                               const iso_region *support, iso_planar_scratch *scratch) {
    iso_offset_options grow = iso_offset_defaults(2 * HOLD);
    ISO_TRY(iso_offset(coarse, part, &grow, scratch));
    ISO_TRY(iso_boolean(near, ISO_INTERSECTION, coarse, support, scratch));
    ISO_TRY(iso_region_simplify(coarse, near, COARSE, scratch));
    return iso_region_simplify(near, part, COARSE, scratch);
}

iso_status iso_bridge_angle(double *angle, const iso_region *bridge, const iso_region *support,
                            double usual, iso_planar_scratch *scratch) {
    iso_region part = {0}, near = {0};
    double degrees[CANDIDATES_MAX];
    iso_trial trial[CANDIDATES_MAX];
    iso_sweeping sweeping = {.region = {&part, &near}};
    *angle = usual;
    iso_status status = near_support(&part, &near, bridge, support, scratch);
    if (status == ISO_OK && part.count > 0 && near.count > 0) {
        int32_t count = list_candidates(degrees, &part, usual);
        for (int32_t i = 0; status == ISO_OK && i < count; i++)
            status = try_direction(&trial[i], &sweeping, degrees[i]);
        if (status == ISO_OK)
            *angle = choose(trial, count);
    }
    iso_release(sweeping.meeting);
    iso_region_free(&part);
    iso_region_free(&near);
    return status;
}
