#include "solid/check.h"

#include <math.h>
#include <string.h>

#include <isoslice/solid.h>

#include "base/memory.h"
#include "base/sort.h"
#include "solid/check_shells.h"

/* One contour in so many is looked at in auto mode, and of small ones fewer: a point costs about as
 * much as the rest of the job does for this many crossings. */
enum { AUTO_SHARE = 4, AUTO_CROSSINGS = 100 };

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
    int64_t contours, checked, buried, empty, wrong, points;
    iso_vec3 where; /* of the first wrong one */
    int32_t claimed, found;
} findings;

/* A contour of a model's slices. */
typedef struct place {
    int32_t model, contour;
} place;

typedef struct desk { /* of one thread; for the level with most contours */
    sample *sample;   /* [2 contours] */
    iso_vec3 *point;  /* [2 contours] */
    int32_t *winding; /* [2 contours] */
    int32_t *claim;   /* [2 contours] */
    place *place;     /* [contours] */
} desk;

typedef struct checker {
    const solid_subject *subject;
    const iso_solid *solid;
    desk *desk;         /* [threads] */
    findings *findings; /* [levels] */
    int64_t share;      /* one contour in so many */
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

static int32_t choose(desk *d, const checker *c, int32_t level, findings *found) {
    int32_t chosen = 0;
    for (int32_t m = 0; m < c->subject->count; m++) {
        const iso_slices *s = &c->subject->slices[m];
        found->contours += s->level_first[level + 1] - s->level_first[level];
        for (int32_t k = s->level_first[level]; k < s->level_first[level + 1]; k++) {
            iso_vec2 beside[2];
            if ((k + (int64_t)level) % c->share != 0 || !look_beside(beside, s, k, 0))
                continue;
            for (int32_t side = 0; side < 2; side++)
                d->sample[2 * chosen + side] =
                    (sample){.at = beside[side], .contour = 2 * chosen + side};
            d->place[chosen++] = (place){m, k};
        }
    }
    return chosen;
}

/* ---- the comparison ---- */

/* Ask again about one contour whose first answer was wrong; true if another one is right. `winding`
 * left and right is then that. */
static iso_status look_again(bool *right, int32_t winding[2], findings *found, const checker *c,
                             int32_t level, place at) {
    double z = c->subject->levels->cut[level];
    *right = false;
    for (int32_t turn = 1; turn < ATTEMPTS && !*right; turn++) {
        iso_vec2 beside[2];
        if (!look_beside(beside, &c->subject->slices[at.model], at.contour, turn))
            continue;
        sample list[2] = {{.at = beside[0], .contour = 0}, {.at = beside[1], .contour = 1}};
        iso_vec3 point[2];
        sort_samples(list, 2);
        wind(list, 2, c->subject, level);
        for (int i = 0; i < 2; i++)
            point[i] = (iso_vec3){beside[i].x, beside[i].y, z + attempts[turn].up};
        ISO_TRY(iso_solid_winding(winding, NULL, c->solid, point, 2, NULL));
        found->points += 2;
        *right = list[0].winding == winding[list[0].contour] &&
                 list[1].winding == winding[list[1].contour];
    }
    return ISO_OK;
}

static void judge(findings *found, int32_t left, int32_t right) {
    found->buried += left >= 1 && right >= 1;
    found->empty += left <= 0 && right <= 0;
}

static iso_status compare(findings *found, const checker *c, const desk *d, int32_t level,
                          int32_t i) {
    const int32_t *winding = d->winding + 2 * i, *claim = d->claim + 2 * i;
    found->checked++;
    if (winding[0] == claim[0] && winding[1] == claim[1]) {
        judge(found, winding[0], winding[1]);
        return ISO_OK;
    }
    bool right;
    int32_t other[2];
    ISO_TRY(look_again(&right, other, found, c, level, d->place[i]));
    if (right) {
        judge(found, other[0], other[1]);
        return ISO_OK;
    }
    if (found->wrong++ == 0) {
        int side = winding[0] == claim[0];
        found->where = d->point[2 * i + side];
        found->claimed = claim[side];
        found->found = winding[side];
    }
    return ISO_OK;
}

static iso_status check_level(void *payload, int64_t number, int worker) {
    const checker *c = payload;
    int32_t level = (int32_t)number;
    desk *d = &c->desk[worker];
    findings *found = &c->findings[level];
    int32_t chosen = choose(d, c, level, found);
    for (int32_t i = 0; i < 2 * chosen; i++)
        d->point[i] =
            (iso_vec3){d->sample[i].at.x, d->sample[i].at.y, c->subject->levels->cut[level]};
    ISO_TRY(iso_solid_winding(d->winding, NULL, c->solid, d->point, 2 * chosen, NULL));
    found->points += 2 * chosen;
    sort_samples(d->sample, 2 * chosen);
    wind(d->sample, 2 * chosen, c->subject, level);
    for (int32_t i = 0; i < 2 * chosen; i++)
        d->claim[d->sample[i].contour] = d->sample[i].winding;
    for (int32_t i = 0; i < chosen; i++)
        ISO_TRY(compare(found, c, d, level, i));
    return ISO_OK;
}

/* ---- all levels ---- */

static int64_t contours_of(const solid_subject *subject, int32_t level) {
    int64_t sum = 0;
    for (int32_t m = 0; m < subject->count; m++)
        sum += subject->slices[m].level_first[level + 1] - subject->slices[m].level_first[level];
    return sum;
}

/* By counts alone, never by the clock. */
static int64_t share_of(const solid_subject *subject) {
    int64_t contours = 0, crossings = 0;
    if (subject->mode == ISO_CHECK_FULL)
        return 1;
    for (int32_t m = 0; m < subject->count; m++) {
        contours += subject->slices[m].contour_count;
        crossings += subject->slices[m].crossing_count;
    }
    int64_t affordable = crossings / AUTO_CROSSINGS + 1, share = contours / affordable + 1;
    return share > AUTO_SHARE ? share : AUTO_SHARE;
}

static iso_status furnish(desk *d, int64_t contours) {
    ISO_TRY(ISO_ALLOCATE(d->sample, 2 * contours));
    ISO_TRY(ISO_ALLOCATE(d->point, 2 * contours));
    ISO_TRY(ISO_ALLOCATE(d->winding, 2 * contours));
    ISO_TRY(ISO_ALLOCATE(d->claim, 2 * contours));
    return ISO_ALLOCATE(d->place, contours);
}

static iso_status check_levels(findings *sum, checker *c, iso_pool *pool) {
    int32_t levels = c->subject->levels->count, threads = pool ? iso_pool_threads(pool) : 1;
    int64_t most = 0;
    for (int32_t i = 0; i < levels; i++) {
        int64_t contours = contours_of(c->subject, i);
        most = contours > most ? contours : most;
    }
    ISO_TRY(ISO_ALLOCATE(c->findings, levels));
    memset(c->findings, 0, (size_t)levels * sizeof *c->findings);
    ISO_TRY(ISO_ALLOCATE(c->desk, threads));
    memset(c->desk, 0, (size_t)threads * sizeof *c->desk);
    for (int32_t i = 0; i < threads; i++)
        ISO_TRY(furnish(&c->desk[i], most));
    ISO_TRY(iso_parallel_for(pool, levels, check_level, c));
    for (int32_t i = 0; i < levels; i++) {
        const findings *f = &c->findings[i];
        if (sum->wrong == 0)
            sum->where = f->where, sum->claimed = f->claimed, sum->found = f->found;
        sum->contours += f->contours;
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
    }
    iso_release(c->desk);
    iso_release(c->findings);
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

static iso_status check_with(iso_report *report, const solid_subject *subject,
                             const iso_solid *solid, iso_pool *pool) {
    checker c = {.subject = subject, .solid = solid, .share = share_of(subject)};
    findings found = {0};
    shell_kinds kinds = {0};
    iso_status status = check_levels(&found, &c, pool);
    checker_free(&c, pool ? iso_pool_threads(pool) : 1);
    if (status == ISO_OK)
        status = shells_sort_by_kind(&kinds, subject, solid, pool);
    if (status != ISO_OK)
        return status;
    add_findings(&report->solid, &found, &kinds);
    return verdict(report, subject, &found);
}

static iso_status warn_unchecked(iso_report *report) {
    for (int32_t i = 0; i < report->warning_count; i++)
        if (strcmp(report->warning[i].code, "solid-unchecked") == 0)
            return ISO_OK;
    return iso_report_warn(report, "solid-unchecked",
                           "whether slices are right was not checked: %s", iso_error_message());
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
    if (!solid_check_is_due(subject->mesh, subject->count, subject->mode))
        return ISO_OK;
    iso_solid *solid;
    iso_status status = iso_solid_new(&solid, subject->mesh, subject->count);
    if (status == ISO_BAD_CONFIG && subject->mode == ISO_CHECK_AUTO)
        return warn_unchecked(report);
    if (status != ISO_OK)
        return status;
    status = check_with(report, subject, solid, pool);
    iso_solid_free(solid);
    return status;
}
