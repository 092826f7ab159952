/* Expressions against C's own, and what is said of mistakes. */
#include "check.h"

#include <stdlib.h>

#include "base/memory.h"
#include "field/expression.h"

static const char *const names[] = {"x", "y", "z", "skin", "r", "grid"};

enum { NAMES = 6, VALUES = 1000 };

static double place[NAMES][VALUES];
static const double *places[NAMES];

static void make_places(void) {
    uint64_t state = 88172645463325252u;
    for (int k = 0; k < NAMES; k++) {
        for (int i = 0; i < VALUES; i++) {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            place[k][i] = (double)(int64_t)state * 0x1p-63 * (k == 0 ? 1 : 10);
        }
        places[k] = place[k];
    }
}

static iso_expression *compiled(const char *text) {
    iso_expression *expression = NULL;
    if (!CHECK_OK(expression_compile(&expression, text, names, NAMES)))
        fprintf(stderr, "%s\n", text);
    return expression;
}

static double value_of(const char *text) {
    double value = -12345;
    iso_expression *expression = compiled(text);
    if (expression) {
        CHECK(!expression_uses(expression, 0) && !expression_uses(expression, 5));
        expression_evaluate(&value, expression, NULL, 1);
    }
    expression_free(expression);
    return value;
}

static bool same(double a, double b) {
    return a == b || (isnan(a) && isnan(b)) || fabs(a - b) <= 2e-15 * fabs(a);
}

/* An expression and what it is in C, of the six variables of which `x` is within 1. */
#define SAME(text, expected)                                                                       \
    do {                                                                                           \
        iso_expression *same_expression = compiled(text);                                          \
        static double same_value[VALUES];                                                          \
        expression_evaluate(same_value, same_expression, places, VALUES);                          \
        int same_wrong = 0;                                                                        \
        for (int i = 0; i < VALUES; i++) {                                                         \
            double x = place[0][i], y = place[1][i], z = place[2][i], skin = place[3][i],          \
                   r = place[4][i], grid = place[5][i];                                            \
            (void)x, (void)y, (void)z, (void)skin, (void)r, (void)grid;                            \
            same_wrong += !same(expected, same_value[i]);                                          \
        }                                                                                          \
        if (!CHECK_EQUAL(0, same_wrong))                                                           \
            fprintf(stderr, "%s\n", text);                                                         \
        expression_free(same_expression);                                                          \
    } while (0)

static void test_numbers(void) {
    const char *const text[] = {
        "0",     "1",    "0.1",        "1e3",   "1E-3",  "2.5e+2",           ".5",
        "5.",    "1e22", "123456.789", "1e-22", "0.3e1", "9007199254740993", "1e308",
        "4.9e-5"};
    for (int i = 0; i < (int)(sizeof text / sizeof *text); i++)
        CHECK(value_of(text[i]) == strtod(text[i], NULL));
    CHECK(same(3.14159265358979323846264338327950288,
               value_of("3.14159265358979323846264338327950288")));
    CHECK(same(1.2345678901234567e-300, value_of("1.2345678901234567e-300")));
    CHECK(same(0.1, value_of("0.1000000000000000000000000000000000000000000000000000000000")));
    CHECK(same(1e40, value_of("10000000000000000000000000000000000000000")));
    CHECK(value_of("1e999") == HUGE_VAL && value_of("1e-999") == 0 &&
          value_of("0e99999999999") == 0);
    CHECK(value_of("pi") == 3.14159265358979323846);
}

