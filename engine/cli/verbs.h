/* What the program does, one function a verb, and what it prints about itself. */
#ifndef ISO_CLI_VERBS_H
#define ISO_CLI_VERBS_H

#include <isoslice/status.h>

#include <isoslice/lattice.h>
#include <isoslice/report.h>

#include "arguments.h"

iso_status iso_verb_slice(const iso_arguments *arguments) ISO_MUST_CHECK;
iso_status iso_verb_contours(const iso_arguments *arguments) ISO_MUST_CHECK;
iso_status iso_verb_info(const iso_arguments *arguments) ISO_MUST_CHECK;
iso_status iso_verb_preview(const iso_arguments *arguments) ISO_MUST_CHECK;
iso_status iso_verb_lattice(const iso_arguments *arguments) ISO_MUST_CHECK;
iso_status iso_verb_channels(const iso_arguments *arguments) ISO_MUST_CHECK;

/* Slice the arguments' files with these options, `cut` taken out of its lattice (NULL: nothing). */
iso_status iso_slice_files(iso_report *report, const iso_arguments *arguments,
                           const iso_options *options, const iso_lattice_cut *cut,
                           const char *output) ISO_MUST_CHECK;

/* Print the warnings and write the report of a job that came to `status`, which is returned: one
 * that failed has a report too, and the first failure is the one that counts. */
iso_status iso_finish_job(iso_report *report, const iso_arguments *arguments,
                          const iso_options *options, iso_status status) ISO_MUST_CHECK;

/* Print arguments->page to standard output. */
iso_status iso_page_print(const iso_arguments *arguments) ISO_MUST_CHECK;

/* `file` with its ending replaced; the directory stays. ISO_USAGE if it is longer than size - 1. */
iso_status iso_replace_ending(char *out, size_t size, const char *file,
                              const char *ending) ISO_MUST_CHECK;

/* Whatever the case of its letters; a name that is nothing else has no ending. */
bool iso_ends_in(const char *path, const char *ending);

/* A result must not take the place of what it is made from: ISO_USAGE if `path` is one of the
 * files. NULL and "-" are none. */
iso_status iso_keep_files(const iso_arguments *arguments, const char *path) ISO_MUST_CHECK;

/* One file, no more and no less. */
iso_status iso_one_file(const iso_arguments *arguments) ISO_MUST_CHECK;

#endif
