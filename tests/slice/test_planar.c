/* Slices against closed forms and against the cross-section found another way. */
#include "check.h"

#include "base/memory.h"
#include "models/shapes.h"

#include <isoslice/slice.h>

static double contour_area(const iso_slices *s, int32_t contour) {
    double sum = 0;
    int64_t first = s->contour_first[contour], end = s->contour_first[contour + 1];
    iso_vec2 base = s->point[first];
    for (int64_t i = first; i < end; i++) {
        iso_vec2 p = s->point[i], q = s->point[i + 1 < end ? i + 1 : first];
        sum += (p.x - base.x) * (q.y - base.y) - (p.y - base.y) * (q.x - base.x);
    }
    return sum / 2;
}

static double level_area(const iso_slices *s, int32_t level) {
    double sum = 0;
    for (int32_t c = s->level_first[level]; c < s->level_first[level + 1]; c++)
        sum += contour_area(s, c);
    return sum;
}

/* Green's theorem over the triangles, each cut by itself: no opposites, no orbits. */
static double section_area(const iso_mesh *mesh, double z, double *length, int64_t *segments) {
    double sum = 0;
    *length = 0, *segments = 0;
    iso_vec3 base = mesh->min;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        double x[2], y[2];
        int found = 0, enters = 0;
        for (int k = 0; k < 3; k++) {
            iso_vec3 p = mesh->position[mesh->origin[3 * t + k]];
            iso_vec3 q = mesh->position[mesh->origin[3 * t + (k + 1) % 3]];
            if ((p.z <= z) == (q.z <= z))
                continue;
            double u = (z - p.z) / (q.z - p.z);
            if (found == 0)
                enters = p.z > z; /* down first: this is where the segment starts */
            x[found] = p.x - base.x + u * (q.x - p.x);
            y[found++] = p.y - base.y + u * (q.y - p.y);
        }
        if (found < 2)
            continue;
        ++*segments;
        *length += sqrt((x[1] - x[0]) * (x[1] - x[0]) + (y[1] - y[0]) * (y[1] - y[0]));
        double twice = x[0] * y[1] - y[0] * x[1];
        sum += enters ? twice : -twice;
    }
    return sum / 2;
}

/* Structure, areas, lengths and numbers of crossings of all levels. */
static void check_slices(const iso_slices *s, const iso_mesh *mesh, const iso_levels *levels) {
    CHECK_OK(iso_slices_validate(s));
    CHECK_EQUAL(levels->count, s->level_count);
    for (int32_t i = 0; i < s->level_count; i++) {
        double length, found = 0;
        int64_t segments;
        double area = section_area(mesh, levels->cut[i], &length, &segments);
        double scale = (mesh->max.x - mesh->min.x) * (mesh->max.y - mesh->min.y);
        CHECK_NEAR(area, level_area(s, i), 1e-9 * (scale + 1));
        int64_t first = s->contour_first[s->level_first[i]];
        int64_t end = s->contour_first[s->level_first[i + 1]];
        CHECK_EQUAL(segments, end - first);
        for (int32_t c = s->level_first[i]; c < s->level_first[i + 1]; c++)
            for (int64_t q = s->contour_first[c]; q < s->contour_first[c + 1]; q++) {
                int64_t next = q + 1 < s->contour_first[c + 1] ? q + 1 : s->contour_first[c];
                found += hypot(s->point[next].x - s->point[q].x, s->point[next].y - s->point[q].y);
            }
        /* orbits that jumped would be longer than the segments of the triangles */
        CHECK_NEAR(length, found, 1e-8 * (1 + length));
    }
}

static int slice(iso_slices *slices, iso_levels *levels, iso_mesh *mesh, const shape *s,
                 double height) {
    if (!CHECK_OK(iso_mesh_from_triangles(mesh, s->triangle, s->count)))
        return 0;
    iso_mesh_translate(mesh, (iso_vec3){0, 0, -mesh->min.z});
    if (!CHECK_OK(iso_levels_uniform(levels, mesh->max.z, height, height)))
        return 0;
    return CHECK_OK(iso_slice_planar(slices, mesh, levels));
}

