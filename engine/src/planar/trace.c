#include "planar/trace.h"

#include "base/sort.h"
#include "planar/face.h"
#include "planar/predicate.h"

/* A simple closed run of boundary darts, chosen faces on its left. */
typedef struct iso_loop {
    iso_point least; /* lexicographic least point */
    iso_point lower; /* the neighbour of `least` below: the next point, of a hole the one before */
    int32_t first, count; /* in iso_tracing.dart */
    int32_t lead;         /* the dart that leaves `least` */
    int32_t index;        /* of `least` in the points of the arrangement */
    bool hole;
} iso_loop;

typedef struct iso_tracing {
    const iso_arrangement *a;
    const uint8_t *chosen; /* by face */
    int32_t *zone;         /* by face: faces not parted by a boundary are one zone */
    iso_loop *loop;
    int32_t loop_count;
    int32_t *dart; /* of all loops */
    int32_t dart_count;
    int32_t *stack, *place; /* of the trace under way; place[junction] in it, or -1 */
    uint8_t *visited;
} iso_tracing;

/* Does the dart have a chosen face on its left and none on its right? */
static bool is_boundary(const iso_tracing *t, int32_t dart) {
    return t->chosen[t->a->face[dart]] && !t->chosen[t->a->face[dart ^ 1]];
}

/* The next boundary dart along the same chosen face: the first one clockwise from where we came. */
static int32_t boundary_next(const iso_tracing *t, int32_t dart) {
    int32_t next = dart_alpha(t->a, dart);
    while (!is_boundary(t, next))
        next = t->a->cw[next];
    return next;
}

/* Lexicographic least point of the loop, and what goes with it. */
static void find_least(iso_tracing *t, iso_loop *loop) {
    const iso_arrangement *a = t->a;
    const int32_t *dart = t->dart + loop->first;
    int32_t best = 0;
    for (int32_t i = 1; i < loop->count; i++)
        if (point_less(a->point[a->lowest[dart[i] >> 1]], a->point[a->lowest[dart[best] >> 1]]))
            best = i;
    int32_t d = dart[best], chain = d >> 1, index = a->lowest[chain];
    int32_t end = d & 1 ? a->chain_first[chain] : a->chain_first[chain + 1] - 1;
    if (index == end) { /* the least point ends this dart, so it starts the next */
        d = dart[best + 1 == loop->count ? 0 : best + 1];
        chain = d >> 1;
        index = d & 1 ? a->chain_first[chain + 1] - 1 : a->chain_first[chain];
    }
    loop->lead = d;
    loop->index = index;
    loop->least = a->point[index];
}

static iso_point point_before_least(const iso_tracing *t, const iso_loop *loop) {
    const iso_arrangement *a = t->a;
    int32_t d = loop->lead, chain = d >> 1;
    int32_t start = d & 1 ? a->chain_first[chain + 1] - 1 : a->chain_first[chain];
    if (loop->index != start)
        return a->point[d & 1 ? loop->index + 1 : loop->index - 1];
    const int32_t *dart = t->dart + loop->first;
    int32_t i = 0;
    while (dart[i] != d)
        i++;
    return dart_second(a, dart[i == 0 ? loop->count - 1 : i - 1] ^ 1);
}

static void emit_loop(iso_tracing *t, const int32_t *dart, int32_t count) {
    iso_loop *loop = &t->loop[t->loop_count++];
    *loop = (iso_loop){.first = t->dart_count, .count = count};
    memcpy(t->dart + t->dart_count, dart, (size_t)count * sizeof *dart);
    t->dart_count += count;
    find_least(t, loop);
    int32_t d = loop->lead;
    iso_point before = point_before_least(t, loop),
              after = t->a->point[loop->index + (d & 1 ? -1 : 1)];
    loop->hole = orient2d(before, loop->least, after) < 0;
    loop->lower = loop->hole ? before : after;
}

