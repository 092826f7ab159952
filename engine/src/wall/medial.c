#include "wall/medial.h"

#include <math.h>

#include "planar/scratch.h"
#include "planar/triangulation.h"

/* A corner whose tip reaches further than this out of the circle at its root, in radii of that, is
 * a place of its own: one sharper than 47 degrees. */
#define STICKS_OUT 1.5

enum { PRUNING_ROUNDS = 4, ARMS = 3, GONE = -1 };

/* The axis as a graph: a node a chord, and one in each triangle that has three chords or one. */
typedef struct iso_axis {
    int32_t count;
    iso_medial_point *at;
    int32_t (*arm)[ARMS]; /* neighbours, GONE behind the last */
    uint8_t *pruned;      /* a branch was cut off here */
    uint8_t *visited;
} iso_axis;

/* ---- contours in steps ---- */

static int32_t pieces_of(iso_point a, iso_point b, int32_t step) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    return (int32_t)ceil(sqrt(dx * dx + dy * dy) / step);
}

static iso_status cut_sides(iso_region *out, const iso_region *region, int32_t step,
                            iso_arena *arena) {
    int64_t points = 0, n = 0;
    for (int pass = 0; pass < 2; pass++) {
        if (pass == 1) {
            if (points > INT32_MAX / 16)
                return iso_fail(ISO_OUTSIDE, "narrow places with %lld points", (long long)points);
            ISO_TRY(ISO_PUSH(out->point, arena, points));
            ISO_TRY(ISO_PUSH(out->first, arena, (int64_t)region->count + 1));
            out->first[0] = 0;
            out->count = region->count;
        }
        for (int32_t c = 0; c < region->count; c++) {
            for (int32_t i = region->first[c], end = region->first[c + 1]; i < end; i++) {
                iso_point a = region->point[i];
                iso_point b = region->point[i + 1 == end ? region->first[c] : i + 1];
                int32_t pieces = pieces_of(a, b, step);
                points += pieces;
                for (int32_t k = 0; pass == 1 && k < pieces; k++) {
                    double share = (double)k / pieces;
                    out->point[n++] =
                        (iso_point){(int32_t)floor(a.x + ((double)b.x - a.x) * share + 0.5),
                                    (int32_t)floor(a.y + ((double)b.y - a.y) * share + 0.5)};
                }
            }
            if (pass == 1)
                out->first[c + 1] = (int32_t)n;
        }
    }
    return ISO_OK;
}

/* ---- nodes ---- */

static iso_vec2 place(const iso_triangulation *t, int32_t dart) {
    iso_point p = t->vertex[t->origin[dart]];
    return (iso_vec2){p.x, p.y};
}

static double distance(iso_vec2 a, iso_vec2 b) {
    double dx = b.x - a.x, dy = b.y - a.y;
    return sqrt(dx * dx + dy * dy);
}

/* The point of a side nearest to p. */
static iso_vec2 nearest(const iso_triangulation *t, int32_t side, iso_vec2 p) {
    iso_vec2 a = place(t, side), b = place(t, corner_next(side));
    double ux = b.x - a.x, uy = b.y - a.y;
    double share = ((p.x - a.x) * ux + (p.y - a.y) * uy) / (ux * ux + uy * uy);
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    return (iso_vec2){a.x + share * ux, a.y + share * uy};
}

/* The nearest point of the two sides that meet where the dart starts, on either side of it. */
static iso_vec2 foot_of(const iso_triangulation *t, int32_t dart, iso_vec2 p) {
    int32_t left = dart, right = dart;
    do
        left = t->opposite[corner_back(left)];
    while (!t->fence[left]);
    while (!t->fence[right])
        right = corner_next(t->opposite[right]);
    iso_vec2 a = nearest(t, left, p), b = nearest(t, right, p);
    return distance(p, a) < distance(p, b) ? a : b;
}

