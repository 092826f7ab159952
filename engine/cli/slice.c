/* isoslice slice: models become G-code. */
#include <isoslice/job.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "progress.h"
#include "verbs.h"
#include "warnings.h"

static void print_summary(const iso_report *report, const char *output) {
    int seconds = (int)(report->print.time + 0.5);
    fprintf(stderr, "%s: %d layers, %.2f m of filament, %dh %dm %ds to print; sliced in %.2f s\n",
            strcmp(output, "-") == 0 ? "standard output" : output, report->layer_count,
            report->print.filament_mm / 1000, seconds / 3600, seconds / 60 % 60, seconds % 60,
            report->seconds);
}

/* ---- the job ---- */

/* The date in the G-code: a constant one unless one is asked for, so that output stays the same.
 * SOURCE_DATE_EPOCH is https://reproducible-builds.org/specs/source-date-epoch */
static iso_status choose_timestamp(int64_t *timestamp, bool real) {
    const char *text = getenv("SOURCE_DATE_EPOCH");
    *timestamp = real ? (int64_t)time(NULL) : 0;
    if (real || !text || !*text)
        return ISO_OK;
    size_t digits = strspn(text, "0123456789");
    if (text[digits] != 0 || digits > 15)
        return iso_fail(ISO_USAGE, "SOURCE_DATE_EPOCH: %.40s is not a number of seconds", text);
    *timestamp = strtoll(text, NULL, 10);
    return ISO_OK;
}

iso_status iso_slice_files(iso_report *report, const iso_arguments *arguments,
                           const iso_options *options, const iso_lattice_cut *cut,
                           const char *output) {
    iso_progress line = {0};
    iso_job_hooks hooks = {.threads = arguments->threads, .lattice_cut = cut};
    bool talks = arguments->progress && !arguments->quiet;
    ISO_TRY(choose_timestamp(&hooks.timestamp, arguments->timestamp));
    if (talks) {
        hooks.progress = iso_progress_draw;
        hooks.payload = &line;
    }
    iso_status status =
        iso_job_run(report, options, arguments->file, arguments->file_count, output, &hooks);
    iso_progress_clear(&line);
    if (status == ISO_OK && talks)
        print_summary(report, output);
    return status;
}

iso_status iso_finish_job(iso_report *report, const iso_arguments *arguments,
                          const iso_options *options, iso_status status) {
    char message[1024];
    snprintf(message, sizeof message, "%s", iso_error_message());
    iso_status after = iso_warnings_add(report, &arguments->notes);
    if (!arguments->quiet)
        iso_warnings_print(report);
    const char *path = arguments->json && !arguments->report ? "-" : arguments->report;
    if (after == ISO_OK && path)
        after = iso_report_write(report, options, status, message, path);
    if (status == ISO_OK)
        return after;
    if (after != ISO_OK)
        fprintf(stderr, "isoslice: %s\n", iso_error_message());
    return iso_fail(status, "%s", message);
}

iso_status iso_verb_slice(const iso_arguments *arguments) {
    char name[4096];
    const char *output = arguments->output;
    if (arguments->file_count == 0)
        return iso_fail(ISO_USAGE, "no model given; see isoslice --help");
    if (!output) {
        ISO_TRY(iso_replace_ending(name, sizeof name, arguments->file[0], ".gcode"));
        output = name;
    }
    if (arguments->report && strcmp(arguments->report, output) == 0)
        return iso_fail(ISO_USAGE, "%s: can't hold both the G-code and the report", output);
    ISO_TRY(iso_keep_files(arguments, output));
    ISO_TRY(iso_keep_files(arguments, arguments->report));
    iso_report report = {0};
    iso_status status = iso_slice_files(&report, arguments, &arguments->options, NULL, output);
    status = iso_finish_job(&report, arguments, &arguments->options, status);
    iso_report_free(&report);
    return status;
}
