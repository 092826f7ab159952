#include "solid/check.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/sort.h"
#include "solid/check_shells.h"
#include "solid/planes.h"

/* In auto mode one level in so many is looked at, from the second on: a level costs about a sixth
 * of what a print of nothing but one wall takes for it. By counts alone, never by the clock. */
enum { AUTO_LEVELS = 3 };

/* Another place of the contour, further from it, or a little above or below: a sheet next to it or
 * a face in the level is no defect. In mm; a nanometre is about what solid.h rounds a metre to. */
typedef struct attempt {
    double aside, up;
} attempt;
static const attempt attempts[] = {{1e-4, 0}, {1e-3, 0}, {1e-3, 4e-6}, {1e-3, -4e-6}, {1e-2, 0}};
enum { ATTEMPTS = sizeof attempts / sizeof *attempts };

typedef struct sample {
    iso_vec2 at;
    int32_t contour; /* number among those that were chosen */
    int32_t winding; /* of the level's contours */
} sample;

typedef struct findings {
    int64_t contours; /* of all levels */
    int64_t checked, buried, empty, wrong, points;
    iso_vec3 where; /* of the first wrong one */
    int32_t claimed, found;
} findings;

/* A contour of a model's slices, and what was found wrong with it at first. */
typedef struct place {
    int32_t model, contour;
    iso_vec2 beside[2]; /* left and right, where it is looked at this time */
    int32_t claimed, found;
    iso_vec3 where;
} place;

typedef struct desk {     /* of one thread; for the level with most contours and places */
    sample *sample;       /* [2 contours] */
    iso_vec3 *point;      /* [2 (contours + places)] */
    int32_t *winding;     /* [2 (contours + places)] */
    int32_t *claim;       /* [2 contours] */
    place *place;         /* [contours] */
    plane_point *scratch; /* [2 (contours + places)] */
} desk;

typedef struct checker {
    const solid_subject *subject;
    int32_t share;     /* one level in so many is looked at */
    iso_levels levels; /* their cuts alone */
    solid_planes planes;
    shell_places shells; /* none in full mode */
    desk *desk;          /* [threads] */
    findings *findings;  /* [levels] */
} checker;

/* ---- what the contours say ---- */

static inline int sample_before(const sample *a, const sample *b) {
    return a->at.y != b->at.y ? a->at.y < b->at.y : a->contour < b->contour;
}
ISO_SORT(sort_samples, sample, sample_before)