/* Follow the boundary of one chosen face. Where it comes back to a junction it has passed, what
 * lies between is a simple loop of its own: so a hole that touches its outer contour comes away
 * from it. */
static void trace_boundary(iso_tracing *t, int32_t start) {
    const iso_arrangement *a = t->a;
    int32_t n = 0, d = start;
    do {
        t->visited[d] = 1;
        t->place[a->origin[d]] = n;
        t->stack[n++] = d;
        int32_t back = t->place[a->origin[d ^ 1]];
        if (back >= 0) {
            emit_loop(t, t->stack + back, n - back);
            for (int32_t i = back; i < n; i++)
                t->place[a->origin[t->stack[i]]] = -1;
            n = back;
        }
        d = boundary_next(t, d);
    } while (d != start);
}

/* Of loops that share their least point the one that starts lower is around the others, or beside
 * them. */
static bool loop_less(const iso_loop *a, const iso_loop *b) {
    if (!point_equal(a->least, b->least))
        return point_less(a->least, b->least);
    return direction_less((int64_t)a->lower.x - a->least.x, (int64_t)a->lower.y - a->least.y,
                          (int64_t)b->lower.x - b->least.x, (int64_t)b->lower.y - b->least.y);
}
ISO_SORT(sort_loops, iso_loop, loop_less)

static iso_status trace_loops(iso_tracing *t, iso_arena *arena) {
    const iso_arrangement *a = t->a;
    int32_t darts = 2 * a->chain_count;
    ISO_TRY(ISO_PUSH(t->loop, arena, a->chain_count));
    ISO_TRY(ISO_PUSH(t->dart, arena, a->chain_count));
    ISO_TRY(ISO_PUSH(t->stack, arena, a->chain_count));
    ISO_TRY(ISO_PUSH(t->place, arena, a->junction_count));
    ISO_TRY(ISO_PUSH(t->visited, arena, darts));
    memset(t->visited, 0, (size_t)darts);
    for (int32_t j = 0; j < a->junction_count; j++)
        t->place[j] = -1;
    for (int32_t d = 0; d < darts; d++)
        if (a->origin[d] >= 0 && !t->visited[d] && is_boundary(t, d))
            trace_boundary(t, d);
    sort_loops(t->loop, t->loop_count);
    return ISO_OK;
}

/* Zones: faces joined across chains that are no boundary. Zone 0's set holds the unbounded face. */
static iso_status find_zones(iso_tracing *t, iso_arena *arena) {
    const iso_arrangement *a = t->a;
    ISO_TRY(sets_new(&t->zone, a->face_count, arena));
    for (int32_t c = 0; c < a->chain_count; c++) {
        if (a->origin[2 * c] < 0)
            continue;
        int32_t left = a->face[2 * c], right = a->face[2 * c + 1];
        if (t->chosen[left] == t->chosen[right])
            set_unite(t->zone, left, right);
    }
    for (int32_t f = 0; f < a->face_count; f++)
        t->zone[f] = set_find(t->zone, f);
    return ISO_OK;
}

/* A hole's parent is the outer loop of the chosen zone on its left. An outer loop lies in the zone
 * on its right: in the unbounded one; in the hole that has this zone inside; or, where outer loops
 * alone close it in by touching, beside the first of them, with whom it shares the parent. Loops
 * come sorted, parents first. */
