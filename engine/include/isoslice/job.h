/* A whole job: models in, G-code out. */
#ifndef ISOSLICE_JOB_H
#define ISOSLICE_JOB_H

#include <isoslice/config.h>
#include <isoslice/report.h>
#include <isoslice/status.h>

/* What the caller adds to a job. Zero-initialise. */
typedef struct iso_job_hooks {
    int32_t threads;   /* 0: as many as the machine has processors */
    int64_t timestamp; /* seconds since 1970, UTC, for the G-code's first line */
    /* Called now and then on the calling thread, done from 0 to 1; may be NULL. */
    void (*progress)(void *payload, double done, const char *stage);
    void *payload;
    const iso_lattice_cut
        *lattice_cut; /* void all the same, in lattices of a single object; or NULL
                       */
} iso_job_hooks;

/* Slice the models into one print and write its G-code to `output` ("-": standard output), whole or
 * not at all. Models keep their places relative to each other; their common box is centred on the
 * bed and set down on it. `report` (zeroed or freed before) tells what happened as far as the job
 * came; free it in any case. The same bytes for any number of threads. Statuses are those of the
 * stages, and ISO_OUTSIDE: the models or the skirt reach beyond the bed or max_print_height, or
 * there is nothing to print at these layers; ISO_NOT_VERIFIED: the sliced volume isn't the model's.
 */
ISO_API iso_status iso_job_run(iso_report *report, const iso_options *options,
                               const char *const *input, int32_t input_count, const char *output,
                               const iso_job_hooks *hooks) ISO_MUST_CHECK;

#endif
