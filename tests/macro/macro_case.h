/* One text, evaluated with the options, the job and the variables of the test. */
#ifndef TESTS_MACRO_CASE_H
#define TESTS_MACRO_CASE_H

#include "check.h"
#include "config/foreign.h"
#include "macro/macro.h"

static iso_options options;
static iso_macro_globals globals;
static char expanded[1 << 16];

static const iso_vec2 case_hull[] = {{95, 90}, {105, 95}, {100, 112.5}};
static const iso_macro_job case_job = {.input_filename = "models/part.one.stl",
                                       .timestamp = 1795319958,
                                       .object_count = 2,
                                       .instance_count = 3,
                                       .layer_count = 40,
                                       .print_min = {95, 90},
                                       .print_max = {105, 112.5},
                                       .hull_count = 3,
                                       .hull = case_hull};
static const iso_macro_number case_number[] = {
    {"layer_num", 7, true}, {"layer_z", 2.45, false}, {"max_layer_z", 2.45, false}};

static iso_status expand_case(const char *text) {
    const iso_macro_scope scope = {&options, &case_job, case_number, 3, &globals};
    return iso_macro_expand(expanded, sizeof expanded, text, "start_gcode", &scope);
}

typedef struct macro_case {
    const char *text, *result;
} macro_case;

static inline void check_cases(const macro_case *cases, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (!CHECK_OK(expand_case(cases[i].text)) || !CHECK(strcmp(expanded, cases[i].result) == 0))
            fprintf(stderr, "  %s\n  is %s\n not %s\n", cases[i].text, expanded, cases[i].result);
        CHECK_OK(iso_macro_check(cases[i].text, "start_gcode"));
    }
}

/* `result` is the message behind "start_gcode, line ". */
static inline void check_refused(const macro_case *cases, size_t count) {
    for (size_t i = 0; i < count; i++) {
        CHECK_STATUS(ISO_BAD_CONFIG, expand_case(cases[i].text));
        const char *message = iso_error_message();
        size_t begin = strlen("start_gcode, line ");
        if (!CHECK(strlen(message) > begin && strcmp(message + begin, cases[i].result) == 0))
            fprintf(stderr, "  %s\n  is %s\n not %s\n", cases[i].text, message, cases[i].result);
        CHECK(expanded[0] == 0);
    }
}

#define CHECK_CASES(cases) check_cases(cases, sizeof(cases) / sizeof *(cases))
#define CHECK_REFUSED(cases) check_refused(cases, sizeof(cases) / sizeof *(cases))

#endif
