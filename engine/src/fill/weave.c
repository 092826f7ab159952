#include "fill/weave.h"

#include <math.h>

#include "fill/hatch.h"
#include "link/fill_link.h"

/* ---- linking ---- */

/* How far along its edge a crossing lies, in the edge's greater coordinate. */
static int32_t along(const iso_weave *weave, int32_t c, int32_t next) {
    iso_point a = weave->region->point[weave->crossing[c].edge >> 1];
    iso_point b = weave->region->point[next], at = weave->crossing[c].at;
    int32_t dx = b.x - a.x, dy = b.y - a.y;
    int wide = (dx < 0 ? -dx : dx) >= (dy < 0 ? -dy : dy);
    int32_t step = wide ? at.x - a.x : at.y - a.y;
    return (wide ? dx : dy) < 0 ? -step : step;
}

/* Crossings on an edge in its direction. Those on one unit may come in any order: the arcs between
 * them are points. */
static void sort_edge(const iso_weave *weave, int32_t *list, int32_t count, int32_t next) {
    for (int32_t i = 1; i < count; i++) {
        int32_t moving = list[i], key = along(weave, moving, next), j = i;
        for (; j > 0; j--) {
            int32_t other = along(weave, list[j - 1], next);
            if (other < key || (other == key && list[j - 1] < moving))
                break;
            list[j] = list[j - 1];
        }
        list[j] = moving;
    }
}

/* list = the crossings by edge, begin[i] .. begin[i + 1] those of edge i. */
static void deal_out(const iso_weave *weave, int32_t *begin, int32_t *list) {
    int32_t edges = weave->region->first[weave->region->count];
    memset(begin, 0, ((size_t)edges + 1) * sizeof *begin);
    for (int32_t c = 0; c < weave->count; c++)
        if (weave->crossing[c].edge >= 0)
            begin[weave->crossing[c].edge >> 1]++;
    for (int32_t i = 0, sum = 0; i <= edges; i++) {
        int32_t size = begin[i];
        begin[i] = sum;
        sum += size;
    }
    for (int32_t c = 0; c < weave->count; c++)
        if (weave->crossing[c].edge >= 0)
            list[begin[weave->crossing[c].edge >> 1]++] = c;
    for (int32_t i = edges; i > 0; i--)
        begin[i] = begin[i - 1];
    begin[0] = 0;
}

/* The dart that leaves a crossing forward along its contour. */
static int32_t forward_dart(const iso_weave *weave, int32_t c) {
    return 2 * c + (weave->crossing[c].edge & 1);
}

static void join(iso_weave *weave, int32_t before, int32_t c) {
    int32_t leave = forward_dart(weave, before);
    int32_t reach = iso_fill_link_other_side(forward_dart(weave, c));
    weave->arc[leave] = reach;
    weave->arc[reach] = leave;
}

static void link_contour(iso_weave *weave, int32_t m, int32_t *begin, int32_t *list) {
    const iso_region *region = weave->region;
    int32_t from = region->first[m], to = region->first[m + 1];
    for (int32_t i = from; i < to; i++)
        if (begin[i + 1] - begin[i] > 1)
            sort_edge(weave, list + begin[i], begin[i + 1] - begin[i], i + 1 < to ? i + 1 : from);
    for (int32_t k = begin[from]; k < begin[to]; k++) {
        weave->contour[list[k]] = m;
        join(weave, list[k > begin[from] ? k - 1 : begin[to] - 1], list[k]);
    }
}

