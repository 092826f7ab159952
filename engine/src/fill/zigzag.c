#include "fill/zigzag.h"

/* The flow of links beside that of lines: no less than this, and those longer than a bead is wide
 * are no narrower than this. */
#define FLOW_LEAST 0.25
#define WIDTH_LEAST 0.6

/* Ends are drawn out to the edge of what is to be full, but no further than this many margins where
 * the edge runs almost along the line. */
#define REACH_MOST 2.0

/* Ends at least as upright to the boundary as this make room for links that bring more than is
 * missing; at others that would leave gaps. */
#define UPRIGHT 0.6

typedef struct bead {
    int32_t width, area;
} bead;

/* A run of the zigzag while it grows. */
typedef struct zigzag {
    const iso_hatch *hatch;
    const iso_fill_options *options;
    iso_flanks *flanks;
    uint8_t *drawn; /* of each segment */
    iso_point *point;
    bead *to; /* the bead that comes to each point; to[0] unused */
    int32_t count;
    bead line;
    int32_t runs;
    int32_t end[2];   /* darts at which its first and last line end, if no link or anchor does */
    int32_t *cell;    /* monotonic: of each dart */
    int32_t *waiting; /* monotonic: of each cell, segments below it that are not drawn */
    double *anchored; /* with anchors: of each dart, how much of its arc is drawn from there */
} zigzag;

static void draw_to(zigzag *run, iso_point to, bead with) {
    iso_point last = run->count ? run->point[run->count - 1] : (iso_point){0};
    if (run->count && last.x == to.x && last.y == to.y)
        return;
    run->to[run->count] = with;
    run->point[run->count++] = to;
}

/* Does a line's widening fill the strip along this arc? */
static int is_slope(const zigzag *run, int32_t dart) {
    return run->flanks->count > 0 && iso_flanks_run_along(run->flanks, dart);
}

/* Is every point within `deviation` of the line a-b? (The points of a short arc: so no spike can
 * hide beyond the ends for longer than the link itself.) */
static int is_straight(iso_point a, iso_point b, const iso_point *point, int32_t count,
                       double deviation) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y, length = iso_hatch_distance(a, b);
    for (int32_t i = 0; i < count; i++) {
        double px = (double)point[i].x - a.x, py = (double)point[i].y - a.y;
        double off = dx * py - dy * px, along = dx * px + dy * py;
        if (fabs(off) > deviation * length || along < 0 || along > length * length)
            return 0;
    }
    return 1;
}

static iso_point place(const zigzag *run, int32_t dart) {
    return run->hatch->crossing[dart >> 1].at;
}

/* The sine of the angle between a line and the boundary that ends it. */
static double steepness(const zigzag *run, int32_t dart) {
    const iso_region *region = run->hatch->part.region;
    int32_t i = run->hatch->crossing[dart >> 1].edge >> 1;
    int32_t contour = run->hatch->part.member[run->hatch->link.contour[dart >> 1]];
    int32_t next = i + 1 < region->first[contour + 1] ? i + 1 : region->first[contour];
    iso_point a = region->point[i], b = region->point[next];
    iso_point p = place(run, dart), q = place(run, dart ^ 2);
    double lengths = iso_hatch_distance(a, b) * iso_hatch_distance(p, q);
    double cross = ((double)b.x - a.x) * ((double)q.y - p.y);
    cross -= ((double)b.y - a.y) * ((double)q.x - p.x);
    return lengths > 0 ? fabs(cross) / lengths : 1;
}

/* The end of a line, moved out along it until it is `by` units further from the boundary, or in if
 * that is negative; by no more than `most` units, and a quarter of the line. */
static iso_point moved_end(const zigzag *run, int32_t dart, double by, double most) {
    iso_point end = place(run, dart), other = place(run, dart ^ 2);
    double length = iso_hatch_distance(other, end), steep = steepness(run, dart);
    if (length <= 0)
        return end;
    most = by < 0 && most > length / 4 ? length / 4 : most;
    double far = fabs(by) < steep * most ? by / steep : by < 0 ? -most : most;
    end.x += (int32_t)floor(far / length * ((double)end.x - other.x) + 0.5);
    end.y += (int32_t)floor(far / length * ((double)end.y - other.y) + 0.5);
    return end;
}