static void release(iso_slices *slices, iso_levels *levels, iso_mesh *mesh) {
    iso_slices_free(slices);
    iso_levels_free(levels);
    iso_mesh_free(mesh);
}

/* Levels anywhere, in any spacing. */
static iso_levels levels_at(double *cut, int32_t count) {
    return (iso_levels){.count = count, .cut = cut};
}

static void test_cube(void) {
    shape s = {0};
    iso_slices slices;
    iso_levels levels;
    iso_mesh mesh;
    shape_box(&s, 5, 5, 0, 25, 35, 20);
    if (slice(&slices, &levels, &mesh, &s, 0.2)) {
        CHECK_EQUAL(100, slices.level_count);
        CHECK_EQUAL(100, slices.contour_count);
        for (int32_t i = 0; i < 100; i++)
            CHECK_NEAR(600, level_area(&slices, i), 1e-10);
        for (int64_t q = 0; q < slices.crossing_count; q++) {
            iso_vec2 p = slices.point[q];
            CHECK(p.x == 5 || p.x == 25 || p.y == 5 || p.y == 35);
        }
        check_slices(&slices, &mesh, &levels);
        release(&slices, &levels, &mesh);
    }
    shape_free(&s);
}

static void test_tetrahedron(void) {
    shape s = {0};
    iso_slices slices;
    iso_levels levels;
    iso_mesh mesh;
    shape_tetrahedron(&s, 6);
    if (slice(&slices, &levels, &mesh, &s, 0.1)) {
        CHECK_EQUAL(60, slices.contour_count);
        for (int32_t i = 0; i < slices.level_count; i++) {
            double side = 6 - levels.cut[i];
            CHECK_NEAR(side * side / 2, level_area(&slices, i), 1e-12);
            CHECK_EQUAL(3, slices.contour_first[i + 1] - slices.contour_first[i]);
        }
        release(&slices, &levels, &mesh);
    }
    shape_free(&s);
}

static void test_torus(void) {
    shape s = {0};
    iso_slices slices;
    iso_levels levels;
    iso_mesh mesh;
    shape_torus(&s, (shape_point){3, 4, 0}, 30, 10, 200, 100);
    if (slice(&slices, &levels, &mesh, &s, 0.3)) {
        CHECK_EQUAL(2 * slices.level_count, slices.contour_count);
        double volume = 0;
        for (int32_t i = 0; i < slices.level_count; i++) {
            /* between the circles 30 +- w: 120 pi w */
            double up = levels.cut[i] - 10, w = sqrt(100 - up * up);
            if (fabs(up) < 9.5) /* beyond, the facets show */
                CHECK_NEAR(120 * SHAPE_PI * w, level_area(&slices, i), 5);
            int32_t c = slices.level_first[i];
            double a = contour_area(&slices, c), b = contour_area(&slices, c + 1);
            CHECK((a > 0) != (b > 0)); /* the hole runs clockwise */
            volume += level_area(&slices, i) * levels.height[i];
        }
        CHECK_NEAR(iso_mesh_volume_between(&mesh, 0, levels.top[levels.count - 1]), volume,
                   0.003 * volume);
        check_slices(&slices, &mesh, &levels);
        release(&slices, &levels, &mesh);
    }
    shape_free(&s);
}