iso_status iso_weave_link(iso_weave *weave, iso_arena *scratch) {
    const iso_region *region = weave->region;
    int32_t *begin, *list;
    ISO_TRY(ISO_PUSH(weave->arc, scratch, 2 * (int64_t)weave->count));
    ISO_TRY(ISO_PUSH(weave->contour, scratch, weave->count));
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(ISO_PUSH(begin, scratch, (int64_t)region->first[region->count] + 1));
    ISO_TRY(ISO_PUSH(list, scratch, weave->count));
    deal_out(weave, begin, list);
    for (int32_t m = 0; m < region->count; m++)
        link_contour(weave, m, begin, list);
    for (int32_t c = 0; c < weave->count; c++)
        if (weave->crossing[c].edge < 0) {
            weave->contour[c] = region->count + c;
            weave->arc[2 * c] = 2 * c + 1;
            weave->arc[2 * c + 1] = 2 * c;
        }
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

iso_status iso_weave_validate(const iso_weave *weave) {
    if (weave->count < 0 || weave->count % 2)
        return iso_fail(ISO_BUG, "weave: %d crossings, not an even number", weave->count);
    for (int32_t d = 0; d < 2 * weave->count; d++) {
        int32_t b = weave->arc[d];
        if (b < 0 || b >= 2 * weave->count)
            return iso_fail(ISO_BUG, "weave: B(%d) = %d is no dart", d, b);
        if (weave->arc[b] != d || b == d)
            return iso_fail(ISO_BUG, "weave: BB = 1 without fixed points fails at dart %d", d);
        if (weave->contour[b >> 1] != weave->contour[d >> 1])
            return iso_fail(ISO_BUG, "weave: pB = p fails at dart %d", d);
    }
    for (int32_t c = 0; c < weave->count; c++)
        if (weave->crossing[c].edge >= 0 && (weave->crossing[c].edge & 1) != (c & 1))
            return iso_fail(ISO_BUG, "weave: chain %d %s the region at its %s", c >> 1,
                            c & 1 ? "enters" : "leaves", c & 1 ? "end" : "start");
    return ISO_OK;
}

/* ---- drawing ---- */

/* A path while it grows. */
typedef struct weaver {
    const iso_weave *weave;
    const iso_fill_options *options;
    uint8_t *drawn;   /* of each chain */
    double *anchored; /* of each dart: how much of its arc is drawn from there, alone */
    iso_point *point;
    iso_weave_bead *bead; /* of the piece from each point to the next, if they differ */
    int32_t count;
} weaver;

/* A bead of the weave's; the options' for links and anchors. */
static void draw_bead(weaver *run, iso_point to, int32_t bead) {
    iso_point last = run->count ? run->point[run->count - 1] : (iso_point){0};
    if (run->count && last.x == to.x && last.y == to.y)
        return;
    if (run->bead && run->count)
        run->bead[run->count - 1] = bead < 0
                                        ? (iso_weave_bead){run->options->width, run->options->area}
                                        : run->weave->bead[bead];
    run->point[run->count++] = to;
}

static void draw_to(weaver *run, iso_point to) {
    draw_bead(run, to, -1);
}

static iso_point place(const weaver *run, int32_t dart) {
    return run->weave->crossing[dart >> 1].at;
}

/* Where an arc has got to on its way from a dart to its other end. */
typedef struct stroll {
    const iso_region *region;
    int32_t from, to; /* points of the contour */
    int32_t at, last; /* edges */
    int forward, all_round;
    iso_point end;
} stroll;

static stroll stroll_from(const iso_weave *weave, int32_t dart) {
    const iso_crossing *a = &weave->crossing[dart >> 1];
    int32_t reach = weave->arc[dart];
    const iso_crossing *b = &weave->crossing[reach >> 1];
    int32_t m = weave->contour[dart >> 1];
    stroll walk = {.region = weave->region,
                   .from = weave->region->first[m],
                   .to = weave->region->first[m + 1],
                   .at = a->edge >> 1,
                   .last = b->edge >> 1,
                   .forward = (dart & 1) == (a->edge & 1),
                   .end = b->at};
    if (walk.at == walk.last) { /* within the edge, or all the way round? */
        int32_t next = walk.at + 1 < walk.to ? walk.at + 1 : walk.from;
        int32_t ahead = along(weave, reach >> 1, next) - along(weave, dart >> 1, next);
        walk.all_round = walk.forward ? ahead < 0 : ahead > 0;
    }
    return walk;
}

/* The next corner, or the end. Returns whether there was a corner. */
static int stroll_on(stroll *walk, iso_point *passed) {
    if (walk->at == walk->last && !walk->all_round) {
        *passed = walk->end;
        return 0;
    }
    int32_t next = walk->forward ? (walk->at + 1 < walk->to ? walk->at + 1 : walk->from)
                                 : (walk->at > walk->from ? walk->at : walk->to) - 1;
    *passed = walk->region->point[walk->forward ? next : walk->at];
    walk->at = next;
    walk->all_round = 0;
    return 1;
}

/* How long the arc of a dart is, or more than `longest` if it is longer than that. */
static double arc_length(const weaver *run, int32_t dart, double longest) {
    iso_point here = place(run, dart), there;
    if (iso_hatch_distance(here, place(run, run->weave->arc[dart])) > longest)
        return 2 * longest + 1;
    stroll walk = stroll_from(run->weave, dart);
    double length = 0;
    for (int more = 1; more && length <= longest; here = there) {
        more = stroll_on(&walk, &there);
        length += iso_hatch_distance(here, there);
    }
    return length;
}

/* Is every point within `deviation` of the line a-b, and beside it? */
static int is_straight(iso_point a, iso_point b, const iso_point *point, int32_t count,
                       double deviation) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y, length = iso_hatch_distance(a, b);
    for (int32_t i = 0; i < count; i++) {
        double px = (double)point[i].x - a.x, py = (double)point[i].y - a.y;
        double off = dx * py - dy * px, beside = dx * px + dy * py;
        if (fabs(off) > deviation * length || beside < 0 || beside > length * length)
            return 0;
    }
    return 1;
}

