/* Each defect as docs/models.md describes it: mended and counted, or refused. */
#include "check.h"

#include "base/memory.h"
#include "models/shapes.h"

#include <isoslice/mesh.h>

/* Read the shape, check the double-link and its volume; 1 if there is a mesh. */
static int mend(iso_mesh *mesh, const shape *s, double volume) {
    if (!CHECK_OK(iso_mesh_from_triangles(mesh, s->triangle, s->count)))
        return 0;
    CHECK_OK(iso_mesh_validate(mesh));
    CHECK_NEAR(volume, iso_mesh_volume(mesh), 1e-7 * (1 + fabs(volume)));
    return 1;
}

static void refuse(const shape *s, const char *part1, const char *part2) {
    iso_mesh mesh;
    if (!CHECK_STATUS(ISO_UNSLICEABLE, iso_mesh_from_triangles(&mesh, s->triangle, s->count))) {
        iso_mesh_free(&mesh);
        return;
    }
    if (!CHECK(strstr(iso_error_message(), part1) && strstr(iso_error_message(), part2)))
        fprintf(stderr, "  \"%s\" lacks \"%s\" or \"%s\"\n", iso_error_message(), part1, part2);
}

static shape cube(double size) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, size, size, size);
    return s;
}

static void test_sound_meshes_are_left_alone(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 20, 20, 20);
    shape_torus(&s, (shape_point){100, 0, 0}, 30, 10, 24, 16);
    shape_tetrahedron(&s, -3); /* mirrored three times over: inside out */
    shape_turn(&s, s.count - 4, s.count);
    shape_move(&s, s.count - 4, s.count, -10, 0, 0);
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
        iso_mesh_defects wanted = {.triangles_read = s.count, .shells = 3};
        CHECK(memcmp(&wanted, &mesh.defects, sizeof wanted) == 0);
        for (int64_t i = 0; i < 3 * s.count; i++) {
            iso_vec3 p = mesh.position[mesh.origin[i]];
            CHECK(p.x == s.triangle[3 * i] && p.y == s.triangle[3 * i + 1] &&
                  p.z == s.triangle[3 * i + 2]);
        }
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_cube_less_any_triangle(void) {
    for (int t = 0; t < 12; t++) {
        shape s = cube(20);
        shape_remove(&s, t);
        iso_mesh mesh;
        if (mend(&mesh, &s, 8000)) {
            CHECK_EQUAL(12, mesh.triangle_count);
            CHECK_EQUAL(8, mesh.vertex_count);
            CHECK_EQUAL(3, mesh.defects.bad_edges);
            CHECK_EQUAL(1, mesh.defects.holes_closed);
            CHECK_NEAR(200, mesh.defects.cap_area, 1e-12);
            CHECK_NEAR(8000, iso_mesh_volume(&mesh), 0);
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

static void test_box_without_lid_is_refused(void) {
    shape s = cube(20);
    shape_remove(&s, 2);
    shape_remove(&s, 2);
    refuse(&s, "4 open edges", "20 %");
    shape_free(&s);
}

static void test_hemisphere_is_refused(void) {
    shape s = {0};
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, 20, 40);
    for (int64_t t = s.count - 1; t >= 0; t--)
        if (s.triangle[9 * t + 2] + s.triangle[9 * t + 5] + s.triangle[9 * t + 8] > 0)
            shape_remove(&s, t);
    refuse(&s, "40 open edges", "% to its area");
    shape_free(&s);
}

static void test_sheets_are_refused(void) {
    shape s = {0};
    shape_quad(&s, (shape_point){0, 0, 0}, (shape_point){9, 0, 0}, (shape_point){9, 9, 0},
               (shape_point){0, 9, 0});
    refuse(&s, "4 open edges", "100 %");
    shape_remove(&s, 1);
    refuse(&s, "3 open edges", "100 %");
    shape_box(&s, 20, 20, 20, 30, 30, 30); /* a sound part beside it makes no difference */
    refuse(&s, "3 open edges", "100 %");
    shape_free(&s);
}

static void test_moebius_strip_is_refused(void) {
    shape s = {0};
    enum { N = 40 };
    shape_point p[N + 1][2];
    for (int i = 0; i <= N; i++)
        for (int k = 0; k < 2; k++) {
            double u = 2 * SHAPE_PI * i / N, across = k ? 3 : -3;
            double far = 20 + across * cos(u / 2);
            p[i][k] = (shape_point){far * cos(u), far * sin(u), across * sin(u / 2)};
        }
    p[N][0] = p[0][1];
    p[N][1] = p[0][0];
    for (int i = 0; i < N; i++)
        shape_quad(&s, p[i][0], p[i + 1][0], p[i + 1][1], p[i][1]);
    refuse(&s, "one side", "Moebius");
    shape_free(&s);
}

static void test_long_tube_is_capped(void) {
    enum { N = 32 };
    shape s = {0};
    double area = 0;
    for (int i = 0; i < N; i++) {
        double u = 2 * SHAPE_PI * i / N, w = 2 * SHAPE_PI * ((i + 1) % N) / N;
        float ux = (float)cos(u), uy = (float)sin(u), wx = (float)cos(w), wy = (float)sin(w);
        shape_quad(&s, (shape_point){ux, uy, 0}, (shape_point){wx, wy, 0},
                   (shape_point){wx, wy, 50}, (shape_point){ux, uy, 50});
        area += 0.5 * ((double)ux * wy - (double)wx * uy);
    }
    iso_mesh mesh;
    if (mend(&mesh, &s, 50 * area)) {
        CHECK_EQUAL(2, mesh.defects.holes_closed);
        CHECK_EQUAL(64, mesh.defects.bad_edges);
        CHECK_NEAR(2 * area, mesh.defects.cap_area, 1e-6);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* Two holes that touch in a corner are two holes. */
static void test_holes_that_share_a_corner(void) {
    uint8_t block[16 * 16];
    memset(block, 1, sizeof block);
    shape s = {0};
    shape_cells(&s, block, 16, 16, 1);
    int removed = 0;
    for (int64_t t = s.count - 1; t >= 0; t--) {
        const float *f = s.triangle + 9 * t;
        if (f[2] != 1 || f[5] != 1 || f[8] != 1)
            continue;
        double x = (f[0] + f[3] + f[6]) / 3, y = (f[1] + f[4] + f[7]) / 3;
        int first = x > 3 && x < 4 && y > 3 && y<4, second = x> 4 && x < 5 && y > 4 && y < 5;
        int third = x > 5 && x < 6 && y > 3 && y < 4;
        if (first || second || third) {
            shape_remove(&s, t);
            removed++;
        }
    }
    CHECK_EQUAL(6, removed);
    iso_mesh mesh;
    if (mend(&mesh, &s, 256)) {
        CHECK_EQUAL(3, mesh.defects.holes_closed);
        CHECK_EQUAL(12, mesh.defects.bad_edges);
        CHECK_NEAR(3, mesh.defects.cap_area, 1e-12);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_torus_less_a_twentieth(void) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        shape s = {0};
        shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, 60, 40);
        iso_mesh whole, mesh;
        if (!CHECK_OK(iso_mesh_from_triangles(&whole, s.triangle, s.count)))
            return;
        uint64_t state = seed;
        for (int64_t t = s.count - 1; t >= 0; t--)
            if (shape_random(&state) % 20 == 0)
                shape_remove(&s, t);
        shape_shuffle(&s, seed);
        if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
            CHECK_OK(iso_mesh_validate(&mesh));
            double volume = iso_mesh_volume(&whole);
            CHECK_NEAR(volume, iso_mesh_volume(&mesh), 0.002 * volume);
            CHECK(mesh.defects.holes_closed > 100);
            iso_mesh_free(&mesh);
        }
        iso_mesh_free(&whole);
        shape_free(&s);
    }
}

static void test_degenerate_triangles_are_dropped(void) {
    shape s = cube(20);
    shape_add(&s, (shape_point){0, 0, 0}, (shape_point){0, 0, 0}, (shape_point){20, 0, 0});
    shape_add(&s, (shape_point){50, 0, 0}, (shape_point){60, 0, 0}, (shape_point){50, -0.0, 0});
    iso_mesh mesh;
    if (mend(&mesh, &s, 8000)) {
        CHECK_EQUAL(2, mesh.defects.degenerate);
        CHECK_EQUAL(0, mesh.defects.bad_edges);
        CHECK_EQUAL(12, mesh.triangle_count);
        CHECK_EQUAL(8, mesh.vertex_count); /* those of the dropped triangle are gone */
        CHECK_NEAR(20, mesh.max.x, 0);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
    shape_add(&s, (shape_point){0, 0, 0}, (shape_point){0, 0, 0}, (shape_point){20, 0, 0});
    refuse(&s, "nothing is left of 1", "1 have no area");
    shape_free(&s);
}

static void test_duplicates_are_dropped(void) {
    shape s = cube(20);
    shape_repeat(&s, 3);
    shape_repeat(&s, 3);
    shape_repeat(&s, 7);
    iso_mesh mesh;
    if (mend(&mesh, &s, 8000)) {
        CHECK_EQUAL(3, mesh.defects.duplicate);
        CHECK_EQUAL(6, mesh.defects.bad_edges);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_shell_that_occurs_twice(void) {
    shape s = cube(20);
    for (int t = 0; t < 12; t++)
        shape_repeat(&s, t);
    shape_shuffle(&s, 3);
    iso_mesh mesh;
    if (mend(&mesh, &s, 8000)) {
        CHECK_EQUAL(12, mesh.defects.duplicate);
        CHECK_EQUAL(1, mesh.defects.shells);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* Three tetrahedra stand on the two sides of one triangle: it occurs twice one way and once the
 * other, every edge is balanced, and dropping the duplicate would tear the surface open. */
static void test_duplicates_that_balance_stay(void) {
    shape s = {0};
    shape_point a = {0, 0, 0}, b = {9, 0, 0}, c = {0, 9, 0};
    shape_point apex[3] = {{1, 1, 5}, {2, 2, 7}, {1, 1, -5}};
    for (int i = 0; i < 3; i++) {
        shape_point x = i < 2 ? a : b, y = i < 2 ? b : a;
        shape_add(&s, x, c, y);
        shape_add(&s, x, y, apex[i]);
        shape_add(&s, y, c, apex[i]);
        shape_add(&s, c, x, apex[i]);
    }
    iso_mesh mesh;
    if (mend(&mesh, &s, 81 / 6.0 * (5 + 7 + 5))) {
        CHECK_EQUAL(2, mesh.defects.cancelled);
        CHECK_EQUAL(0, mesh.defects.duplicate);
        CHECK_EQUAL(0, mesh.defects.holes_closed);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_coincident_faces_cancel(void) {
    shape s = cube(20);
    shape_box(&s, 0, 0, 20, 20, 20, 30);
    iso_mesh mesh;
    if (mend(&mesh, &s, 12000)) {
        CHECK_EQUAL(4, mesh.defects.cancelled);
        CHECK_EQUAL(1, mesh.defects.shells);
        CHECK_EQUAL(5, mesh.defects.bad_edges);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_triangles_back_to_back(void) {
    shape s = cube(20);
    for (int i = 0; i < 2; i++)
        shape_add(&s, (shape_point){30, 0, 50}, (shape_point){30 + 9 * i, 9 - 9 * i, 50},
                  (shape_point){30 + 9 * (1 - i), 9 * i, 50});
    iso_mesh mesh;
    if (mend(&mesh, &s, 8000)) {
        CHECK_EQUAL(2, mesh.defects.cancelled);
        CHECK_EQUAL(1, mesh.defects.shells);
        CHECK_NEAR(20, mesh.max.z, 0);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
    for (int i = 0; i < 2; i++)
        shape_add(&s, (shape_point){30, 0, 50}, (shape_point){30 + 9 * i, 9 - 9 * i, 50},
                  (shape_point){30 + 9 * (1 - i), 9 * i, 50});
    refuse(&s, "nothing is left of 2", "2 lie back to back");
    shape_free(&s);
}

/* Four triangles on an edge: paired across material, the boxes stay two. */
static void test_boxes_that_share_an_edge(void) {
    for (int inverted = 0; inverted < 4; inverted++) {
        shape s = cube(20);
        shape_box(&s, 20, 20, 0, 40, 40, 20);
        if (inverted & 1)
            shape_turn(&s, 0, 12);
        if (inverted & 2)
            shape_turn(&s, 12, 24);
        iso_mesh mesh;
        if (mend(&mesh, &s, 16000)) {
            CHECK_EQUAL(1, mesh.defects.bad_edges);
            /* where both are inside out their material, all of space, is one */
            static const int shells[] = {2, 2, 2, 1}, turned[] = {0, 1, 1, 1};
            CHECK_EQUAL(shells[inverted], mesh.defects.shells);
            CHECK_EQUAL(turned[inverted], mesh.defects.inverted_shells);
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

/* Whichever of the two is inside out, and whichever way their common face is cut in triangles. */
static void test_boxes_that_share_a_face(void) {
    for (int round = 0; round < 32; round++) {
        int inverted = round & 3, diagonal = round >> 2 & 1, seed = round >> 3;
        shape s = cube(20);
        if (diagonal) { /* the upper box's floor, the other way */
            shape upper = {0};
            shape_box(&upper, 0, 0, 20, 20, 20, 30);
            shape_quad(&s, (shape_point){0, 20, 20}, (shape_point){20, 20, 20},
                       (shape_point){20, 0, 20}, (shape_point){0, 0, 20});
            for (int t = 2; t < 12; t++) {
                const float *f = upper.triangle + 9 * t;
                shape_add(&s, (shape_point){f[0], f[1], f[2]}, (shape_point){f[3], f[4], f[5]},
                          (shape_point){f[6], f[7], f[8]});
            }
            shape_free(&upper);
        } else {
            shape_box(&s, 0, 0, 20, 20, 20, 30);
        }
        if (inverted & 1)
            shape_turn(&s, 0, 12);
        if (inverted & 2)
            shape_turn(&s, 12, 24);
        if (seed)
            shape_shuffle(&s, (uint64_t)seed);
        iso_mesh mesh;
        if (mend(&mesh, &s, 12000)) {
            CHECK(mesh.defects.inverted_shells == (inverted > 0));
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

/* Solids of random cells meet along edges and in corners in every way there is. */
static void test_random_cells(void) {
    uint64_t state = 5;
    for (int round = 0; round < 150; round++) {
        enum { N = 5 };
        uint8_t filled[N * N * N];
        int count = 0, density = 1 + round % 9;
        for (int i = 0; i < N * N * N; i++)
            count += filled[i] = shape_random(&state) % 10 < (uint32_t)density;
        if (count == 0)
            continue;
        shape s = {0};
        shape_cells(&s, filled, N, N, N);
        shape_shuffle(&s, (uint64_t)round);
        iso_mesh mesh;
        if (mend(&mesh, &s, count)) {
            CHECK_EQUAL(s.count, mesh.triangle_count);
            CHECK_EQUAL(0, mesh.defects.inverted_shells);
            CHECK_EQUAL(0, mesh.defects.flipped_triangles);
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

static void test_turned_triangles_are_turned_back(void) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        shape s = {0};
        shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, 12, 8);
        iso_mesh whole, mesh;
        if (!CHECK_OK(iso_mesh_from_triangles(&whole, s.triangle, s.count)))
            return;
        uint64_t state = seed;
        int64_t turned = 0;
        for (int64_t t = 0; t < s.count; t++)
            if (shape_random(&state) % 30 < seed) {
                shape_turn(&s, t, t + 1);
                turned++;
            }
        int64_t minority = turned <= s.count / 2 ? turned : s.count - turned;
        if (mend(&mesh, &s, iso_mesh_volume(&whole))) {
            CHECK_EQUAL(minority, mesh.defects.flipped_triangles);
            CHECK_EQUAL(turned > s.count / 2, mesh.defects.inverted_shells);
            iso_mesh_free(&mesh);
        }
        iso_mesh_free(&whole);
        shape_free(&s);
    }
}

/* Bit i turns box i of four within one another; all of them are judged by where they lie. */
static void check_nest(int boxes, int turned, double volume, int inverted) {
    shape s = {0};
    for (int i = 0; i < boxes; i++) {
        shape_box(&s, i, i, i, 20 - i, 20 - i, 20 - i);
        if (turned >> i & 1)
            shape_turn(&s, 12 * i, 12 * i + 12);
    }
    iso_mesh mesh;
    if (mend(&mesh, &s, volume))
        CHECK_EQUAL(inverted, mesh.defects.inverted_shells);
    iso_mesh_free(&mesh);
    shape_free(&s);
}

static void test_cavities_stay(void) {
    double v0 = 8000, v1 = 18 * 18 * 18, v2 = 16 * 16 * 16, v3 = 14 * 14 * 14;
    check_nest(1, 1, v0, 1);
    check_nest(2, 2, v0 - v1, 0);      /* a cavity */
    check_nest(2, 1, v0 - v1, 2);      /* the same, inside out */
    check_nest(2, 3, v0 - v1, 1);      /* the outer one alone is inside out */
    check_nest(3, 2, v0 - v1 + v2, 0); /* an island in the cavity */
    check_nest(3, 6, v0 - v1 + v2, 1); /* inside out in the void */
    check_nest(3, 5, v0 - v1 + v2, 3); /* all of it inside out */
    check_nest(4, 10, v0 - v1 + v2 - v3, 0);
    check_nest(4, 5, v0 - v1 + v2 - v3, 4);
    check_nest(2, 0, v0 + v1, 0); /* material within material is the regions' business */
}

static void test_many_shells(void) {
    shape s = {0};
    for (int i = 0; i < 100; i++) {
        shape_box(&s, 3 * (i % 10), 3 * (i / 10), 0, 3 * (i % 10) + 2, 3 * (i / 10) + 2, 2);
        if (i % 3 == 0)
            shape_turn(&s, s.count - 12, s.count);
    }
    shape_shuffle(&s, 1);
    iso_mesh mesh;
    if (mend(&mesh, &s, 800)) {
        CHECK_EQUAL(100, mesh.defects.shells);
        CHECK_EQUAL(34, mesh.defects.inverted_shells);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* A sphere in two halves whose rims do not quite meet. */
static shape halves(double gap) {
    shape s = {0};
    uint64_t state = 9;
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, 20, 24);
    for (int64_t t = 0; t < s.count; t++) {
        float *f = s.triangle + 9 * t;
        if (f[2] + f[5] + f[8] < 0)
            continue;
        for (int k = 0; k < 3; k++)
            if (fabs(f[3 * k + 2]) < 1e-4) { /* the rim of the upper half */
                f[3 * k] += (float)gap * (f[3 * k + 1] > 0 ? 0.7f : -0.5f);
                f[3 * k + 2] += (float)gap * 0.7f;
            }
    }
    shape_random(&state);
    return s;
}

static void test_seams_within_ten_micrometres(void) {
    shape sound = halves(0), near = halves(0.009), far = halves(0.02);
    iso_mesh whole, mesh;
    if (CHECK_OK(iso_mesh_from_triangles(&whole, sound.triangle, sound.count))) {
        if (CHECK_OK(iso_mesh_from_triangles(&mesh, near.triangle, near.count))) {
            CHECK_OK(iso_mesh_validate(&mesh));
            CHECK_NEAR(iso_mesh_volume(&whole), iso_mesh_volume(&mesh), 4);
            CHECK_EQUAL(24, mesh.defects.welded_vertices);
            CHECK_EQUAL(48, mesh.defects.bad_edges);
            CHECK_EQUAL(0, mesh.defects.holes_closed);
            CHECK_EQUAL(1, mesh.defects.shells);
            CHECK_EQUAL(whole.vertex_count, mesh.vertex_count);
            iso_mesh_free(&mesh);
        }
        iso_mesh_free(&whole);
    }
    refuse(&far, "24 open edges", "add");
    shape_free(&sound);
    shape_free(&near);
    shape_free(&far);
}

/* Smaller than the seam's reach: welding would fold it up, so it is left alone. */
static void test_tiny_open_part_is_not_folded_up(void) {
    shape s = cube(0.004);
    shape_remove(&s, 5);
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
        CHECK_OK(iso_mesh_validate(&mesh));
        CHECK_NEAR(64e-9, iso_mesh_volume(&mesh), 1e-13);
        CHECK_EQUAL(0, mesh.defects.welded_vertices);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* All at once, in any order, with every allocation failing in turn. */
static shape everything(void) {
    shape s = {0}, half = halves(0.005);
    shape_torus(&s, (shape_point){200, 0, 0}, 30, 10, 12, 8);
    shape_remove(&s, 17);
    shape_turn(&s, 40, 42);
    shape_box(&s, 100, 0, 0, 120, 20, 20);
    shape_turn(&s, s.count - 12, s.count);
    shape_repeat(&s, s.count - 3);
    for (int64_t t = 0; t < half.count; t++) {
        const float *f = half.triangle + 9 * t;
        shape_add(&s, (shape_point){f[0], f[1], f[2]}, (shape_point){f[3], f[4], f[5]},
                  (shape_point){f[6], f[7], f[8]});
    }
    shape_add(&s, (shape_point){0, 0, 0}, (shape_point){0, 0, 0}, (shape_point){20, 0, 0});
    shape_free(&half);
    return s;
}

static void test_everything_in_any_order(void) {
    double volume = 0;
    for (uint64_t seed = 0; seed < 20; seed++) {
        shape s = everything();
        if (seed)
            shape_shuffle(&s, seed);
        iso_mesh mesh;
        if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
            if (seed == 0)
                volume = iso_mesh_volume(&mesh);
            CHECK_OK(iso_mesh_validate(&mesh));
            /* which of two near corners stays depends on the order; the rest does not */
            CHECK_NEAR(volume, iso_mesh_volume(&mesh), 4);
            CHECK_EQUAL(3, mesh.defects.shells);
            CHECK_EQUAL(1, mesh.defects.inverted_shells);
            CHECK_EQUAL(2, mesh.defects.flipped_triangles);
            CHECK_EQUAL(1, mesh.defects.duplicate);
            CHECK_EQUAL(1, mesh.defects.degenerate);
            CHECK_EQUAL(1, mesh.defects.holes_closed);
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

static void test_allocation_failures(void) {
    shape s = everything();
    for (int64_t n = 0;; n++) {
        iso_mesh mesh;
        iso_fail_allocation_after(n);
        iso_status status = iso_mesh_from_triangles(&mesh, s.triangle, s.count);
        iso_fail_allocation_after(-1);
        if (status == ISO_OK) {
            CHECK(n > 40);
            iso_mesh_free(&mesh);
            break;
        }
        CHECK_EQUAL(ISO_NO_MEMORY, status);
        CHECK(mesh.origin == NULL);
    }
    shape_free(&s);
}

static void test_validate_names_what_is_wrong(void) {
    shape s = cube(20);
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count))) {
        int32_t kept = mesh.opposite[7];
        mesh.opposite[7] = 7;
        CHECK_STATUS(ISO_BUG, iso_mesh_validate(&mesh));
        CHECK(strstr(iso_error_message(), "beta alpha(7)") != NULL);
        mesh.opposite[7] = (kept + 1) % 36;
        CHECK_STATUS(ISO_BUG, iso_mesh_validate(&mesh));
        CHECK(strstr(iso_error_message(), "(beta alpha)^2 = 1") != NULL);
        mesh.opposite[7] = kept;
        int32_t origin = mesh.origin[5];
        mesh.origin[5] = (origin + 1) % 8;
        CHECK_STATUS(ISO_BUG, iso_mesh_validate(&mesh));
        mesh.origin[5] = 99;
        CHECK_STATUS(ISO_BUG, iso_mesh_validate(&mesh));
        CHECK(strstr(iso_error_message(), "v(5) = 99") != NULL);
        mesh.origin[5] = origin;
        CHECK_OK(iso_mesh_validate(&mesh));
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* A fan of many triangles around one vertex, at either end of the numbering, in any order. */
static void test_hubs(void) {
    enum { N = 20000 };
    for (int round = 0; round < 3; round++) {
        shape s = {0};
        for (int i = 0; i < N; i++) {
            double u = 2 * SHAPE_PI * i / N, w = 2 * SHAPE_PI * ((i + 1) % N) / N;
            shape_point a = {1e3 * cos(u), 1e3 * sin(u), 0}, b = {1e3 * cos(w), 1e3 * sin(w), 0};
            shape_add(&s, (shape_point){0, 0, 5}, a, b);
            shape_add(&s, b, a, (shape_point){0, 0, -5});
        }
        if (round == 1)
            shape_shuffle(&s, 1);
        if (round == 2) { /* a second dart on hub edges that have their pair */
            shape_repeat(&s, 2 * 777);
            shape_remove(&s, 2 * 5000);
        }
        iso_mesh mesh;
        if (mend(&mesh, &s, SHAPE_PI * 1e7 / 3)) {
            CHECK_EQUAL(round == 2 ? 6 : 0, mesh.defects.bad_edges);
            CHECK_EQUAL(round == 2, mesh.defects.duplicate);
            CHECK_EQUAL(round == 2, mesh.defects.holes_closed);
            CHECK_EQUAL(2 * N, mesh.triangle_count);
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

int main(void) {
    RUN(test_hubs);
    RUN(test_sound_meshes_are_left_alone);
    RUN(test_cube_less_any_triangle);
    RUN(test_box_without_lid_is_refused);
    RUN(test_hemisphere_is_refused);
    RUN(test_sheets_are_refused);
    RUN(test_moebius_strip_is_refused);
    RUN(test_long_tube_is_capped);
    RUN(test_holes_that_share_a_corner);
    RUN(test_torus_less_a_twentieth);
    RUN(test_degenerate_triangles_are_dropped);
    RUN(test_duplicates_are_dropped);
    RUN(test_shell_that_occurs_twice);
    RUN(test_duplicates_that_balance_stay);
    RUN(test_coincident_faces_cancel);
    RUN(test_triangles_back_to_back);
    RUN(test_boxes_that_share_an_edge);
    RUN(test_boxes_that_share_a_face);
    RUN(test_random_cells);
    RUN(test_turned_triangles_are_turned_back);
    RUN(test_cavities_stay);
    RUN(test_many_shells);
    RUN(test_seams_within_ten_micrometres);
    RUN(test_tiny_open_part_is_not_folded_up);
    RUN(test_everything_in_any_order);
    RUN(test_allocation_failures);
    RUN(test_validate_names_what_is_wrong);
    return check_verdict();
}