static void test_sphere_in_a_sphere(void) {
    shape s = {0};
    iso_slices slices;
    iso_levels levels;
    iso_mesh mesh;
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, 100, 200);
    int64_t outer = s.count;
    shape_sphere(&s, (shape_point){1, 0, 0}, 6, 60, 100);
    shape_turn(&s, outer, s.count);
    shape_box(&s, 20, 0, -10, 24, 4, -2); /* and a part beside it */
    if (slice(&slices, &levels, &mesh, &s, 0.25)) {
        for (int32_t i = 0; i < slices.level_count; i++) {
            double up = levels.cut[i] - 10, wanted = SHAPE_PI * (100 - up * up);
            if (fabs(up) < 6)
                wanted -= SHAPE_PI * (36 - up * up);
            if (levels.cut[i] < 8)
                wanted += 16;
            CHECK_NEAR(wanted, level_area(&slices, i), 0.5);
            CHECK_EQUAL(1 + (fabs(up) < 6) + (levels.cut[i] < 8),
                        slices.level_first[i + 1] - slices.level_first[i]);
        }
        check_slices(&slices, &mesh, &levels);
        release(&slices, &levels, &mesh);
    }
    shape_free(&s);
}

/* Levels through faces, edges and corners: the slice just above. */
static void test_cells_cut_at_their_faces(void) {
    uint64_t state = 17;
    for (int round = 0; round < 100; round++) {
        enum { N = 5 };
        uint8_t filled[N * N * N];
        int layer[N + 1] = {0};
        for (int i = 0; i < N * N * N; i++)
            layer[i / (N * N)] += filled[i] = shape_random(&state) % 10 < 1 + (uint32_t)round % 9;
        shape s = {0};
        shape_cells(&s, filled, N, N, N);
        shape_shuffle(&s, (uint64_t)round);
        iso_mesh mesh;
        if (s.count && CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
            double cut[] = {-1, 0, 0.5, 1, 1, 1.25, 2, 3, 4, 4.999, 5, 6};
            iso_levels levels = levels_at(cut, 12);
            iso_slices slices;
            if (CHECK_OK(iso_slice_planar(&slices, &mesh, &levels))) {
                for (int i = 0; i < 12; i++)
                    CHECK_NEAR(cut[i] < 0 || cut[i] >= 5 ? 0 : layer[(int)cut[i]],
                               level_area(&slices, i), 1e-10);
                check_slices(&slices, &mesh, &levels);
                iso_slices_free(&slices);
            }
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

/* Corners at random integer heights, levels at integers: nothing but ties. */
static void test_random_heights_on_levels(void) {
    uint64_t state = 23;
    for (int round = 0; round < 200; round++) {
        enum { N = 9, M = 7 };
        shape s = {0};
        shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, N, M);
        iso_mesh mesh;
        CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count));
        uint32_t heights = 2 + (uint32_t)round % 4;
        mesh.min = (iso_vec3){-9, -9, 0}, mesh.max = (iso_vec3){9, 9, 9};
        for (int32_t v = 0; v < mesh.vertex_count; v++) {
            mesh.position[v].x = (double)(shape_random(&state) % 19) - 9;
            mesh.position[v].y = (double)(shape_random(&state) % 19) - 9;
            mesh.position[v].z = shape_random(&state) % heights;
        }
        double cut[] = {0, 0.5, 1, 1.5, 2, 3, 3.25, 4};
        iso_levels levels = levels_at(cut, 8);
        iso_slices slices;
        if (CHECK_OK(iso_slice_planar(&slices, &mesh, &levels))) {
            check_slices(&slices, &mesh, &levels);
            iso_slices_free(&slices);
        }
        iso_mesh_free(&mesh);
        shape_free(&s);
    }
}