/* On the chord, equally far from the sides at its two ends. */
static iso_medial_point point_of_chord(const iso_triangulation *t, int32_t dart) {
    iso_vec2 a = place(t, dart), b = place(t, corner_next(dart));
    iso_vec2 p = {(a.x + b.x) / 2, (a.y + b.y) / 2};
    double here = 0, there = 0;
    for (int turn = 0; turn < 3; turn++) {
        iso_vec2 foot = foot_of(t, dart, p), other = foot_of(t, t->opposite[dart], p);
        here = distance(p, foot), there = distance(p, other);
        double shift = (here - there) / 2;
        if (here < 1 || there < 1 || fabs(shift) < 1)
            break;
        iso_vec2 to = shift > 0 ? foot : other;
        double share = fabs(shift) / (shift > 0 ? here : there);
        p = (iso_vec2){p.x + share * (to.x - p.x), p.y + share * (to.y - p.y)};
    }
    return (iso_medial_point){p.x, p.y, (here + there) / 2};
}

/* The middle of a triangle's circle if it lies within, else the widest of its chords' points. */
static iso_medial_point point_of_triangle(const iso_axis *axis, const int32_t node[3],
                                          const iso_triangulation *t, int32_t triangle) {
    int32_t d = 3 * triangle;
    iso_vec2 a = place(t, d), b = place(t, d + 1), c = place(t, d + 2);
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    double area = bx * cy - by * cx, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    double x = (cy * bb - by * cc) / (2 * area), y = (bx * cc - cx * bb) / (2 * area);
    double u = (x * cy - y * cx) / area, v = (bx * y - by * x) / area;
    if (u < 0 || v < 0 || u + v > 1) {
        int32_t widest = node[0];
        for (int k = 1; k < 3; k++)
            widest = axis->at[node[k]].half > axis->at[widest].half ? node[k] : widest;
        return axis->at[widest];
    }
    iso_vec2 p = {a.x + x, a.y + y};
    double half = 1e18;
    for (int32_t k = d; k < d + 3; k++) {
        double far = distance(p, foot_of(t, k, p));
        half = far < half ? far : half;
    }
    return (iso_medial_point){p.x, p.y, half};
}

static void connect(iso_axis *axis, int32_t a, int32_t b) {
    for (int turn = 0; turn < 2; turn++) {
        int32_t from = turn ? b : a, to = turn ? a : b, k = 0;
        while (k < ARMS - 1 && axis->arm[from][k] != GONE)
            k++;
        axis->arm[from][k] = to;
    }
}

static void disconnect(iso_axis *axis, int32_t node) {
    for (int k = 0; k < ARMS; k++) {
        int32_t to = axis->arm[node][k];
        axis->arm[node][k] = GONE;
        if (to == GONE)
            continue;
        int keep = 0;
        for (int i = 0; i < ARMS; i++)
            if (axis->arm[to][i] != node)
                axis->arm[to][keep++] = axis->arm[to][i];
        while (keep < ARMS)
            axis->arm[to][keep++] = GONE;
    }
    axis->visited[node] = 1;
}

static int arms_of(const iso_axis *axis, int32_t node) {
    int n = 0;
    while (n < ARMS && axis->arm[node][n] != GONE)
        n++;
    return n;
}

static int32_t new_node(iso_axis *axis, iso_medial_point at) {
    int32_t node = axis->count++;
    axis->at[node] = at;
    axis->arm[node][0] = axis->arm[node][1] = axis->arm[node][2] = GONE;
    axis->pruned[node] = axis->visited[node] = 0;
    return node;
}

static iso_status build_axis(iso_axis *axis, const iso_triangulation *t, iso_arena *arena) {
    int32_t *chord;
    int64_t inside = 0;
    for (int32_t k = 0; k < t->triangle_count; k++)
        inside += t->inside[k];
    int64_t room = 5 * inside / 2 + 1; /* a chord is of two triangles */
    ISO_TRY(ISO_PUSH(axis->at, arena, room));
    ISO_TRY(ISO_PUSH(axis->arm, arena, room));
    ISO_TRY(ISO_PUSH(axis->pruned, arena, room));
    ISO_TRY(ISO_PUSH(axis->visited, arena, room));
    ISO_TRY(ISO_PUSH(chord, arena, 3 * (int64_t)t->triangle_count));
    for (int32_t d = 0; d < 3 * t->triangle_count; d++) {
        chord[d] = GONE;
        if (t->inside[d / 3] && !t->fence[d])
            chord[d] =
                t->opposite[d] < d ? chord[t->opposite[d]] : new_node(axis, point_of_chord(t, d));
    }
    for (int32_t k = 0; k < t->triangle_count; k++) {
        int32_t node[3], count = 0, free_corner = 3 * k;
        for (int32_t d = 3 * k; d < 3 * k + 3; d++)
            if (chord[d] != GONE) {
                node[count++] = chord[d];
                free_corner = corner_back(d);
            }
        if (count == 2) {
            connect(axis, node[0], node[1]);
        } else if (count > 0) {
            iso_vec2 tip = place(t, free_corner);
            int32_t middle = new_node(axis, count == 1 ? (iso_medial_point){tip.x, tip.y, 0}
                                                       : point_of_triangle(axis, node, t, k));
            for (int32_t i = 0; i < count; i++)
                connect(axis, middle, node[i]);
        }
    }
    return ISO_OK;
}

