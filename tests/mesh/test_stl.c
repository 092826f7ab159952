/* The STL reader: every form of file that is a model, and a clear word on every one that is not. */
#include "check.h"

#include <unistd.h>

#include "base/memory.h"
#include "mesh/builder.h"
#include "mesh/stl.h"
#include "models/shapes.h"

static void check_cube(iso_mesh *mesh) {
    CHECK_EQUAL(12, mesh->triangle_count);
    CHECK_EQUAL(8, mesh->vertex_count);
    CHECK_OK(iso_mesh_validate(mesh));
    CHECK_NEAR(8000, iso_mesh_volume(mesh), 1e-9);
    CHECK_NEAR(20, mesh->max.z, 0);
    CHECK_EQUAL(1, mesh->defects.shells);
    iso_mesh_free(mesh);
}

static shape cube(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 20, 20, 20);
    return s;
}

static iso_status read_text(iso_mesh *mesh, const char *text) {
    return iso_mesh_read_memory(mesh, text, (int64_t)strlen(text));
}

static void refuse(const void *bytes, int64_t size, const char *part1, const char *part2) {
    iso_mesh mesh;
    if (!CHECK_STATUS(ISO_UNREADABLE, iso_mesh_read_memory(&mesh, bytes, size))) {
        iso_mesh_free(&mesh);
        return;
    }
    CHECK(mesh.origin == NULL && mesh.triangle_count == 0);
    if (!CHECK(strstr(iso_error_message(), part1) && strstr(iso_error_message(), part2)))
        fprintf(stderr, "  \"%s\" lacks \"%s\" or \"%s\"\n", iso_error_message(), part1, part2);
}

static void test_binary(void) {
    shape s = cube();
    unsigned char *bytes = shape_binary(&s, "made by a test");
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_read_memory(&mesh, bytes, 84 + 50 * 12)))
        check_cube(&mesh);
    free(bytes);
    shape_free(&s);
}

static void test_binary_that_says_solid(void) {
    shape s = cube();
    unsigned char *bytes = shape_binary(&s, "solid cube facet normal 0 0 1");
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_read_memory(&mesh, bytes, 84 + 50 * 12)))
        check_cube(&mesh);
    refuse(bytes, 84 + 50 * 11, "12", "11"); /* still binary when its size disagrees */
    free(bytes);
    shape_free(&s);
}

static void test_normals_are_not_read(void) {
    shape s = cube();
    unsigned char *bytes = shape_binary(&s, "");
    memset(bytes + 84, 0xff, 12);
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_read_memory(&mesh, bytes, 84 + 50 * 12)))
        check_cube(&mesh);
    free(bytes);
    shape_free(&s);
}

static void test_counts_that_lie(void) {
    shape s = cube();
    unsigned char *bytes = shape_binary(&s, ""), *longer = calloc(1, 84 + 50 * 14);
    memcpy(longer, bytes, 84 + 50 * 12);
    for (int cut = 1; cut < 50 * 12; cut += 37)
        refuse(bytes, 84 + 50 * 12 - cut, "12", "room for");
    refuse(longer, 84 + 50 * 14, "12", "14");
    longer[80] = 0;
    refuse(longer, 84 + 50 * 14, "says 0", "14");
    longer[80] = 12;
    iso_mesh mesh; /* a footer that is no whole number of triangles */
    if (CHECK_OK(iso_mesh_read_memory(&mesh, longer, 84 + 50 * 12 + 7)))
        check_cube(&mesh);
    memset(longer + 80, 0xff, 4);
    refuse(longer, 84 + 50 * 14, "4294967295", "14");
    longer[80] = longer[81] = longer[82] = longer[83] = 0;
    refuse(longer, 84, "no triangles", "");
    free(bytes);
    free(longer);
    shape_free(&s);
}

static void test_too_short(void) {
    refuse("", 0, "empty", "");
    refuse(NULL, 0, "empty", "");
    refuse("x", 1, "1 bytes", "too few");
    char zeros[83] = {0};
    refuse(zeros, 83, "83 bytes", "too few");
}

