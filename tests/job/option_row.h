/* Every option does to the G-code what its help says. Options are tested in tables, a table a
 * subject, each in a file option_SUBJECT.c:
 *
 *     static void key(const change *c) { ... CHECK(...) }
 *     const option_row option_rows_subject[] = {
 *         {make_block, "key", "value", "other = settings", key},
 *         {0},
 *     };
 *
 * and named in the list of test_options.c. The model is printed twice, with the other settings
 * alone and with the option as well; both prints go through the checks of any print (checks.h). */
#ifndef TESTS_JOB_OPTION_ROW_H
#define TESTS_JOB_OPTION_ROW_H

#include "checks.h"

typedef struct change {
    const print *a, *b; /* without the option, with it */
} change;

typedef struct option_row {
    void (*make)(shape *s);
    const char *key, *value;
    const char *base; /* settings of both, lines of "key = value" */
    void (*check)(const change *c);
} option_row;

#define STEADY "cooling = 0\n"

void make_block(shape *s); /* 16 x 16 x 3 mm */
void make_small(shape *s); /* 9 x 9 x 3 mm */
void make_part(shape *s);  /* a block beside a round tower: curved walls, travels of all lengths */

/* The same moves one by one, E, F and fan aside? */
int same_places(const print *a, const print *b);
int same_filament(const print *a, const print *b);

#endif