/* ---- pruning ---- */

static iso_vec2 node_place(const iso_axis *axis, int32_t node) {
    return (iso_vec2){axis->at[node].x, axis->at[node].y};
}

/* From a leaf along its branch: the node before the junction, or GONE if there is no junction. */
static int32_t branch_end(const iso_axis *axis, int32_t leaf) {
    int32_t before = GONE, at = leaf;
    for (;;) {
        int32_t next = axis->arm[at][0] == before ? axis->arm[at][1] : axis->arm[at][0];
        if (next == GONE)
            return GONE;
        if (arms_of(axis, next) == ARMS)
            return at;
        before = at;
        at = next;
    }
}

static int32_t junction_after(const iso_axis *axis, int32_t node) {
    for (int k = 0; k < ARMS && axis->arm[node][k] != GONE; k++)
        if (arms_of(axis, axis->arm[node][k]) == ARMS)
            return axis->arm[node][k];
    return GONE;
}

static void remove_branch(iso_axis *axis, int32_t leaf, int32_t junction) {
    while (leaf != GONE && leaf != junction) {
        int32_t next = axis->arm[leaf][0];
        disconnect(axis, leaf);
        leaf = next;
    }
    axis->pruned[junction] = 1;
}

/* Branches are judged all by what was there at the start of the round, since both corners of a
 * blunt end are to go. */
static iso_status prune(iso_axis *axis, iso_arena *arena) {
    int32_t *leaf, *root, count = 1;
    ISO_TRY(ISO_PUSH(leaf, arena, axis->count));
    ISO_TRY(ISO_PUSH(root, arena, axis->count));
    for (int round = 0; round < PRUNING_ROUNDS && count > 0; round++) {
        count = 0;
        for (int32_t i = 0; i < axis->count; i++) {
            if (axis->visited[i] || arms_of(axis, i) != 1)
                continue;
            int32_t end = branch_end(axis, i);
            int32_t junction = end == GONE ? GONE : junction_after(axis, end);
            if (junction == GONE)
                continue;
            const iso_medial_point *tip = &axis->at[i], *at = &axis->at[junction];
            double out = distance(node_place(axis, i), node_place(axis, junction)) + tip->half;
            if (out - at->half > STICKS_OUT * at->half)
                continue;
            leaf[count] = i;
            root[count++] = junction;
        }
        for (int32_t i = 0; i < count; i++)
            remove_branch(axis, leaf[i], root[i]);
    }
    return ISO_OK;
}

/* Cut off places that are too narrow. */
static void cut_narrow(iso_axis *axis, double least) {
    for (int32_t i = 0; i < axis->count; i++)
        if (!axis->visited[i] && axis->at[i].half < least)
            disconnect(axis, i);
}

/* The arm that leaves a junction most apart from the straightest way through it. */
static int side_arm(const iso_axis *axis, int32_t node) {
    iso_vec2 at = node_place(axis, node), u[ARMS];
    int least = 0;
    double best = 1e18;
    for (int k = 0; k < ARMS; k++) {
        int32_t before = node, arm = axis->arm[node][k];
        for (int ahead = 0; ahead < 6 && arms_of(axis, arm) == 2; ahead++) {
            int32_t next = axis->arm[arm][0] == before ? axis->arm[arm][1] : axis->arm[arm][0];
            before = arm;
            arm = next;
        }
        double length = distance(at, node_place(axis, arm));
        length = length > 0 ? length : 1;
        u[k] = (iso_vec2){(axis->at[arm].x - at.x) / length, (axis->at[arm].y - at.y) / length};
    }
    for (int k = 0; k < ARMS; k++) {
        iso_vec2 a = u[(k + 1) % ARMS], b = u[(k + 2) % ARMS];
        double cosine = a.x * b.x + a.y * b.y;
        if (cosine < best)
            best = cosine, least = k;
    }
    return least;
}