static void test_absurd_coordinates_binary(void) {
    static const float bad[] = {NAN, INFINITY, -INFINITY, 1.1e7f, -1e30f};
    for (int i = 0; i < 5; i++) {
        shape s = cube();
        s.triangle[9 * 7 + i] = bad[i];
        unsigned char *bytes = shape_binary(&s, "");
        refuse(bytes, 84 + 50 * 12, "triangle 7", "byte 434");
        iso_mesh mesh;
        CHECK_STATUS(ISO_UNREADABLE, iso_mesh_from_triangles(&mesh, s.triangle, s.count));
        CHECK(strstr(iso_error_message(), "triangle 7") != NULL);
        free(bytes);
        shape_free(&s);
    }
}

static void test_minus_zero_is_zero(void) {
    shape s = cube();
    for (int64_t i = 0; i < 9 * s.count; i += 2)
        s.triangle[i] = s.triangle[i] == 0 ? -0.0f : s.triangle[i];
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count)))
        check_cube(&mesh);
    shape_free(&s);
}

static void test_ascii(void) {
    shape s = cube();
    static const char *const newline[] = {"\n", "\r", "\r\n", " \t\n\n", "\r\r\n"};
    for (int i = 0; i < 5; i++) {
        char *text = shape_ascii(&s, "a cube, endsolid facet 7", newline[i]);
        iso_mesh mesh;
        if (CHECK_OK(read_text(&mesh, text)))
            check_cube(&mesh);
        free(text);
    }
    shape_free(&s);
}

static void test_ascii_in_upper_case_after_white_space(void) {
    shape s = cube();
    char *text = shape_ascii(&s, "", "\n"), *moved = malloc(strlen(text) + 100);
    for (char *c = text; *c; c++)
        if (*c >= 'a' && *c <= 'z')
            *c = (char)(*c - 32);
    static const char *const before[] = {" \r\n\t ", "\xef\xbb\xbf", "\xef\xbb\xbf \n"};
    for (int i = 0; i < 3; i++) {
        strcpy(moved, before[i]);
        strcat(moved, text);
        iso_mesh mesh;
        if (CHECK_OK(read_text(&mesh, moved)))
            check_cube(&mesh);
    }
    free(text);
    free(moved);
    shape_free(&s);
}

static void test_ascii_with_several_solids(void) {
    shape a = {0}, b = {0};
    shape_box(&a, 0, 0, 0, 1, 1, 1);
    shape_box(&b, 5, 0, 0, 7, 1, 1);
    char *first = shape_ascii(&a, "a", "\n"), *second = shape_ascii(&b, "b", "\r\n");
    char *both = malloc(strlen(first) + strlen(second) + 1);
    strcpy(both, first);
    strcat(both, second);
    iso_mesh mesh;
    if (CHECK_OK(read_text(&mesh, both))) {
        CHECK_NEAR(3, iso_mesh_volume(&mesh), 1e-12);
        CHECK_EQUAL(2, mesh.defects.shells);
        iso_mesh_free(&mesh);
    }
    free(first);
    free(second);
    free(both);
    shape_free(&a);
    shape_free(&b);
}

/* Larger than the reader's window, and the same mesh as the binary file. */
static void test_ascii_agrees_with_binary(void) {
    shape s = {0};
    shape_torus(&s, (shape_point){1, 2, 3}, 30, 10, 60, 40);
    unsigned char *bytes = shape_binary(&s, "");
    char *text = shape_ascii(&s, "torus", "\r\n");
    iso_mesh a, b;
    if (CHECK_OK(iso_mesh_read_memory(&a, bytes, 84 + 50 * s.count)) &&
        CHECK_OK(read_text(&b, text))) {
        CHECK_EQUAL(a.triangle_count, b.triangle_count);
        CHECK_EQUAL(2400, a.vertex_count);
        CHECK(memcmp(a.origin, b.origin, 3 * sizeof(int32_t) * (size_t)a.triangle_count) == 0);
        CHECK(memcmp(a.opposite, b.opposite, 3 * sizeof(int32_t) * (size_t)a.triangle_count) == 0);
        CHECK(memcmp(a.position, b.position, sizeof(iso_vec3) * (size_t)a.vertex_count) == 0);
        iso_mesh_free(&a);
        iso_mesh_free(&b);
    }
    free(bytes);
    free(text);
    shape_free(&s);
}

