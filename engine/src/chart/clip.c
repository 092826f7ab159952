/* Paths of a chart that wraps, cut to one period. */
#include "base/sort.h"
#include "chart/kind.h"

enum {
    NOWHERE,
    LEFT,
    RIGHT,
    JOINED_WITHIN = 500 /* units: ends at the same place but for what offsets and thinning did */
};

/* A path, or what is left of one. */
typedef struct strand {
    int begin_side, end_side; /* where it was cut */
    int32_t next;             /* strand that it goes on as; -1: it ends */
    bool follows, taken;
} strand;

typedef struct end_of {
    int32_t y;
    int32_t strand;
} end_of;

static int is_before(const end_of *a, const end_of *b) {
    return a->y != b->y ? a->y < b->y : a->strand < b->strand;
}
ISO_SORT(sort_ends, end_of, is_before)

typedef struct clip {
    int32_t half, step; /* units: half a period; no segment is longer than a step */
    iso_paths cut;      /* the strands */
    strand *strand;     /* [cut.count] */
    int64_t capacity;
    iso_arena *arena;
} clip;

/* ---- cutting ---- */

static bool is_inside(const clip *c, iso_point p) {
    return p.x >= -c->half && p.x < c->half;
}

static int side_of(const clip *c, iso_point outside) {
    return outside.x < 0 ? LEFT : RIGHT;
}

static int32_t rounded(double x) {
    return (int32_t)(x < 0 ? x - 0.5 : x + 0.5);
}

static iso_point crossing(const clip *c, iso_point a, iso_point b, int side) {
    int32_t x = side == LEFT ? -c->half : c->half;
    double t = ((double)x - a.x) / ((double)b.x - a.x);
    return (iso_point){x, rounded(a.y + t * ((double)b.y - a.y))};
}

static iso_status begin_strand(clip *c, const iso_path *like, int side) {
    ISO_TRY(ISO_GROW(c->strand, c->capacity, (int64_t)c->cut.count + 1));
    c->strand[c->cut.count] = (strand){.begin_side = side, .next = -1};
    ISO_TRY(iso_paths_add(&c->cut, like, NULL, 0, 0, 0));
    iso_path *path = &c->cut.path[c->cut.count - 1];
    path->closed = path->follows = 0;
    return ISO_OK;
}

/* One more vertex, whose bead is as `bead` has it; more of them on a long way there. */
static iso_status put_vertex(clip *c, iso_point at, const iso_path_vertex *bead) {
    iso_paths *cut = &c->cut;
    iso_path *path = &cut->path[cut->count - 1];
    int32_t parts = 1;
    iso_path_vertex from = *bead;
    if (path->count > 0) {
        from = cut->vertex[cut->vertex_count - 1];
        int64_t way = (int64_t)at.x - from.at.x;
        parts = 1 + (int32_t)((way < 0 ? -way : way) / c->step);
    }
    ISO_TRY(ISO_GROW(cut->vertex, cut->vertex_capacity, (int64_t)cut->vertex_count + parts));
    for (int32_t k = 1; k <= parts; k++) {
        double t = (double)k / parts;
        iso_path_vertex *vertex = &cut->vertex[cut->vertex_count++];
        *vertex = k < parts ? from : *bead;
        vertex->at = at;
        if (k < parts)
            vertex->at = (iso_point){rounded(from.at.x + t * ((double)at.x - from.at.x)),
                                     rounded(from.at.y + t * ((double)at.y - from.at.y))};
    }
    path->count += parts;
    return ISO_OK;
}

static void end_strand(clip *c, int side) {
    c->strand[c->cut.count - 1].end_side = side;
}