static void draw_link(weaver *run, int32_t dart) {
    stroll walk = stroll_from(run->weave, dart);
    iso_point *corner = run->point + run->count, here = place(run, dart), end = walk.end;
    int32_t count = 0;
    while (stroll_on(&walk, &corner[count]))
        count++;
    if (!is_straight(here, end, corner, count, run->options->deviation))
        for (int32_t i = 0; i < count; i++)
            draw_to(run, corner[i]);
}

/* Along the arc of a dart for that length. */
static void draw_anchor(weaver *run, int32_t dart, double length) {
    stroll walk = stroll_from(run->weave, dart);
    iso_point here = place(run, dart), there;
    for (int more = 1; more && length > 0; here = there) {
        more = stroll_on(&walk, &there);
        double step = iso_hatch_distance(here, there);
        if (step > length) {
            there.x = here.x + (int32_t)lround((there.x - here.x) * (length / step));
            there.y = here.y + (int32_t)lround((there.y - here.y) * (length / step));
        }
        length -= step;
        draw_to(run, there);
    }
}

/* The shorter arc that leads from crossing c on to a chain not drawn yet; -1: there is none. */
static int32_t find_link(const weaver *run, int32_t c) {
    const iso_weave *weave = run->weave;
    double longest = run->options->link_max;
    int32_t best = -1;
    if (weave->crossing[c].edge < 0 || longest <= 0)
        return -1;
    for (int32_t dart = 2 * c; dart < 2 * c + 2; dart++) {
        int32_t reach = weave->arc[dart];
        if (run->drawn[reach >> 2] || run->anchored[reach] > 0)
            continue;
        double length = arc_length(run, dart, longest);
        if (length > longest)
            continue;
        longest = length;
        best = dart;
    }
    return best;
}

/* The end at crossing c leads nowhere: hold on to the wall where there is most room. An arc is
 * drawn by links only from both of its ends, so there are anchors alone to be mindful of. */
static void anchor_end(weaver *run, int32_t c) {
    const iso_weave *weave = run->weave;
    double wanted = run->options->anchor, best_length = 0;
    int32_t best = -1;
    if (weave->crossing[c].edge < 0 || wanted <= 0 || run->options->link_max <= 0)
        return;
    wanted = wanted < run->options->link_max ? wanted : run->options->link_max;
    for (int32_t dart = 2 * c; dart < 2 * c + 2; dart++) {
        double taken = run->anchored[weave->arc[dart]] + run->options->width;
        double room = arc_length(run, dart, wanted + taken) - taken;
        room = room < wanted ? room : wanted;
        if (room > best_length) {
            best_length = room;
            best = dart;
        }
    }
    if (best < 0 || best_length < run->options->width)
        return;
    run->anchored[best] = best_length;
    draw_anchor(run, best, best_length);
}

