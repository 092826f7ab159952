/* Regular expressions against those of the C library, and what only ours have. */
#include <regex.h>
#include <stdlib.h>

#include "check.h"
#include "macro/regex.h"

static iso_regex compiled;

/* 1, 0, or -1 if the expression is refused */
static int match(const char *expression, const char *text) {
    int32_t at;
    if (iso_regex_compile(&compiled, expression, (int32_t)strlen(expression), &at))
        return -1;
    return iso_regex_matches(&compiled, text, (int32_t)strlen(text));
}

static void test_the_whole_text_must_match(void) {
    static const struct {
        const char *expression, *text;
        int result;
    } cases[] = {
        {"", "", 1},
        {"", "a", 0},
        {"a", "", 0},
        {"a", "ab", 0},
        {"b", "ab", 0},
        {".*", "", 1},
        {".*b.*", "a\nb\nc", 1}, /* . takes line ends */
        {"a.c", "abc", 1},
        {"(ENDER|CR|SERMOON).*", "CR10", 1},
        {"(ENDER|CR|SERMOON).*", "XCR10", 0},
        {".*PRINTER_MODEL_AK(|LP).*", "PRINTER_MODEL_AKLP", 1},
        {"AK(|LP)", "AK", 1},
        {"AK(|LP)", "AKL", 0},
        {"MK(2.5|3)", "MK2.5", 1},
        {"a|b|cd", "cd", 1},
        {"a|b|cd", "ad", 0},
        {"(a|b)*c", "abbac", 1},
        {"(a*)*b", "aaab", 1},
        {"a+?b??", "aa", 1},
        {"a{2,3}", "aaa", 1},
        {"a{2,3}", "aaaa", 0},
        {"a{2}", "aa", 1},
        {"a{2,}", "aaaaa", 1},
        {"a{0}b", "b", 1},
        {"(ab){2}", "abab", 1},
        {"[a-c]+[^a-c]", "abcd", 1},
        {"[]a]+", "]a]", 1},
        {"[a-]+", "a-a", 1},
        {"\\d+\\s\\w*", "42 a_1", 1},
        {"\\D\\S\\W", "ab.", 1},
        {"[\\d.]+", "2.5", 1},
        {"\\.\\/\\\\", "./\\", 1},
        {"a\\tb", "a\tb", 1},
        {"^abc$", "abc", 1},
        {"a^b", "ab", 0},
        {"(?:ab)+", "abab", 1},
        {"(?i)prusa [a-c]", "PRUSA B", 1},
        {"prusa", "PRUSA", 0},
        {"\xC3\xA9+", "\xC3\xA9", 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (!CHECK_EQUAL(cases[i].result, match(cases[i].expression, cases[i].text)))
            fprintf(stderr, "  /%s/ on %s\n", cases[i].expression, cases[i].text);
}

static void test_what_is_not_supported_is_refused(void) {
    static const char *const wrong[] = {
        "(",  ")",      "a)",     "[a",    "*",  "a**b(",       "(?=a)",   "\\b", "\\1",
        "a{", "a{3,2}", "a{300}", "[z-a]", "\\", "[[:alpha:]]", "(?<a>b)", "{2}", "a|*"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (!CHECK_EQUAL(-1, match(wrong[i], "a")))
            fprintf(stderr, "  /%s/\n", wrong[i]);
    char deep[200];
    memset(deep, '(', sizeof deep);
    deep[199] = 0;
    CHECK_EQUAL(-1, match(deep, "a"));
    CHECK_EQUAL(-1, match("((((a{100}){100}){100}){100}){100}", "a"));
}

/* To the C library a ? behind a repetition is another repetition. */
static bool has_lazy_repetition(const char *expression) {
    return strstr(expression, "*?") || strstr(expression, "+?") || strstr(expression, "??") ||
           strstr(expression, "}?");
}

/* Expressions at random, of what both know, on short texts. */
static void test_random_expressions_match_as_in_the_c_library(void) {
    static const char *const pieces[] = {"a", "b", "c",    ".",    "(",    ")",      "|",     "*",
                                         "+", "?", "[ab]", "[^a]", "a{2}", "b{1,2}", "(a|b)", "c*"};
    uint64_t state = 3;
    int compared = 0, matched = 0;
    for (int i = 0; i < 60000; i++) {
        char expression[64] = "", anchored[80], text[8] = "";
        regex_t theirs;
        state = state * 6364136223846793005u + 1442695040888963407u;
        for (uint64_t bits = state >> 20, n = bits % 7; n > 0; n--, bits /= 16)
            strcat(expression, pieces[bits % 16]);
        snprintf(anchored, sizeof anchored, "^(%s)$", expression);
        if (has_lazy_repetition(expression) || match(expression, "") < 0 ||
            regcomp(&theirs, anchored, REG_EXTENDED) != 0)
            continue;
        for (int t = 0; t < 40; t++) {
            int length = t % 6;
            for (int k = 0; k < length; k++)
                text[k] = (char)('a' + (state >> (2 * k + t)) % 3);
            text[length] = 0;
            int expected = regexec(&theirs, text, 0, NULL, 0) == 0;
            int actual = iso_regex_matches(&compiled, text, length);
            compared++;
            matched += actual;
            if (!CHECK_EQUAL(expected, actual))
                fprintf(stderr, "  /%s/ on %s\n", expression, text);
        }
        regfree(&theirs);
    }
    CHECK(compared > 100000 && matched > 10000);
}

/* What takes backtracking matchers longer than the world stands. */
static void test_no_expression_takes_long(void) {
    static char text[30000];
    memset(text, 'a', sizeof text - 1);
    CHECK_EQUAL(0, match("(a*)*b", text));
    CHECK_EQUAL(0, match("(a|a)*b", text));
    CHECK_EQUAL(0, match("(a?){60}a{60}b", text));
    CHECK_EQUAL(1, match(".*.*.*.*a", text));
}

int main(void) {
    RUN(test_the_whole_text_must_match);
    RUN(test_what_is_not_supported_is_refused);
    RUN(test_random_expressions_match_as_in_the_c_library);
    RUN(test_no_expression_takes_long);
    return check_verdict();
}