/* Of a solid fill's lines the ends already lie within the strip that its links run in, so a link
 * adds only what is missing there: two margins' worth of its length. One shorter than a bead is
 * wide is but a bend of its lines' bead, and goes by their width. Others are not too thin to hold;
 * `surplus` is how much more, in units of margin, they bring then. */
static bead link_bead(double *surplus, const zigzag *run, double length) {
    const iso_fill_options *options = run->options;
    *surplus = 0;
    if (!options->fit)
        return (bead){options->width, options->area};
    double wanted = 2.0 * options->margin / options->spacing, least = FLOW_LEAST;
    int bend = length <= options->width;
    if (!bend)
        least = 1 - (1 - WIDTH_LEAST) * options->width / options->spacing;
    double flow = wanted < least ? least : wanted > 1 ? 1 : wanted;
    double narrower = (1 - flow) * options->spacing;
    if (wanted > 0 && flow > wanted)
        *surplus = (flow - wanted) * options->spacing / 2;
    return (bead){bend ? run->line.width : (int32_t)(options->width - narrower + 0.5),
                  (int32_t)(options->area * flow + 0.5)};
}

/* Draw the link that leaves the run's end by `dart`. Returns the dart by which the next segment
 * starts, or -1 if there is no such link. */
static int32_t draw_link(zigzag *run, int32_t dart) {
    const iso_hatch *hatch = run->hatch;
    int32_t reach = hatch->link.arc[dart];
    if (run->drawn[reach >> 2] || is_slope(run, dart))
        return -1;
    iso_point *arc = run->point + run->count, end = place(run, reach);
    int32_t count = iso_hatch_follow(arc, hatch, dart, run->options->link_max);
    if (count < 0)
        return -1;
    double length = 0, surplus;
    for (int32_t i = 0; i <= count; i++)
        length += iso_hatch_distance(arc[i - 1], i < count ? arc[i] : end);
    bead with = link_bead(&surplus, run, length);
    if (!is_straight(arc[-1], end, arc, count, run->options->deviation)) {
        for (int32_t i = 0; i < count; i++)
            draw_to(run, arc[i], with);
    } else if (surplus > 0 && steepness(run, dart) > UPRIGHT && steepness(run, reach) > UPRIGHT) {
        arc[-1] = moved_end(run, dart, -surplus, 2 * surplus); /* the lines give way */
        end = moved_end(run, reach, -surplus, 2 * surplus);
    }
    draw_to(run, end, with);
    return iso_fill_link_other_side(reach);
}

/* From the run's end at `dart`, its segment drawn: first on this side of the line (z = SBF), then
 * on the other; neighbouring lines before a piece of the same line. */
static int32_t draw_next(zigzag *run, int32_t dart) {
    const int32_t *arc = run->hatch->link.arc;
    if (run->options->link_max <= 0)
        return -1;
    for (int same_line = 0; same_line < 2; same_line++)
        for (int other = 0; other < 2; other++) {
            int32_t leave = dart ^ other;
            if (((arc[leave] ^ leave) & 1) == same_line)
                continue;
            int32_t next = draw_link(run, leave);
            if (next >= 0)
                return next;
        }
    return -1;
}

/* Only ever to a line above, and only if all that lies below that is drawn. */
static int32_t draw_upward(zigzag *run, int32_t dart) {
    int32_t leave = dart | 1, reach = run->hatch->link.arc[leave];
    if (run->options->link_max <= 0 || (reach & 1) || run->waiting[run->cell[reach]] > 0)
        return -1;
    return draw_link(run, leave);
}

