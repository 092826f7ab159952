/* Contours against winding numbers: what is right is found right, with all its shells sorted, and
 * each tampered contour is found. */
#include "check.h"

#include <stdlib.h>

#include "base/memory.h"
#include "models/shapes.h"
#include "solid/check.h"

typedef struct cut {
    iso_mesh mesh;
    iso_levels levels;
    iso_slices slices;
    iso_report report;
} cut;

static int slice(cut *c, const shape *s, double step) {
    *c = (cut){0};
    return CHECK_OK(iso_mesh_from_triangles(&c->mesh, s->triangle, s->count)) &&
           CHECK_OK(iso_levels_uniform(&c->levels, c->mesh.max.z, step, step)) &&
           CHECK_OK(iso_slice_planar(&c->slices, &c->mesh, &c->levels));
}

static void cut_free(cut *c) {
    iso_mesh_free(&c->mesh);
    iso_levels_free(&c->levels);
    iso_slices_free(&c->slices);
    iso_report_free(&c->report);
}

static iso_status look(cut *c, iso_check_solid mode, iso_pool *pool) {
    solid_subject subject = {.name = "part.stl",
                             .mesh = &c->mesh,
                             .slices = &c->slices,
                             .count = 1,
                             .levels = &c->levels,
                             .mode = mode};
    return solid_check(&c->report, &subject, pool);
}

/* All contours, none of them wrong. */
static iso_report_solid check_all(const shape *s, double step) {
    cut c;
    iso_report_solid found = {0};
    if (slice(&c, s, step) && CHECK_OK(look(&c, ISO_CHECK_FULL, NULL))) {
        found = c.report.solid;
        CHECK_EQUAL(c.slices.contour_count, found.contours);
        CHECK_EQUAL(0, found.contours_wrong);
        CHECK_EQUAL(0, c.report.warning_count);
    }
    cut_free(&c);
    return found;
}

static void test_sound_solids(void) {
    shape s = {0};
    shape_torus(&s, (shape_point){3, -4, 9}, 9, 4, 48, 24);
    iso_report_solid found = check_all(&s, 0.21);
    CHECK_EQUAL(found.contours, found.contours_checked);
    CHECK_EQUAL(0, found.contours_buried + found.contours_empty);
    CHECK_EQUAL(1, found.shells);
    CHECK_EQUAL(0, found.shells_overlapping + found.shells_nested + found.shells_hollow);
    shape_free(&s);
    shape_sphere(&s, (shape_point){0, 0, 7}, 7, 24, 48);
    found = check_all(&s, 0.1);
    CHECK_EQUAL(found.contours, found.contours_checked);
    CHECK_EQUAL(0, found.contours_buried + found.contours_empty);
    shape_free(&s);
}

/* Levels that lie in flat faces: what is just above them counts. */
static void test_faces_in_the_level(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 20, 20, 1);
    shape_box(&s, 4, 4, 1, 16, 16, 2);
    shape_box(&s, 4, 4, 2, 12, 12, 3);
    iso_report_solid found = check_all(&s, 2); /* cuts at 1 */
    CHECK_EQUAL(1, found.contours_checked);
    CHECK_EQUAL(0, found.contours_buried + found.contours_empty);
    found = check_all(&s, 4); /* at 2 */
    CHECK_EQUAL(1, found.contours_checked);
    CHECK_EQUAL(0, found.contours_buried + found.contours_empty);
    shape_free(&s);
}

static void test_overlapping_boxes(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 5, 5, 2, 15, 15, 12);
    iso_report_solid found = check_all(&s, 0.5);
    CHECK_EQUAL(2, found.shells);
    CHECK_EQUAL(2, found.shells_overlapping);
    CHECK_EQUAL(0, found.shells_nested + found.shells_hollow + found.cavities);
    shape_free(&s);
}

static void test_box_in_a_box(void) {
    for (int cavity = 0; cavity < 2; cavity++) {
        shape s = {0};
        shape_box(&s, 0, 0, 0, 10, 10, 10);
        shape_box(&s, 3, 3, 3, 7, 7, 7);
        if (cavity)
            shape_turn(&s, 12, 24);
        iso_report_solid found = check_all(&s, 0.5);
        CHECK_EQUAL(cavity ? 0 : 1, found.shells_nested);
        CHECK_EQUAL(cavity ? 1 : 0, found.cavities);
        CHECK_EQUAL(0, found.shells_overlapping + found.shells_hollow);
        CHECK_EQUAL(cavity ? 0 : 8, found.contours_buried);
        CHECK_EQUAL(0, found.contours_empty);
        shape_free(&s);
    }
}