/* Where three branches meet, two go through; the third begins beside their bead. */
static void split_junctions(iso_axis *axis) {
    for (int32_t i = 0; i < axis->count; i++) {
        if (axis->visited[i] || arms_of(axis, i) < ARMS)
            continue;
        int32_t node = axis->arm[i][side_arm(axis, i)];
        while (node != GONE && arms_of(axis, node) <= 2 &&
               distance(node_place(axis, i), node_place(axis, node)) < axis->at[i].half) {
            int32_t next = axis->arm[node][0] == i ? axis->arm[node][1] : axis->arm[node][0];
            disconnect(axis, node);
            node = next;
        }
        if (arms_of(axis, i) == ARMS) { /* the third branch begins further off */
            int32_t arm = axis->arm[i][side_arm(axis, i)];
            int keep = 0;
            for (int k = 0; k < ARMS; k++)
                if (axis->arm[i][k] != arm)
                    axis->arm[i][keep++] = axis->arm[i][k];
            axis->arm[i][keep] = GONE;
            keep = 0;
            for (int k = 0; k < ARMS; k++)
                if (axis->arm[arm][k] != i)
                    axis->arm[arm][keep++] = axis->arm[arm][k];
            while (keep < ARMS)
                axis->arm[arm][keep++] = GONE;
        }
    }
}

/* ---- lines ---- */

static void trace_line(iso_medial *out, iso_axis *axis, int32_t start) {
    iso_medial_line *line = &out->line[out->count++];
    int32_t before = GONE, at = start;
    *line = (iso_medial_line){.first = out->point_count};
    line->blunt[0] = axis->pruned[start] || axis->at[start].half == 0;
    for (;;) {
        axis->visited[at] = 1;
        out->point[out->point_count++] = axis->at[at];
        int32_t next = axis->arm[at][0] == before ? axis->arm[at][1] : axis->arm[at][0];
        line->blunt[1] = axis->pruned[at];
        if (next == GONE)
            break;
        if (next == start) {
            line->closed = true;
            break;
        }
        before = at;
        at = next;
    }
    line->count = out->point_count - line->first;
}

/* Points on a side are rounded: where two sides all but touch, the pieces of one may cross the
 * other's, and have to become a region again. */
static iso_status triangulate_in_steps(iso_triangulation *t, const iso_region *region, int32_t step,
                                       iso_planar_scratch *scratch) {
    iso_region cut = {0}, clean = {0};
    ISO_TRY(cut_sides(&cut, region, step, &scratch->arena));
    iso_status status = iso_region_clean(&clean, &cut, ISO_FILL_POSITIVE, scratch);
    if (status == ISO_OK)
        status = triangulate(t, &clean, &scratch->arena);
    iso_region_free(&clean);
    return status;
}

iso_status medial_axis(iso_medial *out, const iso_region *region, int32_t step, double least,
                       iso_planar_scratch *scratch) {
    iso_arena *arena = &scratch->arena;
    iso_triangulation t;
    iso_axis axis = {0};
    *out = (iso_medial){0};
    if (region->count == 0)
        return ISO_OK;
    ISO_TRY(triangulate_in_steps(&t, region, step, scratch));
    if (t.triangle_count == 0)
        return ISO_OK;
#ifndef NDEBUG
    ISO_TRY(triangulation_validate(&t));
#endif
    ISO_TRY(build_axis(&axis, &t, arena));
    ISO_TRY(prune(&axis, arena));
    cut_narrow(&axis, least);
    split_junctions(&axis);
    ISO_TRY(ISO_PUSH(out->line, arena, axis.count));
    ISO_TRY(ISO_PUSH(out->point, arena, axis.count));
    for (int pass = 0; pass < 2; pass++) /* rings are what is left */
        for (int32_t i = 0; i < axis.count; i++)
            if (!axis.visited[i] && (pass == 1 || arms_of(&axis, i) <= 1))
                trace_line(out, &axis, i);
    return ISO_OK;
}