static int32_t first_above(const sample *list, int32_t count, double y) {
    int32_t low = 0, high = count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (list[middle].at.y < y)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Add what an edge contributes to the samples whose rays in the direction of +x it crosses. */
static void add_edge(sample *list, int32_t count, iso_vec2 a, iso_vec2 b) {
    if (a.y == b.y)
        return;
    int way = a.y < b.y ? 1 : -1;
    iso_vec2 low = way > 0 ? a : b, high = way > 0 ? b : a;
    for (int32_t i = first_above(list, count, low.y); i < count && list[i].at.y < high.y; i++) {
        iso_vec2 p = list[i].at;
        if ((high.x - low.x) * (p.y - low.y) > (p.x - low.x) * (high.y - low.y))
            list[i].winding += way;
    }
}

/* Winding numbers of all contours of the level around samples sorted by y. */
static void wind(sample *list, int32_t count, const solid_subject *subject, int32_t level) {
    for (int32_t i = 0; i < count; i++)
        list[i].winding = 0;
    for (int32_t m = 0; m < subject->count; m++) {
        const iso_slices *s = &subject->slices[m];
        for (int32_t c = s->level_first[level]; c < s->level_first[level + 1]; c++) {
            iso_vec2 from = s->point[s->contour_first[c + 1] - 1];
            for (int64_t i = s->contour_first[c]; i < s->contour_first[c + 1]; i++) {
                add_edge(list, count, from, s->point[i]);
                from = s->point[i];
            }
        }
    }
}

/* ---- where to look ---- */

static double square(double a) {
    return a * a;
}

/* Left and right of the middle of an edge of the contour, the longest of those in one part of it.
 * False: it is a point. */
static bool look_beside(iso_vec2 beside[2], const iso_slices *slices, int32_t contour,
                        int32_t turn) {
    int64_t first = slices->contour_first[contour], end = slices->contour_first[contour + 1];
    int64_t count = end - first, begin = first + count * turn / ATTEMPTS;
    double longest = 0;
    iso_vec2 from = {0, 0}, to = from;
    for (int64_t i = begin; i < end || (longest == 0 && i < end + count); i++) {
        iso_vec2 a = slices->point[i < end ? i : i - count];
        iso_vec2 b = slices->point[i + 1 < end ? i + 1 : i + 1 - count];
        double length = square(b.x - a.x) + square(b.y - a.y);
        if (length > longest)
            longest = length, from = a, to = b;
    }
    if (!(longest > 0))
        return false;
    double by = attempts[turn].aside / sqrt(longest);
    iso_vec2 middle = {(from.x + to.x) / 2, (from.y + to.y) / 2};
    iso_vec2 left = {-by * (to.y - from.y), by * (to.x - from.x)};
    beside[0] = (iso_vec2){middle.x + left.x, middle.y + left.y};
    beside[1] = (iso_vec2){middle.x - left.x, middle.y - left.y};
    return beside[0].x != beside[1].x || beside[0].y != beside[1].y;
}

static int64_t contours_of(const solid_subject *subject, int32_t level) {
    int64_t sum = 0;
    for (int32_t m = 0; m < subject->count; m++)
        sum += subject->slices[m].level_first[level + 1] - subject->slices[m].level_first[level];
    return sum;
}

static int32_t list_contours(desk *d, const solid_subject *subject, int32_t level) {
    int32_t listed = 0;
    for (int32_t m = 0; m < subject->count; m++) {
        const iso_slices *s = &subject->slices[m];
        for (int32_t k = s->level_first[level]; k < s->level_first[level + 1]; k++) {
            d->place[listed] = (place){.model = m, .contour = k};
            listed += look_beside(d->place[listed].beside, s, k, 0);
        }
    }
    return listed;
}

/* A contour that had two sides the first time has them further from it, too. */
static void look_elsewhere(desk *d, const solid_subject *subject, int32_t turn, int32_t count) {
    for (place *at = d->place; at < d->place + count; at++)
        (void)look_beside(at->beside, &subject->slices[at->model], at->contour, turn);
}

/* ---- the comparison ---- */

/* Points to both sides of the first `count` places, and what the contours say of them. */
static void claim(desk *d, const checker *c, int32_t level, int32_t turn, int32_t count) {
    double z = c->subject->levels->cut[level] + attempts[turn].up;
    for (int32_t i = 0; i < 2 * count; i++) {
        iso_vec2 at = d->place[i / 2].beside[i % 2];
        d->sample[i] = (sample){.at = at, .contour = i};
        d->point[i] = (iso_vec3){at.x, at.y, z};
    }
    sort_samples(d->sample, 2 * count);
    wind(d->sample, 2 * count, c->subject, level);
    for (int32_t i = 0; i < 2 * count; i++)
        d->claim[d->sample[i].contour] = d->sample[i].winding;
}

static void judge(findings *found, int32_t left, int32_t right) {
    found->buried += left >= 1 && right >= 1;
    found->empty += left <= 0 && right <= 0;
}

/* Of the first `count` places those stay whose numbers differ. */
static int32_t compare(findings *found, desk *d, int32_t turn, int32_t count) {
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        const int32_t *winding = d->winding + 2 * i, *said = d->claim + 2 * i;
        if (winding[0] == said[0] && winding[1] == said[1]) {
            judge(found, winding[0], winding[1]);
            continue;
        }
        place at = d->place[i];
        if (turn == 0) {
            int side = winding[0] == said[0];
            at.where = d->point[2 * i + side];
            at.claimed = said[side];
            at.found = winding[side];
        }
        d->place[kept++] = at;
    }
    return kept;
}

static int32_t level_of(const checker *c, int32_t look) {
    int32_t level = look * c->share + c->share / 2, last = c->subject->levels->count - 1;
    return level < last ? level : last;
}

