/* The report, read back by Python's json in tests/cli; here its JSON byte by byte. */
#include <isoslice/report.h>

#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/output.h"
#include "check.h"
#include "config/json.h"

static char content[65536];

static const char *read_back(const char *path) {
    FILE *file = fopen(path, "rb");
    size_t n = file ? fread(content, 1, sizeof content - 1, file) : 0;
    content[n] = 0;
    if (file)
        fclose(file);
    unlink(path);
    return content;
}

static void test_json_is_laid_out_and_escaped(void) {
    static const char path[] = "test-report-layout.json";
    iso_output *output;
    if (!CHECK_OK(iso_output_open(&output, path)))
        return;
    iso_json json = {output, 0, false};
    iso_json_begin(&json, NULL, '{');
    iso_json_begin(&json, "empty", '[');
    iso_json_end(&json, ']');
    iso_json_text(&json, "a \"b\"", "c\\d\n\t\x01 \xC3\xA9 \xFF\xC3(\xED\xA0\x80");
    iso_json_begin(&json, "list", '[');
    iso_json_integer(&json, NULL, INT64_MIN);
    iso_json_number(&json, NULL, -0.25);
    iso_json_number(&json, NULL, 1e20);
    iso_json_number(&json, NULL, NAN);
    iso_json_number(&json, NULL, 123456789012.0);
    iso_json_end(&json, ']');
    iso_json_end(&json, '}');
    CHECK_OK(iso_output_commit(output));
    CHECK(strcmp(read_back(path),
                 "{\n  \"empty\": [],\n"
                 "  \"a \\\"b\\\"\": \"c\\\\d\\n\\u0009\\u0001 \xC3\xA9 "
                 "\\ufffd\\ufffd(\\ufffd\\ufffd\\ufffd\",\n"
                 "  \"list\": [\n    -9223372036854775808,\n    -0.25,\n    null,\n    null,\n"
                 "    123456789012\n  ]\n}\n") == 0);
}

/* A tetrahedron with a triangle given twice. */
static iso_status damaged_mesh(iso_mesh *mesh) {
    static const float corner[4][3] = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
    static const int face[5][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {2, 0, 3}};
    float triangle[45];
    for (int i = 0; i < 15; i++)
        memcpy(triangle + 3 * i, corner[face[i / 3][i % 3]], 3 * sizeof(float));
    return iso_mesh_from_triangles(mesh, triangle, 5);
}

static void test_a_report_has_what_was_noted(void) {
    static iso_options options;
    iso_report report = {0};
    iso_mesh mesh;
    iso_options_defaults(&options);
    options.perimeters = 7;
    if (!CHECK_OK(damaged_mesh(&mesh)))
        return;
    CHECK_OK(iso_report_add_input(&report, "a \"part\".stl", &mesh));
    iso_mesh_free(&mesh);
    CHECK_OK(iso_report_add_stage(&report, "slice", 0.25, 100));
    CHECK_OK(iso_report_add_stage(&report, "walls", 1, 0));
    CHECK_OK(iso_report_add_stage(&report, "slice", 0.5, 40));
    CHECK_OK(iso_report_warn(&report, "some-code", "%d of %s", 3, "them"));
    CHECK_EQUAL(2, report.stage_count);
    CHECK_NEAR(0.75, report.stage[0].seconds, 1e-15);
    CHECK_EQUAL(100, report.stage[0].bytes);
    CHECK_EQUAL(2, report.warning_count);
    CHECK(strcmp(report.warning[0].code, "mesh-mended") == 0);
    CHECK(strcmp(report.warning[0].message, "a \"part\".stl: 1 duplicate triangles dropped") == 0);
    CHECK_OK(iso_report_write(&report, &options, ISO_OUTSIDE, "too large", "test-report.json"));
    read_back("test-report.json");
    CHECK(strstr(content, "\"status\": 5,\n  \"message\": \"too large\"") != NULL);
    CHECK(strstr(content, "\"file\": \"a \\\"part\\\".stl\"") != NULL);
    CHECK(strstr(content, "\"options\": {\n    \"perimeters\": \"7\"\n  }") != NULL);
    CHECK(strstr(content, "\"duplicate\": 1") != NULL);
    CHECK(strstr(content, "\"message\": \"3 of them\"") != NULL);
    iso_report_free(&report);
    CHECK_EQUAL(0, report.input_count);
}

static iso_status fill_report(iso_report *report, const iso_mesh *mesh) {
    ISO_TRY(iso_report_add_input(report, "part.stl", mesh));
    ISO_TRY(iso_report_add_stage(report, "slice", 1, 1));
    return iso_report_warn(report, "code", "message");
}

static void test_every_allocation_may_fail(void) {
    iso_mesh mesh;
    if (!CHECK_OK(damaged_mesh(&mesh)))
        return;
    for (int64_t n = 0;; n++) {
        iso_report report = {0};
        iso_fail_allocation_after(n);
        iso_status status = fill_report(&report, &mesh);
        iso_fail_allocation_after(-1);
        iso_report_free(&report);
        if (status == ISO_OK) {
            CHECK(n >= 6);
            break;
        }
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
    iso_mesh_free(&mesh);
}

static void test_a_report_that_can_not_be_written_says_so(void) {
    static iso_options options;
    iso_report report = {0};
    iso_options_defaults(&options);
    CHECK_STATUS(ISO_NOT_WRITTEN,
                 iso_report_write(&report, &options, ISO_OK, "", "no/such/folder/report.json"));
}

int main(void) {
    RUN(test_json_is_laid_out_and_escaped);
    RUN(test_a_report_has_what_was_noted);
    RUN(test_every_allocation_may_fail);
    RUN(test_a_report_that_can_not_be_written_says_so);
    return check_verdict();
}