static void test_precedence(void) {
    CHECK(value_of("1 + 2 * 3") == 7 && value_of("(1 + 2) * 3") == 9);
    CHECK(value_of("8 - 4 - 2") == 2 && value_of("16 / 4 / 2") == 2);
    CHECK(value_of("2 ^ 3 ^ 2") == 512 && value_of("(2 ^ 3) ^ 2") == 64);
    CHECK(value_of("-2 ^ 2") == -4 && value_of("(-2) ^ 2") == 4 && value_of("2 ^ -1") == 0.5);
    CHECK(value_of("2 * -3") == -6 && value_of("--3") == 3 && value_of("1 - -1") == 2);
    CHECK(value_of("+3") == 3 && value_of("-+-3") == 3 && value_of("2 ^ -3 ^ 0") == 0.5);
    CHECK(value_of("1 + 1 < 3") == 1);
    CHECK(value_of("3 < 2") == 0 && value_of("2 <= 2") == 1 && value_of("2 >= 3") == 0);
    CHECK(value_of("2 > 1") == 1 && value_of("2 == 2") == 1 && value_of("2 != 2") == 0);
    CHECK(value_of("(1 < 2) + (3 == 3)") == 2);
    CHECK(value_of("0 ? 1 : 0 ? 2 : 3") == 3 && value_of("1 ? 0 ? 4 : 5 : 6") == 5);
    CHECK(value_of("1 < 2 ? 3 + 4 : 5") == 7 && value_of("2 * (0 ? 1 : 4)") == 8);
    CHECK(value_of("\t 1\n+\r2 ") == 3);
    SAME("x + y * z - r / grid", x + y * z - r / grid);
    SAME("x - y - z - r", x - y - z - r);
    SAME("x / y / z", x / y / z);
    SAME("-x ^ 2 + 2 ^ x ^ 2", -(x * x) + pow(2, pow(x, 2)));
    SAME("(x - y) * (z + r) / (grid * grid + 1) - (x + (y - (z * (r + 1))))",
         (x - y) * (z + r) / (grid * grid + 1) - (x + (y - (z * (r + 1)))));
    SAME("x < 0 ? y < 0 ? 1 : 2 : z > r ? skin : -grid", x < 0   ? y < 0 ? 1 : 2
                                                         : z > r ? skin
                                                                 : -grid);
    SAME("(x < y) + 2 * (x <= z) + 4 * (x > r) + 8 * (x >= grid) + 16 * (x == x) + 32 * (x != y)",
         (x < y) + 2 * (x <= z) + 4 * (x > r) + 8 * (x >= grid) + 16 + 32 * (x != y));
}

static double clamped(double v, double low, double high) {
    return v < low ? low : v > high ? high : v;
}

static void test_functions(void) {
    SAME("abs(x) + sqrt(abs(y))", fabs(x) + sqrt(fabs(y)));
    SAME("min(x, y)", fmin(x, y));
    SAME("max(x, y, z, r, grid)", fmax(fmax(fmax(fmax(x, y), z), r), grid));
    SAME("min(x + 1, y * 2, 3, -z, r - x, 1 - grid)",
         fmin(fmin(fmin(fmin(fmin(x + 1, y * 2), 3), -z), r - x), 1 - grid));
    SAME("clamp(y, -1, 2 + x)", clamped(y, -1, 2 + x));
    SAME("floor(y) + ceil(z) + round(r)", floor(y) + ceil(z) + round(r));
    SAME("mod(y, 3)", y - 3 * floor(y / 3) + 0 * x);
    SAME("sin(y)", sin(y));
    SAME("cos(y)", cos(y));
    SAME("tan(y)", tan(y));
    SAME("asin(x)", asin(x));
    SAME("acos(x)", acos(x));
    SAME("atan(y)", atan(y));
    SAME("atan2(y, z)", atan2(y, z));
    SAME("exp(y)", exp(y));
    SAME("log(y)", y < 0 ? NAN : log(y));
    SAME("hypot(x, y)", hypot(x, y));
    SAME("abs(y) ^ z", pow(fabs(y), z));
    SAME("y ^ 3", y * y * y);
    SAME("sqrt(y)", sqrt(y));
    CHECK(value_of("mod(-1, 3)") == 2 && value_of("mod(1, -3)") == -2 &&
          value_of("mod(6, 3)") == 0);
    CHECK(value_of("round(2.5)") == 3 && value_of("round(-2.5)") == -3);
}

static void test_ramp(void) {
    CHECK(value_of("ramp(-1, 0, 40, 20, 80)") == 20 && value_of("ramp(41, 0, 40, 20, 80)") == 80);
    CHECK(value_of("ramp(0, 0, 40, 20, 80)") == 20 && value_of("ramp(40, 0, 40, 20, 80)") == 80);
    CHECK(value_of("ramp(10, 0, 40, 20, 80)") == 35 && value_of("ramp(10, 0, 40, 80, 20)") == 65);
    CHECK(value_of("ramp(10, 40, 0, 20, 80)") == 65); /* downwards */
    CHECK(value_of("ramp(1, 2, 2, 3, 4)") == 3 && value_of("ramp(2, 2, 2, 3, 4)") == 4);
    CHECK(isnan(value_of("ramp(0 / 0, 0, 1, 2, 3)")));
}

