#include "path/seam.h"

#include <math.h>

#include "base/random.h"
#include "path/edges.h"

enum {
    REACH =
        3 * ISO_UNITS_PER_MM, /* how far the seam below may be from a wall that goes on with it */
    SLIDE = 1 * ISO_UNITS_PER_MM, /* along the wall to a corner */
    ARM = ISO_UNITS_PER_MM / 2,   /* a corner turns within this much before and after it */
    SHARPEST = 16,
    BLUNT = 2,   /* corners that turn by less, 40 degrees, hide nothing */
    HANGING = 40 /* grades that a bead over air takes away: it holds to nothing where it begins */
};

void iso_seams_free(iso_seams *seams) {
    iso_release(seams->below);
    iso_release(seams->here);
    *seams = (iso_seams){0};
}

void iso_seams_next_layer(iso_seams *seams) {
    iso_seam_mark *below = seams->below;
    int64_t capacity = seams->below_capacity;
    seams->below = seams->here;
    seams->below_count = seams->here_count;
    seams->below_capacity = seams->here_capacity;
    seams->here = below;
    seams->here_count = 0;
    seams->here_capacity = capacity;
    seams->layer++;
    seams->first = seams->in = NULL;
}

static int32_t cell_of(int64_t offset, int32_t size, int32_t cells) {
    int64_t c = offset < 0 ? 0 : offset / size;
    return (int32_t)(c < cells ? c : cells - 1);
}

enum { FEW = 32 /* are looked through one by one */ };

static int32_t cell_of_mark(const iso_seams *seams, int32_t i) {
    iso_point p = seams->below[i].at;
    return cell_of((int64_t)p.y - seams->origin.y, seams->size, seams->rows) * seams->columns +
           cell_of((int64_t)p.x - seams->origin.x, seams->size, seams->columns);
}

iso_status iso_seams_index(iso_seams *seams, iso_arena *scratch) {
    int32_t count = seams->below_count;
    if (count <= FEW)
        return ISO_OK;
    iso_point low = seams->below[0].at, high = low;
    for (int32_t i = 1; i < count; i++) {
        iso_point p = seams->below[i].at;
        low.x = p.x < low.x ? p.x : low.x;
        low.y = p.y < low.y ? p.y : low.y;
        high.x = p.x > high.x ? p.x : high.x;
        high.y = p.y > high.y ? p.y : high.y;
    }
    int64_t width = (int64_t)high.x - low.x + 1, height = (int64_t)high.y - low.y + 1;
    int64_t size = (int64_t)sqrt((double)width * (double)height / count) + 1;
    int64_t longest = (width > height ? width : height) / count + 1;
    seams->size = (int32_t)(size > longest ? size : longest);
    seams->origin = low;
    seams->columns = (int32_t)(width / seams->size + 1);
    seams->rows = (int32_t)(height / seams->size + 1);
    int32_t cells = seams->columns * seams->rows, *first;
    ISO_TRY(ISO_PUSH(seams->in, scratch, count));
    ISO_TRY(ISO_PUSH(first, scratch, (int64_t)cells + 2));
    memset(first, 0, ((size_t)cells + 2) * sizeof *first);
    for (int32_t i = 0; i < count; i++)
        first[cell_of_mark(seams, i) + 2]++;
    for (int32_t c = 0; c < cells; c++)
        first[c + 2] += first[c + 1];
    for (int32_t i = 0; i < count; i++)
        seams->in[first[cell_of_mark(seams, i) + 1]++] = i;
    seams->first = first;
    return ISO_OK;
}

static double distance(iso_point a, iso_point b) {
    return sqrt((double)iso_distance_squared(a, b));
}

/* From vertex i along the path, forth or back, as far as an arm reaches. */
static iso_point reach_of_arm(const iso_path_vertex *vertex, int32_t count, int32_t i, int step) {
    double left = ARM;
    iso_point at = vertex[i].at;
    for (int32_t n = 1; n < count; n++) {
        i = i + step < 0 ? count - 1 : i + step == count ? 0 : i + step;
        iso_point next = vertex[i].at;
        double length = distance(at, next);
        if (length >= left) {
            double t = left / length;
            return (iso_point){at.x + (int32_t)(t * ((double)next.x - at.x)),
                               at.y + (int32_t)(t * ((double)next.y - at.y))};
        }
        left -= length;
        at = next;
    }
    return at;
}

/* By sin^2 of half the turn, which grows with it from 0 to 1. */
int32_t iso_seam_corner(const iso_path_vertex *vertex, int32_t count, int32_t i) {
    iso_point before = reach_of_arm(vertex, count, i, -1), at = vertex[i].at;
    iso_point after = reach_of_arm(vertex, count, i, 1);
    double ax = (double)at.x - before.x, ay = (double)at.y - before.y;
    double bx = (double)after.x - at.x, by = (double)after.y - at.y;
    double lengths = sqrt(ax * ax + ay * ay) * sqrt(bx * bx + by * by);
    if (lengths == 0)
        return 0;
    double sharp = (1 - (ax * bx + ay * by) / lengths) / 2;
    int32_t grade = (int32_t)(sharp * SHARPEST + 0.5);
    if (grade < BLUNT)
        return 0;
    return ax * by - ay * bx < 0 ? SHARPEST + grade : grade;
}