/* A surface that passes through itself: its contours do too, and are right all the same. */
static void test_self_intersecting_shell(void) {
    shape s = {0};
    shape_torus(&s, (shape_point){0, 0, 6}, 4, 6, 48, 32); /* a spindle */
    iso_report_solid found = check_all(&s, 0.25);
    CHECK(found.contours_checked > 40);
    CHECK_EQUAL(1, found.shells_overlapping);
    shape_free(&s);
}

static void test_auto_passes_plain_meshes_by(void) {
    shape s = {0};
    cut c;
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    if (slice(&c, &s, 0.5)) {
        CHECK(!solid_check_is_due(&c.mesh, 1, ISO_CHECK_AUTO));
        CHECK(!solid_check_is_due(&c.mesh, 1, ISO_CHECK_OFF));
        CHECK(solid_check_is_due(&c.mesh, 1, ISO_CHECK_FULL));
        CHECK_OK(look(&c, ISO_CHECK_AUTO, NULL));
        CHECK_EQUAL(0, c.report.solid.points);
        iso_mesh two[2] = {c.mesh, c.mesh};
        CHECK(solid_check_is_due(two, 2, ISO_CHECK_AUTO));
        two[1].min.x += 20, two[1].max.x += 20;
        CHECK(!solid_check_is_due(two, 2, ISO_CHECK_AUTO));
    }
    cut_free(&c);
    shape_remove(&s, 5);
    if (slice(&c, &s, 0.5)) {
        CHECK(solid_check_is_due(&c.mesh, 1, ISO_CHECK_AUTO));
        CHECK(!solid_check_is_due(&c.mesh, 1, ISO_CHECK_OFF));
        CHECK_OK(look(&c, ISO_CHECK_AUTO, NULL));
        CHECK(c.report.solid.points > 0);
    }
    cut_free(&c);
    shape_free(&s);
}

static void turn_contour(iso_slices *s, int32_t contour) {
    int64_t first = s->contour_first[contour], end = s->contour_first[contour + 1];
    for (; first < --end; first++) {
        iso_vec2 swap = s->point[first];
        s->point[first] = s->point[end];
        s->point[end] = swap;
    }
}

/* Of 40 contours, each in turn runs the wrong way or lies beside its place. */
static void test_every_wrong_contour_is_found(void) {
    shape s = {0};
    shape_torus(&s, (shape_point){0, 0, 4}, 9, 4, 48, 24);
    for (int32_t i = 0;; i++) {
        cut c;
        if (!slice(&c, &s, 0.4) || i >= c.slices.contour_count) {
            CHECK(i >= 40);
            cut_free(&c);
            break;
        }
        int64_t first = c.slices.contour_first[i], end = c.slices.contour_first[i + 1];
        if (i % 2 == 0)
            turn_contour(&c.slices, i);
        for (int64_t k = first; i % 2 == 1 && k < end; k++)
            c.slices.point[k].x += 0.5;
        CHECK_STATUS(ISO_NOT_VERIFIED, look(&c, ISO_CHECK_FULL, NULL));
        int32_t level = 0;
        while (c.slices.level_first[level + 1] <= i)
            level++;
        char where[64];
        snprintf(where, sizeof where, "at z %.4f", c.levels.cut[level]);
        if (!CHECK(strstr(iso_error_message(), "part.stl") && strstr(iso_error_message(), where)))
            fprintf(stderr, "  %s\n", iso_error_message());
        cut_free(&c);
    }
    shape_free(&s);
}

/* In auto mode the job goes on with a warning. */
static void test_auto_warns_of_wrong_contours(void) {
    shape s = {0};
    cut c;
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 20, 0, 0, 30, 10, 10);
    if (slice(&c, &s, 0.2)) {
        for (int32_t i = 0; i < c.slices.contour_count; i++)
            turn_contour(&c.slices, i);
        CHECK_OK(look(&c, ISO_CHECK_AUTO, NULL));
        CHECK(c.report.solid.contours_wrong > 0);
        CHECK_EQUAL(c.report.solid.contours_wrong, c.report.solid.contours_checked);
        if (CHECK_EQUAL(1, c.report.warning_count))
            CHECK(strcmp(c.report.warning[0].code, "contours-wrong") == 0);
    }
    cut_free(&c);
    shape_free(&s);
}