/* Uneven levels, many to a triangle and far apart, beyond both ends. */
static void test_uneven_levels(void) {
    shape s = {0};
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, 12, 16);
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
        double cut[400];
        uint64_t state = 3;
        double z = -30;
        for (int i = 0; i < 400; i++) {
            cut[i] = z;
            z += i % 100 == 99 ? 9 : (shape_random(&state) % 100) * 1e-3;
        }
        iso_levels levels = levels_at(cut, 400);
        iso_slices slices;
        if (CHECK_OK(iso_slice_planar(&slices, &mesh, &levels))) {
            CHECK(slices.contour_count > 50);
            check_slices(&slices, &mesh, &levels);
            iso_slices_free(&slices);
        }
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_order_of_triangles_does_not_matter(void) {
    double area[3][200];
    for (uint64_t round = 0; round < 3; round++) {
        shape s = {0};
        iso_slices slices;
        iso_levels levels;
        iso_mesh mesh;
        shape_torus(&s, (shape_point){3, 4, 0}, 30, 10, 40, 32);
        if (round)
            shape_shuffle(&s, round);
        if (slice(&slices, &levels, &mesh, &s, 0.2)) {
            CHECK_EQUAL(100, slices.level_count);
            for (int32_t i = 0; i < 100; i++)
                area[round][i] = level_area(&slices, i);
            release(&slices, &levels, &mesh);
        }
        shape_free(&s);
    }
    for (int i = 0; i < 100; i++) {
        CHECK_NEAR(area[0][i], area[1][i], 1e-9 * area[0][i]);
        CHECK_NEAR(area[0][i], area[2][i], 1e-9 * area[0][i]);
    }
}

/* Contours start at the lowest dart, and the same mesh gives the same bytes. */
static void test_canonical_order(void) {
    shape s = {0};
    iso_slices a, b;
    iso_levels levels;
    iso_mesh mesh;
    shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, 40, 32);
    if (slice(&a, &levels, &mesh, &s, 0.2) && CHECK_OK(iso_slice_planar(&b, &mesh, &levels))) {
        CHECK_EQUAL(a.crossing_count, b.crossing_count);
        CHECK(memcmp(a.point, b.point, (size_t)a.crossing_count * sizeof *a.point) == 0);
        for (int32_t i = 0; i < a.level_count; i++) {
            double z = levels.cut[i];
            int32_t dart = 0; /* the level's lowest upward dart */
            while (!(mesh.position[mesh.origin[dart]].z <= z &&
                     mesh.position[mesh.origin[iso_mesh_alpha(dart)]].z > z))
                dart++;
            iso_vec3 p = mesh.position[mesh.origin[dart]];
            iso_vec3 q = mesh.position[mesh.origin[iso_mesh_alpha(dart)]];
            double t = (z - p.z) / (q.z - p.z);
            iso_vec2 first = a.point[a.contour_first[a.level_first[i]]];
            CHECK(first.x == p.x + t * (q.x - p.x) && first.y == p.y + t * (q.y - p.y));
        }
        iso_slices_free(&b);
        release(&a, &levels, &mesh);
    }
    shape_free(&s);
}