static void refuse_text(const char *text, const char *part1, const char *part2) {
    refuse(text, (int64_t)strlen(text), part1, part2);
}

#define FACET "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"

static void test_ascii_that_is_broken(void) {
    refuse_text("solid a\n" FACET "vertex 0 1 zero\nendloop\nendfacet\nendsolid", "line 6", "zero");
    refuse_text("solid a\n" FACET "vertex 0 1,5 0\nendloop\nendfacet\nendsolid", "line 6", "1,5");
    refuse_text("solid a\n" FACET "vertex 0 1 nan\nendloop\nendfacet\nendsolid", "line 6",
                "triangle 0");
    refuse_text("solid a\n" FACET "vertex 0 1 1e8\nendloop\nendfacet\nendsolid", "line 6",
                "not finite or beyond");
    refuse_text("solid a\n" FACET "vertex 0 1 0\nvertex 0 2 0\nendloop\nendfacet\nendsolid",
                "line 7", "endloop");
    refuse_text("solid a\n" FACET "vertex 0 1 0\nendloop\nendfacet\n", "ends at line 9", "facet");
    refuse_text("solid a\n" FACET "vertex 0 1", "ends at line 6", "");
    refuse_text("solid a\r"
                "facet normal 0 0 1\r\nouter hoop",
                "line 3", "hoop");
    refuse_text("solid a\nendsolid a\n", "no triangles", "");
    refuse_text("solid", "where \"facet\" should be", "");
    refuse_text("solid a\nendsolid a\nG28 ; and more words than 84 bytes so that it cannot be a "
                "binary file of no triangles\n",
                "line 3", "G28");
    refuse_text("G28\nG1 X10 Y10 F3000 ; a file of another kind altogether, longer than 84 bytes, "
                "but no model at all\n",
                "header says", "room for");
    char long_token[3000];
    memset(long_token, 'a', sizeof long_token);
    memcpy(long_token, "solid \n", 7);
    refuse(long_token, sizeof long_token, "line 2", "without a space");
}

static void test_every_truncation_of_ascii(void) {
    shape s = {0};
    shape_tetrahedron(&s, 3);
    char *text = shape_ascii(&s, "t", "\n");
    int64_t last = (int64_t)(strstr(text, "endsolid") - text) + 8;
    for (int64_t size = 1; size < last; size++) {
        iso_mesh mesh;
        if (!CHECK_STATUS(ISO_UNREADABLE, iso_mesh_read_memory(&mesh, text, size)))
            iso_mesh_free(&mesh);
    }
    free(text);
    shape_free(&s);
}

static void test_files(void) {
    shape s = {0};
    shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, 90, 80); /* 720 kB: several windows */
    char path[] = "/tmp/isoslice-test-stl-XXXXXX";
    int file = mkstemp(path);
    CHECK(file >= 0);
    close(file);
    iso_mesh mesh;
    CHECK(shape_write_binary(&s, path));
    if (CHECK_OK(iso_mesh_read(&mesh, path))) {
        CHECK_EQUAL(14400, mesh.triangle_count);
        CHECK_EQUAL(7200, mesh.vertex_count);
        CHECK_OK(iso_mesh_validate(&mesh));
        iso_mesh_free(&mesh);
    }
    s.triangle[9 * 14000] = NAN; /* far behind the first window */
    CHECK(shape_write_binary(&s, path));
    CHECK_STATUS(ISO_UNREADABLE, iso_mesh_read(&mesh, path));
    CHECK(strstr(iso_error_message(), path) != NULL);
    CHECK(strstr(iso_error_message(), "triangle 14000, at byte 700084") != NULL);
    char *text = shape_ascii(&s, "t", "\r\n");
    CHECK(shape_write(path, text, (int64_t)strlen(text)));
    CHECK_STATUS(ISO_UNREADABLE, iso_mesh_read(&mesh, path));
    CHECK(strstr(iso_error_message(), "line 98004: triangle 14000") != NULL);
    free(text);
    unlink(path);
    CHECK_STATUS(ISO_UNREADABLE, iso_mesh_read(&mesh, path));
    CHECK(strstr(iso_error_message(), "No such file") != NULL);
    CHECK_STATUS(ISO_UNREADABLE, iso_mesh_read(&mesh, "/tmp"));
    shape_free(&s);
}