static iso_status check_level(void *payload, int64_t number, int worker) {
    checker *c = payload;
    int32_t look = (int32_t)number, level = level_of(c, look);
    desk *d = &c->desk[worker];
    findings *found = &c->findings[look];
    int32_t count = list_contours(d, c->subject, level);
    found->checked = count;
    for (int32_t turn = 0; turn < ATTEMPTS && (turn == 0 || count > 0); turn++) {
        int32_t places = turn > 0 ? 0 : (int32_t)shell_places_of(&c->shells, look);
        if (turn > 0)
            look_elsewhere(d, c->subject, turn, count);
        claim(d, c, level, turn, count);
        if (places > 0)
            shell_places_points(d->point + 2 * count, &c->shells, look, c->levels.cut[look]);
        planes_winding(d->winding, &c->planes, look, d->point, 2 * (count + places), d->scratch);
        if (places > 0)
            shell_places_note(&c->shells, d->winding + 2 * count, look);
        found->points += 2 * (count + places);
        count = compare(found, d, turn, count);
    }
    found->wrong = count;
    if (count > 0) {
        found->where = d->place[0].where;
        found->claimed = d->place[0].claimed;
        found->found = d->place[0].found;
    }
    return ISO_OK;
}

/* ---- all levels ---- */

static iso_status furnish(desk *d, int64_t contours, int64_t points) {
    ISO_TRY(ISO_ALLOCATE(d->sample, 2 * contours));
    ISO_TRY(ISO_ALLOCATE(d->claim, 2 * contours));
    ISO_TRY(ISO_ALLOCATE(d->place, contours));
    ISO_TRY(ISO_ALLOCATE(d->point, points));
    ISO_TRY(ISO_ALLOCATE(d->winding, points));
    return ISO_ALLOCATE(d->scratch, points);
}

static iso_status check_levels(findings *sum, checker *c, iso_pool *pool) {
    int32_t looks = c->levels.count, threads = pool ? iso_pool_threads(pool) : 1;
    int64_t most = 0, most_points = 0;
    for (int32_t i = 0; i < c->subject->levels->count; i++)
        sum->contours += contours_of(c->subject, i);
    for (int32_t i = 0; i < looks; i++) {
        int64_t contours = contours_of(c->subject, level_of(c, i));
        int64_t points = 2 * (contours + shell_places_of(&c->shells, i));
        most = contours > most ? contours : most;
        most_points = points > most_points ? points : most_points;
    }
    ISO_TRY(ISO_ALLOCATE(c->findings, looks));
    memset(c->findings, 0, (size_t)looks * sizeof *c->findings);
    ISO_TRY(ISO_ALLOCATE(c->desk, threads));
    memset(c->desk, 0, (size_t)threads * sizeof *c->desk);
    for (int32_t i = 0; i < threads; i++)
        ISO_TRY(furnish(&c->desk[i], most, most_points));
    ISO_TRY(iso_parallel_for(pool, looks, check_level, c));
    for (int32_t i = 0; i < looks; i++) {
        const findings *f = &c->findings[i];
        if (sum->wrong == 0)
            sum->where = f->where, sum->claimed = f->claimed, sum->found = f->found;
        sum->checked += f->checked;
        sum->buried += f->buried;
        sum->empty += f->empty;
        sum->wrong += f->wrong;
        sum->points += f->points;
    }
    return ISO_OK;
}

static void checker_free(checker *c, int32_t threads) {
    for (int32_t i = 0; c->desk && i < threads; i++) {
        iso_release(c->desk[i].sample);
        iso_release(c->desk[i].point);
        iso_release(c->desk[i].winding);
        iso_release(c->desk[i].claim);
        iso_release(c->desk[i].place);
        iso_release(c->desk[i].scratch);
    }
    iso_release(c->desk);
    iso_release(c->findings);
    shell_places_free(&c->shells);
    planes_free(&c->planes);
    iso_levels_free(&c->levels);
}