static void test_no_levels(void) {
    shape s = {0};
    iso_mesh mesh;
    iso_slices slices;
    shape_box(&s, 0, 0, 0, 1, 1, 1);
    if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
        iso_levels levels = {0};
        if (CHECK_OK(iso_slice_planar(&slices, &mesh, &levels))) {
            CHECK_EQUAL(0, slices.contour_count);
            CHECK_OK(iso_slices_validate(&slices));
            iso_slices_free(&slices);
        }
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* Whatever was mended slices into closed contours. */
static void test_mended_soups(void) {
    uint64_t state = 31;
    for (int round = 0; round < 1500; round++) {
        shape s = {0};
        for (int i = 1 + (int)(shape_random(&state) % 8); i > 0; i--) {
            shape_point p[4];
            for (int k = 0; k < 4; k++) {
                p[k].x = shape_random(&state) % 4;
                p[k].y = shape_random(&state) % 4;
                p[k].z = shape_random(&state) % 4;
            }
            shape_add(&s, p[0], p[2], p[1]);
            shape_add(&s, p[0], p[1], p[3]);
            shape_add(&s, p[1], p[2], p[3]);
            shape_add(&s, p[2], p[0], p[3]);
        }
        iso_mesh mesh;
        if (iso_mesh_from_triangles(&mesh, s.triangle, s.count) == ISO_OK) {
            double cut[] = {0, 0.3, 1, 1.5, 2, 2.2, 3};
            iso_levels levels = levels_at(cut, 7);
            iso_slices slices;
            if (CHECK_OK(iso_slice_planar(&slices, &mesh, &levels))) {
                check_slices(&slices, &mesh, &levels);
                iso_slices_free(&slices);
            }
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

static void test_allocation_failures(void) {
    shape s = {0};
    iso_slices slices;
    iso_levels levels;
    iso_mesh mesh;
    shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, 40, 32);
    if (slice(&slices, &levels, &mesh, &s, 0.2)) {
        iso_slices_free(&slices);
        for (int64_t n = 0;; n++) {
            iso_fail_allocation_after(n);
            iso_status status = iso_slice_planar(&slices, &mesh, &levels);
            iso_fail_allocation_after(-1);
            if (status == ISO_OK) {
                CHECK(n >= 7);
                break;
            }
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK(slices.point == NULL);
        }
        release(&slices, &levels, &mesh);
    }
    shape_free(&s);
}

/* A box and a taller one, joined: areas add up level by level. */
static void test_joined_models(void) {
    shape box[2] = {{0}, {0}};
    iso_mesh mesh[2];
    iso_levels levels;
    iso_slices each[2], all;
    shape_box(&box[0], 0, 0, 0, 2, 3, 4);
    shape_box(&box[1], 1, 1, 0, 6, 5, 9);
    for (int i = 0; i < 2; i++)
        CHECK_OK(iso_mesh_from_triangles(&mesh[i], box[i].triangle, box[i].count));
    CHECK_OK(iso_levels_uniform(&levels, 9, 0.5, 0.5));
    for (int i = 0; i < 2; i++)
        CHECK_OK(iso_slice_planar(&each[i], &mesh[i], &levels));
    CHECK_OK(iso_slices_join(&all, each, 2));
    CHECK_OK(iso_slices_validate(&all));
    CHECK_EQUAL(18, all.level_count);
    CHECK_EQUAL(8 + 18, all.contour_count);
    for (int32_t l = 0; l < 18; l++) {
        CHECK_NEAR(l < 8 ? 26 : 20, level_area(&all, l), 1e-12);
        CHECK_NEAR(l < 8 ? 6 : 20, contour_area(&all, all.level_first[l]), 1e-12);
    }
    iso_slices_free(&all);
    for (int64_t n = 0; n < 3; n++) {
        iso_fail_allocation_after(n);
        CHECK_STATUS(ISO_NO_MEMORY, iso_slices_join(&all, each, 2));
        iso_fail_allocation_after(-1);
        CHECK(all.point == NULL && all.level_first == NULL);
    }
    each[1].level_count--;
    CHECK_STATUS(ISO_USAGE, iso_slices_join(&all, each, 2));
    each[1].level_count++;
    CHECK_OK(iso_slices_join(&all, NULL, 0));
    CHECK_OK(iso_slices_validate(&all));
    iso_slices_free(&all);
    iso_levels_free(&levels);
    for (int i = 0; i < 2; i++) {
        iso_slices_free(&each[i]);
        iso_mesh_free(&mesh[i]);
        shape_free(&box[i]);
    }
}

int main(void) {
    RUN(test_cube);
    RUN(test_tetrahedron);
    RUN(test_torus);
    RUN(test_sphere_in_a_sphere);
    RUN(test_cells_cut_at_their_faces);
    RUN(test_random_heights_on_levels);
    RUN(test_uneven_levels);
    RUN(test_order_of_triangles_does_not_matter);
    RUN(test_canonical_order);
    RUN(test_no_levels);
    RUN(test_mended_soups);
    RUN(test_joined_models);
    RUN(test_allocation_failures);
    return check_verdict();
}
