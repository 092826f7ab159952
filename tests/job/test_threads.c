/* The same bytes for any number of threads and any run. */
#include "checks.h"
#include "solids.h"

static void check_same(const char *settings, const shape *s, const char *name) {
    static const int32_t threads[] = {1, 2, 3, 4, 8};
    const char *path = print_path("model.stl");
    print first;
    CHECK(shape_write_binary(s, path));
    print_files(&first, &path, 1, settings, 1);
    print_check(&first, s);
    for (int i = 0; i < (int)(sizeof threads / sizeof *threads); i++) {
        print p;
        print_files(&p, &path, 1, settings, threads[i]);
        CHECK_EQUAL(ISO_OK, p.status);
        CHECK_EQUAL(threads[i], p.report.threads);
        if (!CHECK(p.size == first.size && memcmp(p.text, first.text, p.size) == 0))
            fprintf(stderr, "    that was %s with %d threads\n", name, threads[i]);
        CHECK(p.report.kernel.operations == first.report.kernel.operations);
        CHECK(p.report.sliced_volume == first.report.sliced_volume);
        print_free(&p);
    }
    print_free(&first);
}

static void test_threads_and_runs(void) {
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        all_solids[m].make(&s);
        check_same(m % 2 ? "layer_height = 0.2\nfill_pattern = grid"
                         : "top_solid_layers = 7\nbottom_solid_layers = 5\nlayer_height = 0.3",
                   &s, all_solids[m].name);
        shape_free(&s);
    }
}

/* Blocks of 8 layers a thread: 5 layers are less than one, 200 many. */
static void test_few_and_many_layers(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 6, 6, 0.6);
    check_same("layer_height = 0.1\nfirst_layer_height = 0.1", &s, "6 layers");
    shape_free(&s);
    shape_box(&s, 0, 0, 0, 5, 5, 20);
    check_same("layer_height = 0.1\nfirst_layer_height = 0.1\ntop_solid_layers = 60", &s,
               "200 layers");
    shape_free(&s);
}

/* Shells deeper than there are layers. */
static void test_endless_shells(void) {
    shape s = {0};
    solid_small(&s);
    check_same("top_solid_layers = 100000\nbottom_solid_layers = 100000", &s, "endless shells");
    shape_free(&s);
}

int main(void) {
    RUN(test_threads_and_runs);
    RUN(test_few_and_many_layers);
    RUN(test_endless_shells);
    CHECK(print_folder_remove());
    return check_verdict();
}