/* The bead from a to b; the strand so far ends at a if that is inside. */
static iso_status clip_bead(clip *c, const iso_path *like, const iso_path_vertex *a,
                            const iso_path_vertex *b) {
    bool from = is_inside(c, a->at), to = is_inside(c, b->at);
    if (!from && !to && side_of(c, a->at) == side_of(c, b->at))
        return ISO_OK;
    if (!from) {
        int side = side_of(c, a->at);
        ISO_TRY(begin_strand(c, like, side));
        ISO_TRY(put_vertex(c, crossing(c, a->at, b->at, side), a));
    }
    if (to)
        return put_vertex(c, b->at, b);
    int side = side_of(c, b->at);
    ISO_TRY(put_vertex(c, crossing(c, a->at, b->at, side), a));
    end_strand(c, side);
    return ISO_OK;
}

static iso_status keep_whole(clip *c, const iso_paths *paths, const iso_path *path, bool follows) {
    const iso_path_vertex *vertex = paths->vertex + path->first;
    ISO_TRY(begin_strand(c, path, NOWHERE));
    for (int32_t i = 0; i < path->count; i++)
        ISO_TRY(put_vertex(c, vertex[i].at, &vertex[i]));
    iso_path *whole = &c->cut.path[c->cut.count - 1];
    whole->closed = path->closed;
    whole->follows = follows ? path->follows : 0;
    if (path->closed && path->count > 1) { /* the way back may be long, too */
        ISO_TRY(put_vertex(c, vertex[0].at, &vertex[0]));
        whole = &c->cut.path[c->cut.count - 1];
        whole->count--;
        c->cut.vertex_count--;
    }
    return ISO_OK;
}

/* *whole: nothing of it was cut. `follows`: nor of the one before. */
static iso_status clip_path(clip *c, bool *whole, const iso_paths *paths, const iso_path *path,
                            bool follows) {
    const iso_path_vertex *vertex = paths->vertex + path->first;
    int32_t start = 0, count = path->count;
    while (start < count && is_inside(c, vertex[start].at))
        start++;
    *whole = start == count;
    if (*whole)
        return count == 0 ? ISO_OK : keep_whole(c, paths, path, follows);
    if (path->closed) {
        for (int32_t i = 0; i < count; i++)
            ISO_TRY(
                clip_bead(c, path, &vertex[(start + i) % count], &vertex[(start + i + 1) % count]));
        return ISO_OK;
    }
    if (is_inside(c, vertex[0].at)) {
        ISO_TRY(begin_strand(c, path, NOWHERE));
        ISO_TRY(put_vertex(c, vertex[0].at, &vertex[0]));
    }
    for (int32_t i = 0; i + 1 < count; i++)
        ISO_TRY(clip_bead(c, path, &vertex[i], &vertex[i + 1]));
    return ISO_OK;
}

/* ---- joining ---- */

static const iso_path_vertex *first_of(const clip *c, int32_t s) {
    return &c->cut.vertex[c->cut.path[s].first];
}

static const iso_path_vertex *last_of(const clip *c, int32_t s) {
    return first_of(c, s) + c->cut.path[s].count - 1;
}

static bool are_alike(const clip *c, int32_t a, int32_t b) {
    const iso_path *p = &c->cut.path[a], *q = &c->cut.path[b];
    return p->role == q->role && p->tool == q->tool && p->rank == q->rank &&
           p->speed_class == q->speed_class;
}

/* What is printed together with any of them is printed together with all. Few islands reach across,
 * so looking at all paths for each is cheap. */
static void unite_groups(clip *c, int32_t a, int32_t b) {
    int32_t keep = c->cut.path[a].group, gone = c->cut.path[b].group;
    for (int32_t i = 0; keep != gone && i < c->cut.count; i++)
        if (c->cut.path[i].group == gone)
            c->cut.path[i].group = keep;
}

