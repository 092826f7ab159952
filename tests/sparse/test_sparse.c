/* Symmetric systems against solutions known before. */
#include "sparse/sparse.h"

#include <stdlib.h>

#include "base/memory.h"
#include "check.h"

enum { SIDE = 40, SIZE = SIDE * SIDE, MOST = 4 * SIZE };

typedef struct system {
    sparse_entry entry[MOST];
    int64_t count;
    double x[SIZE], b[SIZE];
} system_of;

static void add(system_of *s, int32_t row, int32_t column, double value) {
    s->entry[s->count++] = (sparse_entry){row, column, value};
}

/* The five-point Laplacian of a square with zeros around it, and b = A x, row by row from the grid
 * itself, for some x. */
static void laplacian(system_of *s) {
    s->count = 0;
    for (int32_t j = 0; j < SIDE; j++)
        for (int32_t i = 0; i < SIDE; i++)
            s->x[SIDE * j + i] = sin(0.3 * i) + 0.01 * i * j - 0.2 * (j % 7);
    for (int32_t j = 0; j < SIDE; j++)
        for (int32_t i = 0; i < SIDE; i++) {
            int32_t k = SIDE * j + i;
            /* in two portions, which add up */
            add(s, k, k, 3);
            double sum = 4 * s->x[k];
            if (i > 0)
                add(s, k, k - 1, -1);
            if (j > 0)
                add(s, k, k - SIDE, -1);
            sum -= i > 0 ? s->x[k - 1] : 0;
            sum -= j > 0 ? s->x[k - SIDE] : 0;
            sum -= i + 1 < SIDE ? s->x[k + 1] : 0;
            sum -= j + 1 < SIDE ? s->x[k + SIDE] : 0;
            s->b[k] = sum;
        }
    for (int32_t k = SIZE - 1; k >= 0 && s->count < MOST; k--)
        add(s, k, k, 1);
}

static void solved(const system_of *s, const double *x) {
    double worst = 0;
    for (int32_t k = 0; k < SIZE; k++)
        worst = fmax(worst, fabs(x[k] - s->x[k]));
    CHECK(worst < 1e-11);
}

static system_of one;

static void test_laplacian(void) {
    static double x[SIZE], again[SIZE];
    sparse_factor *factor, *other;
    laplacian(&one);
    if (!CHECK_OK(sparse_factorise(&factor, one.entry, one.count, SIZE)))
        return;
    CHECK_OK(sparse_solve(x, factor, one.b));
    solved(&one, x);
    /* in place, and from a factor made anew: the same bits */
    memcpy(again, one.b, sizeof again);
    if (CHECK_OK(sparse_factorise(&other, one.entry, one.count, SIZE))) {
        CHECK_OK(sparse_solve(again, other, again));
        CHECK(memcmp(x, again, sizeof x) == 0);
        sparse_free(other);
    }
    sparse_free(factor);
}

static void test_small(void) {
    const sparse_entry entry[] = {{1, 0, 1}, {1, 1, 3}, {0, 0, 4}, {2, 2, 0.5}, {1, 1, -1}};
    const double b[] = {9, 5, 1}; /* of x = 2 ... */
    sparse_factor *factor;
    double x[3];
    if (!CHECK_OK(sparse_factorise(&factor, entry, 5, 3)))
        return;
    CHECK_OK(sparse_solve(x, factor, b));
    /* 4 x + y = 9, x + 2 y = 5, z / 2 = 1 */
    CHECK_NEAR(13.0 / 7, x[0], 1e-15);
    CHECK_NEAR(11.0 / 7, x[1], 1e-15);
    CHECK_NEAR(2, x[2], 1e-15);
    sparse_free(factor);
    sparse_free(NULL);
}

static void test_refused(void) {
    sparse_factor *factor = (sparse_factor *)&one;
    const sparse_entry indefinite[] = {{0, 0, 1}, {1, 0, 2}, {1, 1, 1}};
    CHECK_STATUS(ISO_USAGE, sparse_factorise(&factor, indefinite, 3, 2));
    CHECK(factor == NULL);
    CHECK(strstr(iso_error_message(), "positive definite") != NULL);
    const sparse_entry empty_row[] = {{0, 0, 1}};
    CHECK_STATUS(ISO_USAGE, sparse_factorise(&factor, empty_row, 1, 2));
    const sparse_entry upper[] = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    CHECK_STATUS(ISO_USAGE, sparse_factorise(&factor, upper, 3, 2));
    CHECK(strstr(iso_error_message(), "entry 1") != NULL);
    const sparse_entry nan[] = {{0, 0, 1}, {1, 1, NAN}};
    CHECK_STATUS(ISO_USAGE, sparse_factorise(&factor, nan, 2, 2));
    const sparse_entry far[] = {{0, 0, 1}, {2, 1, 1}};
    CHECK_STATUS(ISO_USAGE, sparse_factorise(&factor, far, 2, 2));
    CHECK_STATUS(ISO_USAGE, sparse_factorise(&factor, far, 0, 0));
}

static void test_memory(void) {
    static double x[SIZE];
    laplacian(&one);
    for (int64_t n = 0; n < 100; n++) {
        sparse_factor *factor;
        iso_fail_allocation_after(n);
        iso_status status = sparse_factorise(&factor, one.entry, one.count, SIZE);
        if (status == ISO_OK)
            status = sparse_solve(x, factor, one.b);
        iso_fail_allocation_after(-1);
        sparse_free(factor);
        if (status == ISO_OK) {
            CHECK(n > 4);
            solved(&one, x);
            return;
        }
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
    (void)CHECK(!"it ends");
}

/* A module of that name that is none: the folder named first decides. */
static void test_missing(void) {
    char folder[] = "/tmp/isoslice-sparse-XXXXXX", path[100];
    if (!CHECK(mkdtemp(folder) != NULL))
        return;
    snprintf(path, sizeof path, "%s/isoslice-sparse.so", folder);
    FILE *file = fopen(path, "w");
    if (CHECK(file != NULL)) {
        fputs("no library", file);
        fclose(file);
        setenv("ISOSLICE_MODULES", folder, 1);
        sparse_factor *factor;
        const sparse_entry entry = {0, 0, 1};
        CHECK_STATUS(ISO_BAD_CONFIG, sparse_factorise(&factor, &entry, 1, 1));
        CHECK(strstr(iso_error_message(), "libcxsparse3") != NULL);
        CHECK(factor == NULL);
        remove(path);
    }
    remove(folder);
}

int main(int count, char **argument) {
    (void)argument;
    if (count > 1) {
        RUN(test_missing);
        return check_verdict();
    }
    RUN(test_small);
    RUN(test_laplacian);
    RUN(test_refused);
    RUN(test_memory);
    return check_verdict();
}