static int32_t grade_of(const iso_path_vertex *vertex, int32_t count, int32_t i) {
    int32_t grade = iso_seam_corner(vertex, count, i);
    return vertex[i].role == ISO_ROLE_OVERHANG_PERIMETER ? grade - HANGING : grade;
}

static iso_seam_place at_vertex(const iso_path_vertex *vertex, int32_t i) {
    return (iso_seam_place){i, vertex[i].at};
}

/* ---- aligned ---- */

static iso_box box_of(const iso_path_vertex *vertex, int32_t count) {
    iso_box box = {vertex[0].at, vertex[0].at};
    for (int32_t i = 1; i < count; i++) {
        iso_point p = vertex[i].at;
        box.min.x = p.x < box.min.x ? p.x : box.min.x;
        box.min.y = p.y < box.min.y ? p.y : box.min.y;
        box.max.x = p.x > box.max.x ? p.x : box.max.x;
        box.max.y = p.y > box.max.y ? p.y : box.max.y;
    }
    return box;
}

/* Does one side of the boxes agree? Those of a plate and of a hole in it don't, so that a plate
 * with thousands of holes need not look at all their seams. */
static int are_alike(iso_box a, iso_box b) {
    int64_t side[4] = {(int64_t)a.min.x - b.min.x, (int64_t)a.min.y - b.min.y,
                       (int64_t)a.max.x - b.max.x, (int64_t)a.max.y - b.max.y};
    for (int i = 0; i < 4; i++)
        if (side[i] >= -REACH && side[i] <= REACH)
            return 1;
    return 0;
}

/* A wall that looks for the nearest of the seams below. */
typedef struct looking {
    const iso_path *path;
    const iso_path_vertex *vertex;
    iso_box box;
    iso_seam_place place;
    int64_t closest;
    int found;
} looking;

static void look_at(looking *l, const iso_seam_mark *mark) {
    iso_point p = mark->at;
    if (mark->object != l->path->object || p.x < l->box.min.x - REACH ||
        p.x > l->box.max.x + REACH || p.y < l->box.min.y - REACH || p.y > l->box.max.y + REACH ||
        !are_alike(mark->box, l->box))
        return;
    for (int32_t i = 0; i < l->path->count; i++) {
        iso_point b = l->vertex[i + 1 < l->path->count ? i + 1 : 0].at;
        iso_point on = iso_nearest_on_segment(p, l->vertex[i].at, b);
        int64_t d = iso_distance_squared(p, on);
        if (d < l->closest) {
            l->closest = d;
            l->place = (iso_seam_place){i, on};
            l->found = 1;
        }
    }
}

static void find_below(looking *l, const iso_seams *seams) {
    l->closest = (int64_t)REACH * REACH + 1;
    for (int32_t s = 0; s < seams->below_count && !seams->first; s++)
        look_at(l, &seams->below[s]);
    if (!seams->first)
        return;
    iso_point low = l->box.min, high = l->box.max, origin = seams->origin;
    int32_t left = cell_of((int64_t)low.x - REACH - origin.x, seams->size, seams->columns);
    int32_t right = cell_of((int64_t)high.x + REACH - origin.x, seams->size, seams->columns);
    int32_t top = cell_of((int64_t)high.y + REACH - origin.y, seams->size, seams->rows);
    for (int32_t r = cell_of((int64_t)low.y - REACH - origin.y, seams->size, seams->rows); r <= top;
         r++)
        for (int32_t k = seams->first[r * seams->columns + left];
             k < seams->first[r * seams->columns + right + 1]; k++)
            look_at(l, &seams->below[seams->in[k]]);
}

/* To the best corner within the distance that a seam may slide; of equals the nearest. */
static iso_seam_place slide_to_corner(iso_seam_place place, const iso_path *path,
                                      const iso_path_vertex *vertex) {
    iso_seam_place best = place;
    int32_t grade = 0;
    double nearest = 0;
    for (int step = -1; step <= 1; step += 2) {
        iso_point at = place.at;
        double way = 0;
        int32_t i = step < 0 ? place.vertex : place.vertex + 1 < path->count ? place.vertex + 1 : 0;
        for (int32_t n = 0; n < path->count; n++) {
            way += distance(at, vertex[i].at);
            if (way > SLIDE)
                break;
            int32_t here = grade_of(vertex, path->count, i);
            if (here > grade || (here == grade && here > 0 && way < nearest)) {
                grade = here;
                nearest = way;
                best = at_vertex(vertex, i);
            }
            at = vertex[i].at;
            i = i + step < 0 ? path->count - 1 : i + step == path->count ? 0 : i + step;
        }
    }
    return best;
}