static iso_status find_parents(int32_t *parent, const iso_tracing *t, iso_arena *arena) {
    const iso_arrangement *a = t->a;
    int32_t *outer, *hole, *beside;
    ISO_TRY(ISO_PUSH(outer, arena, a->face_count));
    ISO_TRY(ISO_PUSH(hole, arena, a->face_count));
    ISO_TRY(ISO_PUSH(beside, arena, a->face_count));
    for (int32_t f = 0; f < a->face_count; f++)
        outer[f] = hole[f] = beside[f] = -1;
    for (int32_t l = t->loop_count; l-- > 0;) {
        const iso_loop *loop = &t->loop[l];
        for (int32_t i = 0; i < loop->count; i++) {
            int32_t d = t->dart[loop->first + i];
            int32_t left = t->zone[a->face[d]], right = t->zone[a->face[d ^ 1]];
            if (loop->hole)
                hole[right] = l;
            else
                outer[left] = beside[right] = l;
        }
    }
    for (int32_t l = 0; l < t->loop_count; l++) {
        const iso_loop *loop = &t->loop[l];
        int32_t left = t->zone[a->face[loop->lead]], right = t->zone[a->face[loop->lead ^ 1]];
        if (loop->hole)
            parent[l] = outer[left];
        else if (right == t->zone[0])
            parent[l] = -1;
        else
            parent[l] = hole[right] >= 0 ? hole[right] : parent[beside[right]];
        if (parent[l] >= l || (loop->hole && parent[l] < 0))
            return iso_fail(ISO_BUG, "planar: contour %d has no parent", (int)l);
    }
    return ISO_OK;
}

/* Points of a dart from its start up to its end, which the next dart repeats. */
static iso_point *copy_dart(iso_point *to, const iso_arrangement *a, int32_t dart) {
    int32_t first = a->chain_first[dart >> 1], last = a->chain_first[(dart >> 1) + 1] - 1;
    if (dart & 1)
        for (int32_t i = last; i > first; i--)
            *to++ = a->point[i];
    else
        for (int32_t i = first; i < last; i++)
            *to++ = a->point[i];
    return to;
}

/* Append a loop, turned so that it starts at its least point. */
static void write_loop(iso_region *out, const iso_tracing *t, const iso_loop *loop) {
    const iso_arrangement *a = t->a;
    iso_point *start = out->point + out->first[out->count], *to = start;
    const int32_t *dart = t->dart + loop->first;
    int32_t at = 0;
    while (dart[at] != loop->lead)
        at++;
    for (int32_t i = 0; i < loop->count; i++)
        to = copy_dart(to, a, dart[(at + i) % loop->count]);
    int32_t chain = loop->lead >> 1;
    int32_t lag = loop->lead & 1 ? a->chain_first[chain + 1] - 1 - loop->index
                                 : loop->index - a->chain_first[chain];
    int32_t n = (int32_t)(to - start);
    if (lag > 0) { /* the points before the least one move to the end, through the room behind */
        memcpy(to, start, (size_t)lag * sizeof *to);
        memmove(start, start + lag, (size_t)n * sizeof *to);
    }
    out->first[out->count + 1] = out->first[out->count] + n;
    out->count++;
}

static iso_status write_loops(iso_region *out, const iso_tracing *t, iso_arena *arena) {
    const iso_arrangement *a = t->a;
    int64_t points = 0, most = 0;
    for (int32_t i = 0; i < t->dart_count; i++) {
        int32_t n = a->chain_first[(t->dart[i] >> 1) + 1] - a->chain_first[t->dart[i] >> 1];
        points += n;
        most = n > most ? n : most;
    }
    ISO_TRY(region_reserve(out, t->loop_count, points + most));
    for (int32_t l = 0; l < t->loop_count; l++)
        write_loop(out, t, &t->loop[l]);
    return find_parents(out->parent, t, arena);
}

iso_status trace_region(const iso_choice *choice, const iso_arrangement *a, iso_arena *arena) {
    iso_tracing tracing = {.a = a};
    uint8_t *chosen;
    ISO_TRY(ISO_PUSH(chosen, arena, a->face_count));
    for (int32_t f = 0; f < a->face_count; f++)
        chosen[f] = choice->rule(&a->winding[f], choice->context);
    tracing.chosen = chosen;
    ISO_TRY(find_zones(&tracing, arena));
    ISO_TRY(trace_loops(&tracing, arena));
    return write_loops(choice->out, &tracing, arena);
}
