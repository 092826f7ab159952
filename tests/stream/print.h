/* One print of a made-up job on a machine in memory, in virtual time, with what can go wrong. */
#ifndef TESTS_STREAM_PRINT_H
#define TESTS_STREAM_PRINT_H

#include <stdbool.h>
#include <stdint.h>

#include <isoprint/machine.h>

#include "stream/streamer.h"

enum { PRINT_COMMANDS = 4096, PRINT_TEXT = 96 };

typedef struct print_random {
    uint64_t state;
} print_random;

uint64_t print_random_next(print_random *random);
int print_random_below(print_random *random, int limit);
double print_random_unit(print_random *random);

/* Each command ends with " K" and its index, a word that no firmware looks at: so what was executed
 * is told from what the host said by itself. */
typedef struct print_job {
    int count;
    char commands[PRINT_COMMANDS][PRINT_TEXT];
    char *text; /* of the file, with comments and blank lines */
    size_t length;
    bool
        tiny; /* moves of less than makes a block of the planner sure: what is made can't be told */
} print_job;

/* Heats, homes, moves about for `moves` commands, cools. */
void print_job_make(print_job *job, uint64_t seed, int moves);
void print_job_free(print_job *job);

typedef enum print_act {
    PRINT_NOTHING,
    PRINT_PAUSE, /* and go on after a while */
    PRINT_CANCEL,
    PRINT_STOP,
    PRINT_KILL /* the host dies: what a journal got is all that is known */
} print_act;

typedef struct print_plan {
    fio_machine_options machine;
    fio_stream_options stream;
    print_act act;
    double act_at, act_for;
    double most_seconds; /* of virtual time */
    bool verbose;
} print_plan;

/* What the printer did in all runs together. */
typedef struct print_record {
    const print_job *job;
    fio_machine *machine;
    int executed[PRINT_COMMANDS];   /* times; of commands that the machine surely made */
    int next;                       /* the command whose turn it is; -1: any, a new run begins */
    int last_executed;              /* by the runs before */
    int first;                      /* command of this run; -1: none yet */
    int64_t number[PRINT_COMMANDS]; /* that the command had in this run */
    int64_t wrong;                  /* commands executed out of order, twice, or not as they are */
    int64_t altered;                /* of these: not as they are, by their number or their text */
    char first_wrong[200];
    int64_t resets, run_resets, print_resets; /* before, and when the run, its print, began */
    bool verbose, ending;
} print_record;

typedef struct print_result {
    fio_status status;
    char message[512];
    fio_stream_report report;
    fio_stream_resume resume; /* of the report, or of the last mark of a killed host */
    bool hung, killed, plugged, acted;
    double seconds, idle_loops;
    int64_t loops;
} print_result;

fio_machine *print_machine(print_record *record, const print_job *job, const print_plan *plan);

/* Go on with `resume`, NULL: from the beginning. `plan`'s act happens in this run. */
void print_run(print_result *result, print_record *record, const print_plan *plan, double start,
               const fio_stream_resume *resume);

#endif