/* One contour of the plate runs the wrong way. Every third level is looked at, and the last. */
static void test_auto_finds_one_wrong_contour(void) {
    shape s = {0};
    cut c;
    for (int i = 0; i < 9; i++)
        shape_sphere(&s, (shape_point){9 * (i % 3), 9 * (i / 3.0), 4}, 4, 8, 16);
    if (slice(&c, &s, 0.5) && CHECK_EQUAL(16, c.levels.count))
        for (int32_t level = 0; level < c.levels.count; level++)
            for (int32_t k = c.slices.level_first[level]; k < c.slices.level_first[level + 1];
                 k += 4) {
                int64_t wrong = c.report.solid.contours_wrong;
                turn_contour(&c.slices, k);
                CHECK_OK(look(&c, ISO_CHECK_AUTO, NULL));
                CHECK_EQUAL(level % 3 == 1 || level == 15, c.report.solid.contours_wrong > wrong);
                turn_contour(&c.slices, k);
            }
    cut_free(&c);
    shape_free(&s);
}

static iso_report_solid check_some(const shape *s, double step) {
    cut c;
    iso_report_solid found = {0};
    if (slice(&c, s, step) && CHECK_OK(look(&c, ISO_CHECK_AUTO, NULL)))
        found = c.report.solid;
    CHECK_EQUAL(0, found.contours_wrong);
    CHECK_EQUAL(0, c.report.warning_count);
    cut_free(&c);
    return found;
}

/* As with all their triangles in full mode. */
static void test_auto_sorts_shells(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 3, 3, 3, 7, 7, 7);
    iso_report_solid found = check_some(&s, 0.5);
    CHECK_EQUAL(1, found.shells_nested);
    CHECK_EQUAL(3, found.contours_buried); /* levels 7, 10 and 13 */
    CHECK_EQUAL(0, found.shells_overlapping + found.shells_hollow + found.cavities);
    shape_turn(&s, 12, 24);
    found = check_some(&s, 0.5);
    CHECK_EQUAL(1, found.cavities);
    CHECK_EQUAL(0, found.shells_overlapping + found.shells_hollow + found.shells_nested);
    shape_turn(&s, 12, 24);
    shape_box(&s, 20, 0, 0, 30, 10, 10);
    shape_sphere(&s, (shape_point){30, 5, 5}, 4.9, 12, 24);
    found = check_some(&s, 0.5);
    CHECK_EQUAL(4, found.shells);
    CHECK_EQUAL(1, found.shells_nested);
    CHECK_EQUAL(2, found.shells_overlapping);
    shape_free(&s);
}

/* A shell that is inside out, and its contours with it, bounds no material. */
static void test_hollow_shells(void) {
    shape s = {0};
    cut c;
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 20, 0, 0, 30, 10, 10);
    if (slice(&c, &s, 0.5)) {
        iso_mesh *mesh = &c.mesh;
        for (int32_t t = 12; t < 24; t++) {
            int32_t kept = mesh->origin[3 * t + 1];
            mesh->origin[3 * t + 1] = mesh->origin[3 * t + 2];
            mesh->origin[3 * t + 2] = kept;
        }
        for (int32_t i = 0; i < c.slices.contour_count; i++)
            if (c.slices.point[c.slices.contour_first[i]].x > 15)
                turn_contour(&c.slices, i);
        CHECK_OK(look(&c, ISO_CHECK_AUTO, NULL));
        CHECK_EQUAL(1, c.report.solid.shells_hollow);
        CHECK_EQUAL(0, c.report.solid.contours_wrong);
        CHECK_EQUAL(c.report.solid.contours_checked, 2 * c.report.solid.contours_empty);
        CHECK_OK(look(&c, ISO_CHECK_FULL, NULL));
        CHECK_EQUAL(2, c.report.solid.shells_hollow);
    }
    cut_free(&c);
    shape_free(&s);
}

