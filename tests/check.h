/* Checks for tests: print where and what, go on, and let main() return the verdict.
 *
 *     CHECK(condition)                 CHECK_EQUAL(expected, actual)     integers
 *     CHECK_NEAR(expected, actual, tolerance)    doubles
 *     CHECK_OK(call)                   a status that must be ISO_OK
 *     CHECK_STATUS(expected, call)
 *     int main(void) { RUN(test_a); RUN(test_b); return check_verdict(); } */
#ifndef TESTS_CHECK_H
#define TESTS_CHECK_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <isoslice/status.h>

/* One of each in a test, whatever the number of its files. */
__attribute__((weak)) int check_failures, check_count;

#define CHECK(condition)                                                                           \
    (check_count++,                                                                                \
     (condition) ? 1                                                                               \
                 : (check_failures++,                                                              \
                    fprintf(stderr, "%s:%d: not true: %s\n", __FILE__, __LINE__, #condition), 0))

#define CHECK_EQUAL(expected, actual)                                                              \
    check_equal((long long)(expected), (long long)(actual), #actual, __FILE__, __LINE__)
#define CHECK_NEAR(expected, actual, tolerance)                                                    \
    check_near((expected), (actual), (tolerance), #actual, __FILE__, __LINE__)
#define CHECK_STATUS(expected, call) check_status((expected), (call), #call, __FILE__, __LINE__)
#define CHECK_OK(call) CHECK_STATUS(ISO_OK, call)

#define RUN(test)                                                                                  \
    do {                                                                                           \
        int run_before = check_failures;                                                           \
        test();                                                                                    \
        printf("%s %s\n", check_failures == run_before ? "ok  " : "FAIL", #test);                  \
    } while (0)

static inline int check_equal(long long expected, long long actual, const char *what,
                              const char *file, int line) {
    check_count++;
    if (expected == actual)
        return 1;
    check_failures++;
    fprintf(stderr, "%s:%d: %s is %lld, not %lld\n", file, line, what, actual, expected);
    return 0;
}

static inline int check_near(double expected, double actual, double tolerance, const char *what,
                             const char *file, int line) {
    check_count++;
    if (fabs(expected - actual) <= tolerance)
        return 1;
    check_failures++;
    fprintf(stderr, "%s:%d: %s is %.12g, not within %g of %.12g\n", file, line, what, actual,
            tolerance, expected);
    return 0;
}

static inline int check_status(iso_status expected, iso_status actual, const char *what,
                               const char *file, int line) {
    check_count++;
    if (expected == actual)
        return 1;
    check_failures++;
    fprintf(stderr, "%s:%d: %s gave status %d (%s), not %d\n", file, line, what, actual,
            iso_error_message(), expected);
    return 0;
}

static inline int check_verdict(void) {
    printf("%d checks, %d failed\n", check_count, check_failures);
    return check_count == 0 || check_failures > 0;
}

#endif