/* The segment that starts at the run's end, at `dart`. */
static void draw_segment(zigzag *run, int32_t dart) {
    int32_t segment = dart >> 2, first = iso_flanks_of(run->flanks, segment);
    iso_flank_piece piece[ISO_FLANK_PIECES];
    if (!run->count)
        draw_to(run, place(run, dart), run->line);
    int32_t count = first < 0 ? 0 : iso_flanks_pieces(piece, run->flanks, first);
    int backward = (dart >> 1) & 1;
    for (int32_t i = 0; i < count; i++) {
        int32_t k = backward ? count - 1 - i : i;
        iso_point to = backward ? (k > 0 ? piece[k - 1].to : place(run, dart ^ 2)) : piece[k].to;
        draw_to(run, to, (bead){piece[k].width, piece[k].area});
    }
    draw_to(run, place(run, dart ^ 2), run->line);
    run->drawn[segment] = 1;
    if (run->waiting)
        run->waiting[run->cell[4 * segment + 1]]--;
}

/* The run's end is at `dart`, from where its segment is still to be drawn. */
static void draw_on(zigzag *run, int32_t dart) {
    while (dart >= 0) {
        draw_segment(run, dart);
        run->end[1] = iso_fill_link_across(dart);
        dart = run->waiting ? draw_upward(run, run->end[1]) : draw_next(run, run->end[1]);
    }
}

static void turn_round(zigzag *run) {
    for (int32_t i = 0, j = run->count - 1; i < j; i++, j--) {
        iso_point swap = run->point[i];
        run->point[i] = run->point[j];
        run->point[j] = swap;
    }
    for (int32_t i = 1, j = run->count - 1; i < j; i++, j--) {
        bead swap = run->to[i];
        run->to[i] = run->to[j];
        run->to[j] = swap;
    }
    int32_t end = run->end[0];
    run->end[0] = run->end[1];
    run->end[1] = end;
}

static int is_short(const zigzag *run) {
    double length = 0;
    for (int32_t i = 1; i < run->count && length <= run->options->shortest; i++)
        length += iso_hatch_distance(run->point[i - 1], run->point[i]);
    return run->count < 2 || length <= run->options->shortest;
}

/* An end without a link: out to the edge, since nothing else fills the margin there; but by no more
 * than lines overlap with what is around anyway. If that is nothing, the edge may be the model's.
 */
static iso_point drawn_out(const zigzag *run, iso_point end, int32_t dart) {
    double margin = run->options->margin, overlap = run->options->spacing / 2 - margin;
    double by = margin < overlap ? margin : overlap;
    if (!run->options->fit || run->anchored || by <= 0 || is_slope(run, dart) ||
        is_slope(run, dart ^ 1))
        return end;
    return moved_end(run, dart, by, REACH_MOST * by);
}

static iso_status add_run(iso_paths *out, zigzag *run) {
    iso_path like = run->options->like;
    like.closed = 0;
    if (is_short(run))
        return ISO_OK;
    if (run->waiting) { /* one after another */
        like.follows = run->runs > 0;
        like.rank += run->runs++;
    }
    run->point[0] = drawn_out(run, run->point[0], run->end[0]);
    run->point[run->count - 1] = drawn_out(run, run->point[run->count - 1], run->end[1]);
    int32_t at = out->vertex_count;
    ISO_TRY(iso_paths_add(out, &like, run->point, run->count, run->line.width, run->line.area));
    for (int32_t i = 1; i < run->count; i++) {
        out->vertex[at + i - 1].width = run->to[i].width;
        out->vertex[at + i - 1].area = run->to[i].area;
    }
    return ISO_OK;
}

/* The run's end leads nowhere: along the boundary for a while, where there is most room. Links draw
 * an arc only from both of its ends, so there are anchors alone to be mindful of. */