/* Strands that end on one side go on as those that begin on the other one, as near as any. */
static iso_status join_side(clip *c, int side) {
    end_of *ends, *begins;
    int32_t end_count = 0, begin_count = 0, low = 0;
    ISO_TRY(ISO_PUSH(ends, c->arena, c->cut.count));
    ISO_TRY(ISO_PUSH(begins, c->arena, c->cut.count));
    for (int32_t s = 0; s < c->cut.count; s++) {
        if (c->strand[s].end_side == side)
            ends[end_count++] = (end_of){last_of(c, s)->at.y, s};
        if (c->strand[s].begin_side == LEFT + RIGHT - side)
            begins[begin_count++] = (end_of){first_of(c, s)->at.y, s};
    }
    sort_ends(ends, end_count);
    sort_ends(begins, begin_count);
    for (int32_t i = 0; i < end_count; i++) {
        int32_t best = -1;
        int64_t nearest = JOINED_WITHIN + 1;
        while (low < begin_count && begins[low].y < (int64_t)ends[i].y - JOINED_WITHIN)
            low++;
        for (int32_t k = low; k < begin_count && begins[k].y <= (int64_t)ends[i].y + JOINED_WITHIN;
             k++) {
            int64_t off = (int64_t)begins[k].y - ends[i].y;
            off = off < 0 ? -off : off;
            if (off < nearest && !c->strand[begins[k].strand].follows &&
                are_alike(c, ends[i].strand, begins[k].strand)) {
                nearest = off;
                best = begins[k].strand;
            }
        }
        if (best < 0)
            continue;
        c->strand[ends[i].strand].next = best;
        c->strand[best].follows = true;
        unite_groups(c, ends[i].strand, best);
    }
    return ISO_OK;
}

/* ---- out ---- */

/* A strand and all it goes on as. The end of one is the beginning of the next. */
static iso_status put_chain(iso_paths *out, clip *c, int32_t head) {
    iso_path like = c->cut.path[head];
    int32_t last = head;
    ISO_TRY(iso_paths_add(out, &like, NULL, 0, 0, 0));
    iso_path *path = &out->path[out->count - 1];
    for (int32_t s = head; s >= 0 && !c->strand[s].taken; s = c->strand[s].next) {
        const iso_path *from = &c->cut.path[s];
        int32_t count = from->count - (c->strand[s].next >= 0);
        ISO_TRY(ISO_GROW(out->vertex, out->vertex_capacity, (int64_t)out->vertex_count + count));
        for (int32_t i = 0; i < count; i++)
            out->vertex[out->vertex_count++] = c->cut.vertex[from->first + i];
        path->count += count;
        c->strand[s].taken = true;
        last = s;
    }
    if (c->strand[last].next >= 0)
        path->closed = 1;
    return ISO_OK;
}

static iso_status put_all(iso_paths *out, clip *c) {
    for (int pass = 0; pass < 2; pass++) /* those that begin somewhere, then the loops */
        for (int32_t s = 0; s < c->cut.count; s++)
            if (!c->strand[s].taken && (pass == 1 || !c->strand[s].follows) &&
                c->cut.path[s].count > 1)
                ISO_TRY(put_chain(out, c, s));
    return ISO_OK;
}

static iso_status clip_all(iso_paths *out, clip *c, const iso_paths *paths) {
    bool whole = false;
    for (int32_t p = 0; p < paths->count; p++)
        ISO_TRY(clip_path(c, &whole, paths, &paths->path[p], whole));
    ISO_TRY(join_side(c, RIGHT));
    ISO_TRY(join_side(c, LEFT));
    return put_all(out, c);
}

static iso_status copy_paths(iso_paths *out, const iso_paths *paths) {
    ISO_TRY(iso_paths_append(out, paths, (iso_point){0, 0}, -1));
    for (int32_t i = 0; i < paths->count; i++)
        out->path[i].object = paths->path[i].object;
    return ISO_OK;
}

iso_status chart_clip_paths(iso_paths *out, const iso_paths *paths, const chart *map,
                            iso_arena *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    clip c = {.half = iso_units(0.5 * map->period), .arena = scratch};
    iso_paths_clear(out);
    if (!(map->period > 0))
        return copy_paths(out, paths);
    c.step = c.half / 2;
    iso_status status = clip_all(out, &c, paths);
    iso_paths_free(&c.cut);
    iso_release(c.strand);
    iso_arena_pop(scratch, mark);
    if (status != ISO_OK)
        iso_paths_clear(out);
    return status;
}