/* A pipe has no size to compare with. */
static void test_pipe(void) {
    shape s = cube();
    unsigned char *bytes = shape_binary(&s, "solid");
    for (int short_by = 0; short_by < 2; short_by++) {
        int ends[2];
        CHECK(pipe(ends) == 0);
        CHECK(write(ends[1], bytes, (size_t)(684 - short_by)) == 684 - short_by);
        close(ends[1]);
        char path[40];
        snprintf(path, sizeof path, "/proc/self/fd/%d", ends[0]);
        iso_mesh mesh;
        if (short_by) {
            CHECK_STATUS(ISO_UNREADABLE, iso_mesh_read(&mesh, path));
            CHECK(strstr(iso_error_message(), "12 triangles, the file ends after 11") != NULL);
        } else if (CHECK_OK(iso_mesh_read(&mesh, path))) {
            check_cube(&mesh);
        }
        close(ends[0]);
    }
    free(bytes);
    shape_free(&s);
}

static void test_no_triangles_from_memory(void) {
    iso_mesh mesh;
    CHECK_STATUS(ISO_UNREADABLE, iso_mesh_from_triangles(&mesh, NULL, 0));
    iso_mesh_builder builder;
    CHECK_STATUS(ISO_UNREADABLE, iso_mesh_builder_begin(&builder, 800000000));
    CHECK(strstr(iso_error_message(), "800000000") != NULL);
}

/* Every allocation fails in turn: a status, no mesh, no leak (the sanitizer looks). */
static void test_allocation_failures(void) {
    shape s = {0};
    shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, 40, 30);
    shape_box(&s, 0, 0, 0, 1, 1, 1);
    unsigned char *bytes = shape_binary(&s, "");
    char *text = shape_ascii(&s, "t", "\n");
    for (int ascii = 0; ascii < 2; ascii++) {
        for (int64_t n = 0;; n++) {
            iso_mesh mesh;
            iso_fail_allocation_after(n);
            iso_status status = ascii ? read_text(&mesh, text)
                                      : iso_mesh_read_memory(&mesh, bytes, 84 + 50 * s.count);
            iso_fail_allocation_after(-1);
            if (status == ISO_OK) {
                CHECK(n > 5);
                iso_mesh_free(&mesh);
                break;
            }
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK(mesh.origin == NULL);
        }
    }
    free(bytes);
    free(text);
    shape_free(&s);
}

int main(void) {
    RUN(test_binary);
    RUN(test_binary_that_says_solid);
    RUN(test_normals_are_not_read);
    RUN(test_counts_that_lie);
    RUN(test_too_short);
    RUN(test_absurd_coordinates_binary);
    RUN(test_minus_zero_is_zero);
    RUN(test_ascii);
    RUN(test_ascii_in_upper_case_after_white_space);
    RUN(test_ascii_with_several_solids);
    RUN(test_ascii_agrees_with_binary);
    RUN(test_ascii_that_is_broken);
    RUN(test_every_truncation_of_ascii);
    RUN(test_files);
    RUN(test_pipe);
    RUN(test_no_triangles_from_memory);
    RUN(test_allocation_failures);
    return check_verdict();
}