static iso_status choose_levels(checker *c) {
    int32_t levels = c->subject->levels->count;
    c->levels.count = (levels + c->share - 1) / c->share;
    ISO_TRY(ISO_ALLOCATE(c->levels.cut, c->levels.count));
    for (int32_t i = 0; i < c->levels.count; i++)
        c->levels.cut[i] = c->subject->levels->cut[level_of(c, i)];
    return ISO_OK;
}

/* ---- the report ---- */

static void add_findings(iso_report_solid *to, const findings *found, const shell_kinds *kinds) {
    to->contours += found->contours;
    to->contours_checked += found->checked;
    to->contours_buried += found->buried;
    to->contours_empty += found->empty;
    to->contours_wrong += found->wrong;
    to->points += found->points + kinds->points;
    to->shells += kinds->shells;
    to->shells_overlapping += kinds->overlapping;
    to->shells_nested += kinds->nested;
    to->shells_hollow += kinds->hollow;
    to->cavities += kinds->cavities;
}

static iso_status verdict(iso_report *report, const solid_subject *subject, const findings *found) {
    static const char text[] = "%s: %lld of %lld contours aren't the model's section; the first "
                               "one at z %.4f, near (%.4f, %.4f), has winding number %d there, the "
                               "model %d";
    if (found->wrong == 0)
        return ISO_OK;
    if (subject->mode == ISO_CHECK_FULL)
        return iso_fail(ISO_NOT_VERIFIED, text, subject->name, (long long)found->wrong,
                        (long long)found->checked, found->where.z, found->where.x, found->where.y,
                        found->claimed, found->found);
    return iso_report_warn(report, "contours-wrong", text, subject->name, (long long)found->wrong,
                           (long long)found->checked, found->where.z, found->where.x,
                           found->where.y, found->claimed, found->found);
}

/* Contours, and in auto mode shells with them. */
static iso_status check_sections(findings *found, shell_kinds *kinds, const solid_subject *subject,
                                 iso_pool *pool) {
    bool sampled = subject->mode == ISO_CHECK_AUTO;
    checker c = {.subject = subject, .share = sampled ? AUTO_LEVELS : 1};
    iso_status status = choose_levels(&c);
    if (status == ISO_OK)
        status = planes_make(&c.planes, subject->mesh, subject->count, &c.levels);
    if (status == ISO_OK && sampled)
        status = shell_places_choose(&c.shells, &c.planes);
    if (status == ISO_OK)
        status = check_levels(found, &c, pool);
    if (status == ISO_OK && sampled)
        status = shell_places_sort(kinds, &c.shells);
    checker_free(&c, pool ? iso_pool_threads(pool) : 1);
    return status;
}

static bool boxes_meet(const iso_mesh *a, const iso_mesh *b) {
    return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y &&
           b->min.y <= a->max.y && a->min.z <= b->max.z && b->min.z <= a->max.z;
}

static bool is_plain(const iso_mesh *mesh) {
    const iso_mesh_defects *d = &mesh->defects;
    return d->shells <= 1 && d->bad_edges == 0 && d->duplicate == 0 && d->cancelled == 0 &&
           d->welded_vertices == 0 && d->flipped_triangles == 0 && d->inverted_shells == 0 &&
           d->sheets == 0;
}

bool solid_check_is_due(const iso_mesh *mesh, int32_t count, iso_check_solid mode) {
    bool due = mode == ISO_CHECK_FULL;
    if (mode == ISO_CHECK_OFF)
        return false;
    for (int32_t i = 0; i < count && !due; i++) {
        due = !is_plain(&mesh[i]);
        for (int32_t k = 0; k < i && !due; k++) /* models of one object are few */
            due = boxes_meet(&mesh[i], &mesh[k]);
    }
    return due;
}

iso_status solid_check(iso_report *report, const solid_subject *subject, iso_pool *pool) {
    findings found = {0};
    shell_kinds kinds = {0};
    if (!solid_check_is_due(subject->mesh, subject->count, subject->mode))
        return ISO_OK;
    ISO_TRY(check_sections(&found, &kinds, subject, pool));
    if (subject->mode == ISO_CHECK_FULL)
        ISO_TRY(shells_ask_rays(&kinds, subject, pool));
    add_findings(&report->solid, &found, &kinds);
    return verdict(report, subject, &found);
}