/* From crossing c, which the run has reached, to the other end of its chain. Returns that. */
static int32_t draw_chain(weaver *run, int32_t c) {
    const iso_weave *weave = run->weave;
    run->drawn[c >> 1] = 1;
    draw_to(run, weave->crossing[c].at);
    int32_t last = c | 1; /* beads are those of the pieces before, seen along the chain */
    if (weave->inner_first) {
        int32_t from = weave->inner_first[c >> 1], to = weave->inner_first[(c >> 1) + 1];
        for (int32_t i = from; i < to; i++) {
            int32_t k = c & 1 ? to - 1 - (i - from) : i,
                    before = i == from ? last : weave->count + k + 1;
            draw_bead(run, weave->inner[k], c & 1 ? before : weave->count + k);
        }
        if (from < to && c & 1)
            last = weave->count + from;
    }
    draw_bead(run, weave->crossing[c ^ 1].at, last);
    return c ^ 1;
}

/* On from crossing c, where the run ends, as long as links lead on; then the anchor. */
static int32_t draw_on(weaver *run, int32_t c) {
    for (int32_t dart; (dart = find_link(run, c)) >= 0;) {
        draw_link(run, dart);
        c = draw_chain(run, run->weave->arc[dart] >> 1);
    }
    anchor_end(run, c);
    return c;
}

static void turn_round(weaver *run) {
    for (int32_t i = 0, j = run->count - 1; i < j; i++, j--) {
        iso_point swap = run->point[i];
        run->point[i] = run->point[j];
        run->point[j] = swap;
    }
    if (run->bead)
        for (int32_t i = 0, j = run->count - 2; i < j; i++, j--) {
            iso_weave_bead swap = run->bead[i];
            run->bead[i] = run->bead[j];
            run->bead[j] = swap;
        }
}

static int is_short(const weaver *run) {
    double length = 0;
    for (int32_t i = 1; i < run->count && length <= run->options->shortest; i++)
        length += iso_hatch_distance(run->point[i - 1], run->point[i]);
    return run->count < 2 || length <= run->options->shortest;
}

/* Of the path added last. The last point's are nobody's. */
static void set_beads(iso_paths *out, const weaver *run) {
    iso_path_vertex *vertex = out->vertex + out->path[out->count - 1].first;
    for (int32_t i = 0; i < run->count; i++) {
        iso_weave_bead bead = run->bead[i + 1 < run->count ? i : i - 1];
        vertex[i].width = bead.width;
        vertex[i].area = bead.area;
    }
}

static iso_status draw_all(iso_paths *out, weaver *run) {
    iso_path like = run->options->like;
    like.closed = 0;
    int32_t chains = run->weave->count / 2;
    iso_point at = chains ? run->weave->crossing[0].at : (iso_point){0};
    for (int32_t k = 0; k < chains; k++) {
        if (run->drawn[k])
            continue;
        int32_t start = 2 * k;
        if (iso_hatch_distance(at, run->weave->crossing[start].at) >
            iso_hatch_distance(at, run->weave->crossing[start ^ 1].at))
            start ^= 1;
        run->count = 0;
        draw_on(run, draw_chain(run, start));
        turn_round(run); /* and on from the other end, if it leads anywhere */
        draw_on(run, start);
        at = run->point[run->count - 1];
        if (is_short(run))
            continue;
        ISO_TRY(iso_paths_add(out, &like, run->point, run->count, run->options->width,
                              run->options->area));
        if (run->bead)
            set_beads(out, run);
    }
    return ISO_OK;
}

iso_status iso_weave_draw(iso_paths *out, const iso_weave *weave, const iso_fill_options *options,
                          iso_arena *scratch) {
    int32_t chains = weave->count / 2;
    weaver run = {.weave = weave, .options = options};
    /* every chain and every arc at most once; an anchor may end within an edge */
    int64_t points = 4 * (int64_t)weave->count + weave->region->first[weave->region->count] + 2;
    if (weave->inner_first)
        points += weave->inner_first[chains];
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(ISO_PUSH(run.point, scratch, points));
    if (weave->bead)
        ISO_TRY(ISO_PUSH(run.bead, scratch, points));
    ISO_TRY(ISO_PUSH(run.drawn, scratch, chains));
    ISO_TRY(ISO_PUSH(run.anchored, scratch, 2 * (int64_t)weave->count));
    memset(run.drawn, 0, (size_t)chains);
    memset(run.anchored, 0, 2 * (size_t)weave->count * sizeof *run.anchored);
    ISO_TRY(draw_all(out, &run));
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}