static int is_further_back(iso_point a, iso_point b) {
    return a.y != b.y ? a.y > b.y : a.x < b.x;
}

static iso_seam_place best_corner(const iso_path *path, const iso_path_vertex *vertex) {
    int32_t best = 0, grade = grade_of(vertex, path->count, 0);
    for (int32_t i = 1; i < path->count; i++) {
        int32_t here = grade_of(vertex, path->count, i);
        if (here > grade || (here == grade && is_further_back(vertex[i].at, vertex[best].at))) {
            grade = here;
            best = i;
        }
    }
    return at_vertex(vertex, best);
}

/* ---- the others ---- */

/* A place without a corner is worth 3 mm of way more than one at the sharpest convex corner, and a
 * concave one is worth more still. */
static iso_seam_place nearest_corner(const iso_path *path, const iso_path_vertex *vertex,
                                     iso_point from) {
    double least = INFINITY;
    int32_t best = 0;
    for (int32_t i = 0; i < path->count; i++) {
        double way = distance(vertex[i].at, from) - 3.0 * ISO_UNITS_PER_MM;
        if (way >= least)
            continue;
        int32_t grade = grade_of(vertex, path->count, i);
        grade = grade > SHARPEST ? SHARPEST : grade;
        double cost = way + 3.0 * ISO_UNITS_PER_MM * (SHARPEST - grade) / SHARPEST;
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    return at_vertex(vertex, best);
}

static iso_seam_place rearmost(const iso_path *path, const iso_path_vertex *vertex) {
    int32_t best = 0;
    for (int32_t i = 1; i < path->count; i++)
        if (is_further_back(vertex[i].at, vertex[best].at))
            best = i;
    return at_vertex(vertex, best);
}

static iso_seam_place anywhere(const iso_path *path, const iso_path_vertex *vertex, uint64_t seed) {
    double all = 0;
    for (int32_t i = 0; i < path->count; i++)
        all += distance(vertex[i].at, vertex[i + 1 < path->count ? i + 1 : 0].at);
    double left = all * random_unit(&seed);
    for (int32_t i = 0; i < path->count; i++) {
        iso_point a = vertex[i].at, b = vertex[i + 1 < path->count ? i + 1 : 0].at;
        double length = distance(a, b);
        if (left < length) {
            double t = left / length;
            return (iso_seam_place){i,
                                    {a.x + (int32_t)(t * ((double)b.x - a.x)),
                                     a.y + (int32_t)(t * ((double)b.y - a.y))}};
        }
        left -= length;
    }
    return at_vertex(vertex, 0);
}

iso_status iso_seam_choose(iso_seam_place *place, iso_seams *seams, const iso_path *path,
                           const iso_path_vertex *vertex, int32_t number, iso_seam how,
                           iso_point from) {
    looking l = {.path = path, .vertex = vertex};
    switch (how) {
    case ISO_SEAM_ALIGNED:
        l.box = box_of(vertex, path->count);
        find_below(&l, seams);
        *place = l.found ? slide_to_corner(l.place, path, vertex) : best_corner(path, vertex);
        break;
    case ISO_SEAM_REAR:
        *place = rearmost(path, vertex);
        break;
    case ISO_SEAM_RANDOM:
        *place =
            anywhere(path, vertex, ((uint64_t)(uint32_t)seams->layer << 32) | (uint32_t)number);
        break;
    default:
        *place = nearest_corner(path, vertex, from);
    }
    if (how != ISO_SEAM_ALIGNED)
        return ISO_OK;
    ISO_TRY(ISO_GROW(seams->here, seams->here_capacity, (int64_t)seams->here_count + 1));
    seams->here[seams->here_count++] = (iso_seam_mark){place->at, path->object, l.box};
    return ISO_OK;
}

/* Of segments, so that a seam on a long one has its neighbour right beside it. */
iso_seam_place iso_seam_beside(const iso_path *path, const iso_path_vertex *vertex, iso_point to) {
    double closest = INFINITY;
    int32_t best = 0;
    for (int32_t i = 0; i < path->count; i++) {
        iso_point a = vertex[i].at, b = vertex[i + 1 < path->count ? i + 1 : 0].at;
        double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
        double px = (double)to.x - a.x, py = (double)to.y - a.y;
        double along = px * dx + py * dy, all = dx * dx + dy * dy, aside = px * dy - py * dx;
        double d = px * px + py * py;
        if (along > 0 && along < all)
            d = aside * aside / all;
        if (d < closest) {
            closest = d;
            best = i;
        }
    }
    iso_point next = vertex[best + 1 < path->count ? best + 1 : 0].at;
    return (iso_seam_place){best, iso_nearest_on_segment(to, vertex[best].at, next)};
}
