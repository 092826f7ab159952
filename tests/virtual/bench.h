/* A machine on the bench: send it text, let time pass, see what it says. */
#ifndef TESTS_VIRTUAL_BENCH_H
#define TESTS_VIRTUAL_BENCH_H

#include <stdio.h>
#include <stdlib.h>

#include <isoprint/machine.h>

#include "check.h"

enum { BENCH_HEARD = 1 << 18, BENCH_LOGGED = 1 << 16 };

typedef struct bench {
    fio_machine *machine;
    double now;
    size_t used, logged;
    int64_t entries;
    char heard[BENCH_HEARD]; /* all it said since the last look */
    char log[BENCH_LOGGED];  /* the text of each known command executed, a line each */
    double last_start, last_end;
    bool (*judge)(struct bench *b, const fio_executed *executed); /* NULL: of no interest */
    int64_t number, wrong;                                        /* the judge's */
} bench;

static inline void bench_entry(void *context, const fio_executed *executed) {
    bench *b = context;
    b->entries++;
    CHECK(executed->start >= b->last_start - 1e-9);
    b->last_start = executed->start;
    b->last_end = executed->start + executed->duration;
    if (b->judge && !b->judge(b, executed))
        b->wrong++;
    if (executed->known && b->logged + executed->length + 2 < sizeof b->log)
        b->logged += (size_t)sprintf(b->log + b->logged, "%s\n", executed->text);
}

/* Quick and quiet: no reset by DTR, no busy. */
static inline fio_machine_options bench_options(void) {
    fio_machine_options options = fio_machine_options_defaults();
    options.rate = 250000;
    options.reset_on_dtr = false;
    return options;
}

static inline bench *bench_make(fio_machine_options options) {
    bench *b = calloc(1, sizeof *b);
    options.log = (fio_execution_log){bench_entry, b};
    if (!b || fio_machine_create(&b->machine, &options) != FIO_OK) {
        fprintf(stderr, "no machine: %s\n", fio_error_message());
        exit(1);
    }
    return b;
}

static inline bench *bench_script(const char *script) {
    fio_machine_options options = bench_options();
    options.script = script;
    return bench_make(options);
}

static inline void bench_free(bench *b) {
    fio_machine_free(b->machine);
    free(b);
}

static inline void bench_hear(bench *b) {
    size_t count;
    do {
        count =
            fio_machine_read(b->machine, b->now, b->heard + b->used, sizeof b->heard - 1 - b->used);
        b->used += count;
    } while (count > 0);
    b->heard[b->used] = 0;
}

static inline void bench_pass(bench *b, double seconds) {
    double end = b->now + seconds;
    for (int64_t turns = 0; CHECK(turns < 10000000); turns++) {
        double next = fio_machine_next(b->machine);
        CHECK(next >= b->now);
        b->now = next < end ? next : end;
        fio_machine_advance(b->machine, b->now);
        bench_hear(b);
        if (!(next < end))
            return;
        if (next == b->now && fio_machine_readable(b->machine))
            return;
    }
}

static inline void bench_send(bench *b, const char *text) {
    for (size_t left = strlen(text); left > 0;) {
        size_t taken = fio_machine_write(b->machine, b->now, text, left);
        text += taken;
        left -= taken;
        if (taken == 0)
            bench_pass(b, 0.001);
    }
}

/* Send, wait, and return what was said since the last look. */
static inline const char *bench_ask(bench *b, const char *text, double seconds) {
    b->used = 0;
    b->heard[0] = 0;
    bench_send(b, text);
    bench_pass(b, seconds);
    return b->heard;
}

static inline int bench_count(const char *text, const char *word) {
    int count = 0;
    for (const char *p = text; (p = strstr(p, word)); p += strlen(word))
        count++;
    return count;
}

/* `command` with number and checksum and line end, in one of four places that take turns. */
static inline const char *bench_line(int number, const char *command) {
    static char texts[4][300];
    static int turn;
    char *text = texts[turn++ & 3];
    int length = snprintf(text, 280, "N%d %s", number, command);
    unsigned sum = 0;
    for (int i = 0; i < length; i++)
        sum ^= (unsigned char)text[i];
    snprintf(text + length, 8, "*%u\n", sum);
    return text;
}

/* What was said must be this. */
static inline void bench_expect(bench *b, const char *text, double seconds, const char *expected) {
    const char *heard = bench_ask(b, text, seconds);
    if (!CHECK(!strcmp(heard, expected)))
        fprintf(stderr, "    %.60s was answered by:\n%.600s\n    not by:\n%s", text, heard,
                expected);
}

#endif