/* As with IEEE 754, and never worse. */
static void test_no_value(void) {
    CHECK(value_of("1 / 0") == HUGE_VAL && value_of("-1 / 0") == -HUGE_VAL);
    CHECK(isnan(value_of("0 / 0")) && isnan(value_of("sqrt(-1)")) && isnan(value_of("log(-1)")));
    CHECK(isnan(value_of("asin(2)")) && isnan(value_of("(-8) ^ 0.5")) &&
          isnan(value_of("mod(1, 0)")));
    CHECK(value_of("log(0)") == -HUGE_VAL && value_of("exp(1000)") == HUGE_VAL);
    CHECK(isnan(value_of("min(0 / 0, 1)")) && isnan(value_of("min(1, 0 / 0)")));
    CHECK(isnan(value_of("max(0 / 0, 1)")) && isnan(value_of("max(1, 0 / 0)")));
    CHECK(isnan(value_of("clamp(0 / 0, 1, 2)")) && isnan(value_of("sin(1 / 0)")));
    CHECK(value_of("0 / 0 < 1") == 0 && value_of("0 / 0 == 0 / 0") == 0);
    CHECK(value_of("0 / 0 != 1") == 1 && value_of("(0 / 0) ^ 0") == 1);
}

static void test_mistakes(void) {
    static const struct {
        const char *text, *message;
    } mistake[] = {
        {"", "column 1: expected a number, a name or '(', not the end"},
        {"  ", "column 3: expected a number, a name or '(', not the end"},
        {"1 +", "column 4: expected a number, a name or '(', not the end"},
        {"1 + * 2", "column 5: expected a number, a name or '(', not '*'"},
        {"(1 + 2", "column 7: expected an operator or ')', not the end"},
        {"1 2", "column 3: expected an operator or the end, not '2'"},
        {"3x", "column 2: expected an operator behind the number, not 'x'"},
        {"1.2.3", "column 4: expected an operator behind the number, not '.'"},
        {"1e", "column 3: expected digits of the exponent, not the end"},
        {"x + foo", "column 5: there is no variable 'foo'; there are pi, x, y, z, skin, r, grid"},
        {"foo(1)", "column 1: there is no function 'foo'"},
        {"x(1)", "column 1: there is no function 'x'"},
        {"sin + 1", "column 5: expected '(' behind the name of a function, not '+'"},
        {"1 + sin(1, 2)", "column 5: sin takes 1 value"},
        {"ramp(z, 0, 40)", "column 1: ramp takes 5 values"},
        {"min(1)", "column 1: min takes 2 values or more"},
        {"ramp(z, 0", "column 10: expected an operator, ',' or ')', not the end"},
        {"sin()", "column 5: expected a number, a name or '(', not ')'"},
        {"1 < 2 < 3", "column 7: a comparison that is compared again needs brackets"},
        {"x ? 1", "column 6: expected an operator or ':', not the end"},
        {"x = 1", "column 3: expected an operator or the end, not '='"},
        {"x\xff", "column 2: expected an operator or the end, not a byte 255"},
        {"$", "column 1: expected a number, a name or '(', not '$'"},
    };
    for (int i = 0; i < (int)(sizeof mistake / sizeof *mistake); i++) {
        iso_expression *expression = NULL;
        CHECK_STATUS(ISO_BAD_CONFIG,
                     expression_compile(&expression, mistake[i].text, names, NAMES));
        CHECK(expression == NULL);
        if (!CHECK(!strcmp(mistake[i].message, iso_error_message())))
            fprintf(stderr, "%s: %s\n", mistake[i].text, iso_error_message());
    }
}

static char *repeated(const char *begin, const char *part, int times, const char *end) {
    char *text = malloc(strlen(begin) + strlen(part) * (size_t)times + strlen(end) + 1), *to = text;
    to += sprintf(to, "%s", begin);
    for (int i = 0; i < times; i++)
        to += sprintf(to, "%s", part);
    sprintf(to, "%s", end);
    return text;
}