static void draw_anchor(zigzag *run) {
    const iso_fill_options *options = run->options;
    double most = options->anchor < options->link_max ? options->anchor : options->link_max;
    double best_length = 0;
    int32_t best = -1;
    if (!run->anchored || most <= 0)
        return;
    iso_point *arc = run->point + run->count;
    for (int other = 0; other < 2; other++) {
        int32_t dart = run->end[1] ^ other;
        double taken = run->anchored[run->hatch->link.arc[dart]] + options->width;
        double length = most + taken;
        (void)iso_hatch_follow_for(arc, run->hatch, dart, &length);
        if (length - taken > best_length) {
            best_length = length - taken;
            best = dart;
        }
    }
    if (best < 0 || best_length < options->width)
        return;
    int32_t count = iso_hatch_follow_for(arc, run->hatch, best, &best_length);
    run->anchored[best] = best_length;
    for (int32_t i = 0; i < count; i++)
        draw_to(run, arc[i], run->line);
}

/* Segments in the order of the lines: what is left lowest has nothing left below, so that a run
 * that starts there does not cut a column in two. */
static iso_status draw_all(iso_paths *out, zigzag *run) {
    int32_t segments = run->hatch->link.count / 2;
    iso_point at = segments ? run->hatch->crossing[0].at : (iso_point){0};
    for (int32_t s = 0; s < segments; s++) {
        if (run->drawn[s])
            continue;
        int32_t left = 4 * s + 1, right = 4 * s + 3; /* darts that go on upward */
        int32_t start =
            iso_hatch_distance(at, place(run, right)) < iso_hatch_distance(at, place(run, left))
                ? right
                : left;
        run->count = 0;
        run->end[0] = start;
        draw_on(run, start);
        draw_anchor(run);
        at = run->point[run->count - 1];
        turn_round(run); /* and on from the other end, if it leads anywhere */
        int32_t back = run->waiting ? -1 : draw_next(run, start);
        draw_on(run, back);
        draw_anchor(run);
        if (back < 0)
            turn_round(run);
        else
            at = run->point[run->count - 1];
        ISO_TRY(add_run(out, run));
    }
    return ISO_OK;
}

/* Which cell each dart looks into, and how many segments lie below each. */
static iso_status find_cells(zigzag *run, iso_arena *scratch) {
    const iso_fill_link *link = &run->hatch->link;
    int32_t darts = 2 * link->count, cells = 0;
    ISO_TRY(ISO_PUSH(run->cell, scratch, darts));
    ISO_TRY(ISO_PUSH(run->waiting, scratch, darts));
    memset(run->cell, -1, (size_t)darts * sizeof *run->cell);
    memset(run->waiting, 0, (size_t)darts * sizeof *run->waiting);
    for (int32_t start = 0; start < darts; start++) {
        if (run->cell[start] >= 0)
            continue;
        int32_t d = start;
        do {
            int32_t across = iso_fill_link_across(d);
            run->cell[d] = run->cell[across] = cells;
            run->waiting[cells] += d & 1;
            d = link->arc[across];
        } while (d != start);
        cells++;
    }
    return ISO_OK;
}

iso_status iso_zigzag_draw(iso_paths *out, const iso_hatch *hatch, iso_flanks *flanks,
                           const iso_fill_options *options, iso_arena *scratch) {
    const iso_fill_part *part = &hatch->part;
    zigzag run = {.hatch = hatch, .options = options, .flanks = flanks};
    run.line = (bead){flanks->usual.width, flanks->usual.area};
    int64_t darts = 2 * (int64_t)hatch->link.count;
    int64_t points = 4 + hatch->link.count + flanks->pieces + (options->anchor > 0 ? darts : 0);
    for (int32_t m = 0; m < part->count; m++)
        points += part->region->first[part->member[m] + 1] - part->region->first[part->member[m]];
    ISO_TRY(ISO_PUSH(run.point, scratch, points));
    ISO_TRY(ISO_PUSH(run.to, scratch, points));
    ISO_TRY(ISO_PUSH(run.drawn, scratch, hatch->link.count / 2));
    memset(run.drawn, 0, (size_t)hatch->link.count / 2);
    if (options->monotonic)
        ISO_TRY(find_cells(&run, scratch));
    if (options->anchor > 0) {
        ISO_TRY(ISO_PUSH(run.anchored, scratch, darts));
        memset(run.anchored, 0, (size_t)darts * sizeof *run.anchored);
    }
    return draw_all(out, &run);
}