/* A plate of many parts, some in others: the same with any number of threads. */
static void test_threads(void) {
    shape s = {0};
    for (int i = 0; i < 64; i++) {
        double x = 6.1 * (i % 8), y = 6.1 * (i / 8.0);
        shape_sphere(&s, (shape_point){x, y, 3}, 3, 8, 16);
    }
    iso_report_solid found[3];
    for (int threads = 0; threads < 3; threads++) {
        cut c;
        iso_pool *pool = NULL;
        if (threads > 0)
            CHECK_OK(iso_pool_new(&pool, 2 * threads));
        if (slice(&c, &s, 0.3))
            CHECK_OK(look(&c, threads == 2 ? ISO_CHECK_AUTO : ISO_CHECK_FULL, pool));
        found[threads] = c.report.solid;
        cut_free(&c);
        iso_pool_free(pool);
    }
    CHECK(memcmp(&found[0], &found[1], sizeof found[0]) == 0);
    CHECK_EQUAL(0, found[0].contours_wrong);
    CHECK_EQUAL(64, found[0].shells);
    CHECK_EQUAL(found[0].contours, found[2].contours);
    CHECK(found[2].points < found[0].points / 3);
    shape_free(&s);
}

static void test_random_soup_of_boxes(void) {
    uint64_t seed = 5;
    for (int run = 0; run < 20; run++) {
        shape s = {0};
        for (int i = 0; i < 12; i++) {
            double at[3], size[3];
            for (int k = 0; k < 3; k++) {
                at[k] = shape_random(&seed) % 12;
                size[k] = 1 + shape_random(&seed) % 9;
            }
            int64_t from = s.count;
            shape_box(&s, at[0], at[1], at[2], at[0] + size[0], at[1] + size[1], at[2] + size[2]);
            if (shape_random(&seed) % 4 == 0)
                shape_turn(&s, from, s.count);
        }
        check_all(&s, 1); /* cuts between faces */
        check_all(&s, 2); /* cuts in faces */
        shape_free(&s);
    }
}

static void test_no_memory(void) {
    shape s = {0};
    cut c;
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 5, 5, 2, 15, 15, 12);
    if (slice(&c, &s, 1)) {
        int64_t n = 0;
        iso_status status = ISO_NO_MEMORY;
        for (; status != ISO_OK; n++) {
            iso_fail_allocation_after(n);
            status = look(&c, ISO_CHECK_FULL, NULL);
            iso_fail_allocation_after(-1);
            CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        }
        CHECK(n > 10);
        status = ISO_NO_MEMORY;
        for (n = 0; status != ISO_OK; n++) {
            iso_fail_allocation_after(n);
            status = look(&c, ISO_CHECK_AUTO, NULL);
            iso_fail_allocation_after(-1);
            CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        }
        CHECK(n > 10);
    }
    cut_free(&c);
    shape_free(&s);
}

/* A process of its own, as modules stay open. A file that is no module counts as one missing. */
static int without_module(void) {
    char folder[] = "check-XXXXXX", path[64];
    shape s = {0};
    cut c;
    if (!CHECK(mkdtemp(folder) != NULL))
        return check_verdict();
    snprintf(path, sizeof path, "%s/isoslice-solid.so", folder);
    FILE *file = fopen(path, "w");
    CHECK(file && fclose(file) == 0);
    CHECK_EQUAL(0, setenv("ISOSLICE_MODULES", folder, 1));
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 5, 5, 2, 15, 15, 12);
    if (slice(&c, &s, 1)) {
        CHECK_OK(look(&c, ISO_CHECK_AUTO, NULL));
        CHECK_EQUAL(2, c.report.solid.shells_overlapping);
        CHECK_EQUAL(0, c.report.warning_count);
        CHECK_STATUS(ISO_BAD_CONFIG, look(&c, ISO_CHECK_FULL, NULL));
    }
    cut_free(&c);
    shape_free(&s);
    CHECK(remove(path) == 0 && remove(folder) == 0);
    return check_verdict();
}

int main(int count, char **argument) {
    if (count > 1 && strcmp(argument[1], "without") == 0)
        return without_module();
    RUN(test_sound_solids);
    RUN(test_faces_in_the_level);
    RUN(test_overlapping_boxes);
    RUN(test_box_in_a_box);
    RUN(test_self_intersecting_shell);
    RUN(test_auto_passes_plain_meshes_by);
    RUN(test_every_wrong_contour_is_found);
    RUN(test_auto_warns_of_wrong_contours);
    RUN(test_auto_finds_one_wrong_contour);
    RUN(test_auto_sorts_shells);
    RUN(test_hollow_shells);
    RUN(test_threads);
    RUN(test_random_soup_of_boxes);
    RUN(test_no_memory);
    return check_verdict();
}