/* Long ones work; deep ones are refused before the stack is. */
static void test_long_and_deep(void) {
    static double value[VALUES];
    char *text = repeated("x", " + 0.5 * y - z / 2", 5000, "");
    iso_expression *expression = compiled(text);
    free(text);
    expression_evaluate(value, expression, places, VALUES);
    expression_free(expression);
    int wrong = 0;
    for (int i = 0; i < VALUES; i++) {
        double expected = place[0][i];
        for (int k = 0; k < 5000; k++)
            expected = expected + 0.5 * place[1][i] - place[2][i] / 2;
        wrong += expected != value[i];
    }
    CHECK_EQUAL(0, wrong);
    text = repeated("min(x", ", 20", 3000, ")");
    SAME(text, x);
    free(text);
    text = repeated("", "x + y * (", 40, "1");
    char *closed = repeated(text, ")", 40, "");
    expression = compiled(closed);
    wrong = 0;
    expression_evaluate(value, expression, places, VALUES);
    for (int i = 0; i < VALUES; i++) {
        double expected = 1;
        for (int k = 0; k < 40; k++)
            expected = place[0][i] + place[1][i] * expected;
        wrong += !same(expected, value[i]);
    }
    CHECK_EQUAL(0, wrong);
    expression_free(expression);
    free(closed);
    free(text);
    const char *const deep[] = {"(", "-", "sin(", "1?", "x^", "min(x,", "1 ? 2 : "};
    for (int i = 0; i < 7; i++) {
        text = repeated("", deep[i], 100000, "1");
        CHECK_STATUS(ISO_BAD_CONFIG, expression_compile(&expression, text, names, NAMES));
        CHECK(strstr(iso_error_message(), "nested deeper than 100") != NULL);
        free(text);
    }
}

/* The same however many values at once, also into a variable's own array. */
static void test_blocks(void) {
    const char *text = "sin(x) * (y + z * (r - grid)) > 0 ? x ^ 3 : ramp(y, -5, 5, z, r)";
    iso_expression *expression = compiled(text);
    static double whole[VALUES], piece[VALUES];
    expression_evaluate(whole, expression, places, VALUES);
    for (int first = 0, n; first < VALUES; first += n) {
        const double *from[NAMES];
        n = 1 + first * 7 % 113;
        n = n < VALUES - first ? n : VALUES - first;
        for (int k = 0; k < NAMES; k++)
            from[k] = k == 3 ? NULL : place[k] + first; /* skin isn't in it */
        expression_evaluate(piece + first, expression, from, n);
    }
    CHECK(!memcmp(whole, piece, sizeof whole));
    for (int k = 0; k < NAMES; k++)
        CHECK(expression_uses(expression, k) == (k != 3));
    CHECK(!expression_uses(expression, -1) && !expression_uses(expression, 99));
    const double *from[NAMES] = {piece, place[1], place[2], NULL, place[4], place[5]};
    memcpy(piece, place[0], sizeof piece);
    expression_evaluate(piece, expression, from, VALUES);
    CHECK(!memcmp(whole, piece, sizeof whole));
    expression_evaluate(piece, expression, from, 0);
    expression_free(expression);
    expression = compiled("y");
    expression_evaluate(piece, expression, places, VALUES);
    CHECK(!memcmp(piece, place[1], sizeof piece));
    expression_free(expression);
}

static void test_no_memory(void) {
    iso_expression *expression = NULL;
    iso_status status = ISO_NO_MEMORY;
    for (int i = 0; i < 100 && status == ISO_NO_MEMORY; i++) {
        iso_fail_allocation_after(i);
        status = expression_compile(&expression, "x+y*(z+x*(y+z*(x+y*(z+1))))+x*2+y*3+z*4", names,
                                    NAMES);
        iso_fail_allocation_after(-1);
        CHECK((expression != NULL) == (status == ISO_OK));
    }
    CHECK_OK(status);
    expression_free(expression);
    expression_free(NULL);
    CHECK_STATUS(ISO_BUG, expression_compile(&expression, "1", names, 33));
}

int main(void) {
    make_places();
    RUN(test_numbers);
    RUN(test_precedence);
    RUN(test_functions);
    RUN(test_ramp);
    RUN(test_no_value);
    RUN(test_mistakes);
    RUN(test_long_and_deep);
    RUN(test_blocks);
    RUN(test_no_memory);
    return check_verdict();
}
